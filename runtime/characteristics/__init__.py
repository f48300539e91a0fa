"""Kinematic characteristics of a wheel suspension, over wheel travel and over rack travel.

    `travel`, `steering`     the characteristics as labelled arrays
    `corner`                 what they are computed from: points and first motions of one corner
    `wheel`, `axle`          the formulas, independent of the mechanism
    `macpherson`             the corner of a MacPherson suspension, from its compiled model
    `catalogue`              name, unit, definition and sign of each

Definitions and signs: docs/characteristics.md.
"""

from .datasets import steering, travel

__all__ = ["steering", "travel"]
