"""What an engineer asks of an assembly.

`checkup`          a first look
`characteristics`  kinematic characteristics over the motions of a rig
`sweep`            positions of wheels and joints
`compare`          several suspensions beside each other
`loads`            forces on every part
`compliance`       what bushes do to the wheels, to first order and by any amount
`rig`, `sheet`     curves that a rig measured; the K&C sheet
`roads`, `measurement`, `excitation`    roads, racks and forces by formula and from a file
`scenario`         a motion that is described by data
`ride`             how a car rests, swings and rides over a road
`paper`            what the paper shows of its suspension
"""
