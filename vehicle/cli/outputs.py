"""Data files, figures and hardpoint files: their options, and functions to write them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

import typer
from rich.markup import escape

from ...terminal.console import problems, progress_bar, say
from ...terminal.exits import Exit
from .options import OUTPUT, Force, Json, among, option

if TYPE_CHECKING:
    from xarray import Dataset

    from ..studies.evaluation import Subject
    from ..studies.goals import Goal

Out = Annotated[
    list[Path] | None,
    option(
        "Write the data: .csv or .xlsx (mm, deg), .nc, .parquet or .mat (SI). May be repeated.",
        "PATH",
        "--out",
        "-o",
        panel=OUTPUT,
    ),
]
Plot = Annotated[
    list[Path] | None,
    option(
        "Write the curves: .pdf (a page a group), .png or .svg. May be repeated.",
        "PATH",
        panel=OUTPUT,
    ),
]
Figure = Annotated[
    list[Path] | None,
    option("Write a figure: .pdf, .png or .svg. May be repeated.", "PATH", "--plot", panel=OUTPUT),
]
Figures = Annotated[
    Path | None, option("Write a figure of every curve into this folder.", "FOLDER", panel=OUTPUT)
]
Formats = Annotated[
    list[str] | None, option("Of --figures: png, svg or pdf.", "NAME,...", "--format", panel=OUTPUT)
]
Animation = Annotated[
    Path | None,
    option("Write the motion, in real time: .gif, or .html to play.", "PATH", panel=OUTPUT),
]
Loads = Annotated[
    list[Path] | None,
    option(
        "Write the loads on every part: .csv or .xlsx (mm), .nc, .parquet or .mat. May be "
        "repeated.",
        "PATH",
        panel=OUTPUT,
    ),
]
CarFile = Annotated[
    Path | None,
    option("Write the input file with the new values: .toml.", "PATH", "--out", "-o", panel=OUTPUT),
]


class _Files:
    """The base of groups of options for files."""

    force: bool
    json: bool

    def files(
        self,
        *inputs: str | Path | None,
        suffixes: Sequence[str] = ("",),
        drawn: Sequence[str] | None = None,
        car: Path | None = None,
    ) -> "Outputs":
        """Return the files to write; those that cannot be written are refused before computing.

        `inputs` are files that the command reads: they are never replaced. `suffixes` are the ends
        of the names, one for each dataset, `drawn` those of figures, by default the same. `car` is
        a hardpoint file to write.
        """
        from ...core.files import refuse
        from ...datasets import export

        data, pages = getattr(self, "out", None) or (), getattr(self, "plot", None) or ()
        formats = getattr(self, "formats", None) or ()
        loads, animation = getattr(self, "loads", None) or (), getattr(self, "animate", None)
        for path in (*data, *loads):
            export.check_format(path)
        if pages or formats:
            from ..plots import curves as plots

            plots.check_formats(pages, formats)
        rule: Rule = {"force": self.force, "inputs": [each for each in inputs if each is not None]}
        named = [(data, suffixes), (pages, suffixes if drawn is None else drawn)]
        files, planned = (
            [_named(path, end) for end in ends for path in paths] for paths, ends in named
        )
        refuse([*files, *planned, *loads, *([] if animation is None else [animation])], **rule)
        if car is not None:
            refuse([car], endings=[".toml"], **rule)
        if animation is not None:
            from ..plots.motion import ENDINGS

            refuse([animation], endings=ENDINGS, **rule)
        figures = getattr(self, "figures", None)
        return Outputs(
            rule, data, pages, planned, figures, formats or ("png",), car, loads, animation
        )


@dataclass(frozen=True)
class DataOptions(_Files):
    """The options of a command that writes data."""

    out: Out = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class PlotOptions(_Files):
    """The options of a command that writes data and curves."""

    out: Out = None
    plot: Plot = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class CurveOptions(_Files):
    """The options of a command that writes data, pages of curves, and a figure of each curve."""

    out: Out = None
    plot: Plot = None
    figures: Figures = None
    formats: Formats = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class SingleFigureOptions(_Files):
    """The options of a command that writes data and a figure."""

    out: Out = None
    plot: Figure = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class MotionOptions(SingleFigureOptions):
    """The options of a command that writes the motion of a car, and its animation."""

    animate: Animation = None


@dataclass(frozen=True)
class CarOptions(_Files):
    """The options of a command that writes a new hardpoint file and a figure."""

    car: CarFile = None
    plot: Figure = None
    force: Force = False
    json: Json = False


class Rule(TypedDict):
    """The files that may be replaced; see `kintrafo.core.files`."""

    force: bool
    inputs: Sequence[str | Path]


@dataclass(frozen=True)
class Outputs:
    """The files that a command writes."""

    rule: Rule
    data: Sequence[Path] = ()
    pages: Sequence[Path] = ()
    planned: Sequence[Path] = ()  # files of the pages, in the order in which they are drawn
    figures: Path | None = None
    formats: Sequence[str] = ("png",)
    car: Path | None = None
    loads: Sequence[Path] = ()  # data files of the loads on parts
    animation: Path | None = None

    @property
    def drawn(self) -> bool:
        """Whether curves are drawn."""
        return bool(self.pages) or self.figures is not None

    def write(
        self,
        dataset: "Dataset",
        *,
        title: str,
        names: Sequence[str] = (),
        suffix: str = "",
        rows: "Dataset | None" = None,
        drawn: "Dataset | None" = None,
        goals: "Sequence[Goal]" = (),
    ) -> list[Path]:
        """Write the data and figures, and return the files.

        `names` are the curves of the page, by default all; `suffix` is the end of the name of each
        file, for commands with several datasets. `rows` is the form of the data for tables, `drawn`
        that for figures; `goals` are drawn into the curves.
        """
        written = self.write_data(dataset, suffix, rows=rows)
        if not self.drawn:
            return written
        from ..plots import curves as plots

        shown = dataset if drawn is None else drawn
        written += self.draw(plots.write_overview, shown, names, title, goals=goals, suffix=suffix)
        if self.figures is not None:
            how: dict[str, Any] = {"title": title, "suffix": suffix, "goals": goals, **self.rule}
            with progress_bar("figures") as progress:
                written += plots.write(
                    shown, self.figures, formats=self.formats, progress=progress, **how
                )
        return written

    def write_data(
        self,
        dataset: "Dataset",
        suffix: str = "",
        *,
        rows: "Dataset | None" = None,
        sheets: "Mapping[str, Dataset] | None" = None,
    ) -> list[Path]:
        """Write the data files alone and return them.

        Tables have `rows`, workbooks `sheets`; netCDF has the whole dataset.
        """
        from ...datasets import export

        flat = dataset if rows is None else rows
        return [
            export.write(
                dataset if path.suffix.lower() == ".nc" else flat,
                _named(path, suffix),
                sheets=sheets,
                **self.rule,
            )
            for path in self.data
        ]

    def draw(
        self,
        write: Callable[..., Path],
        shown: Any,
        *rest: Any,
        suffix: str = "",
        **options: Any,
    ) -> list[Path]:
        """Write the pages by a function of the data and a path, and return them.

        A line on the terminal names the figure.
        """
        written = []
        for path in (_named(path, suffix) for path in self.pages):
            number = 1 + self.planned.index(path)
            with problems.status(
                escape(f"drawing figure {number} of {len(self.planned)}: {path.name}")
            ):
                written.append(write(shown, path, *rest, **options, **self.rule))
        return written

    def write_loads(self, found: "Dataset") -> list[Path]:
        """Write the data files of the loads on parts, and return them."""
        from ..analysis import loads as study

        rows, sheets = study.table(found), study.workbook(found)
        return replace(self, data=self.loads).write_data(found, rows=rows, sheets=sheets)

    def write_animation(self, found: Any, title: str) -> list[Path]:
        """Write the animation of a motion, if it is wanted, and return it."""
        if self.animation is None:
            return []
        from ..plots.motion import animate

        with problems.status("animation"):
            return [animate(found, self.animation, title=title, **self.rule)]

    def write_car(self, subject: "Subject", head: str) -> list[Path]:
        """Write the new hardpoint file with a comment at its top, and return it."""
        from ..input.toml_writer import write_toml

        if self.car is None:
            return []
        return [write_toml(subject, self.car, head=[head], **self.rule)]


def named(of: list[str] | None, drawn: "Mapping[str, Dataset]") -> dict[str, list[str]]:
    """Return the wanted curves of each dataset; an empty list selects all curves.

    Names that are in none of the datasets are refused.
    """
    if not of:
        return {key: [] for key in drawn}
    known = dict.fromkeys(str(name) for dataset in drawn.values() for name in dataset)
    wanted = among(of, known)
    # a page has at least one curve: without any of these it has all
    return {key: [n for n in wanted if n in dataset] for key, dataset in drawn.items()}


def of_both(of: list[str] | None) -> list[str]:
    """Return names without sides, for curves of both wheels in one figure."""
    return [name.removesuffix("_left").removesuffix("_right") for name in of or ()]


def only(of: list[str] | None, dataset: "Dataset") -> "Dataset":
    """Return the wanted curves of a dataset, of both wheels; all if none are named."""
    if not of:
        return dataset
    stems = {*of, *of_both(of)}
    names = map(str, dataset.data_vars)
    return dataset[[n for n in names if not stems.isdisjoint((n, *of_both([n])))]]


def title_of(file: str) -> str:
    """Return the title of a file in figures: its name without folder and ending."""
    return Path(file).stem if Path(file).suffix else file


def name_files(files: Sequence[Path]) -> None:
    """Print the written files."""
    for path in files:
        say(f"  {path}")


def end_if_not_valid(reasons: Sequence[str]) -> None:
    """Print the reasons of an invalid result, and end the command with `Exit.REFUSED`."""
    for text in reasons:
        problems.print(f"not valid: {text}", style="red", highlight=False, markup=False)
    if reasons:
        raise typer.Exit(Exit.REFUSED)


def _named(path: Path, suffix: str) -> Path:
    return path.with_name(f"{path.stem}{suffix}{path.suffix}")
