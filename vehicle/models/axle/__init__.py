"""Axles of two suspensions on one rack, with an anti-roll bar.

`file`       the sections of the file
`bar`        the anti-roll bar and its drop links
`steering`   rack displacement over the angle of the steering wheel
`axle`       `Axle`, the data of a file
`equations`  the equations of motion
"""

from .axle import Axle
from .bar import AntiRollBar
from .steering import SteeringCurve

__all__ = ["AntiRollBar", "Axle", "SteeringCurve"]
