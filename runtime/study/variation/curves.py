"""The characteristics that are looked at, of a suspension whose values change."""

from collections.abc import Container, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...suspension.kinds import Suspension
from ...suspension.model import Model
from ..characteristics.datasets import ALONG, over_rack, over_travel, refuse_of_steering
from ..loads.compliance import COMPLIANCES, compliance
from ..loads.flexibility import HELD, Held
from ..sweep import usual_rack, usual_travel

Array = NDArray[np.float64]
Over = Literal["travel", "rack"]
Way = Over | Held
"""Characteristics over wheel travel or the rack; or compliance over wheel travel, by what holds the
wheel under the loads."""


@dataclass(frozen=True)
class Curves:
    """Which characteristics are looked at, and where.

    Attributes
    ----------
    over : str
        'travel' or 'rack'; or what holds the wheel under loads.
    positions : ndarray
        Wheel travel, or displacement of the rack [m].
    names : tuple of str
        The characteristics.
    """

    over: Way
    positions: Array
    names: tuple[str, ...]

    def of(self, model: Model) -> Array:
        """Return the values, of shape (names, positions), SI units.

        Raises
        ------
        PositionError
            If a position is out of reach.
        """
        found = values_of(model, self.over, self.positions, self.names)
        return np.array([found[name] for name in self.names])


class Together:
    """Curves that are evaluated together: at once over wheel travel, and at once over the rack."""

    def __init__(self, curves: Sequence[Curves]) -> None:
        self._curves = tuple(curves)
        self._looks: dict[Way, Curves] = {}
        for over in dict.fromkeys(c.over for c in curves):
            same = [c for c in curves if c.over == over]
            positions = np.unique(np.concatenate([c.positions for c in same]))
            names = dict.fromkeys(name for c in same for name in c.names)
            self._looks[over] = Curves(over, positions, tuple(names))

    def of(self, model: Model) -> list[Array]:
        """Return the values of each of the curves, of shape (names, positions), SI units."""
        found = {over: look.of(model) for over, look in self._looks.items()}
        return [self._part(curves, found[curves.over]) for curves in self._curves]

    def _part(self, curves: Curves, values: Array) -> Array:
        look = self._looks[curves.over]
        rows = [look.names.index(name) for name in curves.names]
        columns = np.searchsorted(look.positions, curves.positions)
        return values[rows][:, columns]


def values_of(
    model: Model, over: Way, positions: Array, names: Container[str] | None = None
) -> dict[str, Array]:
    """Return characteristics or compliance by name, all that there are or some."""
    if over in HELD:
        found = compliance(model, None, positions, held=cast("Held", over))
        return {name: found[name].values for name in COMPLIANCES}
    values = over_travel if over == "travel" else over_rack
    return {q.name: v for q, v in values(model, positions, names=names).items()}


def there(model: Model, over: Way) -> tuple[str, ...]:
    """Return the characteristics, or compliance, for which the file has the data."""
    if over in HELD and not model.suspension.bushings:
        return ()
    return tuple(values_of(model, over, np.zeros(1)))


def model_of(suspension: Suspension, *, wheel_loads: bool = False) -> Model:
    """Return the model in which every body that has mass counts."""
    free_rack = bool(suspension.neglected_masses())
    return Model(suspension, free_rack=free_rack, wheel_loads=wheel_loads)


def changed(suspension: Suspension, changes: Mapping[str, float]) -> Suspension:
    """Return a suspension with other values, or the same."""
    return suspension.with_changes(changes) if changes else suspension


def curves_of(
    given: Arguments,
    suspension: Suspension,
    over: Any,
    positions: Any,
    names: Sequence[str] | None,
) -> Curves:
    """Check what is to be looked at; by default all characteristics over the usual positions."""
    over = given.among("over", over, ALONG)
    if positions is not None:
        positions = given.array("positions", positions, "m", dimensions=[1])
    if given.refused:
        return Curves("travel", np.zeros(1), ())
    if isinstance(names, list | tuple):
        refuse_of_steering(suspension, names)
    model = model_of(suspension)
    if positions is None:
        positions = (usual_travel if over == "travel" else usual_rack)(model)
    known = there(model, over)
    chosen = known if names is None else given.names("names", names, known)
    if not (chosen or given.refused):
        given.refuse(
            f"names is empty: one characteristic or more is needed, of {', '.join(known)}."
        )
    return Curves(over, positions, tuple(dict.fromkeys(chosen)))
