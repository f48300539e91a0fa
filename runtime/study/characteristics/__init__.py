"""Kinematic characteristics of a wheel suspension, over wheel travel and over rack travel.

    `travel`, `steering`     the characteristics as labelled arrays
    `wheel`, `axle`          the formulas, independent of the mechanism
    `from_model`             what they are computed from: the corner of a suspension, from its model
    `catalogue`              name, unit, definition and sign of each
    `groups`                 which belongs beside which others

What each kind of suspension has of its own stands in its file in `kintrafo.suspension.kinds`.
Definitions and signs: docs/characteristics.md.
"""

from .datasets import steering, travel

__all__ = ["steering", "travel"]
