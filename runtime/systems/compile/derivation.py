"""The derivation of a mechanism's equations as a document."""

from pathlib import Path
from typing import TYPE_CHECKING

from ...core.validator import Validator
from .build import require_generator
from .declaration import model_of, translated_errors

if TYPE_CHECKING:
    from ...generator import Formulation, Mechanism


def write_derivation(
    declared: "Formulation | Mechanism | str | Path",
    path: str | Path,
    *,
    name: str | None = None,
    force: bool = False,
) -> list[Path]:
    """Write a document that derives the equations of a mechanism, and return its files.

    It leads from the joints to the equations of motion, M q'' + B = Q. Nothing is compiled.
    ``pdflatex`` or ``lualatex`` compiles a document in LaTeX; it needs the packages of a small
    installation (on Debian: texlive-latex-recommended).

    Parameters
    ----------
    declared : Formulation, Mechanism, str or Path
        A declaration, or a Python file with one at its top level, as for `kintrafo.compile`.
    path : str or Path
        The file: ``.tex``, with four figures beside it as PDF, or ``.md``.
    name : str, optional
        Name of the model or mechanism, if the file has several.
    force : bool, optional
        Whether files that kintrafo did not write are replaced.

    Returns
    -------
    list of Path
        The written files, the text first.

    Raises
    ------
    InputError
        If the declaration cannot be read or the files must not be written.
    MechanismError
        If the declaration contradicts itself, or a loop has no closed form and the declaration does
        not allow iteration.
    MissingPackageError
        If the packages of the extra "generator" are not installed.

    Examples
    --------
    >>> import tempfile
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     files = kintrafo.write_derivation(SLIDER_CRANK, f"{folder}/crank.tex")
    >>> [file.name for file in files][:2]
    ['crank.tex', 'crank_bodies.pdf']
    """
    with Validator("write_derivation") as given:
        given.path("path", path)
        force = given.flag("force", force)
    inputs = [Path(declared)] if isinstance(declared, str | Path) else []
    require_generator()
    from ...generator.backends.report.written import check_files, write_report
    from ...generator.equations.outputs import generate

    check_files(Path(path), force=force, inputs=inputs)
    model = model_of(declared, name)
    with translated_errors(model):
        derived = generate(model)
    return write_report(derived, Path(path), force=force, inputs=inputs)
