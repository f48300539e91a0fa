"""The world, which is at rest.

Its axes are those of ISO 8855: x forward, y left, z up. Gravity acts against z, and the heights of
roads are along z. A mechanism has one body that rests in the world, with its axes along those of
the world at the design position (`Ground`). A mechanism whose bodies all move hangs on the world
itself, by a joint with six degrees of freedom (`Free`).
"""

from .bodies import Ground

WORLD = Ground("world")
"""The world as the first body of a joint."""
