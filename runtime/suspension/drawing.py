"""How a suspension is drawn, as data: what draws it knows no kind."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

Role = Literal["arm", "upper arm", "strut", "rod"]


@dataclass(frozen=True)
class Drawing:
    """What is drawn of a suspension, by the names of its hardpoints.

    Attributes
    ----------
    links : mapping
        For each link that is seen from the front its two ends, and what it is.
    knuckle : tuple of str
        Points of the line that stands for the knuckle there.
    legend : mapping
        What the arms and the strut are called on the page of the report.
    """

    links: Mapping[str, tuple[str, str, Role]]
    knuckle: tuple[str, ...]
    legend: Mapping[str, str]
