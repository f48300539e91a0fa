"""The equations of one mechanism: names from its manifest, and calls of its functions."""

import json
from collections.abc import Callable, Iterator, Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..core.named_types import Array
from ..core.physical import inertia_of_no_body, out_of_range
from .directions import ADJOINTS, TANGENTS, Directions, WiderArrays
from .errors import HEAVIER, WEIGHTLESS, ClosureError, ModelError, ParameterError, located, place_of
from .layout import StateLayout
from .residuals import Residuals
from .status import LAST_GUARD_BIT, NOT_FINITE, bit_of, mask_of

Code = Mapping[str, int | Callable[..., Any]]
"""The functions by name: addresses of C functions, or functions over NumPy arrays."""

# Functions whose guards an integration needs: those of the motion, of outputs, of poses.
_OF_A_SIMULATION = ("rhs", "forces", "signals", "positions", "orientations")
# Beginning of the names of constants that are one over the mass or inertia of a coordinate.
_OF_MASS = "inverse_pivot_"


def _result(
    shape: tuple[int, ...], operations: Mapping[str, int], described: Mapping[str, Any]
) -> str:
    """Return a text about the shape of a result and the operations of a call."""
    kinds = ", ".join(f"{n} {kind}" for kind, n in operations.items() if n and kind != "total")
    text = f"Result (..., {', '.join(map(str, shape))}); {operations['total']} operations"
    text += f" ({kinds or 'none'})"
    if "stage" in described:
        text += f", with all that {described['stage']} computes"
    if "iterates" in described:
        text += f"; iterates: {', '.join(described['iterates'])}"
    return f"{text}."


