"""Roads: heights of two tracks over the distance along them.

`iso8608` returns rough roads of a class, with a seed; `bump`, `kerb` and `sine` single obstacles
and waves; `read` measured roads of tables and OpenCRG files; `Road` is one of given arrays.
`enveloped` returns the effective profile of a road under a tyre.
"""

from .enveloping import enveloped, kerb
from .measured import read
from .road import Road
from .rough import CLASSES, iso8608, isotropic_coherence
from .shapes import bump, sine

__all__ = [
    "CLASSES", "Road", "bump", "enveloped", "iso8608", "isotropic_coherence", "kerb", "read",
    "sine",
]  # fmt: skip
