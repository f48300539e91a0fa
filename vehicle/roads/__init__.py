"""Roads under the two tracks of a vehicle, by the distance along them.

`iso8608` makes rough ones of a class, with a seed; `bump` and `sine` single obstacles and waves;
`Road` takes what was measured.
"""

from .road import Road
from .rough import CLASSES, iso8608, isotropic_coherence
from .shapes import bump, sine

__all__ = ["CLASSES", "Road", "bump", "iso8608", "isotropic_coherence", "sine"]
