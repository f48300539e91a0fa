"""Tyres: read from files, evaluated on arrays.

`tyre`            what every tyre answers
`magic_formula`   PAC2002, MF 6.1 and MF 6.2
`tmeasy`          TMeasy, from files of Project Chrono
`linear`          linear up to the friction
`tir_file`        property files, and `coefficients`, what is in them
`loading`         whatever file a tyre is in
"""

from .linear import LinearSlip
from .loading import load
from .magic_formula import MagicFormula
from .tmeasy import TMeasy
from .tyre import Tyre, TyreState

__all__ = ["LinearSlip", "MagicFormula", "TMeasy", "Tyre", "TyreState", "load"]
