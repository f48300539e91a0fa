"""Elements of the pages of a notebook."""

from base64 import b64encode
from collections.abc import Iterable, Sequence
from html import escape
from io import BytesIO

from matplotlib import rc_context
from matplotlib.figure import Figure

from ..pictures.figures import METADATA, STYLE, lay_out


def heading(text: str) -> str:
    """Return a heading."""
    return f"<h4>{escape(text)}</h4>"


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; with more than two columns all but the first are numbers."""
    aligned = "right" if len(head) > 2 else "left"
    first = _row(head, "th", aligned)
    return f"<table>{first}{''.join(_row(row, 'td', aligned) for row in rows)}</table>"


def _row(cells: Sequence[str], tag: str, aligned: str) -> str:
    texts = (
        f'<{tag} style="text-align: {aligned if place else "left"}">{escape(cell)}</{tag}>'
        for place, cell in enumerate(cells)
    )
    return f"<tr>{''.join(texts)}</tr>"


def columns(*parts: str) -> str:
    """Return parts beside each other, or below each other on a narrow page."""
    style = "display: flex; flex-wrap: wrap; gap: 1.5em; align-items: flex-start"
    return f'<div style="{style}">{"".join(f"<div>{part}</div>" for part in parts)}</div>'


def picture(figure: Figure) -> str:
    """Return a figure as a vector graphic."""
    drawn = BytesIO()
    with rc_context(STYLE):
        lay_out(figure)
        figure.savefig(drawn, format="svg", metadata=METADATA.get("svg"))
    data = b64encode(drawn.getvalue()).decode("ascii")
    style = "max-width: 100%; background: white"
    return f'<img style="{style}" src="data:image/svg+xml;base64,{data}"/>'
