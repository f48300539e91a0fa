"""Print a model over NumPy arrays, for where there is no compiler: the steps of the C code.

Sums and products have the same order as in C, so that the two agree to the last digits of the
library's sines and cosines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...program.floors import ROUNDING
from ..arrays import ArrayFunctions, printed_blocks
from ..templates import template
from ..words import blocks_of, emitted_names, mechanism_hash
from .dialect import NUMPY

if TYPE_CHECKING:
    from ...equations.outputs import Derivation


def numpy_source(derivation: Derivation) -> str:
    """Return the text of the file that replaces the addresses of the C functions."""
    functions = ArrayFunctions(derivation, NUMPY)
    of_parameters = (derivation.design, *derivation.by_parameters.of_parameters)
    return template("numpy", "arrays.py").substitute(
        name=derivation.formulation.name,
        rounding=ROUNDING,
        mechanism=mechanism_hash(derivation),
        functions="\n\n\n".join(
            [
                *printed_blocks(blocks_of(derivation.emitted.values()), NUMPY),
                functions.prepare(),
                *map(functions.of_parameters, of_parameters),
                *map(functions.body, derivation.emitted.values()),
            ]
        ),
        table="\n".join(f'    "{name}": {name},' for name in emitted_names(derivation)),
    )
