"""The catalogue of what a rigid axle has: name, unit, definition, sign and formula of each."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from math import pi

from ...assembly.beam import SIDES, Beam
from ...assembly.quantity import Quantity
from ...core.quantities import Display
from ...suspension.corner import Array
from ...suspension.rigid.axle import RigidAxle
from ...suspension.rigid.model import HEAVE, ROLL
from ..axles.catalogue import of_side
from ..characteristics.catalogue import CORNER
from . import formulas

_PER_DEGREE = Display("N m/deg", pi / 180.0)
_ANGLES = Display("deg/deg", 1.0)
_PERCENT = Display("%", 100.0)
_NEWTON_METRES = Display("N m", 1.0)

_BRAKED = ("wheelbase_mm", "center_of_gravity_height_mm", "front_brake_share")


@dataclass(frozen=True)
class Measure:
    """A quantity of a rigid axle with its formula.

    Attributes
    ----------
    quantity : Quantity
    formula : callable
        Takes a `Beam`.
    known_to : callable
        Whether an axle has what it needs.
    """

    quantity: Quantity
    formula: Callable[[Beam], Array]
    known_to: Callable[[RigidAxle], bool] = lambda _: True


def _has_ground(axle: RigidAxle) -> bool:
    return axle.tyre_radius() is not None


def _has_tyres(axle: RigidAxle) -> bool:
    return _has_ground(axle) and axle.tyre.rate_N_per_m > 0.0


def _is(end: str, *, driven: bool = False) -> Callable[[RigidAxle], bool]:
    """Return whether an axle is at this end, and all is known of its braking or its drive."""
    needed = _BRAKED[:2] if driven else _BRAKED

    def known(axle: RigidAxle) -> bool:
        given = all(getattr(axle.vehicle, name) is not None for name in needed)
        is_there = axle.rigid_axle == end and (axle.drive is not None or not driven)
        return _has_ground(axle) and given and is_there

    return known


def _both(quantity: Quantity, formula: Callable[[Beam, str], Array]) -> Iterator[Measure]:
    """Return what each wheel has, for both."""
    for side in SIDES:
        yield Measure(of_side(quantity, side), partial(_for_side, formula, side))


def _for_side(formula: Callable[[Beam, str], Array], side: str, beam: Beam) -> Array:
    return formula(beam, side)


def _signal(pattern: str) -> Callable[[Beam, str], Array]:
    return lambda beam, side: beam.signal(f"{side}_{pattern}")


_ALIGNMENT = {q.name: q for q in CORNER if q.name in ("camber", "toe", "steer")}

GUIDANCE = (
    Measure(
        Quantity(
            "axle_steer",
            "rad",
            "steer angle of the axle",
            "turn of the line through the wheels about the vehicle's vertical",
            "positive to the left",
        ),
        lambda beam: beam.coordinate("yaw"),
    ),
    Measure(
        Quantity(
            "roll_steer",
            "1",
            "roll steer",
            "derivative of the axle's steer angle by the roll angle, the wheels moving oppositely",
            "positive when a roll with the right side down steers to the left",
            display=_ANGLES,
        ),
        lambda beam: -beam.slope("yaw", ROLL),
    ),
    Measure(
        Quantity(
            "heave_steer",
            "rad/m",
            "heave steer",
            "derivative of the axle's steer angle by the travel of both wheels",
            "positive when the axle steers to the left in bump",
        ),
        lambda beam: beam.slope("yaw", HEAVE),
    ),
    Measure(
        Quantity(
            "axle_lateral",
            "m",
            "lateral displacement of the axle",
            "of the middle between the wheel centres, from design",
            "positive to the left",
        ),
        lambda beam: beam.coordinate("sway"),
    ),
    Measure(
        Quantity(
            "axle_longitudinal",
            "m",
            "longitudinal displacement of the axle",
            "of the middle between the wheel centres, from design",
            "positive forward",
        ),
        lambda beam: beam.coordinate("shift"),
    ),
    Measure(
        Quantity(
            "pinion_angle",
            "rad",
            "pinion angle",
            "turn of the axle about the line through its wheels, from design",
            "positive with the nose of the final drive up",
        ),
        # it points to the middle of the car
        lambda beam: (1.0 if beam.axle.rigid_axle == "front" else -1.0) * beam.coordinate("pitch"),
    ),
    *_both(_ALIGNMENT["camber"], _signal("axle_camber")),
    *_both(_ALIGNMENT["toe"], _signal("axle_toe")),
    *_both(_ALIGNMENT["steer"], _signal("axle_steer")),
)
"""Where the axle goes."""

GROUND = (
    Measure(
        Quantity(
            "roll_center_height",
            "m",
            "roll-centre height",
            "point midway between the contacts that does not move along the line through them as "
            "the axle rolls and the middle between the contacts stays on that line",
            "positive above the contacts",
        ),
        formulas.roll_center_height,
        _has_ground,
    ),
    Measure(
        Quantity(
            "jacking",
            "1",
            "jacking coefficient",
            "lift of the body by a lateral force at the contacts, over the force, -v_y / v_z "
            "in heave",
            "positive when a force to the left lifts the body",
        ),
        formulas.jacking,
        _has_ground,
    ),
    Measure(
        Quantity(
            "anti_dive",
            "1",
            "anti-dive",
            "b (L / h) v_x / v_z under braking: brake share b, wheelbase L, height h of the "
            "gravity centre; contacts with brakes on the axle, wheel centres with inboard ones",
            "positive when braking lifts the front",
            display=_PERCENT,
        ),
        formulas.braking,
        _is("front"),
    ),
    Measure(
        Quantity(
            "anti_lift_driven",
            "1",
            "anti-lift under drive",
            "d (L / h) v_x / v_z under drive: drive share d; contacts with the final drive in the "
            "axle, wheel centres with it on the body",
            "positive when driving holds the front down",
            display=_PERCENT,
        ),
        formulas.driving,
        _is("front", driven=True),
    ),
    Measure(
        Quantity(
            "anti_lift_braked",
            "1",
            "anti-lift under braking",
            "-(1 - b) (L / h) v_x / v_z under braking: front brake share b; contacts with brakes "
            "on the axle, wheel centres with inboard ones",
            "positive when braking holds the rear down",
            display=_PERCENT,
        ),
        formulas.braking,
        _is("rear"),
    ),
    Measure(
        Quantity(
            "anti_squat",
            "1",
            "anti-squat",
            "-d (L / h) v_x / v_z under drive: drive share d; contacts with the final drive in the "
            "axle, wheel centres with it on the body",
            "positive when driving lifts the rear",
            display=_PERCENT,
        ),
        formulas.driving,
        _is("rear", driven=True),
    ),
)
"""What forces of the road do by the axle's paths."""

