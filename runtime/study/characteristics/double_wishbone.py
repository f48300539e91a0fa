"""What the corner of a double wishbone suspension has of its own."""

import numpy as np

from ...suspension.corner import Array, Plane, Spring, Stroke
from ...suspension.guidance import Guidance
from ...suspension.strokes import Strokes


def _links(points: dict[str, Array]) -> tuple[Plane, Plane]:
    """Return the planes of the lower and of the upper arm."""
    return _plane(points, "lower"), _plane(points, "upper")


def _plane(points: dict[str, Array], arm: str) -> Plane:
    ball = points[f"{arm}_ball_joint"]
    front, rear = points[f"{arm}_arm_front"], points[f"{arm}_arm_rear"]
    return Plane(ball, np.cross(front - rear, ball - rear))


def _spring(strokes: Strokes) -> Spring:
    """Return the spring, which acts on the lower arm."""
    return strokes.spring("spring_force", "spring")


def _stops(strokes: Strokes) -> tuple[Spring, ...]:
    """Return no stops: the model has none."""
    del strokes
    return ()


def _gaps(strokes: Strokes) -> tuple[Array, ...]:
    """Return no gaps: there are no stops."""
    del strokes
    return ()


def _damper(strokes: Strokes) -> Stroke:
    """Return the stroke of the damper, which is on the spring's axis."""
    return strokes.stroke("spring")


DOUBLE_WISHBONE = Guidance(_links, _spring, _stops, _gaps, _damper)
"""Two arms, of which the lower one carries spring and damper."""
