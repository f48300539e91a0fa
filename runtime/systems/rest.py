"""Where a mechanism rests: no coordinate is accelerated."""

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from ..core.arguments import Arguments
from ..core.errors import InputError
from ..core.named_types import ArrayLike
from ..equations.errors import ModelError, located
from .state import State, inputs_of
from .system import System

Array = NDArray[np.float64]

_MOST_STEPS, _HALVINGS = 100, 30
# A step so small, beside a radian or a metre, changes nothing more but rounding.
_LAST_STEP = 1e-12
# Part of the greatest slope: what a direction adds less than this to, nothing moves, as the angle
# of a rotor; so much is also left at most, over a step of a radian or a metre.
_NOTHING = 1e-9


def rest(
    system: System, near: ArrayLike | None = None, inputs: Mapping[str, float] | None = None
) -> State:
    """Return a position of rest of any mechanism, found from a position near it.

    Parameters
    ----------
    system : System or Model
        Of a suspension on its road, `kintrafo.equilibrium` knows more.
    near : array_like, optional
        State from which it is looked for; its rates do not matter. By default that at design.
    inputs : mapping of str to float, optional
        Forces and so on that act, by name, SI units. Others are those of `near` where it knows
        them, see `State`, and zero else.

    Returns
    -------
    State
        With the rates zero, and the inputs.

    Raises
    ------
    InputError
        If an argument cannot be used, or no rest is found.
    ClosureError
        If a loop cannot close in the position to start from.

    Notes
    -----
    By Newton's method with the exact Jacobian of the accelerations; steps that bring loops to where
    they cannot close, or no nearer, are halved. Whether it would return to rest or leave it,
    `kintrafo.linearise` shows it: a pendulum rests upside down, too. A coordinate that nothing
    drives to anywhere, such as the angle of a rotor, stays where it is.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generated import four_bar
    >>> system = kintrafo.System(four_bar)
    >>> found = rest(system, inputs={"crank_torque": 1.0})
    >>> bool(abs(system.evaluate("rhs", found)).max() < 1e-9)
    True
    """
    with Arguments("rest") as given:
        given.kind("system", system, System, System.NEEDED)
        if not given.refused:
            size = len(system.state_names)
            start = system.design_state if near is None else near
            state = given.array("near", start, dimensions=[1], last=size, empty=True)
            acting = given.mapping("inputs", {} if inputs is None else inputs, "names and numbers")
    held = inputs_of(start, system.names_of_states)
    known = {} if held is None else dict(zip(system.input_names, held.tolist(), strict=True))
    own = system.inputs({**known, **acting})
    search = _Search(system, own)
    position = search.from_position(np.array(state[: system.layout.positions]))
    return State.of(search.at_rest(position), own, system.names_of_states)


class _Search:
    """Newton's method on the accelerations of a system under some inputs, at rest."""

    def __init__(self, system: System, inputs: Array) -> None:
        self._system, self._inputs, self._layout = system, inputs, system.layout

    def from_position(self, position: Array) -> Array:
        position = self._layout.normalised(position)
        left = self._accelerations(position)
        for _ in range(_MOST_STEPS):
            slopes, directions = self._slopes(position)
            step = np.asarray(-np.linalg.pinv(slopes, rcond=_NOTHING) @ left)
            position, left, part = self._shortened(position, left, directions @ step)
            if np.abs(part * step).max(initial=0.0) <= _LAST_STEP:
                break
        # what no step can take away is no rounding
        if np.abs(left).max(initial=0.0) > _NOTHING * max(1.0, np.abs(slopes).max(initial=0.0)):
            self._refuse(position, left)
        return position

    def _shortened(self, position: Array, left: Array, step: Array) -> tuple[Array, Array, float]:
        """Return where a step leads, halved until it leads nearer; or nowhere."""
        part = 1.0
        for _ in range(_HALVINGS):
            moved = self._layout.normalised(position + part * step)
            try:
                after = self._accelerations(moved)
            except ModelError:
                part *= 0.5
                continue
            if np.linalg.norm(after) < np.linalg.norm(left):
                return moved, after, part
            part *= 0.5
        return position, left, 0.0

    def at_rest(self, position: Array) -> Array:
        """Return the state of a position, with all speeds zero."""
        return np.concatenate([position, np.zeros(len(self._system.state_names) - position.size)])

    def _accelerations(self, position: Array) -> Array:
        rates = self._system.evaluate("rhs", self.at_rest(position), self._inputs)
        return rates[position.size :]

    def _slopes(self, position: Array) -> tuple[Array, Array]:
        """Return the slopes of the accelerations along what speeds change, and the latter."""
        slopes = self._system.evaluate("rhs_jacobian", self.at_rest(position), self._inputs)
        directions = slopes[: position.size, position.size : position.size + self._layout.speeds]
        return slopes[position.size :, : position.size] @ directions, directions

    def _refuse(self, position: Array, left: Array) -> None:
        described = self._system.equations.STATE
        values = dict(zip(self._system.state_names, position.tolist(), strict=False))
        worst = int(np.abs(left).argmax())
        own = {speed: place for place, speed in self._layout.own}
        name = self._system.state_names[own.get(worst, position.size + worst)]
        unit = described[name]["unit"].removesuffix("/s")
        words = (
            f"no rest was found: at {located(values, described)}, {name} is still accelerated by "
            f"{left[worst]:.3g} {unit}/s^2. Begin nearer to it, with other inputs, or see "
            "whether there is one."
        )
        raise InputError([words], "rest")
