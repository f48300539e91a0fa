"""The HTML report: one file that opens anywhere, without a network."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path

import numpy as np
from jinja2 import Environment

from ...core.files import Paths, refuse, write_text
from ...core.legible import legible, power_of_ten
from ...core.validator import Validator, shown
from ...pages.embedded import asset, page_environment
from ...pages.mechanism.page import report_page
from ...simulation.result import Simulation
from ...systems.system import System
from ..analysis.characteristics.groups import ORDER
from ..analysis.loads.along import is_motion_of
from ..analysis.paper import SPIN_RATE
from ..assembly.quantity import displaced_by
from ..input.section import Section
from ..models.model import Model
from ..plots.motion.page import player_script, player_style
from ..studies.goals import Goal, check_goals
from .accuracy import GridAccuracy, measure
from .chapters.chapter import Chapter
from .curves import CharacteristicCurve, curves, gaps_on
from .grid import Grid
from .marks import Marks, marks
from .motion import DROP, simulated_second
from .payload import Look, ReportSamples, page_data
from .plotted import decimals, shown_range
from .poses import poses, reachable_grid
from .tables import input_tables, summary

ENDINGS = (".html", ".htm")
"""Endings of the names of reports."""


def write(
    model: System,
    path: str | Path,
    *,
    title: str | None = None,
    chapters: Sequence[Chapter] = (),
    without: Collection[str] = (),
    goals: Sequence[Goal] = (),
    motion: Simulation | None = None,
    progress: Callable[[str], None] | None = None,
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write an HTML report of a suspension, or of any mechanism, and return its path.

    One file without references to others has a three-dimensional view of the mechanism that is
    moved by hand, its characteristics, a simulated second and the input data. A mechanism of your
    own has bodies as lines between their joints, a slider for each coordinate, signals, and modes
    at rest.

    Parameters
    ----------
    model : Model or System
        A suspension, or another mechanism.
    path : str or pathlib.Path
        A file whose name ends in ``.html``; it appears when it is complete. Folders are created.
    title : str, optional
        Heading of the page; by default a description of the suspension.
    chapters : sequence of Chapter, optional
        Further chapters: see `kintrafo.report.axle_chapter`, `loads_chapter`,
        `compliance_chapter` and `elastokinematics_chapter`.
    without : collection of str, optional
        Characteristics to leave out, such as those of front axles on a rear axle.
    goals : sequence of TargetValue and Limit, optional
        Result of `kintrafo.variation.goals`, also those of an axle for the report of its side. They
        are marked in the charts of their characteristics, and the page lists those without a chart,
        see `kintrafo.report.goals_chapter`.
    motion : Simulation, optional
        Motion of a mechanism other than a suspension; by default one second from the design
        position at rest, without inputs.
    progress : callable, optional
        Called with a short description of the present step.
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.
    inputs : iterable of str or pathlib.Path, optional
        Files that are never replaced.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    PositionError
        If the suspension cannot move.
    """
    refuse([path], force=force, inputs=inputs, endings=ENDINGS)
    with Validator("report.write") as given:
        given.instance("model", model, System, System.NEEDED)
        given.function("progress", progress)
        if title is not None:
            given.text("title", title)
        if motion is not None:
            given.instance("motion", motion, Simulation, "a result of kintrafo.simulate is needed")
            if isinstance(model, Model):
                given.fail("motion: the report of a suspension has a simulated second of its own")
            elif not given.failed and not is_motion_of(model, motion):
                given.fail(f"motion: it is not one of this mechanism, {model!r}.")
        check_goals(given, "goals", goals)
        if not isinstance(chapters, list | tuple) or not all(
            isinstance(chapter, Chapter) for chapter in chapters
        ):
            given.fail("chapters: a list of chapters is needed, such as goals_chapter returns.")
        if not isinstance(without, list | tuple | set | frozenset):
            given.fail(f"without = {shown(without)}: a list of names is needed.")
        if not (given.failed or isinstance(model, Model)) and (chapters or without or goals):
            given.fail("chapters, without, goals: only the report of a suspension has them")
    report = progress or (lambda _: None)
    if isinstance(model, Model):
        text = render(
            model, title=title, chapters=chapters, without=without, goals=goals, report=report
        )
    else:
        report("positions of the mechanism")
        text = report_page(model, title, motion)
    report("writing the page")
    return write_text(path, text, force=force, inputs=inputs)


def render(
    model: Model,
    *,
    title: str | None = None,
    chapters: Sequence[Chapter] = (),
    without: Collection[str] = (),
    goals: Sequence[Goal] = (),
    report: Callable[[str], None] = lambda _: None,
) -> str:
    """Return the report as text; see `write`."""
    samples = _sample(model, report, without, goals)
    side, steered = model.suspension.vehicle.side, model.suspension.steered()
    template = _environment().get_template("page.html.jinja")
    return template.render(
        title=legible(title or f"{model.suspension.heading()}, {'front ' * steered}{side}"),
        steered=steered,
        on_rack=model.suspension.rack is not None,
        steering=displaced_by(model.suspension.steered_by).long_name,
        side=side,
        version=version("kintrafo"),
        samples=samples,
        over_travel=_over_travel(samples.curves),
        over_rack=_over_rack(samples.curves, samples.marks),
        rows=summary(samples, model.suspension),
        inputs=input_tables(model.suspension),
        parts=model.suspension.drawing().legend,
        chapters=chapters,
        drop=DROP,
        spin=SPIN_RATE / (2.0 * np.pi),
        data=page_data(model.suspension, samples),
        script=asset(__package__, "assets/report.js"),
        style=asset(__package__, "assets/report.css"),
    )


