"""Steered rigid axles: a beam on four rods, two knuckles, a drag link and a track rod.

`file`       the sections of the file
`axle`       `SteeredRigidAxle`, the data of a file
`structure`  its joints and force elements
`model`      `SteeredRigidAxleModel`, its equations of motion
"""

from .axle import SteeredRigidAxle

__all__ = ["SteeredRigidAxle"]
