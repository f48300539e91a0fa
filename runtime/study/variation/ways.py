"""What may be looked at of a suspension, of an axle or of a rigid axle, and over what.

A way is what varies along curves: wheel travel or the rack of a suspension, the motions of a rig of
both wheels of an axle; or what holds the wheel under the loads of a compliance.
"""

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, cast, overload

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ...assembly.assembly import Assembly
from ...assembly.axle import AxleAssembly
from ...assembly.by_wheel import SIDES, flat
from ...assembly.of import assembly_of
from ...assembly.quantity import ROLL, TRAVEL, Quantity
from ...core.arguments import Arguments
from ...core.quantities import display_of
from ...suspension.axle import Axle
from ...suspension.kinds import Suspension
from ...suspension.model import Model
from ...suspension.rigid import RigidAxle
from ...suspension.rigid.model import RigidAxleModel
from ..characteristics.datasets import ALONG, KNOWN, OF_AXLES, dataset, flat_values
from ..compare import common_positions as common_to
from ..compliance.flexibility import HELD, Held
from ..compliance.linear import COMPLIANCES, COMPLIANCES_OF_AXLES, linear

Array = NDArray[np.float64]
Subject = Suspension | RigidAxle
"""What has values of its own that move."""

Looked = Model | RigidAxleModel | Axle
"""What curves are evaluated of."""

NEEDED = "a kintrafo.Suspension or a kintrafo.RigidAxle is needed"
_OF_SIDES = (
    "{name}: the values of an axle stand in the files of its sides, and studies move those of one "
    "file. Give a side, or a rigid axle."
)


@dataclass(frozen=True)
class Way:
    """What varies along some curves.

    Attributes
    ----------
    along : Quantity
    known : mapping of str to Quantity
        What is told over it, by name.
    words : str
        'wheel travel'.
    """

    along: Quantity
    known: Mapping[str, Quantity]
    words: str

    @property
    def unit(self) -> str:
        """The unit for people of what varies."""
        return display_of(self.along.attributes()).units

    @property
    def factor(self) -> float:
        """How many of them the SI unit has."""
        return display_of(self.along.attributes()).factor


_MOTIONS = {
    "bump": (TRAVEL, "parallel wheel travel"),
    "roll": (ROLL, "roll"),
    "left": (TRAVEL, "travel of the left wheel"),
    "right": (TRAVEL, "travel of the right wheel"),
}
WAYS: dict[str, Way] = {
    "travel": Way(TRAVEL, KNOWN["travel"], "wheel travel"),
    "rack": Way(ALONG["rack"], KNOWN["rack"], "the rack"),
    **{name: Way(along, OF_AXLES[along.name], words) for name, (along, words) in _MOTIONS.items()},
}
"""What characteristics may be over, by name."""

OF_SUSPENSIONS = ("travel", "rack")
"""Those of a suspension."""

UNDER_LOADS = {
    held: Way(TRAVEL, COMPLIANCES | COMPLIANCES_OF_AXLES, "wheel travel") for held in HELD
}
"""Compliance over wheel travel, of an axle over parallel travel, by what holds the wheels."""

_COMPLIANCES_OVER: dict[str, Mapping[str, Quantity]] = {
    "travel": COMPLIANCES,
    "bump": COMPLIANCES_OF_AXLES,
}


def way(over: str) -> Way:
    """Return what some curves are over."""
    return (WAYS | UNDER_LOADS)[over]


def compliances_over(over: str) -> Mapping[str, Quantity]:
    """Return what is told under loads over something, by name; none where nothing is."""
    return _COMPLIANCES_OVER.get(over, {})


def ways_of(subject: Any) -> tuple[str, ...]:
    """Return what the characteristics of something may be over, the usual first."""
    return tuple(_MOTIONS) if isinstance(subject, Axle | RigidAxle) else OF_SUSPENSIONS


def check_subject(given: Arguments, subject: Any, name: str = "suspension") -> None:
    """See that values of something can move."""
    if isinstance(subject, Axle):
        given.refuse(_OF_SIDES.format(name=name))
        return
    given.kind(name, subject, (Suspension, RigidAxle), NEEDED)