def write_chapters(
    path: str | Path,
    *,
    title: str,
    chapters: Sequence[Chapter],
    data: Mapping[str, Section],
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write an HTML report of chapters and input data, and return its path.

    The page has no interactive mechanism.

    Parameters
    ----------
    path, force, inputs
        Name of the file, whether a file that kintrafo did not write is replaced; files that are
        never replaced.
    title : str
        Heading of the page.
    chapters : sequence of Chapter
    data : mapping of str to Section
        Sections of the input files, by the prefix of their names on the page.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        If the file must not or cannot be written.
    """
    refuse([path], force=force, inputs=inputs, endings=ENDINGS)
    template = _environment().get_template("plain.html.jinja")
    text = template.render(
        title=legible(title),
        version=version("kintrafo"),
        inputs=[
            replace(table, name=f"{begin} {table.name}".strip())
            for begin, section in data.items()
            for table in input_tables(section)
        ],
        chapters=chapters,
        moves=any(chapter.players for chapter in chapters),
        player_script=player_script(),
        player_style=player_style(),
        style=asset(__package__, "assets/report.css"),
    )
    return write_text(path, text, force=force, inputs=inputs)


def _sample(
    model: Model, report: Callable[[str], None], without: Collection[str], goals: Sequence[Goal]
) -> ReportSamples:
    report("reach of the mechanism")
    grid = reachable_grid(model)
    travel, rack = grid.travel.values, grid.rack.values
    report("positions over wheel travel and rack displacement")
    sampled = poses(model, travel, rack)
    drawn = [c for c in curves(model, travel, rack, report=report) if c.name not in without]
    gaps = gaps_on(model, grid)
    marked = marks(drawn, grid, goals, model.suspension.vehicle.side)
    ranges = {c.key: marked.widened(c.key, shown_range(c.values)) for c in drawn}
    accuracy = measure(model, grid, sampled, drawn, gaps, ranges, report=report)
    report("one second of motion")
    return ReportSamples(
        grid=grid,
        poses=sampled,
        curves=drawn,
        gaps=gaps,
        accuracy=accuracy,
        looks={c.key: _look(c, grid, ranges[c.key], accuracy) for c in drawn},
        marks=marked,
        motion=simulated_second(model, grid),
    )


def _look(
    curve: CharacteristicCurve, grid: Grid, shown: tuple[float, float], accuracy: GridAccuracy
) -> Look:
    """Return range and decimals of a curve, which distinguish values through design."""
    values = curve.through_design(grid)
    drawn = values if np.isfinite(values).any() else curve.values
    low, high = (end * curve.factor for end in shown_range(drawn))
    design = float(curve.values[grid.travel.zero, grid.rack.zero]) * curve.factor
    return Look(
        shown=(shown[0] * curve.factor, shown[1] * curve.factor),
        decimals=decimals(low, high, unit=curve.unit, value=design),
        error=accuracy.curves[curve.key],
    )


def _over_travel(drawn: list[CharacteristicCurve]) -> dict[str, list[CharacteristicCurve]]:
    """Return the curves over travel under their headings, in the order of the page."""
    found = {
        name: [curve for curve in drawn if curve.over == "travel" and curve.group == name]
        for name in ORDER
    }
    return {name: group for name, group in found.items() if group}


def _over_rack(
    drawn: list[CharacteristicCurve], marked: Marks
) -> tuple[list[CharacteristicCurve], list[CharacteristicCurve]]:
    """Return the curves over the rack that are shown: of steering, wheel and goals, and others."""
    first = {c.name for c in drawn} - {c.name for c in drawn if c.over == "travel"}
    first |= {c.name for c in drawn if c.group == ORDER[0]}
    first |= {c.name for c in drawn if c.over == "rack" and marked.about(c.key)}
    along = [curve for curve in drawn if curve.over == "rack"]
    return [c for c in along if c.name in first], [c for c in along if c.name not in first]


def _environment() -> Environment:
    environment = page_environment(__package__)
    environment.filters["fixed"] = _fixed
    environment.filters["minus"] = _with_minus
    environment.filters["upper_limit"] = _upper_limit
    return environment


def _fixed(value: float, places: int) -> str:
    """Return a number with a true minus sign; a dash if it is not finite."""
    if not np.isfinite(value):
        return "\u2013"
    text = f"{abs(value):.{places}f}"
    return f"\u2212{text}" if value < 0.0 and float(text) != 0.0 else text


def _with_minus(text: str) -> str:
    """Return a number as text with a true minus sign."""
    return text.replace("-", "\u2212") if text[1:2].isdigit() else text


def _upper_limit(error: float) -> str:
    """Return an error with one digit, rounded up."""
    if error == 0.0:
        return "0"
    exponent = int(np.floor(np.log10(error)))
    digit = int(np.ceil(error / 10.0**exponent * (1.0 - 1e-9)))
    if digit == 10:
        digit, exponent = 1, exponent + 1
    if -4 <= exponent <= 2:
        return f"{digit * 10.0**exponent:.{max(-exponent, 0)}f}"
    return f"{digit} \u00b7 {power_of_ten(exponent)}"
