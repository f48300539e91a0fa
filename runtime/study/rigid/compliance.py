"""How a rigid axle gives way under loads on its wheels, on the bushes of its rods: first order."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ...assembly.beam import Beam
from ...assembly.parts import Parts
from ...assembly.poses import touching
from ...assembly.quantity import TRAVEL, Quantity
from ...assembly.rig import Extent
from ...assembly.soft_lines import lines_by_rates, lines_of_beam
from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import Display, display_of
from ...core.vectors import cross
from ...suspension.bushes import described_bushings, left_out, refuse_rigid
from ...suspension.corner import Array, RoadWheel
from ...suspension.rigid.axle import RigidAxle
from ..axles.compliance import COMPLIANCES as OF_WHEELS
from ..axles.compliance import LOADINGS, WORDS, Together, dataset_of_both, under_loads
from ..loads.compliance import RIG_LOADS, RigLoad
from ..loads.flexibility import HELD, Held, Side, flexibility, refuse_without_rate
from .datasets import usual
from .on_bushes import guided


def compliance(
    axle: RigidAxle,
    bushings: Mapping[str, Any] | None = None,
    travel: ArrayLike | None = None,
    *,
    held: Held = "height",
) -> xr.Dataset:
    """Return how a rigid axle gives way under loads, over parallel wheel travel, to first order.

    Parameters
    ----------
    axle : RigidAxle
    bushings : mapping, optional
        In the place of those of the file. By the name of a rod with ``_chassis`` or ``_axle``
        behind it, and ``wheel_center`` for the bearings of both wheels; stiffnesses as of
        `kintrafo.loads.compliance`. The axis of a bush is by default that of its rod.
    travel : array_like, shape (n,), optional
        Heights of both wheel centres above design [m]; by default the usual range.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds each wheel; the anti-roll bar acts besides.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.axles.compliance`; and of the line through both wheel centres
        ``axle_steer_by_...``, positive to the left, and of its middle ``axle_lateral_by_...``,
        positive to the left, and ``axle_longitudinal_by_...``, positive forward.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a travel is out of reach.

    Notes
    -----
    As of `kintrafo.loads.compliance`. A rod carries a force along it, so that of its bushes counts
    how soft they are along the rod. What springs and stops do as their directions change is counted
    with the springs.

    Five rods, which leave the axle heave and roll only as their bushes give way, share forces as
    the least energy asks; the positions are those of the four that hold it firmest.

    Examples
    --------
    >>> bushes = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}
    >>> found = compliance(RigidAxle.load("rigid_axle"), bushes, [0.0])
    >>> shift = found["axle_lateral_by_lateral_parallel"][0]
    >>> round(1e6 * float(shift), 2)  # mm by 1 kN on each wheel, so by 2 kN on 5 kN/mm
    0.38
    """
    with Arguments("compliance") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        given.among("held", held, HELD)
        if travel is not None:
            travel = given.array("travel", travel, "m", dimensions=[1])
        if not given.refused:
            bushes = axle.bushes(given, described_bushings(given, bushings, axle.bushings))
            refuse_rigid(given, bushes, 0.0)
            refuse_without_rate(given, held, axle.tyre)
            if axle.tyre_radius() is None:
                given.refuse("[tyre] radius_mm is needed: where the road touches the wheels.")
    travels = usual(axle, "bump", Extent()) if travel is None else np.asarray(travel)
    model = guided(axle)
    beam = Beam(model, model.states_at(travels, travels))
    parts = Parts.of(model, beam.states)
    lines = None
    if held != "locked":
        lines = lines_by_rates(beam) if axle.overheld else lines_of_beam(beam)
    rate = 0.0 if axle.anti_roll_bar is None else model.parameters["bar_rate"]
    bar = parts.bar_by_torque() if rate else None
    side = Side(parts, bushes, lines, bar)
    flexible = flexibility([side], held, bar=1.0 / rate if rate else 0.0)
    wheels = [*parts.wheels.values()]
    found = dataset_of_both(wheels, flexible, travels, held).assign(_of_axle(wheels, flexible))
    without = [left_out(bushes)]
    if axle.overheld:
        (fifth,) = {*axle.rods} - {*axle.guides}
        without += ["what springs do as they turn", f"what {fifth} does to where the axle is"]
    return found.assign_attrs(left_out=" and ".join(filter(None, without)))


# -- the axle -------------------------------------------------------------------------------------


def turn_of(left: Array, right: Array, forward: Array) -> Array:
    """Return how far the line through the wheel centres turns to the left [rad].

    Parameters
    ----------
    left, right : ndarray, shape (n, 3)
        The wheel centres [m].
    forward : ndarray, shape (n, 3)
        How far the left one goes more than the right one [m].
    """
    line = (left - right)[:, :2]
    turn: Array = (line[:, 0] * forward[:, 1] - line[:, 1] * forward[:, 0]) / (line**2).sum(-1)
    return turn


OF_AXLE = {
    "axle_steer": ("rad", "steer angle of the axle", "positive to the left"),
    "axle_lateral": ("m", "lateral displacement of the axle", "positive to the left"),
    "axle_longitudinal": ("m", "longitudinal displacement of the axle", "positive forward"),
}
"""What is told of the axle itself: unit, words and sign."""


def _of_axle(wheels: Sequence[RoadWheel], flexible: Array) -> dict[str, xr.Variable]:
    """Return what the line through the wheel centres does under loads, and its middle."""
    found = {}
    left, right = wheels
    for test, how, both in under_loads(wheels, flexible):
        one, other = (
            moved[:, :3] + cross(moved[:, 3:], wheel.center - touching(wheel))
            for moved, wheel in zip(both, wheels, strict=True)
        )
        middle = 0.5 * (one + other)
        values = {
            "axle_steer": turn_of(left.center, right.center, one - other),
            "axle_lateral": middle[:, 1],
            "axle_longitudinal": middle[:, 0],
        }
        for name, along in values.items():
            quantity = _quantity(name, test, how)
            found[quantity.name] = xr.Variable(TRAVEL.name, along, quantity.attributes())
    return found


def _quantity(name: str, test: RigLoad, how: Together) -> Quantity:
    unit, words, sign = OF_AXLE[name]
    shown = display_of({"units": unit})
    return Quantity(
        f"{name}_by_{test.name}_{how.name}",
        f"{unit}/({test.unit})" if " " in test.unit else f"{unit}/{test.unit}",
        f"{words} by {WORDS[test.name]}, {how.words}",
        f"change of the {words}, by the line through the wheel centres, for each wheel's load",
        sign,
        display=Display(f"{shown.units}/{test.shown.units}", shown.factor * test.shown.factor),
    )


COMPLIANCES = OF_WHEELS | {
    quantity.name: quantity
    for test in RIG_LOADS
    for how in LOADINGS[test.name]
    for quantity in (_quantity(name, test, how) for name in OF_AXLE)
}
"""What is told of both wheels and of the axle under loads, by name."""
