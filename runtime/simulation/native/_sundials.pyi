from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from ...equations.layout import StateLayout

Array: TypeAlias = NDArray[np.float64]

def version() -> str: ...
def integrate(
    addresses: tuple[int, int, int, int],
    layout: StateLayout,
    constants: Array,
    inputs: Array,
    splines: Sequence[tuple[Array, Array, tuple[int, int, int]]],
    milestones: Array,
    turns: Array,
    state: Array,
    times: Array,
    *,
    method: str,
    rtol: float,
    atol: Array,
    first_step: float,
    max_step: float,
    max_steps: int,
    every_step: bool,
    stop_at_outputs: bool,
    dense: bool,
    signal_count: int,
    events: Sequence[tuple[int, float]],
    roots: Sequence[Callable[[float, Array], float]],
    directions: NDArray[np.int32],
    terminal: NDArray[np.int32],
    guards: NDArray[np.int32],
    usual_margins: Array,
    stopped: Callable[[], bool] | None = None,
) -> dict[str, Any]: ...

class Motion:
    def __init__(
        self,
        addresses: tuple[int, int, int],
        layout: StateLayout,
        constants: Array,
        state: Array,
        inputs: Array,
        moving: Sequence[tuple[int, int, int]],
        length: float,
        *,
        method: str,
        rtol: float,
        atol: Array,
        max_step: float,
        max_steps: int,
        guards: NDArray[np.int32],
        usual_margins: Array,
    ) -> None: ...
    @property
    def time(self) -> float: ...
    def begin(self, start: float) -> None: ...
    def advance(self) -> bool: ...
