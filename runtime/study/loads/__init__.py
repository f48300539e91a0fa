"""The forces in a suspension: what every joint, spring and bearing carries.

`static`    in load cases, at rest
`along`     along a simulation
`envelope`  the extremes of load cases
`table`     a column for each component
`workbook`  that and the extremes, for Excel
`compliance`  how the wheel gives way on its bushes, to first order
`elastokinematics`, `deflection`  what bushes do over travel, and under loads of any size
`read`, `read_bushes`  a file of load cases, of bushes
"""

from ...suspension.bushes import read_bushes
from .along import along
from .cases import read, standard_cases
from .compliance import compliance
from .dataset import envelope, table, workbook
from .elastic.deflection import deflection
from .elastic.elastokinematics import elastokinematics
from .static import static

__all__ = [
    "along",
    "compliance",
    "deflection",
    "elastokinematics",
    "envelope",
    "read",
    "read_bushes",
    "standard_cases",
    "static",
    "table",
    "workbook",
]
