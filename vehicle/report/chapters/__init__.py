"""Further chapters of a report, a file for each kind.

`chapter`           the class of a chapter
`axle`              both wheels of an axle, or a rigid axle, over the motions of a rig
`loads`             load cases, with free bodies
`compliance`        deflection of the wheel on bushes, and curves over the motions of a rig on them
`goals`             targets and limits of characteristics
`sheet`             kinematic and compliance gradients at design
`rest`              a car at rest: data, a view, wheel loads
`ride`              modes and responses of a car, and its motion over a bump
`handling`          steady turns of a car that drives, and its motion in a step steer
"""
