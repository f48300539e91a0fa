"""Suspensions, axles and rigid axles together with their compiled equations.

`model`      a suspension together with its compiled equations
`packaged`, `corner_equations`    equations that are part of kintrafo; those of a suspension
`axle`, `rigid_axle`    two suspensions, a rack and an anti-roll bar; a beam with two wheels
`points`     hardpoints in a position
`swing`, `reach`, `positions`    the range of wheel travel, and positions at rest
`model_batch`      a batch of suspensions
`plausibility`, `typical`      almost certain mistakes of a file, and usual ranges of cars
"""
