"""An axle: two suspensions on one rack, with an anti-roll bar, as a file describes it.

`file`       the sections of the file
`bar`        the anti-roll bar and its drop links
`steering`   from the angle of the steering wheel to the rack
`axle`       what the sections make together: `Axle`
`equations`  the equations of motion of the whole
"""

from .axle import Axle
from .bar import AntiRollBar
from .steering import SteeringCurve

__all__ = ["AntiRollBar", "Axle", "SteeringCurve"]
