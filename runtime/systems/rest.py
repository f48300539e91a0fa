"""States of rest of a mechanism, in which no coordinate is accelerated."""

from collections.abc import Mapping

import numpy as np

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from ..equations.errors import ModelError, located
from .state import State, inputs_of
from .system import System

_MOST_STEPS, _HALVINGS = 100, 30
# A smaller step [rad, m] is a rounding error.
_LAST_STEP = 1e-12
# Relative to the greatest slope: a smaller singular value is that of a direction without effect,
# such as the angle of a rotor; and the largest residual, over a step of a radian or a metre.
_NOTHING = 1e-9


def rest(
    system: System, near: ArrayLike | None = None, inputs: Mapping[str, float] | None = None
) -> State:
    """Return a state of rest of any mechanism, stable or not, near a given state.

    Parameters
    ----------
    system : System or Model
        The equations. `kintrafo.equilibrium` is for vehicles on a road.
    near : array_like, optional
        State at which the search starts; its rates are ignored. By default the design position.
    inputs : mapping of str to float, optional
        Forces and other inputs by name, SI units. Others are those of `near` if it is a `State`,
        else zero.

    Returns
    -------
    State
        The state, with zero rates, and the inputs at which it is at rest.

    Raises
    ------
    InputError
        If an argument cannot be used, or no state of rest is found.
    ClosureError
        If a loop cannot close at the start.

    Notes
    -----
    Newton's method with the exact Jacobian of the accelerations; steps after which a loop cannot
    close, or accelerations are not smaller, are halved. The state may be unstable, such as an
    inverted pendulum: `kintrafo.linearise` has the eigenvalues. A coordinate without effect, such
    as the angle of a rotor, does not change.

    Examples
    --------
    >>> from kintrafo import rest
    >>> import kintrafo
    >>> from kintrafo.generated import four_bar
    >>> system = kintrafo.System(four_bar)
    >>> found = rest(system, inputs={"crank_torque": 1.0})
    >>> bool(abs(system.evaluate("rhs", found)).max() < 1e-9)
    True
    """
    with Validator("rest") as given:
        given.instance("system", system, System, System.NEEDED)
        if not given.failed:
            size = len(system.state_names)
            start = system.design_state if near is None else near
            state = given.array("near", start, dimensions=[1], last=size, empty=True)
            acting = given.mapping("inputs", {} if inputs is None else inputs, "names and numbers")
    held = inputs_of(start, system.names_of_states)
    known = {} if held is None else dict(zip(system.input_names, held.tolist(), strict=True))
    own = system.inputs({**known, **acting})
    found = _RestSearch(system, own).from_state(np.array(state))
    return State.of(found, own, system.names_of_states)


class _RestSearch:
    """Newton's method on the accelerations of a system under given inputs, at rest.

    The unknowns are the positions and the internal states of forces, whose rates are zero, too.
    """

    def __init__(self, system: System, inputs: Array) -> None:
        self._system, self._inputs, self._layout = system, inputs, system.layout
        positions = self._layout.positions
        self._speeds = slice(positions, positions + self._layout.speeds)

    def from_state(self, state: Array) -> Array:
        """Return the state of rest near a state, whose speeds are ignored."""
        state = self._layout.normalised(state)
        state[self._speeds] = 0.0
        left = self._accelerations(state)
        for _ in range(_MOST_STEPS):
            slopes, directions = self._slopes(state)
            step = np.asarray(-np.linalg.pinv(slopes, rcond=_NOTHING) @ left)
            state, left, part = self._shortened(state, left, directions @ step)
            if np.abs(part * step).max(initial=0.0) <= _LAST_STEP:
                break
        # a residual that no step reduces, and that exceeds rounding
        if np.abs(left).max(initial=0.0) > _NOTHING * max(1.0, np.abs(slopes).max(initial=0.0)):
            self._refuse(state, left)
        return state

    def _shortened(self, state: Array, left: Array, step: Array) -> tuple[Array, Array, float]:
        """Return the state after a step, halved until the residual decreases; or the same state."""
        part = 1.0
        for _ in range(_HALVINGS):
            moved = self._layout.normalised(state + part * step)
            try:
                after = self._accelerations(moved)
            except ModelError:
                part *= 0.5
                continue
            if np.linalg.norm(after) < np.linalg.norm(left):
                return moved, after, part
            part *= 0.5
        return state, left, 0.0

    def _accelerations(self, state: Array) -> Array:
        rates = self._system.evaluate("rhs", state, self._inputs)
        return rates[self._layout.positions :]

    def _slopes(self, state: Array) -> tuple[Array, Array]:
        """Return derivatives of accelerations, and of the state, by the unknowns."""
        jacobian = self._system.evaluate("rhs_jacobian", state, self._inputs)
        positions, basis = self._layout.positions, self._layout.basis(state)
        internal = len(state) - self._speeds.stop
        directions = np.zeros((len(state), basis.shape[1] + internal))
        directions[:positions, : basis.shape[1]] = basis
        directions[self._speeds.stop :, basis.shape[1] :] = np.eye(internal)
        return jacobian[positions:] @ directions, directions

    def _refuse(self, state: Array, left: Array) -> None:
        described, positions = self._system.equations.STATE, self._layout.positions
        names = self._system.state_names
        values = dict(zip(names[:positions], state.tolist(), strict=False))
        worst = int(np.abs(left).argmax())
        own = {self._layout.speed_of[place]: place for place in self._layout.joints}
        name = names[own.get(worst, positions + worst)]
        unit = described[name]["unit"]
        rate = f"is still accelerated by {left[worst]:.3g} {unit}/s^2"
        if worst not in own:
            rate = f"still changes by {left[worst]:.3g} ({unit})/s"
        words = (
            f"no state of rest was found: at {located(values, described)}, {name} {rate}. Start "
            "nearer to it or with other inputs, if there is such a state."
        )
        raise InputError([words], "rest")
