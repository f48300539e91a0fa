"""``kintrafo report``: an interactive page with drawings, tables and curves."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from ...terminal.console import problems, say
from . import goals as wanted
from .loading import assembly_of_file, bushes_of, of_cases, system_of
from .options import Bushes, File, Force, Which, argument, option, refuse_options, refuse_which
from .outputs import title_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from ...core.named_types import Array
    from ...systems.system import System
    from ..analysis.compliance.flexibility import WheelSupport
    from ..assembly.assembly import Assembly
    from ..models.axle import Axle
    from ..report import Chapter
    from ..studies.goals import Goal

# Support of the wheels in the chapter of compliance.
_HELD: "WheelSupport" = "height"

EXAMPLES = (
    "kintrafo report reference_car",
    'kintrafo report my_car.toml front_axle.html --title "Front axle, stage 2"',
    "kintrafo report my_car.toml --standard-cases --bushes bushes.toml",
    "kintrafo report my_car.toml --goals goals.toml",
    "kintrafo report reference_axle",
    "kintrafo report rigid_axle --standard-cases",
    "kintrafo report quarter_car",
    "kintrafo report my_mechanism.py",
)


def command(
    file: File,
    path: Annotated[
        Path | None,
        argument("Ends in .html. Default: the file's name with .html.", "PATH"),
    ] = None,
    *,
    title: Annotated[str | None, option("Heading of the report.")] = None,
    model_name: Which = None,
    standard_cases: Annotated[
        bool, option("Add the standard load cases and their free bodies.")
    ] = False,
    cases: Annotated[Path | None, option("Add the load cases of this file (TOML).", "PATH")] = None,
    bushes: Bushes = None,
    goals: wanted.Goals = None,
    force: Force = False,
) -> None:
    """Write a report that opens in any browser: interactive 3D view, curves, data.

    FILE may be the Python file of a mechanism of your own.

    The 3D view shows one side of an axle; a chapter has the characteristics of both sides on a rig.
    A rigid axle or a twist beam is shown in its motions on a rig. A car is shown at rest, in motion
    over a bump and, if it drives, in a step steer; a line in the curves marks the time of the
    picture. Each axle has a chapter. Targets and limits of --goals have a chapter. Compliance is
    included if FILE has bushes, or with --bushes.
    """
    from ...core.files import refuse
    from ..report import ENDINGS, write, write_chapters
    from ..studies.sweep_axes import sweep_axes_of

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
            {
                "--standard-cases": standard_cases or None,
                "--cases": cases,
                "--bushes": bushes,
                "--goals": goals,
            },
        )
        moved: System | None = system_of(file, model_name)
        page: dict[str, Any] = {"title": title}
    else:
        assembly = assembly_of_file(file)
        if assembly.body_moves:
            refuse_options("an axle or a suspension", {"--cases": cases, "--bushes": bushes})
        aims = wanted.read(goals, None, sweep_axes_of(assembly.subject))
        with problems.status("tables and curves") as status:
            chapters = [
                *_chapters(
                    assembly,
                    aims,
                    cases,
                    bushes,
                    standard_cases=standard_cases,
                    progress=status.update,
                )
            ]
        name = f"{title_of(file)}: {assembly.heading}" if assembly.body_moves else None
        moved, page = _page(assembly, title or name, chapters, aims)
    with problems.status("report") as status:
        if moved is None:
            written = write_chapters(target, **page, force=force, inputs=inputs)
        else:
            written = write(
                moved, target, **page, progress=status.update, force=force, inputs=inputs
            )
    say(f"  {written}")


def _page(
    assembly: "Assembly",
    title: str | None,
    chapters: "Sequence[Chapter]",
    goals: "Sequence[Goal]",
) -> "tuple[System | None, dict[str, Any]]":
    """Return the equations of the interactive view, if any, and the page's other arguments."""
    from ..report.marks import of_shown_side

    page: dict[str, Any] = {"title": title, "chapters": chapters}
    if len(assembly.wheels) == 1 and not assembly.body_moves:
        return assembly.model, page | {"goals": goals}
    heading = title or f"{assembly.heading[:1].upper()}{assembly.heading[1:]}"
    if not assembly.corners:
        return None, page | {"title": heading, "data": assembly.input_sections}
    # the right side, if both differ
    side, model = [*assembly.corners.items()][-1]
    return model, page | {
        "title": title or f"{heading}, {side} side",
        "without": _of_one_side(assembly.subject),
        "goals": of_shown_side(assembly.subject, goals, side),
    }


