"""What the commands do with the file of a rigid axle."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ..report import Chapter
    from ..study.variation.goals import Goal


def is_rigid_axle(file: str) -> bool:
    """Tell whether a file is that of a rigid axle."""
    from ..suspension.rigid.axle import is_rigid_axle as found

    return found(file)


def report(
    file: str,
    target: Path,
    title: str | None,
    further: "Sequence[Chapter]",
    goals: "Sequence[Goal]",
    *,
    force: bool,
    inputs: list[str | Path],
) -> Path:
    """Write the report of a rigid axle: drawings, tables, curves with goals, further chapters.

    There is nothing to be moved.
    """
    from ..report import axle_chapter, write_chapters
    from ..suspension.rigid import RigidAxle

    axle = RigidAxle.load(file)
    heading = axle.heading()
    heading = title or f"{heading[:1].upper()}{heading[1:]}"
    chapters = [axle_chapter(axle, goals), *further]
    return write_chapters(
        target, title=heading, chapters=chapters, data=axle, force=force, inputs=inputs
    )
