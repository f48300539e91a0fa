"""What bushes do to the wheels of any assembly: to first order, and by any amount.

`linear`            how wheels move per unit of a load, over parallel wheel travel
`nonlinear`         the same by equilibrium, under loads of any size
`elastokinematics`  the motions of a rig on bushes, beside rigid joints
`combined`          over wheel travel and a load at once
`read_bushes`       a file of bushes
"""

from ...corner.bushes import read_bushes
from .combined import combined
from .elastokinematics import elastokinematics
from .linear import linear
from .nonlinear import nonlinear

__all__ = ["combined", "elastokinematics", "linear", "nonlinear", "read_bushes"]
