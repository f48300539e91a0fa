"""A first look at a rigid axle: reach, rest, modes, guidance and roll."""

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ...assembly.beam import SIDES, parameters_of
from ...assembly.equilibrium import equilibrium
from ...assembly.usual import USUAL_TRAVEL
from ...core.arguments import Arguments
from ...core.quantities import display_of
from ...suspension.axle.axle import RIGHT
from ...suspension.plausibility import (
    beyond_the_table,
    stray_points,
    unlikely_inertia,
    unlikely_rates,
    unlikely_tyre,
    unlikely_vehicle,
    unlikely_wheel,
    unusual_alignment,
)
from ...suspension.reach import PositionError
from ...suspension.rigid.axle import RigidAxle
from ...suspension.rigid.file import Rod
from ...suspension.rigid.model import HEAVE, ROLL, RigidAxleModel
from ...systems.linearisation import linearise
from .datasets import bump

# Read at design over parallel travel, and what stands before the value.
_AT_DESIGN = {
    "roll_center_height": "roll-centre height",
    "roll_steer": "roll steer",
    "roll_stiffness": "roll stiffness",
    "roll_stiffness_bar": "roll stiffness of the anti-roll bar",
    "roll_stiffness_with_tyres": "roll stiffness with tyres",
    "wheel_rate_left": "wheel rate, left",
    "wheel_rate_right": "wheel rate, right",
    "anti_dive": "anti-dive",
    "anti_lift_driven": "anti-lift under drive",
    "anti_lift_braked": "anti-lift under braking",
    "anti_squat": "anti-squat",
}
# How far the axle is let go when its reach is looked for [m].
_FAR = 0.4
# At rest so far from design, or on tyres so far apart, a rate, a unit or a free length is wrong.
_MOST_TRAVEL = 0.5 * USUAL_TRAVEL
# A rod whose axle's end is so much farther from the axle than the other one is swapped [m].
_SWAPPED = 0.2


@dataclass(frozen=True)
class RigidAxleCheckup:
    """What a first look at a rigid axle shows.

    Attributes
    ----------
    heading : str
        What the axle is called.
    values : dict of str to float
        At design, by the names of `bump`, SI units; those that are known. Also ``heave_at_rest``
        [m], ``heave_frequency`` and ``roll_frequency`` [Hz], ``heave_damping_ratio`` and
        ``roll_damping_ratio``, of the undamped natural frequencies of its modes on the tyres, and
        ``reach_down``, ``reach_up`` [m].
    rows : dict of str to str
        The same and more, as a person reads it.
    problems, notes : tuple of str
    """

    heading: str
    values: dict[str, float]
    rows: dict[str, str]
    problems: tuple[str, ...]
    notes: tuple[str, ...]


def checkup(axle: RigidAxle) -> RigidAxleCheckup:
    """Look at a rigid axle.

    Parameters
    ----------
    axle : RigidAxle

    Returns
    -------
    RigidAxleCheckup

    Examples
    --------
    >>> found = checkup(RigidAxle.load("rigid_axle"))
    >>> found.problems, round(found.values["roll_center_height"], 2)
    ((), 0.41)
    """
    with Arguments("checkup") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
    model = RigidAxleModel(axle)
    values, rows = _reach(model)
    problems = [*_unlikely(axle)]
    notes = [*unusual_alignment(axle.wheel)]
    for side in SIDES:
        notes += beyond_the_table(parameters_of(model, side), axle.length("spring", side))
    try:
        at_rest, told = _rest(model)
        values |= at_rest
        rows |= told
    except PositionError as error:
        problems.append(str(error))
    else:
        if abs(values["heave_at_rest"]) > _MOST_TRAVEL:
            notes.append(
                f"the axle rests {1e3 * values['heave_at_rest']:+.1f} mm from its design position: "
                "check the springs' free length or force, and the tyres' free height"
            )
    dataset = bump(axle, [0.0])
    for name, words in _AT_DESIGN.items():
        if name in dataset:
            shown = display_of(dataset[name].attrs)
            values[name] = float(dataset[name][0])
            rows[words] = f"{values[name] * shown.factor:.4g} {shown.units}"
    if axle.tyre_radius() is None:
        notes.append(
            "[tyre] radius_mm is not given, and wheel_center is no wheel's radius above z = 0: "
            "what needs the ground is left out"
        )
    return RigidAxleCheckup(axle.heading(), values, rows, tuple(problems), tuple(notes))


def as_dict(found: RigidAxleCheckup) -> dict[str, Any]:
    """Return a checkup for scripts, in SI units."""
    kept = asdict(found)
    del kept["rows"]
    return kept


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


def _reach(model: RigidAxleModel) -> tuple[dict[str, float], dict[str, str]]:
    """Return how far the axle goes, and what it is."""
    axle = model.axle
    ends = {"reach_down": -_FAR, "reach_up": _FAR}
    values = {name: far * model.farthest(far, far) for name, far in ends.items()}
    rows = {"track": f"{2e3 * axle.half_track:.4g} mm", "rods": _rods(axle)}
    for name, value in values.items():
        more = " and more" if abs(value) == _FAR else ""
        rows[f"travel {name.removeprefix('reach_')} to"] = f"{1e3 * value:.1f} mm{more}"
    return values, rows


def _rods(axle: RigidAxle) -> str:
    lengths = {n: 1e3 * float(np.linalg.norm(b - a)) for n, (a, b) in axle.ends().items()}
    return ", ".join(
        f"{name.replace('_', ' ')} {length:.1f} mm" for name, length in lengths.items()
    )


def _rest(model: RigidAxleModel) -> tuple[dict[str, float], dict[str, str]]:
    """Return where the axle rests, and its modes there; without friction, as it slides."""
    state = equilibrium(model)
    heave = float(state[model.state_names.index(HEAVE)])
    signals = model.signals(state)
    values = {"heave_at_rest": heave}
    rows = {
        "equilibrium": f"wheel centres at {1e3 * (model.axle.center[2] + heave):.3f} mm, "
        f"{1e3 * heave + 0.0:+.3f} mm from design",
        "forces there, each wheel": f"tyre {float(signals['left_axle_tyre_force']):.0f} N, spring "
        f"{float(signals['left_spring_spring_force']):.0f} N",
    }
    smooth = RigidAxleModel(model.axle.with_changes({"damper.friction_N": 0.0}))
    linear = linearise(smooth, equilibrium(smooth))
    for name, words in ((HEAVE, "axle hop"), (ROLL, "axle tramp")):
        mode = linear.mode_of(name)
        values[f"{name}_frequency"] = mode.natural_frequency
        values[f"{name}_damping_ratio"] = mode.damping_ratio
        rows[f"{words} on the tyres"] = mode.text
    return values, rows
