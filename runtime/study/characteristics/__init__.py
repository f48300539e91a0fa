"""Kinematic characteristics of a wheel suspension, over wheel travel and over rack travel.

    `travel`, `steering`     the characteristics as labelled arrays
    `corner`                 what they are computed from: points and first motions of one corner
    `wheel`, `axle`          the formulas, independent of the mechanism
    `from_model`             the corner of a suspension, from its compiled model
    `guidance`               what each kind of suspension has of its own: links, spring, damper,
                             stops; in `macpherson` and `double_wishbone`
    `catalogue`              name, unit, definition and sign of each

Definitions and signs: docs/characteristics.md.
"""

from .datasets import steering, travel

__all__ = ["steering", "travel"]