def _of_one_side(axle: "Axle") -> frozenset[str]:
    """Return the measures left out of the page of one side of an axle."""
    from ..assembly.measures.corner import BOTH

    # measures of both wheels: the page mirrors one side, so they are wrong if the sides differ
    both = frozenset(measure.name for measure in BOTH)
    without = frozenset() if axle.symmetric else both
    return without if axle.end == "front" else both | {"anti_dive", "anti_lift_braked"}


def _chapters(
    assembly: "Assembly",
    goals: "Sequence[Goal]",
    cases: Path | None,
    bushes: Path | None,
    *,
    standard_cases: bool,
    progress: "Callable[[str], None]",
) -> "Iterator[Chapter]":
    """Yield the chapters of an assembly, then those of its parts on a held body."""
    from ..report import (
        axle_chapter,
        goals_chapter,
        rest_chapter,
        ride_chapter,
        steady_turns_chapter,
        step_steer_chapter,
    )

    if assembly.body_moves:
        progress("the car at rest")
        yield rest_chapter(assembly)
    if assembly.drives:
        progress("steady turns and step steer")
        yield steady_turns_chapter(assembly)
        yield step_steer_chapter(assembly)
    if assembly.body_moves:
        progress("ride")
        yield ride_chapter(assembly)
    if len(assembly.wheels) > 1:
        progress("motions of a rig")
        yield axle_chapter(assembly, goals)
    if assembly.body_moves and goals:
        progress("targets and limits")
        yield goals_chapter(assembly, goals)
    of_parts = () if assembly.body_moves else goals
    for name, part in assembly.held_parts.items():
        progress(f"tables and curves {name}".strip())
        for chapter in _of_held(part, of_parts, cases, bushes, standard_cases=standard_cases):
            title = f"{chapter.title}: {name}" if name else chapter.title
            yield replace(chapter, title=title)


def _of_held(
    assembly: "Assembly",
    goals: "Sequence[Goal]",
    cases: Path | None,
    bushes: Path | None,
    *,
    standard_cases: bool,
) -> "Iterator[Chapter]":
    """Yield the chapters of a suspension or an axle: loads, compliance, goals, K&C sheet."""
    from ..analysis import loads as study
    from ..analysis.sheet import sheet
    from ..report import goals_chapter, loads_chapter, sheet_chapter

    described = bushes_of(assembly, bushes)
    if standard_cases or cases is not None:
        content = {} if cases is None else study.read(cases)
        at_rest = content.get("static_load_N")
        with of_cases(cases):
            found = study.static(assembly, content.get("cases"), static_load=at_rest)
        yield loads_chapter(found)
    if described is not None or assembly.has_bushes:
        yield from _of_bushes(assembly, described, goals)
    if goals:
        on_bushes = assembly if described is None else assembly.with_bushings(described)
        yield goals_chapter(on_bushes, goals)
    yield sheet_chapter(sheet(assembly, described))


def _of_bushes(
    assembly: "Assembly", described: Mapping[str, Any] | None, goals: "Sequence[Goal]"
) -> "Iterator[Chapter]":
    from ..analysis import compliance
    from ..report import compliance_chapter, elastokinematics_chapter
    from ..report.chapters.curves import positions_of

    at = positions_of(assembly, _HELD, goals)
    yield compliance_chapter(compliance.linear(assembly, described, at, held=_HELD), goals)
    motions = ["travel"] if len(assembly.wheels) == 1 else ["bump", "roll"]
    soft = [
        compliance.elastokinematics(
            assembly, described, motion, _as_far_as(assembly, motion, goals)
        )
        for motion in motions
    ]
    yield elastokinematics_chapter(*soft, goals=goals)


def _as_far_as(assembly: "Assembly", over: str, goals: "Sequence[Goal]") -> "Array | None":
    """Return positions that reach all goals; None if the default ones do."""
    from ..report.chapters.curves import positions_of
    from ..studies.evaluation import usual_positions

    if all(goal.over != over for goal in goals):
        return None
    usual, wanted = usual_positions(assembly, over), positions_of(assembly, over, goals)
    return wanted if wanted[0] < usual[0] or wanted[-1] > usual[-1] else None
