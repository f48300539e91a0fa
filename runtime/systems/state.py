"""States that know the inputs they belong to."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


class State(np.ndarray[tuple[int, ...], np.dtype[np.float64]]):
    """An array of a state's elements, with the inputs under which the state was found.

    Rest is rest only on its own road and with its rack where it was. Whatever takes a state and
    inputs takes these where none are given: ``signals``, ``evaluate``, `kintrafo.linearise`, and
    for the inputs that it is not told of, `kintrafo.simulate`. Copies, and sums such as
    ``state + small``, keep them; an array made of several states has none, and inputs are zero
    then as everywhere.

    Attributes
    ----------
    inputs : ndarray or None
        In the order of ``model.input_names``.

    Examples
    --------
    >>> import kintrafo
    >>> model = kintrafo.Model("reference_car")
    >>> rest = kintrafo.equilibrium(model, wheel_load=3000.0)
    >>> abs(float(model.signal("wheel_acceleration", rest))) < 1e-6
    True
    >>> rest.inputs.shape
    (5,)
    """

    inputs: Array | None

    @classmethod
    def of(cls, elements: ArrayLike, inputs: ArrayLike) -> "State":
        """Return a state with its inputs."""
        state = np.array(elements, dtype=np.float64).view(cls)
        state.inputs = np.array(inputs, dtype=np.float64)
        return state

    def __array_finalize__(self, source: Any) -> None:
        same = source is not None and source.shape == self.shape
        self.inputs = getattr(source, "inputs", None) if same else None

    def __reduce__(self) -> tuple[Any, ...]:
        return State.of, (np.asarray(self), self.inputs)


def inputs_of(state: Any) -> Array | None:
    """Return the inputs that belong to a state, if it knows them."""
    return state.inputs if isinstance(state, State) else None
