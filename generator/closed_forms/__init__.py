"""The catalogue of closed forms.

Each entry solves one kind of closure for position, velocity and bias acceleration. Velocities are
those of the implicit equation, ``g_x x' = -g_u u'``, so the linear factor of the velocity level
serves the acceleration level again. Everything is written in the axes that the solution itself
gives to the body (line, steering arm, normal), in which most components vanish.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ..loops.actions import (
    PlaceByCross,
    PlaceByGuide,
    PlaceByPin,
    PlaceIdle,
    PlaceTelescope,
    SolveCarrier,
    SolveHinge,
    SolveSlide,
    SolveStroke,
    SolveStrut,
    SolveTelescope,
    SolveTogether,
    SolveTurn,
)
from .carrier import solve_carrier
from .coupled_loops import solve_together
from .cross import place_by_cross, place_idle
from .prismatic import solve_slide
from .revolute import place_by_pin, solve_hinge
from .rpr import place_telescope, solve_stroke
from .telescope import solve_telescope
from .turn import solve_turn
from .ups import place_by_guide, solve_strut

if TYPE_CHECKING:
    from collections.abc import Callable

CATALOGUE: dict[type, Callable[..., Any]] = {
    PlaceByCross: place_by_cross,
    PlaceByGuide: place_by_guide,
    PlaceByPin: place_by_pin,
    PlaceIdle: place_idle,
    PlaceTelescope: place_telescope,
    SolveCarrier: solve_carrier,
    SolveHinge: solve_hinge,
    SolveSlide: solve_slide,
    SolveStroke: solve_stroke,
    SolveStrut: solve_strut,
    SolveTelescope: solve_telescope,
    SolveTogether: solve_together,
    SolveTurn: solve_turn,
}
"""What carries out each action of a plan, on kinematics and action."""
