"""Arguments of the commands about values that vary."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from .options import among

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..suspension.model import Model

Over = Annotated[Literal["travel", "rack"], typer.Option(help="What varies along the curves.")]
At = Annotated[float, typer.Option(metavar="MM", help="Position that the table is about.")]
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


def chosen(model: "Model", wanted: list[str] | None, over: Literal["travel", "rack"]) -> list[str]:
    """Return the characteristics that are shown, those that were asked for or the usual ones."""
    from ..study.characteristics.datasets import refuse_of_steering
    from ..study.variation.curves import there

    refuse_of_steering(model.suspension, wanted or ())
    known = there(model, over)
    if wanted is None:
        return [name for name in _USUAL[over] if name in known]
    return among(wanted, known)


def positions_with(model: "Model", over: Literal["travel", "rack"], at: float) -> "NDArray[Any]":
    """Return the usual positions and the one that the table is about [m]."""
    from ..study.sweep import usual_rack, usual_travel

    usual = usual_travel if over == "travel" else usual_rack
    return with_position(usual(model), at)


def with_position(usual: "NDArray[Any]", at: float) -> "NDArray[Any]":
    """Return positions and the one that a table is about [m]."""
    import numpy as np

    from ..core.errors import InputError

    if not np.isfinite(at):
        raise InputError([f"--at {at}: a finite number of mm is needed."], "positions")
    return np.union1d(usual, [at / 1e3])


def along(over: Literal["travel", "rack"], at: float) -> str:
    """Say where something is: 'at 20 mm of wheel travel'."""
    return f"at {at:g} mm of {'wheel travel' if over == 'travel' else 'the rack'}"