class Equations:
    """Compiled equations of one mechanism: contents of its manifest, and calls of its functions.

    One compiled function may have several results, which share computations: the poses together,
    mass matrix with bias and forces, and so on. Each result can be called separately, and then
    refuses a state only for its own guards.

    Parameters
    ----------
    manifest : mapping
        The contents of ``NAME.json``.
    code : mapping
        The functions that the manifest names.

    Attributes
    ----------
    manifest : mapping
    name : str
    parameter_names, state_names, input_names, relative_names, constant_names : tuple of str
    layout : StateLayout
        Positions, speeds and internal states in the state.
    guards : tuple of dict
        ``name``, ``meaning`` and ``unit`` of each.
    addresses : dict
        Addresses of the C functions, for native callers; empty without C code.
    default_constants : ndarray
        Constants of the default parameters.
    functions : dict
        Every result by its name, and every stage with all of its results: callables over arrays of
        states.
    """

    def __init__(self, manifest: Mapping[str, Any], code: Code) -> None:
        self.manifest = manifest
        self.name: str = manifest["name"]
        self.parameter_names = tuple(manifest["parameters"])
        self.state_names = tuple(manifest["state"])
        self.input_names = tuple(manifest["inputs"])
        self.layout = StateLayout.of(manifest["layout"])
        self.relative_names = tuple(manifest["relative_coordinates"])
        self.constant_names = tuple(manifest["constants"])
        self.guards = tuple(manifest["guards"])
        self.addresses = {n: at for n, at in code.items() if isinstance(at, int)}
        self._code = code
        # the compiled module only for C code
        self._calls: Any = import_module("._calls" if self.addresses else ".arrays", __package__)
        self.widths = (len(self.constant_names), len(self.state_names), len(self.input_names))
        self.no_inputs = np.zeros(len(self.input_names))
        self.default_constants = self.prepare(
            {key: entry["default"] for key, entry in manifest["parameters"].items()}
        )
        self._acting = {n: tuple(f["guards"]) for n, f in manifest["functions"].items()}
        self._acting |= {
            stage: tuple(sorted({g for part in self._parts_of(stage) for g in self._acting[part]}))
            for stage in manifest["stages"]
        }
        names = [*manifest["functions"], *manifest["stages"]]
        made = {name: self._function(name) for name in names if name != "residuals"}
        self.functions = {name: f for name, f in made.items() if not self._behind(name)}
        self.residuals = Residuals(self)
        self.directions = Directions(self, {n: f for n, f in made.items() if self._behind(n)})

    @classmethod
    def beside(cls, module: str, code: Code, mechanism: str) -> "Equations":
        """Return the equations whose manifest is in the folder of a module, from its ``__file__``.

        `code` has the functions that the manifest names; `mechanism` is the hash of the equations
        that they were compiled from. Raises `ModelError` if the manifest is that of other
        equations: calls would write outside of their arrays.
        """
        manifest = json.loads(Path(module).with_suffix(".json").read_text(encoding="utf-8"))
        if mechanism != manifest["mechanism"]:
            problem = (
                f"{manifest['name']}: its compiled code is that of other equations than its "
                f"manifest describes, {mechanism} and {manifest['mechanism']}. Build it again: "
                "`make build`, or reinstall the package."
            )
            raise ModelError(problem)
        return cls(manifest, code)

    def __repr__(self) -> str:
        return f"<Equations of {self.name}>"

    # -- the module of a mechanism ----------------------------------------------------------------

    def names(self) -> dict[str, Any]:
        """Return the names of the mechanism's module with their values."""
        manifest = self.manifest
        functions = manifest["functions"]
        return {
            "NAME": self.name,
            "MECHANISM_HASH": manifest["mechanism"],
            "ADDRESSES": self.addresses,
            "DEFAULT_CONSTANTS": self.default_constants,
            "PARAMETERS": manifest["parameters"],
            "STATE": manifest["state"],
            "LAYOUT": self.layout,
            "INPUTS": manifest["inputs"],
            "RELATIVE_COORDINATES": manifest["relative_coordinates"],
            "SIGNALS": manifest["signals"],
            "BODIES": tuple(manifest["bodies"]),
            "MASSIVE_BODIES": tuple(manifest["massive_bodies"]),
            "CONSTANTS": self.constant_names,
            "GUARDS": tuple((g["name"], g["meaning"]) for g in self.guards),
            "GUARD_UNITS": {g["name"]: g["unit"] for g in self.guards},
            "ACTING_GUARDS": {
                name: tuple(functions[name]["guards"])
                for name in _OF_A_SIMULATION
                if name in functions
            },
            "HELD_VARIANTS": {k: tuple(v) for k, v in manifest["held_variants"].items()},
            "ITERATES": self.iterates,
            "MOBILITY": manifest["mobility"],
            "DRAWING": manifest["drawing"],
            "LOOPS": tuple(tuple(t["bodies"]) for t in manifest["transformers"]),
            "ClosureError": ClosureError,
            "ModelError": ModelError,
            "ParameterError": ParameterError,
            "prepare": self.prepare,
            "prepare_many": self.prepare_many,
            "design_state": self.design_state,
            **self.functions,
            "DIRECTIONS": self.directions,
            "residuals": self.residuals,
            "__doc__": "\n".join(self._described()),
        }

    def _described(self) -> Iterator[str]:
        """Yield the lines of the module's docstring."""
        manifest, (constants, states, inputs) = self.manifest, self.widths
        yield f"{manifest['title']}."
        yield from ("", manifest["note"], "") if manifest["note"] else ("",)
        yield f"Every function takes\n\nstate : array_like, shape (..., {states})"
        yield f"    {', '.join(self.state_names)}"
        yield f"inputs : array_like, shape (..., {inputs}), optional"
        yield f"    {', '.join(self.input_names) or 'none'}; zero by default."
        yield f"constants : array_like, shape (..., {constants}), optional"
        yield "    From `prepare`; those of the default parameters if left out."
        yield "\nand returns a new array that has the broadcast leading dimensions of the three in"
        yield "front. All quantities are in SI units, axes are ISO 8855 (x forward, y left, z up);"
        yield "`STATE`, `INPUTS`, `PARAMETERS`, `SIGNALS` and `RELATIVE_COORDINATES` give unit,"
        yield "meaning and sign of every element. A state at which a loop cannot close raises"
        yield "`ClosureError`; there is no silent NaN.\n\nFunctions\n---------"
        own = ((n, f) for n, f in manifest["functions"].items() if not self._behind(n))
        for name, function in own:
            yield f"``{name}``\n    {function['doc']}"

    # -- functions --------------------------------------------------------------------------------

    def _parts_of(self, stage: str) -> dict[str, Mapping[str, Any]]:
        """Return the results of one compiled function in their order."""
        functions = self.manifest["functions"]
        return {n: f for n, f in functions.items() if f.get("stage", n) == stage}

    def _function(self, name: str) -> Any:
        """Return a callable for one result, or all results of a stage, over arrays of states."""
        stages = self.manifest["stages"]
        described = stages[name] if name in stages else self.manifest["functions"][name]
        stage: str = described.get("stage", name)
        behind = self._behind(name)
        labels = tuple(labels_of(described))
        if name in stages:
            parts = self._parts_of(name).items()
            labels = tuple(f"{part} {label}" for part, f in parts for label in labels_of(f))
        shape = tuple(described.get("shape", [len(labels)]))
        operations = stages.get(stage, described)["operations"]
        return self._calls.ModelFunction(
            WiderArrays(self, behind) if behind else self,
            name,
            self._code[stage],
            shape,
            labels,
            operations,
            f"{described['doc']}\n\n{_result(shape, operations, described)}",
            stage,
            described.get("start", 0),
            stages[stage]["size"] if stage in stages else len(labels),
            mask_of(self._acting[name]),
        )

    @property
    def iterates(self) -> bool:
        """Whether a loop is closed by iteration."""
        return any("iterates" in text for text in self.manifest["functions"].values())

    def _behind(self, name: str) -> tuple[int, ...]:
        """Return the numbers of values after constants, state and inputs; () for most functions."""
        parts = [*self._parts_of(name).values()] or [self.manifest["functions"][name]]
        part = parts[0].get("part")
        if part == TANGENTS:
            return self.widths
        if part == ADJOINTS:
            original = self.manifest["functions"][name.removesuffix("_adjoint")]
            return 0, 0, len(labels_of(original))
        return ()

    def call_of_parameters(self, function: str, given: Array, found: Array) -> int:
        """Fill the result of a function of parameters; return 0 or the number of an error."""
        return self._calls.call_prepare(self._code[function], given, found)

    def design_state(self, parameters: Mapping[str, float]) -> Array:
        """Return the state at rest in the design position of parameters by name (SI units)."""
        given = np.array([parameters[name] for name in self.parameter_names], dtype=np.float64)
        state = np.empty(len(self.state_names))
        self.call_of_parameters("design_state", given, state)
        return state

    def prepare(self, parameters: Mapping[str, float] | ArrayLike) -> Array:
        """Return the constants of one parameter set, read-only, in the order of ``CONSTANTS``.

        Parameters are values by name, or in the order of ``PARAMETERS``, in SI units. Raises
        `ParameterError` if a name is unknown or missing, a value is not finite or out of its range,
        an inertia is that of no body, or the geometry is degenerate.
        """
        values = self._ordered(parameters) if isinstance(parameters, Mapping) else parameters
        given = np.ascontiguousarray(values, dtype=np.float64)
        if given.shape != (len(self.parameter_names),):
            message = (
                f"{self.name}: {len(self.parameter_names)} parameters expected, "
                f"an array of shape {given.shape} given"
            )
            raise ParameterError(message)
        bad = [n for n, v in zip(self.parameter_names, given, strict=True) if not np.isfinite(v)]
        if bad:
            message = f"{self.name}: parameters that are NaN or infinite: {', '.join(bad)}"
            raise ParameterError(message)
        named = dict(zip(self.parameter_names, given.tolist(), strict=True))
        problems = out_of_range(named, self.manifest["parameters"]) or inertia_of_no_body(named)
        if problems:
            raise ParameterError(f"{self.name}: {'; '.join(problems)}")
        constants = np.empty(len(self.constant_names))
        failed = self.call_of_parameters("prepare", given, constants)
        if failed:
            raise ParameterError(f"{self.name}: {self._unusable(failed, constants)}")
        constants.flags.writeable = False
        return constants

    def prepare_many(self, parameters: Array) -> tuple[Array, Array, NDArray[np.bool_]]:
        """Return constants and design states of parameter sets, and which sets failed, (count,).

        Parameters, (count, parameters), are in the order of ``PARAMETERS``, finite and in their
        ranges, in SI units. Sets failed that `prepare` refuses; their constants are meaningless.
        """
        count = len(parameters)
        constants = np.empty((count, len(self.constant_names)))
        states = np.empty((count, len(self.state_names)))
        failed = np.zeros(count, dtype=bool)
        prepare, at_design = self._code["prepare"], self._code["design_state"]
        call = self._calls.call_prepare
        for k, given in enumerate(np.ascontiguousarray(parameters)):
            failed[k] = call(prepare, given, constants[k]) != 0
            call(at_design, given, states[k])
        return constants, states, failed

    def _ordered(self, parameters: Mapping[str, float]) -> list[float]:
        unknown = sorted(set(parameters) - set(self.parameter_names))
        missing = [name for name in self.parameter_names if name not in parameters]
        if unknown or missing:
            parts = [f"unknown parameters: {', '.join(unknown)}"] * bool(unknown)
            parts += [f"missing parameters: {', '.join(missing)}"] * bool(missing)
            message = f"{self.name}: {'; '.join(parts)}"
            raise ParameterError(message)
        return [parameters[name] for name in self.parameter_names]

    def _unusable(self, failed: int, constants: Array) -> str:
        """Return a message for the error number of `prepare`."""
        if failed <= len(self.constant_names):
            name = self.constant_names[failed - 1]
            if name.startswith(_OF_MASS):
                return f"{WEIGHTLESS.format(name.removeprefix(_OF_MASS))}; {HEAVIER}"
            return (
                f"the constant {name!r} is not finite: the geometry at "
                "the design position is degenerate (coincident points, or a point on a line that "
                "it must lie beside)"
            )
        broken = self.manifest["assumptions"][failed - len(self.constant_names) - 1]
        meaning, remedy, unit = broken["meaning"], broken["remedy"], broken["unit"]
        value = float(abs(constants[self.constant_names.index(broken["quantity"])]))
        least = broken.get("least")
        if least is None:
            return f"{meaning}: it is off by {_amount_off(value, unit)}; {remedy}"
        known = least in self.constant_names
        needed = float(constants[self.constant_names.index(least)] if known else least)
        return (
            f"{meaning}: {_amount_off(value, unit)}, and more than {_amount_off(needed, unit)} "
            f"is needed; {remedy}"
        )

    def call_residuals(
        self, constants: Array, state: Array, inputs: Array, given: Array, out: Array
    ) -> int:
        """Fill the closure residuals of one state and return the status word."""
        return self._calls.call_residuals(
            self._code["residuals"], constants, state, inputs, given, out
        )

    # -- errors -----------------------------------------------------------------------------------

    def refuse(
        self,
        function: str,
        status: int,
        constants: Array,
        state: Array,
        inputs: Array,
        index: tuple[int, ...],
    ) -> None:
        """Raise the error of a status word, with the quantities that explain it.

        It returns if the status is that of a guard which does not act in the function, but shares
        the last bit with one that does.
        """
        where = f"{self.name}.{function}"
        names = (*self.state_names, *self.input_names)
        coordinates = dict(zip(names, map(float, (*state, *inputs)), strict=True))
        described = {**self.manifest["state"], **self.manifest["inputs"]}
        bad = [n for n, v in coordinates.items() if not np.isfinite(v)]
        bad += [
            n for n, v in zip(self.constant_names, constants, strict=True) if not np.isfinite(v)
        ]
        if bad:
            message = f"{where}: NaN or infinite: {', '.join(bad)}{place_of(index)}"
            raise ModelError(message)
        margins = np.empty(len(self.guards))
        self._calls.call_margins(self._code["margins"], constants, state, inputs, margins)
        hit = [
            place
            for place in self._acting[function]
            if status >> bit_of(place) & 1 and (place < LAST_GUARD_BIT or not margins[place] > 0.0)
        ]
        if not hit and not status & NOT_FINITE:
            return
        if not hit:
            shown = located(coordinates, described)
            message = (
                f"{where}: the result is no finite number (it overflows double precision, or a "
                f"formula has no value there), at {shown}{place_of(index)}"
            )
            raise ModelError(message)
        raise ClosureError(
            where,
            [self.guards[place]["meaning"] for place in hit],
            {self.guards[place]["name"]: float(margins[place]) for place in hit},
            coordinates,
            index,
            {guard["name"]: guard["unit"] for guard in self.guards},
            described,
        )


def labels_of(described: Mapping[str, Any]) -> list[str]:
    """Return one label for each element of a result, row-major."""
    if "by" in described:
        return [f"{row} by {column}" for row in described["labels"] for column in described["by"]]
    return described.get("labels", [])


def _amount_off(value: float, unit: str) -> str:
    """Return a value in a display unit: a length, the sine of an angle, or any other quantity."""
    if unit == "m":
        return f"{1e3 * value:.3g} mm"
    if unit != "1":
        return f"{value:.3g} {unit}"
    return f"{np.degrees(np.arcsin(min(value, 1.0))):.3g} degrees"
