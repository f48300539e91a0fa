"""A chapter of a report: words, tables and pictures that do not move."""

from base64 import b64encode
from dataclasses import dataclass
from io import BytesIO
from typing import Literal

from matplotlib import rc_context
from matplotlib.figure import Figure

from ....core.tabulated import Tabulated
from ....pictures.figures import METADATA, lay_out


@dataclass(frozen=True)
class ChapterPicture:
    """A picture of a chapter.

    Attributes
    ----------
    source : str
        The picture itself, as the address of an image.
    words : str
        What it shows.
    """

    source: str
    words: str

    @classmethod
    def of(
        cls, figure: Figure, words: str, ending: Literal["svg", "png"] = "svg"
    ) -> "ChapterPicture":
        """Return a figure as a picture: of sharp lines, or of points where it has many letters."""
        drawn = BytesIO()
        # letters stay letters: they can be searched for, and take a tenth of the room
        with rc_context({"svg.fonttype": "none"}):
            lay_out(figure).savefig(drawn, dpi=110, format=ending, metadata=METADATA[ending])
        kind = {"svg": "svg+xml", "png": "png"}[ending]
        return cls(f"data:image/{kind};base64,{b64encode(drawn.getvalue()).decode()}", words)


@dataclass(frozen=True)
class Chapter:
    """A chapter.

    Attributes
    ----------
    title : str
    words : tuple of str
        Paragraphs.
    tables : tuple of Tabulated
    pictures : tuple of ChapterPicture
    """

    title: str
    words: tuple[str, ...]
    tables: tuple[Tabulated, ...]
    pictures: tuple[ChapterPicture, ...]
