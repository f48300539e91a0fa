"""Interface of forces: their actions, signals and descriptions."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, ClassVar

from ..bodies import Ground
from ..declared import DeclarationError

if TYPE_CHECKING:
    from collections.abc import Iterator

    import sympy as sp

    from ..bodies import Body
    from ..inputs import Input
    from ..joints import Joint
    from ..parameters import Parameter
    from ..shown import Shown
    from ..surroundings import Surroundings


@dataclass(frozen=True)
class Action:
    """The generalised forces of a force, as expressions, and values for its signals.

    Attributes
    ----------
    forces
        Generalised force [N or N m] by the name of the coordinate. That along a prescribed
        coordinate does no work on the others, and is ignored.
    values
        Values of its signals, by name.
    total
        Force [N] or moment [N m] that pushes two ends apart, of an element with ends.
    rates
        Rates of its internal states, by name.
    """

    forces: dict[str, sp.Expr]
    values: dict[str, sp.Expr] = field(default_factory=dict)
    total: sp.Expr | None = None
    rates: dict[str, sp.Expr] = field(default_factory=dict)


@dataclass(frozen=True)
class Description:
    """Description of a force in reports."""

    name: str
    acts: str  # action, with names of parameters and inputs
    share: str  # share of Q, by the paper's Eqs. 23 and 24: words, or LaTeX between `$` and `$`.


class Force(ABC):
    """The base of all forces, also of your own: a dataclass with the decorator `declared`.

    Bodies, inputs and parameters in its fields become those of the mechanism. A copy of the force
    has copies of its fields; the class attribute `turns_about` has the names of those fields that
    are axes of rotation. A force appends steps to a program; derivatives are those of the steps,
    and need no formulas of their own.
    """

    turns_about: ClassVar[tuple[str, ...]] = ()
    in_common: ClassVar[bool] = False
    """Whether it acts on all bodies, so that copies of a mechanism share it."""

    @property
    @abstractmethod
    def identity(self) -> tuple[str, str]:
        """Kind and name, which distinguish it from all other forces of a mechanism."""

    @property
    def along(self) -> Joint | None:
        """The joint along whose coordinate it acts, which must be driven."""
        return None

    def describe(self) -> Description:
        """Return its description in reports."""
        does = (type(self).__doc__ or "").partition("\n")[0]
        return Description(" ".join(self.identity), does, "its power by the rate")

    @abstractmethod
    def act(self, at: Surroundings) -> Action:
        """Append its steps to the program, and return its generalised forces."""

    def signals(self, at: Surroundings, action: Action) -> Iterator[Shown]:
        """Yield its signals, which may read the accelerations.

        Parameters
        ----------
        at
            Surroundings of the force.
        action
            Its action.
        """
        yield from ()


def road_problems(road: Input, damper: Parameter | None, road_velocity: Input | None) -> list[str]:
    """Return the problems of a road and its rate, which the damper of a tyre needs."""
    problems = []
    if road.unit != "m":
        problems.append(f"road {road.name!r} is in {road.unit}; m is needed")
    if (damper is None) != (road_velocity is None):
        problems.append("give damper and road_velocity, or neither")
    elif road_velocity is not None and road_velocity.derivative_of != road:
        problems.append(
            f"road_velocity {road_velocity.name!r} is not the rate of the road {road.name!r}; give "
            f"Input({road_velocity.name!r}, unit, meaning, derivative_of=the road)"
        )
    return problems


def check_applied(kind: str, body: Body, given: Input, unit: str) -> None:
    """Raise `DeclarationError` unless an external force is in its unit, on a body that moves."""
    problems = []
    if given.unit != unit:
        problems.append(f"input {given.name!r} is in {given.unit}; {unit} is needed")
    if isinstance(body, Ground):
        problems.append(f"it acts on {body.name!r}, which rests; give a body that moves")
    if problems:
        raise DeclarationError(f"{kind} by {given.name!r}", problems)
