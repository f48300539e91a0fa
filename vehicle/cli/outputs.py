"""Data files and figures: the options for them, and writing them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, TypedDict

import typer

from ...terminal.console import progress_bar, say
from .options import Force, among, by_comma

if TYPE_CHECKING:
    from xarray import Dataset

    from ..studies.goals import Goal

Out = Annotated[
    list[Path] | None,
    typer.Option(
        "--out",
        "-o",
        metavar="PATH",
        help="Write the data: .csv or .xlsx (mm, deg), .nc or .parquet (SI). May be repeated.",
        rich_help_panel="Output",
    ),
]
Plot = Annotated[
    list[Path] | None,
    typer.Option(
        "--plot",
        metavar="PATH",
        help="Write the curves: .pdf (a page a group), .png or .svg. May be repeated.",
        rich_help_panel="Output",
    ),
]
Figures = Annotated[
    Path | None,
    typer.Option(
        metavar="FOLDER",
        help="Write a figure of every curve into this folder.",
        rich_help_panel="Output",
    ),
]
Formats = Annotated[
    list[str] | None,
    typer.Option(
        "--format",
        metavar="NAME,...",
        help="Of --figures: png, svg or pdf.",
        callback=by_comma,
        rich_help_panel="Output",
    ),
]


@dataclass(frozen=True)
class OutputOptions:
    """The options of data files and figures of curves."""

    out: Out = None
    plot: Plot = None
    figures: Figures = None
    formats: Formats = None
    force: Force = False

    def of(self, inputs: Sequence[str | Path], suffixes: Sequence[str] = ("",)) -> "Outputs":
        """Return the files, having refused what cannot be written; see `Outputs.of`."""
        return Outputs.of(
            self.out,
            self.plot,
            self.figures,
            self.formats,
            force=self.force,
            inputs=inputs,
            suffixes=suffixes,
        )


USUAL_OUTPUT = OutputOptions()


class _Rule(TypedDict):
    """What may be replaced, see `kintrafo.core.files`."""

    force: bool
    inputs: Sequence[str | Path]


@dataclass(frozen=True)
class Outputs:
    """The files that a command was asked for."""

    data: Sequence[Path] = ()
    pages: Sequence[Path] = ()
    figures: Path | None = None
    formats: Sequence[str] = ("png",)
    force: bool = False
    inputs: Sequence[str | Path] = ()

    @classmethod
    def of(
        cls,
        data: list[Path] | None,
        pages: list[Path] | None,
        figures: Path | None = None,
        formats: list[str] | None = None,
        *,
        force: bool,
        inputs: Sequence[str | Path],
        suffixes: Sequence[str] = ("",),
    ) -> "Outputs":
        """Return the files, having refused what cannot be written before anything is computed.

        Parameters
        ----------
        data, pages, figures, formats
            What was asked for.
        force : bool
            Whether files that somebody else wrote are replaced.
        inputs : sequence of str or pathlib.Path
            Files that the command reads: they are never replaced.
        suffixes : sequence of str, optional
            What goes behind the names, where a command has several datasets.
        """
        from ...core.files import refuse
        from ...datasets import export

        for path in data or ():
            export.check_format(path)
        if pages or formats:
            from ..plots import curves as plots

            plots.check_formats(pages or (), formats or ())
        paths = [_named(p, suffix) for p in (*(data or ()), *(pages or ())) for suffix in suffixes]
        refuse(paths, force=force, inputs=inputs)
        return cls(data or (), pages or (), figures, formats or ("png",), force, inputs)

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
            Stands above the figures.
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
        if self.drawn:
            rule: _Rule = {"force": self.force, "inputs": self.inputs}
            curves = dataset if drawn is None else drawn
            written += self._drawn(curves, title, names, suffix, goals, rule)
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

        rule: _Rule = {"force": self.force, "inputs": self.inputs}
        flat = dataset if rows is None else rows
        return [
            export.write(
                dataset if path.suffix.lower() == ".nc" else flat,
                _named(path, suffix),
                sheets=sheets,
                **rule,
            )
            for path in self.data
        ]

    def _drawn(
        self,
        dataset: "Dataset",
        title: str,
        names: Sequence[str],
        suffix: str,
        goals: "Sequence[Goal]",
        rule: "_Rule",
    ) -> list[Path]:
        from ..plots import curves as plots

        written = [
            plots.write_overview(dataset, _named(path, suffix), names, title, goals=goals, **rule)
            for path in self.pages
        ]
        if self.figures is not None:
            with progress_bar("figures") as progress:
                written += plots.write(
                    dataset,
                    self.figures,
                    formats=self.formats,
                    title=title,
                    suffix=suffix,
                    goals=goals,
                    progress=progress,
                    **rule,
                )
        return written


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


def _named(path: Path, suffix: str) -> Path:
    return path.with_name(f"{path.stem}{suffix}{path.suffix}")
