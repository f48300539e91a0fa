"""The variables of an FMU, and the rest of its description, for any version of FMI."""

import hashlib
import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ...core.si_units import rate_of
from ..emitted import Emitted
from .crossings import Crossing, crossings

_SOLVER = {
    "solver.step": (
        "s",
        math.inf,
        (
            "fixed step of Co-Simulation; zero for the method of Dormand and Prince, whose steps "
            "follow the tolerance"
        ),
    ),
    "solver.implicit": (
        "1",
        1.0,
        (
            "method with the fixed step: 0 for the classical method of Runge and Kutta, 1 for the "
            "linearly implicit method RODASP, for stiff equations"
        ),
    ),
}
"""Parameters of the solver in Co-Simulation: unit, greatest value, meaning."""


@dataclass(frozen=True)
class Variable:
    """One variable."""

    reference: int  # value reference; they count from zero, in order
    name: str
    meaning: str
    unit: str
    # attributes of FMI; `initial` is empty for none
    causality: str
    variability: str = "continuous"
    initial: str = ""
    start: float | None = None
    derivative_of: int | None = None  # reference of the variable of which this is the derivative
    # infinite without a bound
    least: float = -math.inf
    most: float = math.inf


@dataclass(frozen=True)
class ModelDescription:
    """The description of an FMU."""

    emitted: Emitted

    @property
    def identifier(self) -> str:
        """Identifier of the model in C; its libraries have this name."""
        return self.emitted.name

    @property
    def manifest(self) -> dict[str, Any]:
        """Manifest of the equations."""
        return self.emitted.manifest

    @cached_property
    def crossings(self) -> tuple[Crossing, ...]:
        """Events of the signals, and guards beyond which there is no motion."""
        return crossings(self.manifest)

    # -- variables ------------------------------------------------------------------------------

    @cached_property
    def variables(self) -> tuple[Variable, ...]:
        """All variables, in the order of their references."""
        groups = (
            self._time, self._states, self._rates, self._inputs, self._outputs, self._events,
            self._parameters, self._solver,
        )  # fmt: skip
        found: list[Variable] = []
        for group in groups:
            found += group(len(found))
        return tuple(found)

    @property
    def states(self) -> Sequence[Variable]:
        """The continuous states."""
        return self.variables[1 : 1 + self._state_count]

    @property
    def rates(self) -> Sequence[Variable]:
        """Their derivatives."""
        return self.variables[1 + self._state_count : 1 + 2 * self._state_count]

    @property
    def inputs(self) -> Sequence[Variable]:
        """The inputs."""
        return [v for v in self.variables if v.causality == "input"]

    @property
    def parameters(self) -> Sequence[Variable]:
        """The parameters of the model."""
        return [v for v in self.variables if v.causality == "parameter" and v.name not in _SOLVER]

    @property
    def outputs(self) -> Sequence[Variable]:
        """The signals."""
        return [v for v in self.variables if v.causality == "output"]

    @property
    def events(self) -> Sequence[Variable]:
        """The event indicators."""
        start = 1 + 2 * self._state_count + len(self.inputs) + len(self.outputs)
        return self.variables[start : start + len(self.crossings)]

    @property
    def _state_count(self) -> int:
        return len(self.manifest["state"])

    def _time(self, first: int) -> list[Variable]:
        return [Variable(first, "time", "simulated time", "s", "independent")]

    def _states(self, first: int) -> list[Variable]:
        entries = self.manifest["state"].items()
        return [
            Variable(
                first + k, name, entry["meaning"], entry["unit"], "local", initial="exact",
                start=float(self.emitted.state[k]),
            )
            for k, (name, entry) in enumerate(entries)
        ]  # fmt: skip

    def _rates(self, first: int) -> list[Variable]:
        count = self._state_count
        return [
            Variable(
                first + k, f"der({name})", f"derivative of {name}", rate_of(entry["unit"]),
                "local", initial="calculated", derivative_of=first + k - count,
            )
            for k, (name, entry) in enumerate(self.manifest["state"].items())
        ]  # fmt: skip

    def _inputs(self, first: int) -> list[Variable]:
        inputs = self.manifest["inputs"]
        references = {name: first + k for k, name in enumerate(inputs)}
        return [
            Variable(
                first + k, name, entry["meaning"], entry["unit"], "input",
                start=float(self.emitted.inputs[k]),
                derivative_of=references.get(entry["derivative_of"]),
            )
            for k, (name, entry) in enumerate(inputs.items())
        ]  # fmt: skip

    def _outputs(self, first: int) -> list[Variable]:
        taken = {*self.manifest["state"], *self.manifest["inputs"], "time"}
        return [
            Variable(
                first + k, f"signals.{name}" if name in taken else name, entry["meaning"],
                entry["unit"], "output", initial="calculated",
            )
            for k, (name, entry) in enumerate(self.manifest["signals"].items())
        ]  # fmt: skip

    def _events(self, first: int) -> list[Variable]:
        units = [entry["unit"] for entry in self.manifest["signals"].values()]
        guards = [entry["unit"] for entry in self.manifest["guards"]]
        return [
            Variable(
                first + k, c.name, f"zero crossing: {c.meaning}",
                guards[c.guard] if c.signal < 0 else units[c.signal], "local", initial="calculated",
            )
            for k, c in enumerate(self.crossings)
        ]  # fmt: skip

    def _parameters(self, first: int) -> list[Variable]:
        return [
            Variable(
                first + k, f"parameters.{name}", entry["meaning"], entry["unit"], "parameter",
                "fixed", "exact", float(self.emitted.system.parameters[name]),
                least=max(entry.get("least", -math.inf), entry.get("above", -math.inf)),
                most=entry.get("most", math.inf),
            )
            for k, (name, entry) in enumerate(self.manifest["parameters"].items())
        ]  # fmt: skip

    def _solver(self, first: int) -> list[Variable]:
        return [
            Variable(
                first + k, name, meaning, unit, "parameter", "fixed", "exact", 0.0, least=0.0,
                most=most,
            )
            for k, (name, (unit, most, meaning)) in enumerate(_SOLVER.items())
        ]  # fmt: skip

    # -- numbers --------------------------------------------------------------------------------

    @property
    def values(self) -> list[float]:
        """Parameters, initial state and initial inputs, in the order of the library."""
        emitted = self.emitted
        return [*emitted.system.parameters.values(), *map(float, (*emitted.state, *emitted.inputs))]

    def token(self, version: int) -> str:
        """Return the token that the description and the library of one export share."""
        text = repr((version, self.variables, self.crossings, self.manifest["mechanism"]))
        digits = hashlib.sha256(text.encode()).hexdigest()
        parts = (digits[a:b] for a, b in ((0, 8), (8, 12), (12, 16), (16, 20), (20, 32)))
        return f"{{{'-'.join(parts)}}}"
