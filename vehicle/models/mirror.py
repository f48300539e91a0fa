"""The mirror image of a point, apart from the names of sides, which need no NumPy."""

import numpy as np

MIRROR = np.array([1.0, -1.0, 1.0])
"""The factors of a point's coordinates in its mirror image on the other side."""
