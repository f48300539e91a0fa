"""What distinguishes the corner of one kind of suspension from that of another."""

from collections.abc import Callable
from dataclasses import dataclass

from .corner import Array, Plane, Spring, Stroke
from .strokes import Strokes


@dataclass(frozen=True)
class Guidance:
    """How a kind of suspension guides and springs the wheel.

    Attributes
    ----------
    links : callable
        Takes the hardpoints by name, each of shape (..., 3) [m]; returns the planes of the links.
    spring : callable
        Takes the strokes of a model; returns its spring.
    stops : callable
        The same for its stops.
    gaps : callable
        The same for what is open of each stop [m]: where it closes, the stop begins to act.
    damper : callable
        The same for the stroke of its damper.
    """

    links: Callable[[dict[str, Array]], tuple[Plane, Plane]]
    spring: Callable[[Strokes], Spring]
    stops: Callable[[Strokes], tuple[Spring, ...]]
    gaps: Callable[[Strokes], tuple[Array, ...]]
    damper: Callable[[Strokes], Stroke]
