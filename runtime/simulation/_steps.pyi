from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
Bytes: TypeAlias = NDArray[np.uint8]

def go_through(
    rhs: int,
    constants: Array,
    table: Array,
    lengths: Array,
    restarts: Bytes,
    inputs: Array,
    states: Array,
    rates: Array,
) -> bool: ...
def go_back(
    adjoint: int,
    constants: Array,
    table: Array,
    lengths: Array,
    restarts: Bytes,
    inputs: Array,
    states: Array,
    at_begin: Array,
    at_stages: Array,
    by_constants: Array,
    by_start: Array,
    by_inputs: Array,
) -> bool: ...
