"""What a report has besides the suspension that is moved: a file for each kind of chapter.

`chapter`     what a chapter is
`axle`        both wheels and the anti-roll bar over the motions of a rig
`rigid_axle`  a rigid axle, drawn and over the motions of a rig
`loads`       load cases, with the free bodies
`compliance`  how the wheel gives way on its bushes
`goals`       targets and limits of characteristics
`elastokinematics`  what bushes do to the curves over wheel travel
`sheet`       kinematic and compliance gradients at design
"""

from .axle import axle_chapter
from .chapter import Chapter
from .compliance import compliance_chapter
from .elastokinematics import elastokinematics_chapter
from .goals import goals_chapter
from .loads import loads_chapter
from .rigid_axle import rigid_axle_chapters
from .sheet import sheet_chapter

__all__ = [
    "Chapter",
    "axle_chapter",
    "compliance_chapter",
    "elastokinematics_chapter",
    "goals_chapter",
    "loads_chapter",
    "rigid_axle_chapters",
    "sheet_chapter",
]
