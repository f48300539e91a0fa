"""Floors of guarded quantities: the distance of a closed form from a singular set.

A direction is a difference of positions over its length. The positions have the extent L of the
loop, the greatest distance in it, and are rounded to u L, u = 1.1e-16; so the direction of a length
l has an error of some u L / l, and so have the distances of all points placed by it. With some ten
roundings on the way, l > 1e-5 L leaves 1e-10 of them, ten times less than the promised error.
Guarded quantities are squares: `DIRECTION`.

Where the normal of two vectors is divided by its square, the same happens to the square of their
sine: `NORMAL`. A root that vanishes at a dead point spoils nothing: the equations that keep the
distances hold for any value of it. It must only be positive: `ROOT`.

An extent is a constant: the root of the sum of squared distances from one joint of a loop to the
others, at the design position. Far from the origin of the axes in which positions are computed,
they are rounded to more than u L; a tenth of that distance counts, which leaves 1e-9 at worst.

Constants at the design position are checked once, by `prepare`.
"""

import sympy as sp

DIRECTION = sp.Float("1e-10")
"""A length whose direction is used: least square, as a fraction of that of the extent."""

LENGTH = sp.Float("1e-5")
"""The same for the length itself, and for a sine."""

NORMAL = sp.Float("1e-6")
"""The normal of two vectors, as a divisor: least square, as a fraction of the extent^4."""

ROOT = sp.Float("1e-16")
"""A quantity that only has to be positive: rounding, as a fraction of the squared extent."""

BRANCH = sp.Float("1e-9")
"""Least distance of a design position from its dead point, so that its side is clear."""

FAR = sp.Float("0.01")
"""Weight of the squared distance from the origin in the squared extent."""

SMALLEST = sp.Float("1e-24")
"""A pure number that only has to be positive."""

POSITIVE = sp.Float("1e-280")
"""The bound of a value that only has to be positive, in any unit: its reciprocal is finite."""

SINGULAR = sp.Float("1e-13")
"""Rest of a mass after elimination by rounding alone: some hundred units, as a fraction."""

ROUNDING = "1.0e-9"
"""Bound below which an angle [rad], or a distance as a fraction of a length, counts as zero.

Directions of unit length are exact to 1e-16, and differences of hardpoints to that times how much
farther from the origin they are than from each other: up to a million times. A geometry that is off
by as much as 1e-9 closes its loops within a nanometre per metre.
"""
