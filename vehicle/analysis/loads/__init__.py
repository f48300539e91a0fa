"""The loads on all joints, springs and bearings of a suspension.

`static`       in load cases, at rest
`along`        along a simulation
`envelope`     the extremes of load cases
`peaks`        the greatest loads along a simulation
`table`        a table with a column for each component
`workbook`     this table and the extremes, for Excel
`write_cards`  files for Nastran and Abaqus
`read`         a file of load cases
"""

from .along import along
from .cards import write_cards
from .cases import read, standard_cases
from .dataset import envelope, peaks, table, workbook
from .static import static

__all__ = [
    "along", "envelope", "peaks", "read", "standard_cases", "static", "table", "workbook",
    "write_cards",
]  # fmt: skip
