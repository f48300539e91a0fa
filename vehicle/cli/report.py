"""``kintrafo report``: one file to send to a colleague."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ...terminal.console import problems, say
from . import goals as wanted
from .options import File, Force, Which, refuse_options, refuse_which, system_of
from .subject import described_by

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    from ...systems.system import System
    from ..analysis.compliance.flexibility import WheelSupport
    from ..models.axle import Axle
    from ..models.model import Model
    from ..models.rigid import RigidAxle
    from ..report import Chapter
    from ..studies.goals import Goal

# What holds the wheels where the chapter of compliance has curves.
_HELD: "WheelSupport" = "height"

EXAMPLES = (
    "kintrafo report reference_car",
    'kintrafo report my_car.toml front_axle.html --title "Front axle, stage 2"',
    "kintrafo report my_car.toml --loads --bushes bushes.toml",
    "kintrafo report my_car.toml --goals goals.toml",
    "kintrafo report reference_axle",
    "kintrafo report rigid_axle --loads",
    "kintrafo report my_mechanism.py",
)


def command(
    file: File,
    path: Annotated[
        Path | None,
        typer.Argument(metavar="PATH", help="Ends in .html. Default: the file's name with .html."),
    ] = None,
    *,
    title: Annotated[str | None, typer.Option(help="Heading of the report.")] = None,
    model_name: Which = None,
    loads: Annotated[
        bool, typer.Option("--loads", help="With the usual load cases and their free bodies.")
    ] = False,
    cases: Annotated[
        Path | None,
        typer.Option(metavar="PATH", help="With the load cases of this file (TOML)."),
    ] = None,
    bushes: Annotated[
        Path | None,
        typer.Option(
            metavar="PATH",
            help="With the compliance on the bushes of this file (TOML), not those of FILE.",
        ),
    ] = None,
    goals: wanted.Goals = None,
    force: Force = False,
) -> None:
    """Write a report that opens in any browser: the mechanism to move by hand, curves, data.

    FILE may be the Python file of a mechanism of your own.

    Of an axle it has one side to be moved, and what a rig finds of both; of a rigid axle drawings,
    tables and curves.
    """
    from ...core.files import refuse
    from ..report import ENDINGS

    refuse_which(file, model_name)
    target = path or Path(f"{Path(file).stem}.html")
    inputs: list[str | Path] = [
        file,
        *(read for read in (cases, bushes, goals) if read is not None),
    ]
    refuse([target], force=force, inputs=inputs, endings=ENDINGS)
    if file.endswith(".py"):
        refuse_options(
            "the file of a suspension",
            {"--loads": loads or None, "--cases": cases, "--bushes": bushes, "--goals": goals},
        )
        page = _Page(system_of(file, model_name), title)
    else:
        of = described_by(file)
        aims = _aims(of, goals)
        with problems.status("tables and curves"):
            chapters = [*_of_axle(of, aims), *_of_loads(of, cases, wanted=loads)]
            chapters += _of_wheels(of, bushes, aims)
        page = _Page.of(of, title, chapters, aims)
    with problems.status("report") as status:
        written = page.write(target, progress=status.update, force=force, inputs=inputs)
    say(f"  {written}")


@dataclass
class _Page:
    """A report before it is written.

    Attributes
    ----------
    moved : Model, System or None
        What is moved by hand; None of a rigid axle.
    title : str or None
    chapters : sequence of Chapter
    options : dict
        Of `kintrafo.report.write`.
    data : RigidAxle or None
        What the file says, of what is not moved.
    """

    moved: "System | None"
    title: str | None
    chapters: "Sequence[Chapter]" = ()
    options: dict[str, Any] = field(default_factory=dict)
    data: "RigidAxle | None" = None

    @classmethod
    def of(
        cls,
        of: "Model | Axle | RigidAxle",
        title: str | None,
        chapters: "Sequence[Chapter]",
        goals: "Sequence[Goal]",
    ) -> "_Page":
        """Return that of a corner, of an axle of which one side is moved, or of a rigid axle."""
        from ..assembly.of import assembly_of
        from ..report.marks import of_shown_side

        assembly = assembly_of(of)
        if len(assembly.wheels) == 1:
            return cls(assembly.model, title, chapters, {"goals": goals})
        heading = f"{assembly.heading[:1].upper()}{assembly.heading[1:]}"
        if not assembly.corners:
            return cls(None, title or heading, chapters, data=assembly.subject)
        # of two that differ the right one
        side, model = [*assembly.corners.items()][-1]
        options = {
            "without": _of_one_side(assembly.subject),
            "goals": of_shown_side(assembly.subject, goals, side),
        }
        return cls(model, title or f"{heading}, {side} side", chapters, options)

    def write(self, target: Path, *, progress: Any, **written: Any) -> Path:
        """Write it."""
        from ..report import write, write_chapters

        if self.moved is not None:
            return write(
                self.moved,
                target,
                title=self.title,
                chapters=self.chapters,
                progress=progress,
                **self.options,
                **written,
            )
        assert self.title is not None
        assert self.data is not None
        return write_chapters(
            target, title=self.title, chapters=self.chapters, data=self.data, **written
        )


def _of_one_side(axle: "Axle") -> frozenset[str]:
    """Return what the page of one side of an axle leaves out."""
    from ..assembly.measures.corner import BOTH

    # what both wheels decide: the page knows but one side, and takes the other for its image
    both = frozenset(measure.name for measure in BOTH)
    without = frozenset() if axle.symmetric else both
    return without if axle.end == "front" else both | {"anti_dive", "anti_lift_braked"}


def _of_axle(of: "Model | Axle | RigidAxle", goals: "Sequence[Goal]") -> "list[Chapter]":
    from ..assembly.of import assembly_of
    from ..report import axle_chapter

    assembly = assembly_of(of)
    return [axle_chapter(of, goals)] if len(assembly.wheels) > 1 else []


def _of_loads(
    of: "Model | Axle | RigidAxle", cases: Path | None, *, wanted: bool
) -> "list[Chapter]":
    from ..analysis import loads as study
    from ..report import loads_chapter

    if cases is None and not wanted:
        return []
    described = {} if cases is None else study.read(cases)
    load_at_rest = described.get("static_load_N")
    return [loads_chapter(study.static(of, described.get("cases"), static_load=load_at_rest))]


def _aims(of: "Model | Axle | RigidAxle", path: Path | None) -> "list[Goal]":
    """Return the targets and limits of a file."""
    from ..analysis.compliance.flexibility import HELD
    from ..kinds import Suspension
    from ..studies.sweep_axes import sweep_axes_of

    subject = wanted.subject_of(of)
    known = sweep_axes_of(subject)
    unsteered = isinstance(subject, Suspension) and not subject.steered()
    return wanted.read(path, [*(known[:1] if unsteered else known), *HELD], known)


def _of_wheels(
    of: "Model | Axle | RigidAxle", bushes: Path | None, goals: "Sequence[Goal]"
) -> "list[Chapter]":
    """Return the report of compliance, of targets and limits, and of the design position."""
    return [*_of_bushes(of, bushes, goals), *_of_goals(of, bushes, goals), *_of_sheet(of, bushes)]


def _of_goals(
    of: "Model | Axle | RigidAxle", bushes: Path | None, goals: "Sequence[Goal]"
) -> "list[Chapter]":
    from ..analysis.compliance import read_bushes
    from ..assembly.of import assembly_of
    from ..report import goals_chapter

    if not goals:
        return []
    if bushes is None:
        return [goals_chapter(of, goals)]
    return [goals_chapter(assembly_of(of).with_bushings(read_bushes(bushes)), goals)]


def _of_bushes(
    of: "Model | Axle | RigidAxle", bushes: Path | None, goals: "Sequence[Goal]"
) -> "list[Chapter]":
    from ..analysis import compliance
    from ..assembly.of import assembly_of
    from ..report import compliance_chapter, elastokinematics_chapter
    from ..report.chapters.curves import positions_of

    assembly = assembly_of(of)
    if bushes is None and not assembly.has_bushes:
        return []
    described = None if bushes is None else compliance.read_bushes(bushes)
    at = positions_of(assembly, _HELD, goals)
    motions = ["travel"] if len(assembly.wheels) == 1 else ["bump", "roll"]
    soft = [
        compliance.elastokinematics(assembly, described, motion, _as_far_as(of, motion, goals))
        for motion in motions
    ]
    return [
        compliance_chapter(compliance.linear(assembly, described, at, held=_HELD), goals),
        elastokinematics_chapter(*soft, goals=goals),
    ]


def _as_far_as(
    of: "Model | Axle | RigidAxle", over: str, goals: "Sequence[Goal]"
) -> "NDArray[np.float64] | None":
    """Return positions that reach what goals are about; None where the usual ones do."""
    from ..assembly.of import assembly_of
    from ..report.chapters.curves import positions_of
    from ..studies.evaluation import usual_positions

    if all(goal.over != over for goal in goals):
        return None
    assembly = assembly_of(of)
    usual, wanted = usual_positions(assembly, over), positions_of(assembly, over, goals)
    return wanted if wanted[0] < usual[0] or wanted[-1] > usual[-1] else None


def _of_sheet(of: "Model | Axle | RigidAxle", bushes: Path | None) -> "list[Chapter]":
    from ..analysis.compliance import read_bushes
    from ..analysis.sheet import sheet
    from ..report import sheet_chapter

    described = None if bushes is None else read_bushes(bushes)
    return [sheet_chapter(sheet(of, described))]
