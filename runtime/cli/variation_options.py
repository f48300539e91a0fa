"""Arguments of the commands about values that vary."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from .options import among

if TYPE_CHECKING:
    from ..suspension.model import Model

Over = Annotated[Literal["travel", "rack"], typer.Option(help="What varies along the curves.")]
At = Annotated[
    float, typer.Option(metavar="MM", help="Position that the table is about, of those there are.")
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


def chosen(model: "Model", wanted: list[str] | None, over: Literal["travel", "rack"]) -> list[str]:
    """Return the characteristics that are shown, those that were asked for or the usual ones."""
    from ..study.variation.curves import there

    known = there(model, over)
    if wanted is None:
        return [name for name in _USUAL[over] if name in known]
    return among(wanted, known)
