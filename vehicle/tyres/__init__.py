"""Tyres: read from files, evaluated on arrays.

`tyre`            what every tyre answers
`magic_formula`   PAC2002, MF 6.1 and MF 6.2
`tir_file`        property files, and `coefficients`, what is in them
`loading`         whatever file a tyre is in
"""

from .loading import load
from .magic_formula import MagicFormula
from .tyre import Tyre, TyreState

__all__ = ["MagicFormula", "Tyre", "TyreState", "load"]
