from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array: TypeAlias = NDArray[np.float64]

class ModelFunction:
    name: str
    shape: tuple[int, ...]
    labels: tuple[str, ...]
    operations: dict[str, int]
    address: int
    stage: str
    def __init__(
        self,
        model: Any,
        name: str,
        address: int,
        shape: tuple[int, ...],
        labels: tuple[str, ...],
        operations: dict[str, int],
        doc: str,
        stage: str,
        start: int,
        whole: int,
        mask: int,
    ) -> None: ...
    def __call__(
        self,
        state: ArrayLike,
        inputs: ArrayLike | None = None,
        constants: ArrayLike | None = None,
    ) -> Array: ...

def call_prepare(address: int, parameters: Array, constants: Array) -> int: ...
def call_margins(
    address: int, constants: Array, state: Array, inputs: Array, out: Array
) -> int: ...
def call_residuals(
    address: int,
    constants: Array,
    state: Array,
    inputs: Array,
    given: Array,
    out: Array,
) -> int: ...
