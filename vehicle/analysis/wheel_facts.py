"""Facts of an independently suspended wheel: geometry, reach, rest on the road, wheel hop."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...core.named_types import Array
from ...core.validator import Validator
from ...core.vectors import distance_from_line
from ..assembly import wheel
from ..assembly.corner_kinematics import corner
from ..assembly.equilibrium import equilibrium
from ..models.model import Model
from ..models.plausibility import plausibility
from ..models.positions import (
    AngleRange,
    PositionError,
    arm_angles,
    design_height,
    travel_range,
)
from . import paper

# Less travel between design and an end is noted, as a part of the height of the wheel centre: 40 mm
# of a passenger car (300 mm), 27 mm of a Formula Student car (200 mm; its rules ask for 25 mm).
_LITTLE_TRAVEL = 0.04 / 0.3
# A wheel that rests farther from design is noted [m].
_FAR_FROM_DESIGN = 0.005

# A wheel rate below this is not that of a spring: weights alone have some N/m [N/m].
LEAST_WHEEL_RATE = 10.0
NO_STIFFNESS = (
    "only the tyre holds the wheel: the wheel rate of springs and stops is below "
    f"{LEAST_WHEEL_RATE / 1e3:g} N/mm. Load cases, whose forces do not depend on the travel, have "
    "no stable equilibrium there."
)


@dataclass(frozen=True)
class RestFacts:
    """Results for a suspension at rest on a level road at z = 0.

    Attributes
    ----------
    height : float
        Height of the wheel centre: its z in chassis axes [m].
    travel : float
        Wheel travel from design, positive in bump [m].
    signals : dict
        All signals of the model at rest, by name, SI units.
    frequency : float
        Undamped natural frequency of the wheel-hop mode, with the body held [Hz]; NaN if the wheel
        does not oscillate.
    damping_ratio : float
        Damping ratio of that mode without friction; above one where it does not oscillate.
    damping_ratio_with_friction : float or None
        The same with friction linearised at rest, which is valid only for speeds far below
        ``friction_velocity_m_per_s``; None if there is no friction.
    ride_frequency : float or None
        Undamped natural frequency of the body above a wheel at rest on the road: that of the mass
        on spring and stops, with their rate in series with that of the tyre [Hz]. None if they
        carry no load or have no rate.
    """

    height: float
    travel: float
    signals: dict[str, float]
    frequency: float
    damping_ratio: float
    damping_ratio_with_friction: float | None
    ride_frequency: float | None


@dataclass(frozen=True)
class WheelFacts:
    """Results of a check for one wheel; lengths in m, angles in rad, chassis axes of ISO 8855.

    Attributes
    ----------
    title : str
        Title of the suspension.
    side : str
        'left' or 'right'.
    geometry : dict
        Lengths and angles at design, by name; those that end in ``_angle`` are angles.
    reach : AngleRange
        Range of wheel heights with the rack in its middle, and its limits.
    travel : tuple of float
        The same range as wheel travel from design, lowest and highest [m].
    extension_travel : float or None
        Wheel travel at which the strut is fully extended [m]; None if it never is, or there is
        none.
    equilibrium : RestFacts or None
        The wheel at rest on the road; None if there is no stable equilibrium.
    problems : tuple of str
        Errors, and almost certain mistakes.
    notes : tuple of str
        Unusual values.
    """

    title: str
    side: str
    geometry: dict[str, float]
    reach: AngleRange
    travel: tuple[float, float]
    extension_travel: float | None
    equilibrium: RestFacts | None
    problems: tuple[str, ...]
    notes: tuple[str, ...]

    def as_dict(self) -> dict[str, Any]:
        """Return the same as plain numbers, texts and nested dictionaries, SI units."""
        rest = self.equilibrium
        return {
            "suspension": self.title,
            "side": self.side,
            "geometry": dict(self.geometry),
            "travel": {
                "rebound": self.travel[0],
                "rebound_limit": self.reach.lower_limit,
                "bump": self.travel[1],
                "bump_limit": self.reach.upper_limit,
                "strut_fully_extended": self.extension_travel,
            },
            "equilibrium": None if rest is None else dict(vars(rest)),
            "problems": list(self.problems),
            "notes": list(self.notes),
        }


def facts_of(model: Model) -> WheelFacts:
    """Return the facts of the wheel of a corner."""
    reach, design = travel_range(model), design_height(model)
    travel = reach.height[0] - design, reach.height[1] - design
    problems: list[str] = []
    rest = None
    try:
        rest = _equilibrium(model)
    except PositionError as error:
        problems.append(str(error))
    extension = _extension_travel(model, reach)
    seen = plausibility(model.suspension)
    return WheelFacts(
        title=model.suspension.TITLE,
        side=model.suspension.vehicle.side,
        geometry=_geometry(model),
        reach=reach,
        travel=travel,
        extension_travel=extension,
        equilibrium=rest,
        problems=(*seen.problems, *problems),
        notes=(*seen.notes, *_notes(model, travel, rest, extension)),
    )


def _equilibrium(model: Model) -> RestFacts:
    state = equilibrium(model)
    signals = {name: float(value) for name, value in model.signals(state).items()}
    mode = paper.rest(model).hop
    smooth = without_friction(model)
    sliding = mode if smooth is model else paper.rest(smooth).hop
    height = signals["wheel_center_z"]
    return RestFacts(
        height=height,
        travel=height - design_height(model),
        signals=signals,
        frequency=sliding.natural_frequency,
        damping_ratio=sliding.damping_ratio,
        damping_ratio_with_friction=None if smooth is model else mode.damping_ratio,
        ride_frequency=_ride_frequency(model, state),
    )


def without_friction(model: Model) -> Model:
    """Return the model without friction, the same one if it has none.

    Friction is smoothed near rest, where its slope is that of a damper many times as strong as
    those that the wheel has in a motion. At rest it has no force.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Model
    """
    with Validator("without_friction") as given:
        given.instance("model", model, Model, Model.NEEDED)
    smooth = model.suspension.without_friction()
    return model if smooth is model.suspension else model.of_another(smooth)


def _ride_frequency(model: Model, state: Array) -> float | None:
    at_rest = corner(model, state[model.state_names.index(model.names.arm)])
    # a force acts at the wheel by its motion ratio (virtual work)
    pushing = (at_rest.spring, *at_rest.stops)
    carried = -sum(float(spring.force * spring.stroke.slope) for spring in pushing)
    rate = float(wheel.ride_rate(at_rest))
    gravity = model.suspension.gravity.acceleration_m_per_s2
    if carried <= 0.0 or not rate > 0.0:
        return None
    return float(np.sqrt(rate * gravity / carried)) / (2.0 * np.pi)


def _geometry(model: Model) -> dict[str, float]:
    points = model.suspension.hardpoints
    at_design = corner(model, model.design_state[0])
    axis, center = at_design.steering_axis, points.metres("wheel_center")
    found = {
        "half_track": abs(float(center[1])),
        "wheel_center_height": float(center[2]),
        **model.suspension.lengths(),
    }
    if axis is None:
        return found
    outer = points.metres("tie_rod_outer")
    return found | {
        "tie_rod_length": points.distance("tie_rod_outer", "tie_rod_inner"),
        "steering_arm_length": distance_from_line(outer, axis.lower, axis.upper),
        "caster_angle": float(wheel.caster(at_design)),
        "kingpin_inclination_angle": float(wheel.kingpin_inclination(at_design)),
    }


def _extension_travel(model: Model, reach: AngleRange) -> float | None:
    """Return the travel at which the strut is fully extended [m], from a table; None if never."""
    extended = model.suspension.extended()
    if extended is None:
        return None
    angles = np.linspace(*reach.arm_angle, 721)
    states = np.tile(model.design_state, (angles.size, 1))
    states[:, 0] = angles
    signals: dict[str, Array] = model.signals(states)
    longer = signals[extended.signal] - extended.length
    # it becomes shorter from low to high positions
    below = np.flatnonzero((longer[:-1] > 0.0) & (longer[1:] <= 0.0))
    if below.size == 0:
        return None
    first = int(below[-1])
    height = signals["wheel_center_z"][first : first + 2]
    return float(np.interp(0.0, -longer[first : first + 2], height)) - design_height(model)


def _notes(
    model: Model, travel: tuple[float, float], rest: RestFacts | None, extension: float | None
) -> list[str]:
    extended = model.suspension.extended()
    notes = [
        f"only {abs(end) * 1e3:.1f} mm of {name} can be reached from design."
        for end, name in zip(travel, ("rebound", "bump"), strict=True)
        if abs(end) < _LITTLE_TRAVEL * design_height(model)
    ]
    if rest is None:
        return notes
    if abs(rest.travel) > _FAR_FROM_DESIGN:
        notes.append(
            f"the wheel rests {rest.travel * 1e3:+.1f} mm from design. Where the spring is free "
            "of force and [tyre] free_height_mm decide where."
        )
    if extended is not None and extension is not None and rest.travel < extension:
        notes.append(f"at rest, the {extended.name} is longer than {extended.key}.")
    if wheel.wheel_rate(corner(model, arm_angles(model, [rest.height]))) < LEAST_WHEEL_RATE:
        notes.append(NO_STIFFNESS)
    if rest.signals["tyre_force"] <= 0.0:
        notes.append("the tyre carries nothing at rest: check [tyre] free_height_mm.")
    if not np.isfinite(rest.frequency):
        notes.append("the equilibrium is not stable: a displaced wheel does not return.")
    elif rest.damping_ratio <= 0.0:
        notes.append("the wheel-hop mode is not damped.")
    if rest.damping_ratio >= 1.0:
        notes.append("the wheel-hop mode is overdamped.")
    return notes
