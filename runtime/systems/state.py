"""States with the inputs that belong to them."""

from typing import Any, NamedTuple

import numpy as np

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike


class StateNames(NamedTuple):
    """Names of the elements of a state and of its inputs."""

    # as `model.state_names` and `model.input_names`
    state: tuple[str, ...]
    inputs: tuple[str, ...]


class State(np.ndarray[tuple[int, ...], np.dtype[np.float64]]):
    """An array of the elements of a state, with the inputs that belong to it.

    A state of rest belongs to the height of its road and the position of its rack. Functions with
    arguments for a state and inputs use these if no inputs are given: ``signals``, ``evaluate``,
    `kintrafo.linearise`, and `kintrafo.simulate` for the inputs that are left out. Copies, and sums
    such as ``state + small``, keep them; an array of several states has none, and its inputs are
    zero. A model with other coordinates or inputs refuses the state.

    Attributes
    ----------
    inputs : ndarray or None
        In the order of ``model.input_names``, SI units.
    names : StateNames or None
        Names of the elements and inputs of the model to which the state belongs.

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
    names: StateNames | None

    @classmethod
    def of(cls, elements: ArrayLike, inputs: ArrayLike, names: StateNames) -> "State":
        """Return a state with its inputs.

        Parameters
        ----------
        elements, inputs : array_like
            SI units.
        names : StateNames
        """
        state = np.array(elements, dtype=np.float64).view(cls)
        state.inputs = np.array(inputs, dtype=np.float64)
        state.names = names
        return state

    def __array_finalize__(self, source: Any) -> None:
        same = source is not None and source.shape == self.shape
        self.inputs = getattr(source, "inputs", None) if same else None
        self.names = getattr(source, "names", None) if same else None

    def __reduce__(self) -> tuple[Any, ...]:
        if self.names is None:
            return np.array, (np.asarray(self),)
        return State.of, (np.asarray(self), self.inputs, self.names)


def inputs_of(state: Any, names: StateNames) -> Array | None:
    """Return the inputs of a `State`; None for any other array.

    `names` are those of the model that uses the state. Raises `InputError` if the state belongs to
    a model with other coordinates or inputs.
    """
    if not isinstance(state, State) or state.names is None:
        return None
    if state.names != names:
        there, here = (
            f"({', '.join(n.state)}) and ({', '.join(n.inputs)})" for n in (state.names, names)
        )
        problem = (
            f"the state has the coordinates and inputs {there}, this model {here}. Make it with "
            "this model, or give its numbers as a plain array."
        )
        raise InputError([problem], "state")
    return state.inputs
