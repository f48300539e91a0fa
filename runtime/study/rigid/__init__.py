"""A rigid axle on a rig and over a road.

    `beam`      where the axle is and how it moves first, at many positions
    `formulas`  roll centre, rates, anti-squat: the formulas
    `catalogue` name, unit, definition and sign of each
    `datasets`  the labelled arrays over bump, roll and one wheel's travel
    `parts`     the parts at many positions, and what acts on them by itself
    `compliance` how bushes give way under loads on the wheels, to first order
    `on_bushes` the axle on its bushes
    `elastokinematics` the motions of a rig on bushes
    `deflection` loads of any size

Definitions and signs: docs/rigid-axle.md.
"""

from .datasets import MOTIONS, bump, compare, over, roll, single

__all__ = [
    "MOTIONS",
    "bump",
    "compare",
    "over",
    "roll",
    "single",
]
