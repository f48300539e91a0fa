"""What every kind of suspension has, and what is computed from.

`base`, `coil_sprung`    the class of all kinds, and that of those with a coil spring
`bushes`     stiffness of what joins the parts
`structure`  what holds the parts together: joints, and forces along lines
`geometry`   what the geometry of any suspension must fulfil
`facts`, `drawing`    what a kind says of its equations, and how it is drawn
`corner`, `strokes`   what characteristics are computed from
`wheel_loads`         what road, drive shaft and brake do to a wheel, as inputs
"""
