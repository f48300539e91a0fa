"""Targets and limits of curves: the option ``--goals``, and the table of those met."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...core.tabulated import significant
from ...terminal.console import note
from ...terminal.console import table as table_of
from .loading import of_study
from .options import option

if TYPE_CHECKING:
    from rich.table import Table
    from xarray import Dataset

    from ..studies.evaluation import Subject
    from ..studies.goals import Goal

ELSEWHERE = "--goals are about the rack in its middle and the wheel at design"

_ROUNDING = 1e-9  # of the ends of curves [m], [rad]
_HELD = 1e-4  # tolerance of positions held on a rig [m]

Goals = Annotated[
    Path | None,
    option(
        "TOML with [targets] and [limits] of characteristics or compliance, as of kintrafo "
        "optimise: they are drawn in the charts, and a table lists which are met.",
        "FILE",
    ),
]


def read(
    path: Path | None, axes: Sequence[str] | None, known: Sequence[str] = ("travel", "rack")
) -> "list[Goal]":
    """Return the goals of a file for the axes of some curves; none without a file.

    `axes` are these axes, or supports of the wheels for compliance, None for all in the file;
    `known` those that the file may have, the default first.
    """
    if path is None:
        return []
    from ...core.errors import InputError
    from .. import studies as variation
    from ..analysis.compliance.flexibility import HELD
    from ..studies.sweep_axes import name_of_axis, sweep_axis

    looked_at = [over for over in axes or known if name_of_axis(over) in known or over in HELD]
    if not looked_at:
        problem = f"goals are about curves over {_or(known)}, and these are over {_or(axes or ())}."
        raise InputError([problem], str(path))
    content = variation.read(path)
    with of_study(path):
        every = variation.goals(content, known)
    if axes is None:
        axes = [goal.over for goal in every]
    found = [goal for goal in every if goal.over in axes]
    if not found:
        kinematic = {"travel": "toe", "heave": "camber_front_left"}.get(known[0], "camber_left")
        soft = "toe_by_lateral" if known[0] == "travel" else "toe_by_lateral_opposed_left"
        example = soft if looked_at[0] in HELD else kinematic
        problem = (
            f"it has no [targets.NAME] and no [limits.NAME] {_or(list(map(_over, looked_at)))}: "
            f"one is needed, such as [limits.{example}] with "
            f"{sweep_axis(looked_at[0]).key}, least and most."
        )
        raise InputError([problem], str(path))
    others = dict.fromkeys(f"{g.name} {_over(g.over)}" for g in every if g.over not in axes)
    if others:
        note(f"{path}: not about these curves: {', '.join(others)}.")
    return found


def _over(over: str) -> str:
    from ..analysis.compliance.flexibility import HELD
    from ..studies.sweep_axes import title_of_axis

    return f'with held = "{over}"' if over in HELD else f"over {title_of_axis(over)}"


def _or(names: Sequence[str]) -> str:
    return " or ".join(part for part in (", ".join(names[:-1]), names[-1]) if part)


def refuse_elsewhere(curves: "Dataset") -> None:
    """Refuse goals for curves with the rack or the wheel held off design."""
    held = [curve for curve in curves.coords.values() if not curve.ndim and curve.dtype.kind == "f"]
    if any(abs(float(curve)) > _HELD for curve in held):
        raise typer.BadParameter(ELSEWHERE)


def refuse_beyond(
    goals: "Sequence[Goal]", curves: "Mapping[str, Dataset]", path: Path | None
) -> None:
    """Refuse goals beyond the ends of the curves, by axis, with which they are drawn."""
    from ...core.validator import Validator
    from ..studies.sweep_axes import sweep_axis

    with of_study(path), Validator("goals") as given:
        for goal in goals:
            over = sweep_axis(goal.over)
            along = curves[goal.over][over.along.name].values
            ends = float(along.min()), float(along.max())
            beyond = goal.at[(goal.at < ends[0] - _ROUNDING) | (goal.at > ends[1] + _ROUNDING)]
            if beyond.size:
                places, (low, high) = (
                    [f"{over.factor * at + 0.0:g}" for at in values] for values in (beyond, ends)
                )
                given.fail(
                    f"{goal.name}: {', '.join(places)} {over.unit} of {over.words} is beyond its "
                    f"curve, which goes from {low} to {high} {over.unit}. Extend the curve, "
                    "or leave that position out."
                )


def judged(
    subjects: "Mapping[str, Subject]", goals: "Sequence[Goal]", path: Path | None
) -> list[dict[str, Any]]:
    """Return the verdict on each goal of a file for each subject, for tables and JSON."""
    from .. import studies as variation

    with of_study(path):
        return [
            {"file": name, **vars(verdict)}
            for name, subject in subjects.items()
            for verdict in variation.judge(subject, goals)
        ]


def table(found: Sequence[Mapping[str, Any]], title: str) -> "Table":
    """Return the table of verdicts of `judged`."""
    from ...core.quantities import display_of
    from ..studies.goals import words_of
    from ..studies.sweep_axes import sweep_axis

    def cell(row: Mapping[str, Any]) -> str:
        if row["met"]:
            return "met"
        over = sweep_axis(row["over"])
        shown = display_of(over.known[row["name"]].attributes())
        missed = significant(row["beyond"] * shown.factor)
        return f"missed by {missed} at {over.factor * row['at']:g} {over.unit}"

    files = list(dict.fromkeys(row["file"] for row in found))
    by_file = [[row for row in found if row["file"] == file] for file in files]
    rows = [
        (words_of(same[0]["kind"], same[0]["name"], same[0]["over"]), *map(cell, same))
        for same in zip(*by_file, strict=True)
    ]
    return table_of(title, ("goal", *files), rows, words=range(1 + len(files)))
