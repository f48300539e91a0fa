"""The forces in a suspension: what every joint, spring and bearing carries.

`static`    in load cases, at rest
`along`     along a simulation
`envelope`  the extremes of load cases
`peaks`     the greatest loads along a simulation
`table`     a column for each component
`write_cards`  files for programs of strength: Nastran, Abaqus
`workbook`  that and the extremes, for Excel
`read`      a file of load cases
"""

from .along import along
from .cards import write_cards
from .cases import read, standard_cases
from .dataset import envelope, peaks, table, workbook
from .static import static

__all__ = [
    "along",
    "envelope",
    "peaks",
    "read",
    "standard_cases",
    "static",
    "table",
    "workbook",
    "write_cards",
]