@overload
def model_of(subject: Suspension, *, wheel_loads: bool = False) -> Model: ...
@overload
def model_of(subject: RigidAxle, *, wheel_loads: bool = False) -> RigidAxleModel: ...
@overload
def model_of(subject: Subject, *, wheel_loads: bool = False) -> Model | RigidAxleModel: ...
@overload
def model_of(subject: Subject | Axle) -> Looked: ...
def model_of(subject: Subject | Axle, *, wheel_loads: bool = False) -> Looked:
    """Return what is evaluated; of a suspension the model in which every body with mass counts."""
    if isinstance(subject, RigidAxle):
        return RigidAxleModel(subject, wheel_loads=wheel_loads)
    if isinstance(subject, Axle):
        return subject
    free_rack = bool(subject.neglected_masses())
    return Model(subject, free_rack=free_rack, wheel_loads=wheel_loads)


def judged_model(subject: Subject | Axle, overs: Iterable[str]) -> Looked:
    """Return what is evaluated over some ways: five rods, too, where all of it is under loads."""
    if isinstance(subject, RigidAxle) and all(over in HELD for over in overs):
        return RigidAxleModel(subject, guided=subject.overheld)
    return model_of(subject)


def _assembly(model: Looked) -> Assembly:
    found = assembly_of(model)
    assert found is not None
    return found


def usual_positions(model: Looked, over: str) -> Array:
    """Return the usual positions, as far as it goes [m] or [rad]."""
    assembly = _assembly(model)
    return assembly.usual(assembly.usual_motion if over in HELD else over)


def dataset_of(model: Looked, over: str, positions: Array) -> xr.Dataset:
    """Return all that is told over something, to be drawn."""
    if over in HELD:
        found = linear(_assembly(model), None, positions, held=cast("Held", over))
        return found.drop_dims(["moved", "by"])
    return dataset(_assembly(model), over, positions)


def values_of(
    model: Looked, over: str, positions: Array, names: Collection[str] | None = None
) -> dict[str, Array]:
    """Return characteristics or compliance by name, all that there are or some."""
    if over not in HELD:
        return flat_values(_assembly(model), over, positions, names)
    curves = flat(dataset_of(model, over, positions))
    return {str(name): data.values for name, data in curves.items()}


def there(model: Looked, over: str) -> tuple[str, ...]:
    """Return the characteristics, or compliance, for which the file has the data."""
    if over in HELD and not _assembly(model).has_bushes:
        return ()
    return tuple(values_of(model, over, np.zeros(1)))


@overload
def with_bushes(subject: Suspension, bushings: Mapping[str, Any] | None) -> Suspension: ...
@overload
def with_bushes(subject: Subject | Axle, bushings: Mapping[str, Any] | None) -> Subject | Axle: ...
def with_bushes(subject: Subject | Axle, bushings: Mapping[str, Any] | None) -> Subject | Axle:
    """Return something on other bushes than those of its file, or on these.

    Parameters
    ----------
    subject : Suspension, Axle or RigidAxle
    bushings : mapping, optional
        As of `kintrafo.compliance.linear`.
    """
    if bushings is None:
        return subject
    if not isinstance(subject, Axle):
        return subject.with_changes({"bushings": dict(bushings)})
    with Arguments("compliance") as given:
        described = AxleAssembly(subject).described_bushings(given, bushings)
    left, right = (
        subject.sides[side].with_changes({"bushings": described[side]}) for side in SIDES
    )
    return replace(subject, left=left, right=right)


def refuse_of_steering(subject: Subject | Axle, names: Iterable[str]) -> None:
    """Refuse characteristics that have no meaning where nothing steers the wheels."""
    if isinstance(subject, Suspension) and not subject.steered():
        _assembly(Model(subject)).refuse_of_steering(names)


def common_positions(models: Mapping[str, Looked], over: str) -> Array:
    """Return the usual positions that all of some cars can take [m] or [rad], zero included."""
    assemblies = [_assembly(model) for model in models.values()]
    return common_to(assemblies, assemblies[0].usual_motion if over in HELD else over)
