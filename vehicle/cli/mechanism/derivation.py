"""``kintrafo mechanism derivation``: the derivation of the equations as a chapter to print."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from ....terminal.console import problems
from ..options import Force, Which, argument, option, refuse_which
from ..outputs import name_files

if TYPE_CHECKING:
    from ....generator import Formulation

EXAMPLES = (
    "kintrafo mechanism derivation four_bar --out derivation.tex",
    "kintrafo mechanism derivation my_car.toml --out derivation.md",
    "kintrafo mechanism derivation my_mechanism.py --model crane --out crane.tex",
)


def command(
    file: Annotated[
        str,
        argument(
            "File of a suspension, an axle or a car, Python file with a mechanism of your own, or "
            "the name of a model that comes with kintrafo: macpherson, four_bar, andrews.",
            "FILE",
        ),
    ],
    *,
    out: Annotated[
        Path, option("What to write: .tex, with its figures, or .md.", "PATH", "--out", "-o")
    ],
    model: Which = None,
    force: Force = False,
) -> None:
    """Write the derivation of the equations of motion, from the joints to M, B and Q.

    A chapter with the figures of the mechanism and numbered equations, for LaTeX (pdflatex, twice)
    or as Markdown. Needs the packages of the extra "generator": pip install "kintrafo[generator]".
    """
    from ....systems.compile.build import require_generator
    from ....systems.compile.derivation import write_derivation

    require_generator()
    refuse_which(file, model)
    declared = file if file.endswith(".py") else _shipped(file)
    with problems.status("deriving the equations"):
        written = write_derivation(declared, out, name=model, force=force)
    name_files(written)


def _shipped(file: str) -> "Formulation":
    """Return the declaration of a packaged model, or of the subject of a file."""
    from ....core.errors import InputError
    from ....core.suggestions import suggestion
    from ....generator.mechanisms import MODELS
    from ...assembly.of import declaration_of
    from ...data.starter import all_packaged
    from ...files.loading import load

    known = {model.name: model for model in MODELS}
    if file in known:
        return known[file]
    if not Path(file).suffix and file not in all_packaged() and not Path(file).exists():
        problem = f"is neither a file nor a name. {suggestion(file, [*known, *all_packaged()])}"
        raise InputError([problem], file)
    return declaration_of(load(file))
