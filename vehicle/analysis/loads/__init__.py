"""The forces in a suspension: what every joint, spring and bearing carries.

`static`    in load cases, at rest
`along`     along a simulation
`envelope`  the extremes of load cases
`table`     a column for each component
`workbook`  that and the extremes, for Excel
`read`      a file of load cases
"""

from .along import along
from .cases import read, standard_cases
from .dataset import envelope, table, workbook
from .static import static

__all__ = [
    "along",
    "envelope",
    "read",
    "standard_cases",
    "static",
    "table",
    "workbook",
]
