"""The forces in a suspension: what every joint, spring and bearing carries.

`static`    in load cases, at rest
`along`     along a simulation
`envelope`  the extremes of load cases
`table`     a column for each component
`compliance`  how the wheel gives way on its bushes
`read`, `read_bushes`  a file of load cases, of bushes
"""

from .along import along
from .bushes import read_bushes
from .cases import read, standard_cases
from .compliance import compliance
from .dataset import envelope, table
from .static import static

__all__ = [
    "along",
    "compliance",
    "envelope",
    "read",
    "read_bushes",
    "standard_cases",
    "static",
    "table",
]
