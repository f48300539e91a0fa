"""Inputs, which vary in time: forces, roads, motions of joints."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

from ...core.si_units import powers_of, problem_of, rate_of
from .declared import DeclarationError, Name, declared

if TYPE_CHECKING:
    from collections.abc import Iterable


@declared
@dataclass(frozen=True)
class Input:
    """A number that varies in time and is given by the caller.

    Attributes
    ----------
    name
        Name of the input in the generated code and of the argument of a simulation.
    unit
        Unit of SI without a prefix: N, N m, m, rad, m/s.
    meaning
        Description in the documentation of the generated code.
    derivative_of
        The input of which this one is the time derivative; a simulation computes it from that one.
        None: an input of its own.
    """

    name: Name
    unit: str
    meaning: str
    derivative_of: Any = None

    def __post_init__(self) -> None:
        source, problem = self.derivative_of, problem_of(self.unit)
        if source is not None and not isinstance(source, Input):
            problem = f"derivative_of is {source!r}; an Input is needed"
        elif source is not None and not problem:
            unit = rate_of(source.unit)
            if powers_of(unit) != powers_of(self.unit):
                problem = f"it is in {self.unit}, and the rate of {source.name!r} in {unit}"
        if problem:
            raise DeclarationError(f"Input {self.name!r}", [problem])


@declared
@dataclass(frozen=True)
class Motion:
    """The prescribed motion of a joint: its position, velocity and acceleration as inputs.

    Attributes
    ----------
    name
        Prefix of the names of its inputs, ``<name>_position``, ``_velocity`` and ``_acceleration``.
    unit
        Unit of the position: m for a guide, rad for a hinge.
    position, velocity, acceleration
        Descriptions of the three inputs; the latter two follow from the first by default.
    """

    name: Name
    unit: str
    position: str
    velocity: str = ""
    acceleration: str = ""

    def __post_init__(self) -> None:
        if self.unit not in ("m", "rad"):
            problem = f"unit {self.unit!r}: 'm' is needed for a guide, 'rad' for a hinge"
            raise DeclarationError(f"Motion {self.name!r}", [problem])

    @cached_property
    def inputs(self) -> tuple[Input, Input, Input]:
        """Position, velocity and acceleration."""
        name, unit = self.name, self.unit
        rate = self.velocity or f"rate of the {self.position}"
        change = self.acceleration or f"acceleration of the {self.position}"
        position = Input(f"{name}_position", unit, self.position)
        velocity = Input(f"{name}_velocity", rate_of(unit), rate, position)
        rate_unit = rate_of(velocity.unit)
        return position, velocity, Input(f"{name}_acceleration", rate_unit, change, velocity)

    @property
    def rates(self) -> tuple[str, str]:
        """Names of velocity and acceleration, which are zero while the joint does not move."""
        _, velocity, acceleration = self.inputs
        return velocity.name, acceleration.name


def input_problems(inputs: Iterable[Input]) -> list[str]:
    """Return problems of inputs that are rates of the same input."""
    rates: dict[Input, str] = {}
    problems = []
    for entry in inputs:
        source = entry.derivative_of
        if source is not None and rates.setdefault(source, entry.name) != entry.name:
            problems.append(
                f"inputs {rates[source]!r} and {entry.name!r} are both the derivative of "
                f"{source.name!r}; leave one of them out"
            )
    return problems
