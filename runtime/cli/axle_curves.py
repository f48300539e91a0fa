"""The curves of both wheels over the motions of a rig: files, pictures, tables, what is met."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from . import goals as wanted
from .console import console, curve_table, print_json, print_table
from .outputs import Outputs, name_files, named, of_both, only, title_of

if TYPE_CHECKING:
    from xarray import Dataset

    from ..suspension.axle import Axle
    from ..suspension.rigid import RigidAxle


def tell(
    file: str,
    axle: "Axle | RigidAxle",
    curves: "Mapping[str, Dataset]",
    words: Mapping[str, str],
    shown: Mapping[str, Sequence[str]],
    outputs: Outputs,
    *,
    of: list[str] | None,
    goals: Path | None,
    json: bool,
) -> None:
    """Write and print curves by the motion that they are over.

    Parameters
    ----------
    words
        What each motion is called.
    shown
        The curves that a table of each motion has; bump has its own tables.
    """
    from ..study import export
    from ..study.axles import by_side
    from ..study.axles.sheet import at_design
    from ..study.variation.ways import ways_of

    drawn = {motion: by_side(dataset) for motion, dataset in curves.items()}
    names = named(of_both(of), drawn)
    aims = wanted.read(goals, [*curves], ways_of(axle))
    judged = wanted.judged({file: axle}, aims) if aims else []
    if outputs.drawn:
        wanted.refuse_beyond(aims, curves)
    written = []
    for motion, dataset in curves.items():
        written += outputs.write(
            dataset,
            title=f"{title_of(file)}: {words[motion]}",
            names=names[motion],
            suffix=f"_{motion}",
            drawn=drawn[motion],
            goals=[goal for goal in aims if goal.over == motion],
        )
    if json:
        found = {f"over_{motion}": export.as_dict(curves[motion]) for motion in curves}
        print_json(found | ({"goals": judged} if judged else {}))
        return
    for motion, dataset in curves.items():
        if motion == "bump":
            for table in at_design(only(of, dataset), f"{file}: "):
                if table.rows:
                    print_table(table)
            continue
        told = [str(name) for name in (only(of, dataset) if of else shown[motion])]
        told = [name for name in told if name in dataset]
        if told:
            console.print(curve_table(dataset, told, f"{file}: {words[motion]}"))
    if judged:
        console.print(wanted.table(judged, f"{file}: targets and limits of {goals}"))
    name_files(written)
