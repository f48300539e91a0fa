"""Limits of steps near a dead point: the numbers of ``native/trust.h``.

That file has the reasons; a test compares the two.
"""

ACTS, SINGULAR = 1, 2
PART = 0.5
LEFT = 4.0
NOTHING = 1e-10
LAPSE = 1.0 / 256.0
SMALLEST_OF_TIME = 1e-9
SMALLEST_OF_STEP = 1e-6
NEAR = 1e-3
MOST_STUCK = 8
SMALLEST_PART = 1e-14
SHORTER = 0.25
