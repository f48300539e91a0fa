"""The style of all figures, and writing them as PNG, SVG and PDF."""

from base64 import b64encode
from io import BytesIO
from pathlib import Path
from textwrap import fill
from typing import TYPE_CHECKING, Any, Literal

from matplotlib import rc_context
from matplotlib.figure import Figure
from matplotlib.text import Text

from ..core.files import Paths, replacing
from ..core.legible import legible

if TYPE_CHECKING:
    from matplotlib.typing import RcKeyType

BLUE, ORANGE, GREEN = "#0072b2", "#d55e00", "#009e73"
STYLE: "dict[RcKeyType, Any]" = {
    "font.size": 10.0,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.titlesize": 10.5,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.8,
    "svg.hashsalt": "kintrafo",  # the same identifiers in every file
}
_PANEL = (4.1, 2.7)  # width and height [in]
# Neither date nor version in the files: the same curves make the same bytes.
METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "svg": {"Date": None},
    "pdf": {"CreationDate": None},
}


def save(figure: Figure, path: str | Path, *, force: bool = False, inputs: Paths = ()) -> Path:
    """Write a figure to a file, whose ending determines the format, and return its path.

    `force` is whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`;
    `inputs` are never replaced. Raises `InputError` if the file must not or cannot be written.
    """
    ending = Path(path).suffix.lower().removeprefix(".")
    drawn = BytesIO()  # so that an error leaves no open file
    lay_out(figure)
    figure.savefig(drawn, dpi=160, format=ending, metadata=METADATA.get(ending))
    with replacing(path, force=force, inputs=inputs) as temporary:
        temporary.write_bytes(drawn.getvalue())
    return Path(path)


def data_uri(figure: Figure, ending: Literal["svg", "png"] = "svg") -> str:
    """Return a figure as the data URI of an image for a self-contained page.

    It has vector graphics, or as ``png`` pixels, which are smaller for a figure with many letters.
    """
    drawn = BytesIO()
    # text as text can be searched for, and takes a tenth of the size of outlines
    with rc_context({"svg.fonttype": "none"}):
        lay_out(figure).savefig(drawn, dpi=110, format=ending, metadata=METADATA[ending])
    kind = {"svg": "svg+xml", "png": "png"}[ending]
    return f"data:image/{kind};base64,{b64encode(drawn.getvalue()).decode()}"


def written_plainly(figure: Figure) -> Figure:
    """Show all texts of a figure literally: a dollar sign starts no formula."""
    for text in figure.findobj(Text):
        text.set_parse_math(False)
        text.set_text("\n".join(map(legible, text.get_text().split("\n"))))
    return figure


def small(figure: Figure) -> Figure:
    """Set the size of a figure of one curve to that of a panel, so that several fit in a row."""
    figure.set_size_inches(*_PANEL)
    return lay_out(figure)


def lay_out(figure: Figure) -> Figure:
    """Compute the layout of a figure once; otherwise each file would be drawn twice."""
    engine = figure.get_layout_engine()
    if engine is not None:
        engine.execute(figure)
        figure.set_layout_engine(None)
    return figure


def wrapped(label: str, width: int) -> str:
    """Return a label in lines of some letters; a unit in brackets at its end is not broken."""
    name, mark, unit = typeset(label).partition(" [")
    return fill(f"{name}{mark}{unit.replace(' ', chr(0xA0))}", width, break_on_hyphens=False)


def typeset(text: str) -> str:
    """Return a text with superscripts in its units."""
    return text.replace("^2", "\u00b2")
