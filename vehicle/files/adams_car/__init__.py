"""Suspensions of Adams/Car: hardpoints, camber, toe and spring, from the file of a subsystem.

`subsystem`     the contents of the file
`springs`       the spring, from a file beside it
`rest`          the file with all other values
`importing`     the input file
"""

from ..point_names import read_names
from .importing import ImportedSubsystem, imported
from .subsystem import Subsystem, read

__all__ = ["ImportedSubsystem", "Subsystem", "imported", "read", "read_names"]
