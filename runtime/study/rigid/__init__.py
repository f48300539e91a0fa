"""A rigid axle on a rig and over a road.

    `beam`      where the axle is and how it moves first, at many positions
    `formulas`  roll centre, rates, anti-squat: the formulas
    `catalogue` name, unit, definition and sign of each
    `datasets`  the labelled arrays over bump, roll and one wheel's travel
    `checkup`   a first look
    `ride`      over a road

Definitions and signs: docs/rigid-axle.md.
"""

from ...suspension.rigid.model import equilibrium
from .checkup import checkup
from .datasets import MOTIONS, bump, compare, over, roll, single
from .ride import run

__all__ = [
    "MOTIONS",
    "bump",
    "checkup",
    "compare",
    "equilibrium",
    "over",
    "roll",
    "run",
    "single",
]
