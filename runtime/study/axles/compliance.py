"""How both wheels of an axle give way together: on their bushes, a soft rack, the anti-roll bar."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import xarray as xr

from ...assembly import motions
from ...assembly.axle_coupling import SIDES, pull_of_bar
from ...assembly.from_model import corner
from ...assembly.poses import Poses, wheel_axes
from ...assembly.quantity import TRAVEL
from ...assembly.rig import Extent
from ...assembly.soft_lines import soft_lines
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import variable
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.bushes import (
    Bush,
    described_bushings,
    left_out,
    mirrored_bushings,
    refuse_rigid,
    softness_of_rack,
)
from ...suspension.corner import Array, RoadWheel
from ...suspension.positions import arm_angles, design_height
from ...suspension.reach import at_rest
from ..loads.compliance import (
    LOADED,
    MOVED,
    RIG_LOADS,
    RigLoad,
    load_at_contact,
    quantities_under,
    told,
)
from ..loads.flexibility import HELD, Held, Side, flexibility, refuse_without_rate


@dataclass(frozen=True)
class Together:
    """How both wheels are loaded.

    Attributes
    ----------
    name : str
        "parallel", in one direction, or "opposed".
    parts : tuple of float
        Of the load of `RIG_LOADS`, whose images those of both wheels are: left, right.
    words : str
    """

    name: str
    parts: tuple[float, float]
    words: str


_IMAGES = (1.0, 1.0)
_FORE_AND_AFT = (
    Together("parallel", _IMAGES, "both rearward"),
    Together("opposed", (1.0, -1.0), "left rearward and right forward"),
)
LOADINGS = {
    "lateral": (
        Together("parallel", (-1.0, 1.0), "both to the left"),
        Together("opposed", _IMAGES, "both inward"),
    ),
    "braking": _FORE_AND_AFT,
    "recession": _FORE_AND_AFT,
    "aligning": (
        Together("parallel", (1.0, -1.0), "both to the left"),
        Together("opposed", _IMAGES, "both towards toe-out"),
    ),
}
WORDS = {
    "lateral": "lateral forces",
    "braking": "longitudinal forces",
    "recession": "forces at the wheel centres",
    "aligning": "torques about the vertical",
}


def compliance(
    axle: Axle,
    bushings: Mapping[str, Any] | None = None,
    travel: ArrayLike | None = None,
    *,
    rack_position: float = 0.0,
    held: Held = "height",
) -> xr.Dataset:
    """Return how both wheels give way under loads, over parallel wheel travel, to first order.

    Parameters
    ----------
    axle : Axle
    bushings : mapping, optional
        In the place of those that the files of both sides have for each. As of
        `kintrafo.loads.compliance`, for the side whose points the anti-roll bar has: that
        which the file names with ``side``, or the right one. The other side has the image.
        ``rack`` with its ``axial_N_per_mm`` says how stiff the steering holds the rack.
    travel : array_like, shape (n,), optional
        Heights of both wheel centres above design [m]; by default the usual range.
    rack_position : float, optional
        Displacement of the rack [m].
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds each wheel; the anti-roll bar acts besides.

    Returns
    -------
    xarray.Dataset
        Over ``wheel_travel``: toe, camber and displacement of each wheel, with ``_left`` and
        ``_right`` at the end, by loads of the same size on both wheels, ``_parallel`` and
        ``_opposed``; and ``flexibility``, displacement and rotation of both contacts by force and
        moment there, tyre axes of each, of shape (n, 12, 12).

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a travel is out of reach.

    Notes
    -----
    As of `kintrafo.loads.compliance`; the rack and the bar are soft things that both sides load.
    What the bar carries where it is bent at rest does not stiffen anything here.

    Examples
    --------
    >>> from kintrafo import Axle
    >>> bushes = {"rack": {"axial_N_per_mm": 5000.0}}
    >>> found = compliance(Axle.load("reference_axle"), bushes, [0.0])
    >>> for how in ("parallel", "opposed"):  # opposed forces do not move the rack
    ...     toe = found[f"toe_by_lateral_{how}_right"][0]
    ...     print(round(abs(float(np.rad2deg(toe))) * 1e3, 4))  # deg/kN
    0.0189
    0.0
    """
    with Arguments("compliance") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
        rack_position = given.number("rack_position", rack_position, "m")
        given.among("held", held, HELD)
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        if not given.refused:
            described = described_of(given, axle, bushings)
            bushes = {s: side.bushes(given, described[s]) for s, side in axle.sides.items()}
            rack = softness_of_rack(given, described[axle.bar_side])
            refuse_rigid(given, [*bushes[LEFT], *bushes[RIGHT]], rack)
            refuse_without_rate(given, held, *(side.tyre for side in axle.sides.values()))
            if any(side.tyre_radius() is None for side in axle.sides.values()):
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheel.")
    travels = motions.travels(axle, Extent()) if travel is None else np.asarray(travel)
    sides = [_side(axle, side, travels, rack_position, bushes[side], held) for side in SIDES]
    bar = 1.0 / axle.bar.rate() if axle.bar else 0.0
    wheels = [side.poses.wheels["wheel"] for side in sides]
    flexible = flexibility(sides, held, rack=rack, bar=bar)
    found = dataset_of_both(wheels, flexible, travels, held)
    return found.assign_attrs(left_out=left_out([*bushes[LEFT], *bushes[RIGHT]]))


def described_of(given: Arguments, axle: Axle, bushings: Any) -> dict[str, dict[str, Any]]:
    """Return what is said of the bushes of both sides: the files', or what is given and its image.

    What is wrong of the latter is told of the side that it is given for.
    """
    if bushings is None:
        return {
            side: described_bushings(given, None, suspension.bushings)
            for side, suspension in axle.sides.items()
        }
    one = axle.bar_side
    other = LEFT if one == RIGHT else RIGHT
    described = described_bushings(given, bushings, None)
    with_one = Arguments("compliance")
    axle.sides[one].bushes(with_one, described)
    return {one: described, other: {} if with_one.refused else mirrored_bushings(described)}


def _side(
    axle: Axle, side: str, travels: Array, rack: float, bushes: list[Bush], held: Held
) -> Side:
    model = axle.models[side]
    angles = arm_angles(model, design_height(model) + travels, rack)
    poses = Poses.of(model, *at_rest(model, angles, rack))
    bar = pull_of_bar(axle, side, poses) if axle.halves else None
    lines = None if held == "locked" else soft_lines(corner(model, angles, rack))
    return Side(poses, bushes, lines, bar)


def under_loads(
    wheels: Sequence[RoadWheel], flexible: Array
) -> Iterator[tuple[RigLoad, Together, tuple[Array, Array]]]:
    """Yield how both wheels move under each load of a rig, the left one first.

    Parameters
    ----------
    wheels : sequence of RoadWheel
        The left and the right one, over n positions.
    flexible : ndarray, shape (n, 12, 12)

    Yields
    ------
    test : RigLoad
    how : Together
    moved : tuple of ndarray, each of shape (n, 6)
        Displacement and rotation of the contact, chassis axes [m], [rad].
    """
    for test in RIG_LOADS:
        loads = [load_at_contact(test, wheel) for wheel in wheels]
        for how in LOADINGS[test.name]:
            parts = zip(how.parts, loads, strict=True)
            load = np.concatenate([part * one for part, one in parts], axis=-1)
            left, right = np.split(np.einsum("nab,nb->na", flexible, load), 2, axis=-1)
            yield test, how, (left, right)


def dataset_of_both(
    wheels: Sequence[RoadWheel], flexible: Array, travels: Array, held: Held
) -> xr.Dataset:
    """Return what both wheels do under loads, over parallel wheel travel.

    Parameters
    ----------
    wheels, flexible
        As of `under_loads`.
    travels : ndarray, shape (n,)
        [m].
    held : {'height', 'tyre', 'spring', 'locked'}
    """
    found: dict[Any, Any] = {}
    for test, how, moved in under_loads(wheels, flexible):
        for side, one, its, part in zip(SIDES, wheels, moved, how.parts, strict=True):
            found |= _variables(test, how, side, one, its, part)
    axes = np.zeros((len(travels), 12, 12))
    for i, one in enumerate(wheels):
        for begin in (6 * i, 6 * i + 3):
            axes[:, begin : begin + 3, begin : begin + 3] = wheel_axes(one)
    words = "displacement and rotation of the contacts by forces and moments there, tyre axes"
    found["flexibility"] = variable(
        (TRAVEL.name, "moved", "by"), axes @ flexible @ axes.mT, words, "SI"
    )
    coordinates = {
        TRAVEL.name: xr.Variable(TRAVEL.name, travels, TRAVEL.attributes()),
        "moved": [f"{name}_{side}" for side in SIDES for name in MOVED],
        "by": [f"{name}_{side}" for side in SIDES for name in LOADED],
    }
    return xr.Dataset(found, coordinates, {"title": "compliance", "held": HELD[held]})


def _variables(
    test: RigLoad, how: Together, side: str, one: RoadWheel, moved: Array, part: float
) -> dict[str, xr.Variable]:
    """Return what a wheel does under loads on both."""
    named, words = _on_both(test, how, side)
    return {
        f"{quantity.name}_{side}": xr.Variable(TRAVEL.name, values, quantity.attributes())
        for quantity, values in told(named, one, moved, how=words, part=part)
    }


def _on_both(test: RigLoad, how: Together, side: str) -> tuple[RigLoad, str]:
    """Return a load as it is called on both wheels, and words for what one of them does."""
    named = replace(test, name=f"{test.name}_{how.name}", words=WORDS[test.name])
    return named, f"{how.words}, {side}"


COMPLIANCES = {
    f"{quantity.name}_{side}": quantity
    for test in RIG_LOADS
    for how in LOADINGS[test.name]
    for side in SIDES
    for quantity in quantities_under(*_on_both(test, how, side)).values()
}
"""What is told of both wheels under loads, by name."""