SPRINGS = (
    *_both(
        Quantity(
            "spring_length",
            "m",
            "spring length",
            "distance of the spring's seats",
            "positive always; falls in bump",
        ),
        _signal("spring_length"),
    ),
    *_both(
        Quantity(
            "damper_length",
            "m",
            "damper length",
            "distance of the damper's ends",
            "positive always; falls in bump",
        ),
        _signal("damper_length"),
    ),
    *_both(
        Quantity(
            "motion_ratio",
            "1",
            "motion ratio",
            "compression of the spring per travel of both wheels",
            "positive when the spring is compressed in bump",
        ),
        lambda beam, side: formulas.motion_ratio(beam, "spring", side),
    ),
    *_both(
        Quantity(
            "roll_motion_ratio",
            "1",
            "motion ratio in roll",
            "compression of the spring per travel of its wheel, the other one moving oppositely",
            "positive when the spring is compressed with its wheel up",
        ),
        lambda beam, side: formulas.roll_motion_ratio(beam, "spring", side),
    ),
    *_both(
        Quantity(
            "damper_motion_ratio",
            "1",
            "damper motion ratio",
            "compression of the damper per travel of both wheels",
            "positive when the damper is compressed in bump",
        ),
        lambda beam, side: formulas.motion_ratio(beam, "damper", side),
    ),
    *_both(
        Quantity(
            "damper_roll_motion_ratio",
            "1",
            "damper motion ratio in roll",
            "compression of the damper per travel of its wheel, the other one moving oppositely",
            "positive when the damper is compressed with its wheel up",
        ),
        lambda beam, side: formulas.roll_motion_ratio(beam, "damper", side),
    ),
    *_both(
        Quantity(
            "wheel_force",
            "N",
            "wheel force",
            "vertical force at the wheel that springs, stops and bar take; no unsprung weight",
            "positive when the road pushes up",
        ),
        formulas.wheel_force,
    ),
    *_both(
        Quantity(
            "wheel_rate",
            "N/m",
            "wheel rate",
            "derivative of the wheel force by the travel of both wheels, without tyres",
            "positive when the force grows in bump",
        ),
        formulas.wheel_rate,
    ),
    *_both(
        Quantity(
            "wheel_rate_alone",
            "N/m",
            "wheel rate, one wheel",
            "derivative of the wheel force by the travel of this wheel, the other one at rest",
            "positive when the force grows in bump",
        ),
        formulas.wheel_rate_alone,
    ),
    Measure(
        Quantity(
            "roll_moment",
            "N m",
            "roll moment",
            "moment of the wheel forces about the vehicle's centre line at the ground",
            "positive when it turns the right side up",
            display=_NEWTON_METRES,
        ),
        formulas.roll_moment,
        _has_ground,
    ),
    Measure(
        Quantity(
            "roll_moment_gradient",
            "N m/rad",
            "roll-moment gradient",
            "derivative of the roll moment by the roll angle, the wheel centres moving oppositely; "
            "forces and levers change",
            "positive when it resists roll; with the change of levers",
            display=_PER_DEGREE,
        ),
        formulas.roll_moment_gradient,
        _has_ground,
    ),
    Measure(
        Quantity(
            "roll_stiffness",
            "N m/rad",
            "roll stiffness",
            "y' K y, with the stiffness K of both wheels and constant levers y of the contacts; "
            "no tyres",
            "positive when it resists roll; at constant levers",
            display=_PER_DEGREE,
        ),
        lambda beam: formulas.in_roll(beam, formulas.of_all(beam)),
        _has_ground,
    ),
    Measure(
        Quantity(
            "roll_stiffness_bar",
            "N m/rad",
            "roll stiffness of the anti-roll bar",
            "the part of the anti-roll bar",
            "positive when it resists roll",
            display=_PER_DEGREE,
        ),
        lambda beam: formulas.in_roll(beam, formulas.stiffness(beam, beam.of_bar)),
        lambda axle: _has_ground(axle) and axle.anti_roll_bar is not None,
    ),
    Measure(
        Quantity(
            "roll_stiffness_with_tyres",
            "N m/rad",
            "roll stiffness with tyres",
            "roll stiffness in series with the vertical stiffness of the tyres",
            "positive when it resists roll",
            display=_PER_DEGREE,
        ),
        lambda beam: formulas.in_roll(beam, formulas.with_tyres(beam)),
        _has_tyres,
    ),
)
"""What springs, dampers, stops and the anti-roll bar do."""

MEASURES = (*GUIDANCE, *GROUND, *SPRINGS)
"""All of them."""
