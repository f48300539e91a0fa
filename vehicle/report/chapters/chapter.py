"""A chapter of a report: words, tables, pictures, and players of motions."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

from markupsafe import Markup
from matplotlib.figure import Figure

from ....core.tabulated import Tabulated
from ....pictures.figures import data_uri


@dataclass(frozen=True)
class ChapterPicture:
    """A picture of a chapter."""

    source: str  # the picture, as the address of an image
    words: str

    @classmethod
    def of(
        cls, figure: Figure, words: str, ending: Literal["svg", "png"] = "svg"
    ) -> "ChapterPicture":
        """Return a figure as a picture: svg, or png for many letters."""
        return cls(data_uri(figure, ending), words)


@dataclass(frozen=True)
class Chapter:
    """A chapter of a report.

    Attributes
    ----------
    title : str
        Heading of the chapter.
    words : tuple of str
        Paragraphs.
    tables : tuple of Tabulated
        Tables below the paragraphs.
    pictures : tuple of ChapterPicture
        Pictures as wide as the page.
    panels : tuple of ChapterPicture
        Small pictures in rows.
    players : tuple of Markup
        HTML with pictures of a moving car.
    """

    title: str
    words: tuple[str, ...]
    tables: tuple[Tabulated, ...] = ()
    pictures: tuple[ChapterPicture, ...] = ()
    panels: tuple[ChapterPicture, ...] = ()
    players: tuple[Markup, ...] = ()


def not_valid(reasons: Iterable[str]) -> list[str]:
    """Return the paragraphs with the reasons why a result is not valid."""
    return [f"Not valid: {text}." for text in reasons]
