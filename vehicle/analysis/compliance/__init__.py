"""Deflection of the wheels of any assembly on bushes.

`linear`            motion of the wheels per unit of a load, over parallel wheel travel
`nonlinear`         the same by equilibrium, under loads of any size
`elastokinematics`  the motions of a rig on bushes and with rigid joints
`combined`          over wheel travel and a load together
`read_bushes`       a file of bushes
"""

from ...corner.bushes import read_bushes
from .combined import combined
from .elastokinematics import elastokinematics
from .linear import linear
from .nonlinear import nonlinear

__all__ = ["combined", "elastokinematics", "linear", "nonlinear", "read_bushes"]
