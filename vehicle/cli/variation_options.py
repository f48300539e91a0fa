"""The options and curves of commands that vary values of a file."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

from .options import Held, Of, among, option
from .values import completion_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..assembly.assembly import Assembly
    from ..studies.evaluation import Subject

AXES_OF_CARS = ("lateral_acceleration", "speed")
"""Axes of curves of cars besides motions of the body."""

_AXES = (
    "travel", "rack", "bump", "roll", "left", "right", "steer", "heave", "pitch", "load",
    *AXES_OF_CARS,
)  # fmt: skip


Over = Annotated[
    str | None,
    option(
        "What varies along the curves: travel or rack of a suspension; bump, roll, left, right, "
        "steer or rack of an axle; load, a load case of both (options case, cases, a file: "
        "load:case=brake); heave, pitch or roll of the body of a car; speed of a car on a "
        "rough road (options road, seat: speed:road=C); lateral acceleration of steady turns at "
        "100 km/h (options speed_km_per_h, radius_m, steering_wheel_deg: "
        "lateral_acceleration:radius_m=60). Default: travel, bump of an axle, heave of a car.",
        "NAME[:OPTION=VALUE]",
        show_default=False,
        autocompletion=completion_of(_AXES),
    ),
]
AtOfAxis = Annotated[
    float | None,
    option(
        "Position of the table; over roll, pitch and steer in deg, over acceleration in m/s^2, "
        "over speed in km/h, over load in %. Default: 0, 80 over speed, 100 over load, 1 at a "
        "radius or steering wheel angle.",
        "MM",
        show_default=False,
    ),
]


@dataclass(frozen=True)
class StudyOptions:
    """The options of the curves of a study."""

    of: Of = None
    over: Over = None
    held: Annotated[
        Held | None,
        option(
            "Analyse compliance over wheel travel on the [bushings] of the file instead of "
            "characteristics, with this support of the wheel.",
            show_default=False,
        ),
    ] = None
    at: AtOfAxis = None


# Default characteristics by axis; those without data in the file are left out.
_USUAL = {
    "travel": (
        "bump_steer", "camber_gradient", "caster", "kingpin_inclination", "scrub_radius", "trail",
        "roll_center_height_kinematic", "motion_ratio",
    ),
    "rack": (
        "camber", "caster", "scrub_radius", "trail", "steer_gradient", "steer_gradient_left",
        "steering_ratio", "ackermann_error", "camber_left", "camber_right",
    ),
    "lateral_acceleration": (
        "understeer_gradient", "steering_wheel_gradient", "roll_gradient", "sideslip_gradient",
        "steering_wheel_angle",
    ),
    "steer": ("steering_ratio", "ackermann", "ackermann_error", "camber_left", "camber_right"),
    "speed": (
        "acceleration_rms", "weighted_rms", "load_variation", "load_variation_front_left",
        "load_variation_rear_left", "travel_rms", "travel_rms_front_left", "travel_rms_rear_left",
        "heave_frequency", "heave_damping_ratio", "pitch_frequency", "roll_frequency",
    ),
}  # fmt: skip
# Default characteristics of cars, for each axle.
_OF_ENDS = (
    "bump_steer_front_left", "bump_steer_rear_left", "camber_gradient_front_left",
    "camber_gradient_rear_left", "roll_center_height_front", "roll_center_height_rear",
    "roll_stiffness_front", "roll_stiffness_rear",
)  # fmt: skip
_USUAL_OF_AXLES = (
    "bump_steer_left", "camber_gradient_left", "axle_steer", "roll_steer", "heave_steer",
    "axle_lateral", "roll_center_height", "anti_lift_braked", "anti_squat", "roll_stiffness",
    "wheel_rate_left",
)  # fmt: skip


@dataclass(frozen=True)
class StudyCurves:
    """The curves of a study."""

    over: str  # axis of the curves, or support of the wheels
    names: list[str]  # shown curves
    at: float  # position of the table [m] or [rad]
    where: str  # position in words: 'at 20 mm of wheel travel'
    how: dict[str, Any]  # axis and positions as arguments of studies

    @classmethod
    def of(cls, subject: "Subject", asked: StudyOptions) -> "StudyCurves":
        """Return the curves of the options; unknown ones are refused."""
        from ...core.validator import Validator
        from ..assembly.of import assembly_of
        from ..studies.evaluation import usual_positions
        from ..studies.sweep_axes import UNDER_LOADS, given_axis, sweep_axes_of, sweep_axis

        known, assembly = sweep_axes_of(subject), assembly_of(subject)
        assembly.refuse_motion(asked.over or "")
        if asked.held is not None:
            among([asked.over or known[0]], known[:1], "--over beside --held")
        with Validator("--over") as given:
            over = asked.held or given_axis(given, "--over", asked.over or known[0], known)
        axis = sweep_axis(over)
        at = axis.factor * axis.at if asked.at is None else asked.at
        names = _chosen(assembly, asked.of, over)
        positions = with_position(usual_positions(assembly, over), at, over)
        key = "held" if over in UNDER_LOADS else "over"
        where = f"at {at:g} {axis.unit} of {axis.words}"
        how = {key: over, "positions": positions}
        return cls(over, names, at / axis.factor, where, how)


def _chosen(assembly: "Assembly", wanted: list[str] | None, over: str) -> list[str]:
    """Return the wanted characteristics, or the default ones."""
    from ..assembly.by_wheel import columns_of
    from ..studies.evaluation import available, listed
    from ..studies.loading import LOADING
    from ..studies.sweep_axes import UNDER_LOADS, name_of_axis

    assembly.refuse_of_steering(wanted or ())
    known = available(assembly, over)
    if wanted is not None:
        columns = columns_of(wanted, known)
        return among(columns, listed(over, known, columns))
    moved = (*_USUAL_OF_AXLES, *_OF_ENDS) if len(assembly.wheels) > 1 else _USUAL["travel"]
    if name_of_axis(over) == LOADING:
        return listed(over, known)
    usual = known if over in UNDER_LOADS else _USUAL.get(name_of_axis(over), moved)
    return [name for name in usual if name in known]


def with_position(usual: "NDArray[Any]", at: float, over: str = "travel") -> "NDArray[Any]":
    """Return positions including that of the table [m] or [rad]; `at` is in display units."""
    import numpy as np

    from ...core.errors import InputError
    from ..studies.sweep_axes import sweep_axis

    if not np.isfinite(at):
        problem = f"--at {at}: a finite number of {sweep_axis(over).unit} is needed."
        raise InputError([problem], "positions")
    return np.union1d(usual, [at / sweep_axis(over).factor])
