"""The derivation report as files, to be read or printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....core.files import refuse, write_text
from .document import FIGURES
from .latex import latex
from .markdown import markdown

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from ...equations.outputs import Derivation


def check_files(path: Path, *, force: bool = False, inputs: Iterable[Path] = ()) -> None:
    """Raise the errors of `write_report` on its files, before anything is derived."""
    refuse([path], force=force, inputs=inputs, endings=(".tex", ".md"))
    if path.suffix.lower() == ".tex":
        names = (f"{path.stem}_{name}.pdf" for name in FIGURES)
        refuse(map(path.with_name, names), force=force, inputs=inputs)


def write_report(
    derivation: Derivation, path: Path, *, force: bool = False, inputs: Iterable[Path] = ()
) -> list[Path]:
    """Write the report of a derivation; return the files.

    The path ends in .md, or in .tex: the figures are written beside that, as PDF. `force` is
    whether files that kintrafo did not write are replaced, see `kintrafo.core.files`; `inputs` are
    read, and never replaced.
    """
    check_files(path, force=force, inputs=inputs)
    figures: dict[str, str] = {}
    if path.suffix.lower() == ".tex":
        from .figures import print_figures  # noqa: PLC0415 (matplotlib is slow to import)

        figures = print_figures(derivation.plan, path, force=force)
        text = latex(derivation, figures)
    else:
        text = markdown(derivation)
    write_text(path, text, force=force, inputs=inputs)
    return [path, *(path.with_name(name) for name in figures.values())]
