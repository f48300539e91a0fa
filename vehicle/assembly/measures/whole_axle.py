"""The measures of springs, dampers and stops of any axle without sides."""

from collections.abc import Callable
from functools import partial

from ....core.named_types import Array
from ...models.sides import SENSE, SIDES
from ..whole_axle_kinematics import WholeAxleKinematics
from . import rolling
from .corner import GROUND
from .measure import of_axle, of_wheel


def dot(one: Array, other: Array) -> Array:
    """Return the scalar products of vectors, (n,)."""
    return (one * other).sum(-1)


def signal(name: str) -> Callable[[WholeAxleKinematics, str], Array]:
    """Return the function for a signal of a wheel in the equations."""
    return lambda of, side: of.signal(f"{side}_{name}")


def _ratio(part: str, how: str, of: WholeAxleKinematics, side: str) -> Array:
    """Return the compression of a spring or a damper per travel of its wheel in a motion [1]."""
    sense = SENSE[side] if how == "roll" else 1.0
    return sense * of.compression_in(f"{side}_{part}", how)


def wheel_rate(of: WholeAxleKinematics, side: str) -> Array:
    """Return the derivative of a wheel's force with respect to the travel of both wheels [N/m]."""
    return (of.springs + of.bar)[:, SIDES.index(side), :].sum(-1)


def wheel_rate_alone(of: WholeAxleKinematics, side: str) -> Array:
    """Return the derivative of a wheel's force with respect to its own travel alone [N/m]."""
    place = SIDES.index(side)
    return (of.springs + of.bar)[:, place, place]


SPRINGS = (
    of_wheel("spring_length", signal("spring_length"), definition="distance of the spring's seats"),
    of_wheel("damper_length", signal("damper_length"), definition="distance of the damper's ends"),
    of_wheel(
        "motion_ratio", partial(_ratio, "spring", "bump"),
        definition="compression of the spring per travel of both wheels",
    ),
    of_wheel("roll_motion_ratio", partial(_ratio, "spring", "roll")),
    of_wheel(
        "damper_motion_ratio", partial(_ratio, "damper", "bump"),
        definition="compression of the damper per travel of both wheels",
    ),
    of_wheel("damper_roll_motion_ratio", partial(_ratio, "damper", "roll")),
    of_wheel(
        "wheel_force", lambda of, side: of.wheel_force(side),
        definition="vertical force at the wheel that springs, stops and bar take; no unsprung "
        "weight",
    ),
    of_wheel(
        "wheel_rate", wheel_rate,
        definition="derivative of the wheel force with respect to the travel of both wheels, "
        "without tyres",
    ),
    of_wheel("wheel_rate_alone", wheel_rate_alone),
    of_wheel(
        "ride_rate", rolling.ride_rate, ("tyre_rate",), rolling.has_tyres,
        "derivative of the wheel force with respect to the lift of both contacts, on the tyres",
    ),
    of_axle("roll_moment", rolling.moment, GROUND),
    of_axle("roll_moment_gradient", rolling.moment_gradient, GROUND),
    of_axle("roll_stiffness", rolling.stiffness, GROUND),
)  # fmt: skip
"""All of them, by wheel and by axle."""
