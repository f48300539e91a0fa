"""Tyres, read from files and evaluated on arrays.

`tyre`            interface of all tyres
`magic_formula`   PAC2002, MF 6.1 and MF 6.2
`tmeasy`          TMeasy, from files of Project Chrono
`linear`          forces linear in slip, limited by friction
`tir_file`        reads property files; `coefficients` lists their keys, `tir_writer` writes them
`figures`         key figures over the load
`fitting`         coefficients fitted to a measurement (`measured`)
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
    "LinearSlip", "MagicFormula", "TMeasy", "Tyre", "TyreFit", "TyreState", "fit", "key_figures",
    "load", "tabulated", "write_tir",
]  # fmt: skip
