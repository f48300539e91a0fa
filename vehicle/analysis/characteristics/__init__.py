"""Kinematic characteristics of a suspension, an axle or a rigid axle, over the motions of a rig.

Formulas, names, units, definitions and signs are in `kintrafo.vehicle.assembly.measures`; see
docs/suspension/characteristics.md, docs/suspension/axles.md.
"""

from ...assembly.rig import SweepRange
from .datasets import over

__all__ = ["SweepRange", "over"]
