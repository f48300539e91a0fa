"""Inputs: what varies in time from outside, and which of it is the rate of something else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from .declared import Name, checked, declared

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping


@declared
@dataclass(frozen=True)
class Input:
    """A number that varies in time and is given from outside.

    Attributes
    ----------
    unit, meaning
        For the documentation of the generated code.
    derivative_of
        Name of the input whose rate this one is. Whoever simulates gives that one alone.
    """

    name: Name
    unit: str
    meaning: str
    derivative_of: Name | None = None


@checked
def motion(name: Name, unit: str, meaning: str) -> list[Input]:
    """Position, velocity and acceleration that prescribe a coordinate [m or rad]."""
    position, velocity, acceleration = position_of(name), f"{name}_velocity", f"{name}_acceleration"
    return [
        Input(position, unit, meaning),
        Input(velocity, f"{unit}/s", f"rate of the {meaning}", derivative_of=position),
        Input(
            acceleration, f"{unit}/s^2", f"acceleration of the {meaning}", derivative_of=velocity
        ),
    ]


@dataclass(frozen=True)
class Motion:
    """The inputs that prescribe a coordinate.

    Attributes
    ----------
    name
        What the coordinate is called.
    position, velocity, acceleration
        Names of inputs: the coordinate, its rate, and the rate of that.
    """

    name: str
    position: str
    velocity: str
    acceleration: str

    @classmethod
    def of(cls, name: str, inputs: Collection[Input]) -> Motion:
        """Return the inputs of a motion, by its name and by what they are derivatives of."""
        position = position_of(name)
        velocity = derivative(position, inputs)
        acceleration = None if velocity is None else derivative(velocity, inputs)
        assert velocity is not None  # checked with the model
        assert acceleration is not None
        return cls(name, position, velocity, acceleration)

    @property
    def rates(self) -> tuple[str, str]:
        """Velocity and acceleration: what is zero while the coordinate stands still."""
        return self.velocity, self.acceleration


def position_of(motion: str) -> str:
    """Return the name of the input that says where a prescribed coordinate is."""
    return f"{motion}_position"


def derivative(name: str, inputs: Collection[Input]) -> str | None:
    """Return the name of the input that is the rate of another one; None: there is none."""
    return next((i.name for i in inputs if i.derivative_of == name), None)


def motion_problems(motion: str, inputs: Collection[Input]) -> list[str]:
    """Say which input of a prescribed motion is missing."""
    last = position_of(motion)
    if last not in {entry.name for entry in inputs}:
        return []  # told as an unknown name
    for rate in ("velocity", "acceleration"):
        found = derivative(last, inputs)
        if found is None:
            problem = (
                f"prescribed motion {motion!r}: no input is the rate of {last!r}; declare "
                f"Input('{motion}_{rate}', ..., derivative_of={last!r})"
            )
            return [problem]
        last = found
    return []


def input_problems(inputs: Collection[Input]) -> list[str]:
    """Find inputs that are rates of nothing, of themselves, or of what has a rate already."""
    sources = {entry.name: entry.derivative_of for entry in inputs}
    rates: dict[str, str] = {}
    problems = []
    for name, source in sources.items():
        if source is None:
            continue
        if source not in sources:
            others = ", ".join(n for n in sources if n != name) or "no other"
            problems.append(
                f"input {name!r}: derivative_of={source!r} is not declared; there are {others}"
            )
        elif source in rates:
            problems.append(
                f"inputs {rates[source]!r} and {name!r} are both the derivative of {source!r}; "
                "leave one of them out"
            )
        elif _comes_back(name, sources):
            problems.append(f"input {name!r} is the derivative of itself; say of what else")
        rates.setdefault(source, name)
    return problems


def _comes_back(name: str, sources: Mapping[str, str | None]) -> bool:
    """Tell whether an input follows from itself."""
    passed: set[str | None] = {None}
    source = sources[name]
    while source not in passed and source != name:
        passed.add(source)
        source = sources.get(str(source))
    return source == name
