"""Roads under the two tracks of a vehicle, by the distance along them.

`iso8608` makes rough ones of a class, with a seed; `bump`, `kerb` and `sine` single obstacles and
waves; `read` reads measured roads, from tables and OpenCRG files, and `Road` takes it from
arrays. `enveloped` returns the effective profile of a road with edges under a tyre.
"""

from .enveloping import enveloped, kerb
from .measured import read
from .road import Road
from .rough import CLASSES, iso8608, isotropic_coherence
from .shapes import bump, sine

__all__ = [
    "CLASSES",
    "Road",
    "bump",
    "enveloped",
    "iso8608",
    "isotropic_coherence",
    "kerb",
    "read",
    "sine",
]
