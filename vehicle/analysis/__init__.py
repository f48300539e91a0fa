"""Analyses of any assembly.

`checkup`          summary, problems and unusual values
`characteristics`  kinematic characteristics over the motions of a rig
`sweep`            positions of wheels and joints
`compare`          characteristics of several suspensions, and their differences
`loads`            forces on every part
`compliance`       deflection of the wheels on bushes, linear and nonlinear
`rig`, `sheet`     curves measured on a rig; the K&C sheet
`roads`, `measurement`, `excitation`    inputs of simulations: by formula, measured, both
`scenario`         a simulation described by data
`handling`, `ride` a car that drives and steers; a car on a rough road
`paper`            Figures 4 to 6 of the paper
"""
