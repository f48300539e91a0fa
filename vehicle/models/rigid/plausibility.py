"""What no rigid axle of a car looks like: units, and rods that are swapped."""

from collections.abc import Iterator, Mapping

import numpy as np

from ..plausibility import (
    Plausibility,
    beyond_the_table,
    stray_points,
    unlikely_inertia,
    unlikely_rates,
    unlikely_tyre,
    unlikely_vehicle,
    unlikely_wheel,
    unusual_alignment,
)
from ..sides import LEFT, RIGHT, SIDES
from .axle import RigidAxle
from .file import Rod

# A rod whose axle's end is so much farther from the axle than the other one is swapped [m].
_SWAPPED = 0.2


def plausibility(axle: RigidAxle) -> Plausibility:
    """Look for what people get wrong in the files of rigid axles.

    Parameters
    ----------
    axle : RigidAxle

    Returns
    -------
    Plausibility

    Examples
    --------
    >>> plausibility(RigidAxle.load("rigid_axle"))
    Plausibility(problems=(), notes=())
    """
    notes = [*unusual_alignment(axle.wheel)]
    for side in SIDES:
        notes += beyond_the_table(_parameters(axle, side), axle.length("spring", side))
    if axle.tyre_radius() is None:
        notes.append(
            "[tyre] radius_mm is not given, and wheel_center is no wheel's radius above z = 0: "
            "what needs the ground is left out"
        )
    return Plausibility(tuple(_unlikely(axle)), tuple(notes))


def _parameters(axle: RigidAxle, side: str) -> Mapping[str, float]:
    """Return the parameters of a side, by the names that those of the right one have."""
    values = axle.parameters()
    if side == RIGHT:
        return values
    begin = f"{LEFT}_"
    return {n.removeprefix(begin): v for n, v in values.items() if n.startswith(begin)}


def _unlikely(axle: RigidAxle) -> Iterator[str]:
    """Say what is almost surely a mistake: units, and rods that are swapped."""
    points, unit = axle.hardpoints, axle.hardpoints.unit
    given = {points.text(n): points.metres(n) for n in points.given() if n != "wheel_center"}
    for name, ends in axle.ends().items():
        given |= {
            f"[rods.{name}] {end}": at for end, at in zip(Rod.model_fields, ends, strict=True)
        }
    yield from stray_points(given, unit)
    yield from unlikely_vehicle(axle.vehicle)
    size = axle.half_track + max(float(np.linalg.norm(at - axle.center)) for at in given.values())
    yield from unlikely_tyre(axle.tyre)
    yield from unlikely_inertia({"beam": axle.bodies.beam}, size)
    yield from unlikely_wheel(axle.bodies.wheel, axle.tyre_radius())
    half = 0.5 * axle.bodies.beam.mass_kg + axle.bodies.wheel.mass_kg
    length = axle.length("spring", RIGHT)
    yield from unlikely_rates(axle.parameters(), length, half, axle.rate_key)
    for name, ends in axle.ends().items():
        chassis, beam = (float(np.hypot(*(end - axle.center)[[0, 2]])) for end in ends)
        if beam > chassis + _SWAPPED:
            yield (
                f"[rods.{name}]: the end on the axle is {1e3 * beam:.0f} mm from the line through "
                f"the wheels, that on the chassis {1e3 * chassis:.0f} mm. Are the two swapped?"
            )
