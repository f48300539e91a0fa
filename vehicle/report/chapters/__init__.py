"""Further chapters of a report, a file for each kind.

`chapter`           the class of a chapter
`axle`              both wheels of an axle, or a rigid axle, over the motions of a rig
`loads`             load cases, with free bodies
`compliance`        deflection of the wheel on bushes
`goals`             targets and limits of characteristics
`elastokinematics`  curves over the motions of a rig on bushes
`sheet`             kinematic and compliance gradients at design
`rest`              a car at rest: data, a view, wheel loads
`ride`              modes and responses of a car, and its motion over a bump
`handling`          steady turns of a car that drives, and its motion in a step steer
"""

from .axle import axle_chapter
from .chapter import Chapter
from .compliance import compliance_chapter
from .elastokinematics import elastokinematics_chapter
from .goals import goals_chapter
from .handling import steady_turns_chapter, step_steer_chapter
from .loads import loads_chapter
from .rest import rest_chapter
from .ride import ride_chapter
from .sheet import sheet_chapter

__all__ = [
    "Chapter", "axle_chapter", "compliance_chapter", "elastokinematics_chapter", "goals_chapter",
    "loads_chapter", "rest_chapter", "ride_chapter", "sheet_chapter", "steady_turns_chapter",
    "step_steer_chapter",
]  # fmt: skip
