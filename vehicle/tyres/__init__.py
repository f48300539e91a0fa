"""Tyres: read from files, evaluated on arrays.

`tyre`            what every tyre answers
`magic_formula`   PAC2002, MF 6.1 and MF 6.2
`tmeasy`          TMeasy, from files of Project Chrono
`linear`          linear up to the friction
`tir_file`        property files, and `coefficients`, what is in them;
                  `tir_writer` writes them
`figures`         key figures over load
`fitting`         coefficients from what was measured (`measured`)
`loading`         tyres from any file
"""

from .figures import key_figures, tabulated
from .fitting import TyreFit, fit
from .linear import LinearSlip
from .loading import load
from .magic_formula import MagicFormula
from .tir_writer import write_tir
from .tmeasy import TMeasy
from .tyre import Tyre, TyreState

__all__ = [
    "LinearSlip",
    "MagicFormula",
    "TMeasy",
    "Tyre",
    "TyreFit",
    "TyreState",
    "fit",
    "key_figures",
    "load",
    "tabulated",
    "write_tir",
]
