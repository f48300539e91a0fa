"""The base of all kinds of suspension.

`base`, `coil_sprung`    the class of all kinds, and of those with a coil spring
`bushes`     stiffnesses of bushes at joints
`structure`  joints, and forces along lines
`geometry`   checks of the geometry of any suspension
`drawing`    the drawing of a kind
`corner`     the data of characteristics
`wheel_loads`         loads of road, drive shaft and brake on a wheel, as inputs
"""
