"""Suspensions, axles and rigid axles together with their compiled equations.

`model`      a suspension together with its compiled equations
`axle`, `rigid_axle`    two suspensions with what joins them; a beam with two wheels
`points`     where the hardpoints are in a position
`swing`, `reach`, `positions`    how far the wheel travels, and its positions at rest
`model_batch`      many suspensions at once
`plausibility`, `typical`      what no suspension of a car looks like, and where cars usually lie
"""
