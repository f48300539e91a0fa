"""Rigid axles: a beam with two wheels on four rods.

`rods`   the degrees of freedom of a beam on rods
`file`   the sections of the file
`axle`   `RigidAxle`, the data of a file
`model`  `RigidAxleModel`, its equations of motion
"""

from .axle import RigidAxle

__all__ = ["RigidAxle"]
