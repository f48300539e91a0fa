"""What the corner of a MacPherson suspension has of its own."""

import numpy as np

from ...suspension.corner import Array, Plane, Spring, Stroke
from ...suspension.guidance import Guidance
from ...suspension.strokes import Strokes


def _links(points: dict[str, Array]) -> tuple[Plane, Plane]:
    """Return the plane of the control arm and that across the strut through its mount."""
    ball, front, rear = points["ball_joint"], points["arm_front"], points["arm_rear"]
    top, bottom = points["strut_top"], points["strut_lower"]
    return Plane(ball, np.cross(front - rear, ball - rear)), Plane(top, top - bottom)


def _spring(strokes: Strokes) -> Spring:
    """Return the spring, which may have an axis of its own."""
    return strokes.spring("spring_force", "spring" if "spring_length" in strokes else "strut")


def _stops(strokes: Strokes) -> tuple[Spring, ...]:
    """Return the stops that the model has."""
    return tuple(strokes.spring(f"{side}_stop_force", "strut") for side in _sides(strokes))


def _gaps(strokes: Strokes) -> tuple[Array, ...]:
    """Return how far the strut is from touching each of its stops."""
    sense = {"bump": 1.0, "rebound": -1.0}
    length = strokes.stroke("strut").length
    return tuple(
        sense[side] * (length - strokes.parameters[f"{side}_stop_length"])
        for side in _sides(strokes)
        if strokes.parameters[f"{side}_stop_rate"]
    )


def _sides(strokes: Strokes) -> tuple[str, ...]:
    """Return the sides on which the model can have a stop."""
    return tuple(side for side in ("bump", "rebound") if f"{side}_stop_force" in strokes)


def _damper(strokes: Strokes) -> Stroke:
    """Return the stroke of the damper: that of the strut."""
    return strokes.stroke("strut")


MACPHERSON = Guidance(_links, _spring, _stops, _gaps, _damper)
"""A control arm and a strut."""
