"""Data files, figures and hardpoint files: the options for them, and writing them."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypedDict

import typer

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
    option("Write the hardpoint file that was found: .toml.", "PATH", "--out", "-o", panel=OUTPUT),
]


class _Files:
    """What groups of options of files have in common."""

    force: bool
    json: bool

    def files(
        self,
        *inputs: str | Path | None,
        suffixes: Sequence[str] = ("",),
        drawn: Sequence[str] | None = None,
        car: Path | None = None,
    ) -> "Outputs":
        """Return the files to write, having refused what cannot be written, before computing.

        Parameters
        ----------
        *inputs : str, pathlib.Path or None
            Files that the command reads: they are never replaced.
        suffixes : sequence of str, optional
            What goes behind the names, where a command has several datasets.
        drawn : sequence of str, optional
            The same of figures, where these are others.
        car : pathlib.Path, optional
            Hardpoint file to write.
        """
        from ...core.files import refuse
        from ...datasets import export

        data, pages = getattr(self, "out", None) or (), getattr(self, "plot", None) or ()
        formats = getattr(self, "formats", None) or ()
        for path in data:
            export.check_format(path)
        if pages or formats:
            from ..plots import curves as plots

            plots.check_formats(pages, formats)
        rule: Rule = {"force": self.force, "inputs": [each for each in inputs if each is not None]}
        named = [(data, suffixes), (pages, suffixes if drawn is None else drawn)]
        refuse(
            [_named(path, end) for paths, ends in named for path in paths for end in ends], **rule
        )
        if car is not None:
            refuse([car], endings=[".toml"], **rule)
        figures = getattr(self, "figures", None)
        return Outputs(rule, data, pages, figures, formats or ("png",), car)


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
    """The options of a command that writes data, curves, and a figure of each curve."""

    out: Out = None
    plot: Plot = None
    figures: Figures = None
    formats: Formats = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class SingleFigureOptions(_Files):
    """The options of a command that writes data and a figure of its own."""

    out: Out = None
    plot: Figure = None
    force: Force = False
    json: Json = False


@dataclass(frozen=True)
class CarOptions(_Files):
    """The options of a command that finds a car: its hardpoint file, and a figure."""

    car: CarFile = None
    plot: Figure = None
    force: Force = False
    json: Json = False


class Rule(TypedDict):
    """What may be replaced, see `kintrafo.core.files`."""

    force: bool
    inputs: Sequence[str | Path]


@dataclass(frozen=True)
class Outputs:
    """The files that a command was asked for."""

    rule: Rule
    data: Sequence[Path] = ()
    pages: Sequence[Path] = ()
    figures: Path | None = None
    formats: Sequence[str] = ("png",)
    car: Path | None = None

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
        """Write the files and return them; nothing has been printed that could go wrong before.

        Parameters
        ----------
        dataset : xarray.Dataset
        title : str
            Title of the figures.
        names : sequence of str, optional
            The curves of the page; all of them by default.
        suffix : str, optional
            Goes behind the name of each file, where a command has several datasets.
        rows : xarray.Dataset, optional
            The data as tables have them, where that is another form.
        drawn : xarray.Dataset, optional
            The data as they are drawn, where that is another form of them.
        goals : sequence of Goal, optional
            Targets and limits that are drawn into the curves.
        """
        written = self.write_data(dataset, suffix, rows=rows)
        if not self.drawn:
            return written
        from ..plots import curves as plots

        shown = dataset if drawn is None else drawn
        written += [
            plots.write_overview(shown, _named(p, suffix), names, title, goals=goals, **self.rule)
            for p in self.pages
        ]
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

        Formats of rows may have less, and workbooks sheets of their own.
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
        """Write the pages by a function of what is shown and of a path, and return them."""
        paths = [_named(path, suffix) for path in self.pages]
        return [write(shown, path, *rest, **options, **self.rule) for path in paths]

    def write_car(self, subject: "Subject", head: str) -> list[Path]:
        """Write the hardpoint file that was found, with a comment at its head, and return it."""
        from ..input.toml_writer import write_toml

        if self.car is None:
            return []
        return [write_toml(subject, self.car, head=[head], **self.rule)]


def named(of: list[str] | None, drawn: "Mapping[str, Dataset]") -> dict[str, list[str]]:
    """Return which curves of several datasets are drawn: those that are named, where they are.

    An empty list says all of them. One that none of the datasets has is refused.
    """
    if not of:
        return {key: [] for key in drawn}
    known = dict.fromkeys(str(name) for dataset in drawn.values() for name in dataset)
    wanted = among(of, known)
    # a page has a curve at least: where there is none of these, it has all
    return {key: [n for n in wanted if n in dataset] for key, dataset in drawn.items()}


def of_both(of: list[str] | None) -> list[str]:
    """Return what curves of one wheel are called where both wheels are drawn together."""
    return [name.removesuffix("_left").removesuffix("_right") for name in of or ()]


def only(of: list[str] | None, dataset: "Dataset") -> "Dataset":
    """Return what of a dataset is shown: the curves that are named, of both wheels; else all."""
    if not of:
        return dataset
    stems = {*of, *of_both(of)}
    names = map(str, dataset.data_vars)
    return dataset[[n for n in names if not stems.isdisjoint((n, *of_both([n])))]]


def title_of(file: str) -> str:
    """Return what a figure calls a file: its name, without folder and ending."""
    return Path(file).stem if Path(file).suffix else file


def name_files(files: Sequence[Path]) -> None:
    """Name the files that were written, below the results."""
    for path in files:
        say(f"  {path}")


def end_if_not_valid(reasons: Sequence[str]) -> None:
    """Print the reasons why a result is not valid, and end the command with `Exit.REFUSED`."""
    for text in reasons:
        problems.print(f"not valid: {text}", style="red", highlight=False, markup=False)
    if reasons:
        raise typer.Exit(Exit.REFUSED)


def _named(path: Path, suffix: str) -> Path:
    return path.with_name(f"{path.stem}{suffix}{path.suffix}")
