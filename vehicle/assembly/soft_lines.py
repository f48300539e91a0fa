"""Flexibilities of springs and stops along their lines."""

from dataclasses import dataclass, replace

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ..corner.corner import Corner
from ..models.sides import SIDES
from . import wheel
from .whole_axle_kinematics import WholeAxleKinematics


@dataclass(frozen=True)
class SoftLines:
    """Flexibilities of springs and stops along their lines, in n positions."""

    # compression of each spring for a unit force along each, (n, springs, springs) [m/N]
    springs: Array
    # (n, dampers): compression of the stops beside each damper for a unit force on the damper's
    # line alone [m/N]; infinite if none acts. It has no columns if the file has no stops.
    stops: Array


def soft_lines(there: Corner) -> SoftLines:
    """Return the flexibilities of spring and stops of a suspension.

    They include the effect of the preload as the direction of a line changes.
    """
    rates = wheel.wheel_rate(replace(there, stops=()))
    if not (rates > 0.0).all():
        at = 1e3 * (there.center - there.design_center)[rates.argmin(), 2]
        problem = (
            f"at a wheel travel of {at:.1f} mm the spring has a rate of {rates.min():.4g} N/m at "
            "the wheel: nothing holds it. Enter a rate, or another travel."
        )
        raise InputError([problem], "compliance")
    spring = (there.spring.stroke.slope**2 / rates)[:, None, None]
    if not there.stops:
        return SoftLines(spring, np.zeros((len(rates), 0)))
    with np.errstate(divide="ignore"):
        stops = there.damper.slope**2 / (wheel.wheel_rate(there) - rates)
    return SoftLines(spring, stops[:, None])


def lines_by_rates(beam: WholeAxleKinematics) -> SoftLines:
    """Return the flexibilities of springs and stops from their rates alone.

    An axle on five rods has no motion that would change the directions of forces.
    """
    rates = np.stack([beam.rate_of_spring(side) for side in SIDES], axis=1)
    if not (rates > 0.0).all():
        problem = (
            "[spring] has a rate of 0 N/m there: nothing holds the axle. Enter a rate, or a curve "
            "that rises."
        )
        raise InputError([problem], "compliance")
    stops = np.stack([beam.rate_of_stops(side) for side in SIDES], axis=1)
    with np.errstate(divide="ignore"):
        return SoftLines(np.eye(2) / rates[:, None, :], 1.0 / np.abs(stops))


def lines_of_beam(beam: WholeAxleKinematics) -> SoftLines:
    """Return the flexibilities of springs and stops of an axle without sides."""
    growth = np.stack([beam.growth(f"{side}_spring") for side in SIDES], axis=1)
    rates = np.stack([beam.rate_of_stops(side) for side in SIDES], axis=1)
    by_stops = np.stack([beam.growth(f"{side}_damper") for side in SIDES], axis=1)
    # by both coordinates; without the stops the stiffness of the springs remains
    stiffness = -beam.of_springs[1] - by_stops.mT @ (rates[..., None] * by_stops)
    least = np.linalg.eigvalsh(0.5 * (stiffness + stiffness.mT))[:, 0]
    if not (least > 0.0).all():
        at = 1e3 * float(beam.heave[least.argmin()])
        problem = (
            f"at a wheel travel of {at:.1f} mm the springs do not hold the axle: in heave or in "
            "roll they deflect by themselves. Enter a rate, or another travel."
        )
        raise InputError([problem], "compliance")
    with np.errstate(divide="ignore"):
        stops = 1.0 / np.abs(rates)
    return SoftLines(growth @ np.linalg.solve(stiffness, growth.mT), stops)
