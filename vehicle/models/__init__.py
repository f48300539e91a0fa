"""Suspensions and axles together with their compiled equations.

`model`      a suspension together with its compiled equations
`packaged`   equations that are part of kintrafo; those of a suspension
`axle`       two suspensions, a rack and an anti-roll bar
`whole_axle`, `whole_axle_model`    the bases of axles without sides, and of their equations
`rigid_axle`, `steered_rigid_axle`, `twist_beam`    axles without sides
`car`        a body on two axles, or on a suspension
`points`     hardpoints in a position
`swing`, `reach`, `positions`    the range of wheel travel, and positions at rest
`model_batch`      a batch of suspensions
`plausibility`      almost certain mistakes of a file, and usual ranges of cars
"""
