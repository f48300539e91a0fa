"""The catalogue of what an axle has: name, unit, definition, sign and formula of each."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from math import pi

from ...assembly import wheel
from ...assembly.from_model import vehicle
from ...assembly.pair import Pair
from ...assembly.quantity import Quantity
from ...core.quantities import Display
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.corner import Array
from ..characteristics import catalogue as of_wheels
from . import pitching, rolling

SIDES = (LEFT, RIGHT)

_PER_DEGREE = Display("N m/deg", pi / 180.0)
_ANGLES = Display("deg/deg", 1.0)
_PERCENT = Display("%", 100.0)
_NEWTON_METRES = Display("N m", 1.0)

# Of a wheel alone, what an axle has better: by both wheels, and for front and rear.
_REPLACED = ("roll_center_height_kinematic", "anti_dive", "anti_lift_braked", "arm_rotation")
_GROUND = ("tyre_radius",)
_PITCH = ("tyre_radius", "wheelbase", "center_of_gravity_height")


@dataclass(frozen=True)
class Measure:
    """A quantity of an axle with its formula.

    Attributes
    ----------
    quantity : Quantity
    formula : callable
        Takes a `Pair`.
    known_to : callable
        Whether an axle has what it needs besides the data of the vehicle.
    """

    quantity: Quantity
    formula: Callable[[Pair], Array]
    known_to: Callable[[Axle], bool] = lambda _: True

    def has_all(self, axle: Axle) -> bool:
        """Return whether everything that it needs is given."""
        sides = (vehicle(side) for side in axle.sides.values())
        return self.known_to(axle) and all(self.quantity.known_to(side) for side in sides)


def of_side(quantity: Quantity, side: str) -> Quantity:
    """Return a quantity of a wheel as that of the left or the right one."""
    return replace(
        quantity,
        name=f"{quantity.name}_{side}",
        long_name=f"{quantity.long_name}, {side}",
    )


def _of_wheels(quantities: tuple[Quantity, ...]) -> Iterator[Measure]:
    """Return what each wheel has by itself, for both."""
    for quantity in quantities:
        formula = quantity.formula
        if formula is None or quantity.name in _REPLACED:
            continue
        for side in SIDES:
            yield Measure(of_side(quantity, side), partial(_at_wheel, formula, side))


def _at_wheel(formula: Callable[..., Array], side: str, pair: Pair) -> Array:
    return formula(pair.corners[side])


def _both(
    quantity: Quantity,
    formula: Callable[[Pair, str], Array],
    known_to: Callable[[Axle], bool] = lambda _: True,
) -> Iterator[Measure]:
    """Return what each wheel has as one of an axle, for both."""
    for side in SIDES:
        yield Measure(of_side(quantity, side), partial(_for_side, formula, side), known_to)


def _for_side(formula: Callable[[Pair, str], Array], side: str, pair: Pair) -> Array:
    return formula(pair, side)


def _has_bar(axle: Axle) -> bool:
    return axle.bar is not None


def _has_tyres(axle: Axle) -> bool:
    return all(side.tyre.rate_N_per_m > 0.0 for side in axle.sides.values())


def _is(end: str, *, driven: bool = False) -> Callable[[Axle], bool]:
    return lambda axle: axle.end == end and (axle.drive is not None or not driven)


PATH = (
    Measure(
        Quantity(
            "track",
            "m",
            "track",
            "lateral distance of the contacts",
            "positive always",
            needs=_GROUND,
        ),
        rolling.track,
    ),
    Measure(
        Quantity(
            "track_change",
            "m",
            "track change",
            "how much farther apart the contacts are than at design",
            "positive with a wider track",
            needs=_GROUND,
        ),
        rolling.track_change,
    ),
    *_both(
        Quantity(
            "inclination",
            "rad",
            "inclination angle",
            "camber to the line through the contacts instead of the body",
            "positive with the top outboard",
            needs=_GROUND,
        ),
        rolling.inclination,
    ),
)
"""Where the wheels are."""

ROLL = (
    Measure(
        Quantity(
            "roll_center_height",
            "m",
            "roll-centre height",
            "where the normals to the paths of both contacts meet, above the line through them",
            "positive above the contacts",
            needs=_GROUND,
        ),
        lambda pair: rolling.roll_center(pair)[1],
    ),
    Measure(
        Quantity(
            "roll_center_lateral",
            "m",
            "roll-centre offset",
            "the same point, from the middle between the contacts along the line through them",
            "positive to the left",
            needs=_GROUND,
        ),
        lambda pair: rolling.roll_center(pair)[0],
    ),
    *_both(
        Quantity(
            "jacking",
            "1",
            "jacking coefficient",
            "lift of the body by a lateral force at the contact, over the force, s v_Cy / v_Cz",
            "positive when an inboard force lifts the body",
            needs=_GROUND,
        ),
        rolling.jacking,
    ),
    *_both(
        Quantity(
            "roll_steer",
            "1",
            "roll steer",
            "derivative of the steer angle by the roll angle, the wheels moving by -y each",
            "positive when a roll with the right side down steers to the left",
            needs=_GROUND,
            display=_ANGLES,
        ),
        lambda pair, side: rolling.by_roll(
            pair,
            side,
            -pair.corners[side].vehicle.side * wheel.bump_steer(pair.corners[side]),
        ),
    ),
    *_both(
        Quantity(
            "roll_camber",
            "1",
            "roll camber",
            "derivative of camber, to the body, by the roll angle, the wheels moving by -y each",
            "positive when a roll with the right side down adds camber",
            needs=_GROUND,
            display=_ANGLES,
        ),
        lambda pair, side: rolling.by_roll(pair, side, wheel.camber_gradient(pair.corners[side])),
    ),
    *_both(
        Quantity(
            "wheel_force",
            "N",
            "wheel force",
            "vertical force at the wheel that spring, stops and bar take; no unsprung weight",
            "positive when the road pushes up",
        ),
        rolling.wheel_force,
    ),
    Measure(
        Quantity(
            "roll_moment",
            "N m",
            "roll moment",
            "moment of the wheel forces about the vehicle's centre line at the ground",
            "positive when it turns the right side up",
            needs=_GROUND,
            display=_NEWTON_METRES,
        ),
        rolling.moment,
    ),
    Measure(
        Quantity(
            "roll_moment_gradient",
            "N m/rad",
            "roll-moment gradient",
            "derivative of the roll moment by the roll angle, the wheel centres moving oppositely; "
            "forces and levers change",
            "positive when it resists roll; with the change of levers",
            needs=_GROUND,
            display=_PER_DEGREE,
        ),
        rolling.moment_gradient,
    ),
    Measure(
        Quantity(
            "roll_stiffness",
            "N m/rad",
            "roll stiffness",
            "y' K y, with the stiffness K of both wheels and constant levers y of the contacts; "
            "no tyres",
            "positive when it resists roll; at constant levers",
            needs=_GROUND,
            display=_PER_DEGREE,
        ),
        lambda pair: rolling.in_roll(pair, rolling.springs(pair) + rolling.bar(pair)),
    ),
    Measure(
        Quantity(
            "roll_stiffness_springs",
            "N m/rad",
            "roll stiffness of the springs",
            "the part of springs and stops",
            "positive when it resists roll",
            needs=_GROUND,
            display=_PER_DEGREE,
        ),
        lambda pair: rolling.in_roll(pair, rolling.springs(pair)),
        _has_bar,
    ),
    Measure(
        Quantity(
            "roll_stiffness_bar",
            "N m/rad",
            "roll stiffness of the anti-roll bar",
            "the part of the anti-roll bar",
            "positive when it resists roll",
            needs=_GROUND,
            display=_PER_DEGREE,
        ),
        lambda pair: rolling.in_roll(pair, rolling.bar(pair)),
        _has_bar,
    ),
    Measure(
        Quantity(
            "bar_share",
            "1",
            "share of the anti-roll bar",
            "its part of the roll stiffness",
            "0 % without a bar",
            needs=_GROUND,
            display=_PERCENT,
        ),
        rolling.bar_share,
        _has_bar,
    ),
    Measure(
        Quantity(
            "roll_stiffness_with_tyres",
            "N m/rad",
            "roll stiffness with tyres",
            "roll stiffness in series with the vertical stiffness of the tyres",
            "positive when it resists roll",
            needs=("tyre_radius", "tyre_rate"),
            display=_PER_DEGREE,
        ),
        lambda pair: rolling.in_roll(
            pair, rolling.with_tyres(pair, rolling.springs(pair) + rolling.bar(pair))
        ),
        _has_tyres,
    ),
    Measure(
        Quantity(
            "bar_twist",
            "rad",
            "twist of the anti-roll bar",
            "angle of the left half less that of the right",
            "positive when the left half is turned farther about its axis to the left",
        ),
        lambda pair: pair.twist,
        _has_bar,
    ),
    Measure(
        Quantity(
            "bar_torque",
            "N m",
            "torque of the anti-roll bar",
            "its rate times the twist from where it is free",
            "as the twist",
            display=_NEWTON_METRES,
        ),
        lambda pair: pair.torque,
        _has_bar,
    ),
    *_both(
        Quantity(
            "link_force",
            "N",
            "force of the drop link",
            "tension of the drop link",
            "positive when it pulls its ends together",
        ),
        rolling.link_force,
        _has_bar,
    ),
)
"""What springs, bar and geometry make of rolling."""

PITCH = (
    *_both(
        Quantity(
            "anti_dive",
            "1",
            "anti-dive",
            "b (L / h) v_x / v_z under braking: brake share b, wheelbase L, height h of the "
            "gravity centre; contact with brakes on the carrier, wheel centre with inboard ones",
            "positive when braking lifts the front",
            needs=(*_PITCH, "front_brake_share"),
            display=_PERCENT,
        ),
        pitching.braking,
        _is("front"),
    ),
    *_both(
        Quantity(
            "anti_lift_driven",
            "1",
            "anti-lift under drive",
            "d (L / h) v_x / v_z under drive: drive share d; wheel centre with the final drive on "
            "the body, contact with a motor on the carrier",
            "positive when driving holds the front down",
            needs=_PITCH,
            display=_PERCENT,
        ),
        pitching.driving,
        _is("front", driven=True),
    ),
    *_both(
        Quantity(
            "anti_lift_braked",
            "1",
            "anti-lift under braking",
            "-(1 - b) (L / h) v_x / v_z under braking: front brake share b; contact with brakes on "
            "the carrier, wheel centre with inboard ones",
            "positive when braking holds the rear down",
            needs=(*_PITCH, "front_brake_share"),
            display=_PERCENT,
        ),
        pitching.braking,
        _is("rear"),
    ),
    *_both(
        Quantity(
            "anti_squat",
            "1",
            "anti-squat",
            "-d (L / h) v_x / v_z under drive: drive share d; wheel centre with the final drive on "
            "the body, contact with a motor on the carrier",
            "positive when driving lifts the rear",
            needs=_PITCH,
            display=_PERCENT,
        ),
        pitching.driving,
        _is("rear", driven=True),
    ),
)
"""What the wheels' paths make of braking and driving."""

OVER_TRAVEL = (*_of_wheels(of_wheels.CORNER + of_wheels.TRAVEL), *PATH, *ROLL, *PITCH)
"""What there is over travel and rolling."""

OVER_STEERING = (*_of_wheels(of_wheels.CORNER + of_wheels.STEERING), *PATH)
"""What there is over the steering wheel, besides what both wheels decide together."""
