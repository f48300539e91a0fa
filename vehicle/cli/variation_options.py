"""Arguments of the commands about values that vary."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .options import among

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..studies.evaluation import Subject

Over = Annotated[
    Literal["travel", "rack", "bump", "roll", "left", "right"] | None,
    typer.Option(
        help="What varies along the curves. Default: travel; of a rigid axle bump, which has no "
        "others than the last four.",
        show_default=False,
    ),
]
Held = Annotated[
    Literal["height", "tyre", "spring", "locked"] | None,
    typer.Option(
        help="Analyse the compliance over wheel travel of a file with [bushings], instead of "
        "characteristics; this holds the wheels.",
        show_default=False,
    ),
]
At = Annotated[
    float, typer.Option(metavar="MM", help="Position that the table is about; of roll in deg.")
]
Bars = Annotated[
    list[Path] | None,
    typer.Option(
        "--plot",
        metavar="PATH",
        help="Write a figure: .pdf, .png or .svg. May be repeated.",
        rich_help_panel="Output",
    ),
]

# What is shown where nothing is said, as far as the file has the data for it.
_USUAL = {
    "travel": (
        "bump_steer",
        "camber_gradient",
        "caster",
        "kingpin_inclination",
        "scrub_radius",
        "trail",
        "roll_center_height_kinematic",
        "motion_ratio",
    ),
    "rack": ("camber", "caster", "scrub_radius", "trail", "steer_gradient", "steering_ratio"),
}
_USUAL_OF_AXLES = (
    "bump_steer_left",
    "camber_gradient_left",
    "axle_steer",
    "roll_steer",
    "heave_steer",
    "axle_lateral",
    "roll_center_height",
    "anti_lift_braked",
    "anti_squat",
    "roll_stiffness",
    "wheel_rate_left",
)


def way_of(of: "Subject", over: str | None, held: str | None = None) -> str:
    """Return what curves are over: what was asked for, or the usual; or what holds the wheels."""
    from ..studies.sweep_axes import sweep_axes_of

    known = sweep_axes_of(of)
    if held is not None:
        among([over or known[0]], known[:1], "--over beside --held")
        return held
    return among([over or known[0]], known, "--over")[0]


def asked_of(over: str) -> dict[str, Any]:
    """Return what tells a study what curves are over, or what holds the wheels."""
    from ..studies.sweep_axes import UNDER_LOADS

    return {"held" if over in UNDER_LOADS else "over": over}


def chosen(of: "Subject", wanted: list[str] | None, over: str) -> list[str]:
    """Return the characteristics that are shown, those that were asked for or the usual ones."""
    from ..assembly.of import assembly_of
    from ..studies.evaluation import available
    from ..studies.sweep_axes import UNDER_LOADS

    assembly = assembly_of(of)
    assembly.refuse_of_steering(wanted or ())
    known = available(assembly, over)
    if wanted is None:
        usual = known if over in UNDER_LOADS else _USUAL.get(over, _USUAL_OF_AXLES)
        return [name for name in usual if name in known]
    return among(wanted, known)


def positions_with(of: "Subject", over: str, at: float) -> "NDArray[Any]":
    """Return the usual positions and the one that the table is about [m] or [rad]."""
    from ..assembly.of import assembly_of
    from ..studies.evaluation import usual_positions

    return with_position(usual_positions(assembly_of(of), over), at, over)


def with_position(usual: "NDArray[Any]", at: float, over: str = "travel") -> "NDArray[Any]":
    """Return positions and the one that a table is about [m] or [rad]."""
    import numpy as np

    from ...core.errors import InputError
    from ..studies.sweep_axes import sweep_axis

    if not np.isfinite(at):
        problem = f"--at {at}: a finite number of {sweep_axis(over).unit} is needed."
        raise InputError([problem], "positions")
    return np.union1d(usual, [position(over, at)])


def position(over: str, at: float) -> float:
    """Return a position that was given in mm or deg [m] or [rad]."""
    from ..studies.sweep_axes import sweep_axis

    return at / sweep_axis(over).factor


def along(over: str, at: float) -> str:
    """Say where something is: 'at 20 mm of wheel travel'."""
    from ..studies.sweep_axes import sweep_axis

    return f"at {at:g} {sweep_axis(over).unit} of {sweep_axis(over).words}"
