"""The catalogue of closed forms.

Each entry solves one kind of closure for position, velocity and bias acceleration. Velocities are
those of the implicit equation, ``g_x x' = -g_u u'``, so the linear factor of the velocity level
serves the acceleration level again. Everything is written in the axes that the solution itself
gives to the body (line, steering arm, normal), in which most components vanish.
"""

from .cross import place_by_cross
from .hinge import place_by_pin, solve_hinge
from .slide import solve_slide
from .telescope import solve_telescope
from .turn import solve_turn

__all__ = [
    "place_by_cross",
    "place_by_pin",
    "solve_hinge",
    "solve_slide",
    "solve_telescope",
    "solve_turn",
]
