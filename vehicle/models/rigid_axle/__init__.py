"""A rigid axle: a beam with two wheels on four rods, as a file describes it.

`rods`   what four rods hold, and what more or fewer of them would
`file`   the sections of the file
`axle`   what the sections make together: `RigidAxle`
`model`  its equations of motion: `RigidAxleModel`
"""

from .axle import RigidAxle

__all__ = ["RigidAxle"]
