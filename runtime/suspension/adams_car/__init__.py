"""Suspensions of Adams/Car: their hardpoints, camber and toe, from the file of a subsystem.

`subsystem`     what stands in the file
`names`         what templates call the hardpoints of each kind
`fitting`       the file that the rest comes from
`importing`     both of them as an input file
"""

from .importing import Imported, imported
from .names import read_names
from .subsystem import Subsystem, read

__all__ = ["Imported", "Subsystem", "imported", "read", "read_names"]
