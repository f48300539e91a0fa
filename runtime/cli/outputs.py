"""Data files and figures: the options for them, and writing them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .console import progress_bar, say

if TYPE_CHECKING:
    from xarray import Dataset

Out = Annotated[
    list[Path] | None,
    typer.Option(
        "--out",
        "-o",
        metavar="PATH",
        help="Write the data: .csv (mm, deg), .nc or .parquet (SI). May be repeated.",
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
        metavar="NAME",
        help="Of --figures: png, svg or pdf. May be repeated.",
        rich_help_panel="Output",
    ),
]


@dataclass(frozen=True)
class Outputs:
    """The files that a command was asked for."""

    data: Sequence[Path] = ()
    pages: Sequence[Path] = ()
    figures: Path | None = None
    formats: Sequence[str] = ("png",)

    @classmethod
    def of(
        cls,
        data: list[Path] | None,
        pages: list[Path] | None,
        figures: Path | None = None,
        formats: list[str] | None = None,
    ) -> "Outputs":
        """Return the files, having refused what cannot be written before anything is computed."""
        from .. import export

        for path in data or ():
            export.check_format(path)
        if pages or formats:
            from .. import plots

            plots.check_formats(pages or (), formats or ())
        return cls(data or (), pages or (), figures, formats or ("png",))

    def write(
        self,
        dataset: "Dataset",
        *,
        title: str,
        names: Sequence[str] = (),
        suffix: str = "",
        silent: bool = False,
    ) -> None:
        """Write the files, and name them on stdout unless a script reads that.

        Parameters
        ----------
        dataset : xarray.Dataset
        title : str
            Stands above the figures.
        names : sequence of str, optional
            The curves of the page; all of them by default.
        suffix : str, optional
            Goes behind the name of each file, where a command has several datasets.
        silent : bool, optional
        """
        from .. import export

        written = [export.write(dataset, _named(path, suffix)) for path in self.data]
        if self.pages or self.figures:
            written += self._drawn(dataset, title, names, suffix)
        for path in written if not silent else ():
            say(f"  {path}")

    def _drawn(
        self, dataset: "Dataset", title: str, names: Sequence[str], suffix: str
    ) -> list[Path]:
        from .. import plots

        written = [
            plots.write_overview(dataset, _named(path, suffix), names, title) for path in self.pages
        ]
        if self.figures is not None:
            with progress_bar("figures") as progress:
                written += plots.write(
                    dataset,
                    self.figures,
                    formats=self.formats,
                    title=title,
                    suffix=suffix,
                    progress=progress,
                )
        return written


def _named(path: Path, suffix: str) -> Path:
    return path.with_name(f"{path.stem}{suffix}{path.suffix}")
