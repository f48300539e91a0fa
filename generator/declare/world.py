"""The world: what rests, whatever moves in it.

Its axes are those of ISO 8855: x forward, y left, z up. To it belong gravity, which pulls against
z, and roads, whose heights are along z. A mechanism says which of its bodies rests in the world
(`Mechanism.fixed`); one whose bodies all move hangs on it by a joint with six freedoms (`Free`).
"""

WORLD = "world"
"""The name of the world as the first body of a joint."""
