"""The characteristics of a study and their positions."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar, cast

import numpy as np

from ...core.named_types import Array
from ...core.validator import Validator
from ..analysis.compliance.flexibility import HELD
from ..assembly.assembly import Assembly
from ..assembly.by_wheel import columns_of
from ..assembly.of import assembly_of
from ..assembly.quantity import Quantity
from .design_variables import DesignVariable, scaled
from .evaluation import Subject, available, listed, usual_positions, values_of
from .sweep_axes import given_axis, sweep_axes_of, sweep_axis


@dataclass(frozen=True)
class Curves:
    """The characteristics of a study, and their positions."""

    # one of `sweep_axes.ALL_AXES`, with its options; or the support of the wheel under loads
    over: str
    positions: Array  # [m]; over roll [rad]
    names: tuple[str, ...]

    @property
    def along(self) -> Quantity:
        """The quantity of the positions."""
        return sweep_axis(self.over).along

    def quantity(self, name: str) -> Quantity:
        """Return the quantity of a characteristic."""
        return sweep_axis(self.over).known[name]

    def of(self, assembly: Assembly) -> Array:
        """Return the values, (names, positions), in SI units, or raise a `PositionError`."""
        found = values_of(assembly, self.over, self.positions, self.names)
        return np.array([found[name] for name in self.names])


class CurveBundle:
    """Curves of which those over one axis are evaluated together."""

    def __init__(self, curves: Sequence[Curves]) -> None:
        self._curves = tuple(curves)
        self._looks: dict[str, Curves] = {}
        for over in dict.fromkeys(c.over for c in curves):
            same = [c for c in curves if c.over == over]
            positions = np.unique(np.concatenate([c.positions for c in same]))
            names = dict.fromkeys(name for c in same for name in c.names)
            self._looks[over] = Curves(over, positions, tuple(names))

    def of(self, assembly: Assembly) -> list[Array]:
        """Return the values of each of the curves, of shape (names, positions), SI units."""
        found = {over: look.of(assembly) for over, look in self._looks.items()}
        return [self._part(curves, found[curves.over]) for curves in self._curves]

    def _part(self, curves: Curves, values: Array) -> Array:
        look = self._looks[curves.over]
        rows = [look.names.index(name) for name in curves.names]
        return values[rows][:, np.searchsorted(look.positions, curves.positions)]


S = TypeVar("S", bound=Subject)


def changed(suspension: S, changes: Mapping[str, float]) -> S:
    """Return a subject with other values, in the units of the file; lists change by a factor."""
    if not changes:
        return suspension
    return cast("S", suspension.with_changes(scaled(suspension, changes)))


def curves_of(
    given: Validator,
    suspension: Subject,
    over: Any,
    positions: Any,
    names: Sequence[str] | None,
    held: Any = None,
) -> Curves:
    """Return the checked curves; by default all characteristics over the usual positions.

    With a support of the wheels under loads (`held`) these are compliances.
    """
    axes, assembly = sweep_axes_of(suspension), assembly_of(suspension)
    if isinstance(over, str):
        assembly.refuse_motion(over)
    over = axes[0] if over is None else given_axis(given, "over", over, axes)
    if held is not None:
        over = _held(given, suspension, over, held)
    if positions is not None:
        unit = "m" if given.failed else sweep_axis(over).along.units
        positions = given.array("positions", positions, unit, dimensions=[1])
    if given.failed:
        return Curves("travel", np.zeros(1), ())
    if isinstance(names, list | tuple):
        assembly.refuse_of_steering(names)
    if positions is None:
        positions = usual_positions(assembly, over)
    known = available(assembly, over)
    chosen = known if names is None else names_among(given, names, known, over)
    if not (chosen or given.failed):
        given.fail(f"names is empty: one characteristic or more is needed, of {', '.join(known)}.")
    return Curves(over, positions, tuple(dict.fromkeys(chosen)))


def names_among(given: Validator, names: Any, known: Sequence[str], over: str) -> tuple[str, ...]:
    """Return the checked columns over an axis with some names, see `columns_of`."""
    if isinstance(names, list | tuple) and all(isinstance(name, str) for name in names):
        names = columns_of(names, known)
        known = listed(over, known, names)
    return given.names("names", names, known)


def _held(given: Validator, suspension: Subject, over: Any, held: Any) -> Any:
    """Return the checked support of the wheels under loads."""
    usual = sweep_axes_of(suspension)[0]
    if over != usual:
        given.fail(
            f"held: compliance is over {sweep_axis(usual).words}. Leave over = {over!r} out."
        )
    if not assembly_of(suspension).has_bushes:
        given.fail("held: compliance needs a file with [bushings]. Add them.")
    return given.among("held", held, HELD)


def refuse_bushes(given: Validator, places: Iterable[DesignVariable], overs: Iterable[str]) -> None:
    """Add an error for values of bushes in a study without compliance."""
    soft = [place.name for place in places if place.of_bushes]
    if soft and not any(over in HELD for over in overs):
        given.fail(
            f"{', '.join(soft[:3])}{' ...' if soft[3:] else ''}: these results do not depend on "
            "bushes, since joints are rigid. Leave bushes out, or ask for compliance: give the "
            "support of the wheels (held), or limits and targets of compliance."
        )
