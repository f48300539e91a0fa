"""A first look at an axle: its sides, its anti-roll bar, roll, steering."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ...assembly import motions
from ...assembly.rig import Extent
from ...core.arguments import Arguments
from ...core.errors import InputError
from ...core.quantities import display_of
from ...suspension.axle import Axle
from ...suspension.axle.axle import LEFT, RIGHT
from ...suspension.positions import PositionError
from ..checkup import Checkup
from ..checkup import as_dict as of_side_as_dict
from ..checkup import checkup as of_side
from .datasets import bump, roll, steer

# Read at design over parallel travel, and what stands before the value.
_AT_DESIGN = {
    "track": "track",
    "roll_center_height": "roll-centre height",
    "roll_stiffness": "roll stiffness",
    "bar_share": "share of the anti-roll bar",
    "roll_stiffness_with_tyres": "roll stiffness with tyres",
    "anti_dive_left": "anti-dive",
    "anti_lift_driven_left": "anti-lift under drive",
    "anti_lift_braked_left": "anti-lift under braking",
    "anti_squat_left": "anti-squat",
}


@dataclass(frozen=True)
class AxleCheckup:
    """What a first look at an axle shows.

    Attributes
    ----------
    heading : str
        What the axle is called.
    sides : dict of str to Checkup
        One where the other is its mirror image.
    values : dict of str to float
        Of the axle at design, by the names of `bump`, SI units; those that are known.
    rows : dict of str to str
        The same and more, as a person reads it.
    problems, notes : tuple of str
    """

    heading: str
    sides: dict[str, Checkup]
    values: dict[str, float]
    rows: dict[str, str]
    problems: tuple[str, ...]
    notes: tuple[str, ...]


def checkup(axle: Axle) -> AxleCheckup:
    """Look at an axle.

    Parameters
    ----------
    axle : Axle

    Returns
    -------
    AxleCheckup

    Examples
    --------
    >>> found = checkup(Axle.load("reference_axle"))
    >>> found.problems, round(found.values["bar_share"], 2)
    ((), 0.42)
    """
    with Arguments("checkup") as given:
        given.kind("axle", axle, Axle, Axle.NEEDED)
    chosen = (axle.bar_side,) if axle.symmetric else (LEFT, RIGHT)
    sides = {side: of_side(axle.models[side]) for side in chosen}
    problems = [f"{side} side: {text}" for side, one in sides.items() for text in one.problems]
    notes = [f"{side} side: {text}" for side, one in sides.items() for text in one.notes]
    if axle.bar is not None and axle.bar.free_twist_deg:
        notes.append("the anti-roll bar is bent at design: the sides' equilibrium is without it")
    values: dict[str, float] = {}
    rows: dict[str, str] = {}
    try:
        values, rows = _at_design(axle)
        rows |= _in_roll(axle) | _in_steering(axle)
    except (InputError, PositionError) as error:
        problems += getattr(error, "problems", (str(error),))
    return AxleCheckup(axle.heading(), sides, values, rows, tuple(problems), tuple(notes))


def as_dict(found: AxleCheckup) -> dict[str, Any]:
    """Return a checkup for scripts, in SI units."""
    kept = asdict(found) | {"sides": {s: of_side_as_dict(one) for s, one in found.sides.items()}}
    del kept["rows"]
    return kept


def _at_design(axle: Axle) -> tuple[dict[str, float], dict[str, str]]:
    dataset = bump(axle, [0.0])
    values, rows = {}, {}
    if axle.bar is not None:
        rate = np.deg2rad(axle.bar.rate())
        soft = ", its bushes or drop links included" if axle.bar.gives_way() else ""
        part = axle.bar.link_on.replace("_", " ")
        rows["anti-roll bar"] = f"{rate:.4g} N m/deg{soft}, drop links on the {part}"
    for name, words in _AT_DESIGN.items():
        if name in dataset:
            shown = display_of(dataset[name].attrs)
            values[name] = float(dataset[name][0])
            told = f"{words}, left" if name.endswith("_left") and not axle.symmetric else words
            rows[told] = f"{values[name] * shown.factor:.4g} {shown.units}"
    return values, rows


def _in_roll(axle: Axle) -> dict[str, str]:
    angles = motions.rolls(axle, Extent())
    # that the drop links reach is seen over all of the usual travel, too
    bump(axle)
    dataset = roll(axle, angles[[0, -1]])
    most = np.degrees(angles[-1])
    if "roll_moment" not in dataset:
        return {}
    return {f"roll moment at {most:.3g} deg": f"{float(dataset['roll_moment'][-1]):.4g} N m"}


def _in_steering(axle: Axle) -> dict[str, str]:
    if not axle.steered():
        return {}
    dataset = steer(axle)
    if axle.end == "rear":
        return {}
    (along,) = dataset.sizes
    ends = np.degrees([dataset["steer_left"].values.min(), dataset["steer_left"].values.max()])
    rows = {"left wheel steers": f"{ends[0]:.1f} deg to {ends[1]:.1f} deg"}
    if "steering_ratio" in dataset:
        middle = int(np.abs(dataset[along].values).argmin())
        rows["steering ratio"] = f"{float(dataset['steering_ratio'][middle]):.2f}, in the middle"
    if "turning_circle" in dataset:
        rows["turning circle"] = f"{float(dataset['turning_circle'].min()):.2f} m"
    return rows
