"""Equations linearised about a state: matrices, modes, frequency response.

With ``x = state - state_0``, ``u = inputs - inputs_0`` and ``y = signals - signals_0``,

    x' = A x + B u + rate_0,        y = C x + D u,

where ``rate_0`` is the time derivative of the state at the point. At an equilibrium, or in a steady
motion in which only the spin angle changes, it has no effect, and the eigenvalues of A are those of
the motion. About any other state the matrices are also exact, but describe the motion only near
that state: the modes are those of frozen coefficients.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator
from ..equations.layout import StateLayout
from .inputs import rates_of
from .modes import Mode, eigenvalues_of, mode_of_states, modes_of
from .state import inputs_of
from .system import System
from .tangent import Tangent

if TYPE_CHECKING:
    from scipy.signal import StateSpace


Complex = NDArray[np.complex128]

# Rate below which a state counts as steady, relative to the accelerations by the forces.
_STEADY = 1e-6
# Change of the fastest element of a state, after which its equations are compared.
_MOMENT = 1e-2
# Its square does not overflow [Hz].
_GREATEST_FREQUENCY = 1e100


@dataclass(frozen=True)
class Linearisation:
    """Linear equations of motion about a state.

    Attributes
    ----------
    state, inputs, outputs : ndarray
        State and inputs about which the equations are linear, and the chosen signals there, SI
        units.
    rate : ndarray, shape (states,)
        Time derivative of this state; see `steady`.
    A : ndarray, shape (states, states)
        Exact derivatives of the rate of the state with respect to the state, SI units.
    B : ndarray, shape (states, inputs)
        Those of the rate with respect to the inputs.
    C : ndarray, shape (outputs, states)
        Those of the outputs with respect to the state.
    D : ndarray, shape (outputs, inputs)
        Those of the outputs with respect to the inputs.
    layout : StateLayout
        Positions, speeds and internal states in the state.
    constant : bool
        Whether A to D are the same at all times of the motion from this state. False only for
        bodies that move freely, for example for one that spins, whose axes turn relative to the
        world.
    state_names, input_names, output_names : tuple of str
        Names of the elements of `state`, `inputs` and `outputs`, in order.
    state_units, input_units, output_units : tuple of str
        Their SI units.
    input_rates : mapping
        For each input, the inputs that are its derivatives, in order.
    """

    state: Array
    inputs: Array
    outputs: Array
    rate: Array
    A: Array
    B: Array
    C: Array
    D: Array
    layout: StateLayout
    constant: bool
    state_names: tuple[str, ...]
    input_names: tuple[str, ...]
    output_names: tuple[str, ...]
    state_units: tuple[str, ...]
    input_units: tuple[str, ...]
    output_units: tuple[str, ...]
    input_rates: Mapping[str, tuple[str, ...]]

    @property
    def steady(self) -> bool:
        """Whether all rates at this state are zero, except those of coordinates without effect.

        Such a coordinate is the angle of a spinning rotor. A free body may move if its
        accelerations are constant, for example along a circle on level ground.
        """
        changing: NDArray[np.bool_] = np.array(self.A.any(axis=0))
        free = np.ones(self.layout.positions, dtype=bool)
        free[list(self.layout.joints)] = False
        changing[: free.size][free] = False
        # rates after a change of the state by about 1e-6 rad or m
        scale = float(np.abs(self.A[changing]).max(initial=1.0))
        greatest = np.abs(self.rate[changing]).max(initial=0.0)
        return self.constant and bool(greatest <= _STEADY * scale)

    @property
    def eigenvalues(self) -> Complex:
        """Eigenvalues of the motions [1/s], those with the largest imaginary part first.

        They are those of A without those of the norms of quaternions; see `tangent`.
        """
        return eigenvalues_of(self.tangent.A)

    @cached_property
    def tangent(self) -> Tangent:
        """The linear motions about the state, in as many coordinates as there are speeds."""
        return Tangent.at(self.A, self.rate, self.state, self.layout)

    @property
    def modes(self) -> tuple[Mode, ...]:
        """The modes: one for each conjugate pair and for each real eigenvalue."""
        return modes_of(self.tangent.A, self.state_names, self.tangent.lift)

    def mode_of(self, coordinate: str) -> Mode:
        """Return the mode in which a coordinate takes the largest part.

        Parameters
        ----------
        coordinate : str
            Name of a position, from the first of `state_names` on; for a free body that of the
            displacement along an axis, or of a component e1, e2 or e3 of its quaternion for the
            rotation about one.

        Returns
        -------
        Mode
            The pair of eigenvalues with the largest participation of the coordinate and its rate,
            see `mode_of_states`.

        Raises
        ------
        InputError
            If there is no such coordinate.
        """
        directions = self.layout.directions
        known = {self.state_names[position]: position for position in directions}
        with Validator("mode") as given:
            given.among("coordinate", coordinate, known)
        position = known[coordinate]
        speed = self.layout.speed_of[position]
        places = [directions[position]] + ([] if speed is None else [len(directions) + speed])
        return mode_of_states(self.tangent.A, self.state_names, places, self.tangent.lift)

    def state_space(self) -> "StateSpace":
        """Return the matrices as SciPy's ``StateSpace``."""
        from scipy.signal import StateSpace  # noqa: PLC0415 (slow to import)

        return StateSpace(self.A, self.B, self.C, self.D)

    def frequency_response(self, frequency: ArrayLike, source: str) -> dict[str, Complex]:
        """Return the response of the outputs to a small harmonic input.

        Parameters
        ----------
        frequency : array_like
            [Hz].
        source : str
            An input. Inputs that are its derivatives, such as velocity and acceleration of a
            prescribed position, change with it.

        Returns
        -------
        dict
            By output: complex amplitude divided by that of the input, in the SI units of both.

        Raises
        ------
        InputError
            If there is no such input, or an eigenvalue lies on one of the frequencies.
        """
        _, response = self.responses(frequency, [source])
        return {name: response[..., i, 0] for i, name in enumerate(self.output_names)}

    def state_response(self, frequency: ArrayLike, source: str) -> Complex:
        """Return the complex response of the states to a small harmonic input, (..., states).

        Parameters
        ----------
        frequency : array_like
            [Hz].
        source : str
            An input, as for `frequency_response`.

        Raises
        ------
        InputError
            If there is no such input, or an eigenvalue lies on one of the frequencies.
        """
        return self.responses(frequency, [source])[0][..., 0]

    def responses(self, frequency: ArrayLike, sources: Sequence[str]) -> tuple[Complex, Complex]:
        """Return the complex amplitudes of states and outputs per unit amplitude of each input.

        Parameters
        ----------
        frequency : array_like
            [Hz].
        sources : sequence of str
            Inputs, as for `frequency_response`.

        Returns
        -------
        tuple of ndarray
            Of states, (..., states, sources), and of outputs, (..., outputs, sources).

        Raises
        ------
        InputError
            If there is no such input, or an eigenvalue lies on one of the frequencies.
        """
        with Validator("frequency response") as given:
            frequencies = given.array("frequency", frequency, "Hz", empty=True)
            for source in sources:
                given.among("source", source, self.input_names)
            if np.abs(frequencies).max(initial=0.0) > _GREATEST_FREQUENCY:
                given.fail(f"frequency: {_GREATEST_FREQUENCY:g} Hz at most, in size, are possible.")
        s = (2j * np.pi * frequencies[..., None]).astype(np.complex128)
        columns = np.stack([self._harmonic(source, s) for source in sources], axis=-1)
        moved = s[..., None] * np.eye(len(self.A)) - self.A
        try:
            found = np.linalg.solve(moved, self.B @ columns)
        except np.linalg.LinAlgError as error:
            problem = (
                "frequency: an undamped mode lies on one of the frequencies (at 0 Hz what turns "
                "freely), where the response is infinite. Leave that frequency out."
            )
            raise InputError([problem], "frequency response") from error
        states: Complex = found.astype(np.complex128)
        outputs: Complex = (self.C @ states + self.D @ columns).astype(np.complex128)
        return states, outputs

    def _harmonic(self, source: str, s: Complex) -> Complex:
        """Return the amplitudes of all inputs if one of them has the amplitude one."""
        column = np.zeros((*s.shape[:-1], len(self.input_names)), dtype=np.complex128)
        column[..., self.input_names.index(source)] = 1.0
        for order, rate in enumerate(self.input_rates[source], 1):
            column[..., self.input_names.index(rate)] = s[..., 0] ** order
        return column


def linearise(
    model: "System",
    state: ArrayLike,
    inputs: ArrayLike | None = None,
    *,
    outputs: Sequence[str] | None = None,
) -> Linearisation:
    """Return the linear equations of motion about a state.

    Parameters
    ----------
    model : System or Model
    state, inputs : array_like
        One state, and its inputs, SI units; by default the inputs of a `State`, or zeros.
        `kintrafo.equilibrium` returns a state of rest; any other state is allowed, see
        `Linearisation.steady`. Quaternions of free bodies are normalised.
    outputs : sequence of str, optional
        Signals that are outputs, all by default.

    Returns
    -------
    Linearisation
        Matrices from the compiled exact derivatives.

    Raises
    ------
    InputError
        If an output is not known, or more than one state is given.

    Examples
    --------
    >>> from kintrafo import Model, equilibrium, linearise
    >>> model = Model("reference_car")
    >>> linear = linearise(model, equilibrium(model), outputs=["tyre_force"])
    >>> linear.steady, linear.mode_of("beta1").text
    (True, '12.35 Hz, damping ratio 0.233')
    """
    with Validator("linearise") as checked:
        checked.instance("model", model, System, System.NEEDED)
        if not checked.failed:
            held = inputs_of(state, model.names_of_states)
            inputs = held if inputs is None else inputs
            given = checked.array(
                "inputs", model.inputs() if inputs is None else inputs, dimensions=[1],
                last=len(model.input_names), empty=True,
            )  # fmt: skip
            point = checked.array(
                "state", state, dimensions=[1], last=len(model.state_names), empty=True
            )
            outputs = model.signal_names if outputs is None else outputs
            names = checked.names("outputs", outputs, model.signal_names)
    point = model.layout.normalised(point)
    rows = [model.signal_names.index(name) for name in names]
    described = model.equations

    def evaluated(function: str, *shape: int) -> Array:
        """Return a result, empty where the mechanism has no states, inputs or signals."""
        return model.evaluate(function, point, given) if all(shape) else np.empty(shape)

    signals, states, entries = map(len, (model.signal_names, model.state_names, model.input_names))
    return Linearisation(
        state=point,
        inputs=given,
        outputs=evaluated("signals", signals)[rows],
        rate=evaluated("rhs", states),
        A=evaluated("rhs_jacobian", states, states),
        B=evaluated("rhs_input_jacobian", states, entries),
        C=evaluated("signals_jacobian", signals, states)[rows],
        D=evaluated("signals_input_jacobian", signals, entries)[rows],
        layout=model.layout,
        constant=_constant(model, point, given),
        state_names=model.state_names,
        input_names=model.input_names,
        output_names=names,
        state_units=tuple(entry["unit"] for entry in described.STATE.values()),
        input_units=tuple(entry["unit"] for entry in described.INPUTS.values()),
        output_units=tuple(described.SIGNALS[name]["unit"] for name in names),
        input_rates={name: rates_of(name, described.INPUTS) for name in described.INPUTS},
    )


def _constant(model: System, state: Array, inputs: Array) -> bool:
    """Return whether the equations of motions near a state are the same a moment later."""
    if not model.layout.free:
        return True
    rate = model.evaluate("rhs", state, inputs)
    ahead = model.layout.normalised(state + rate * _MOMENT / max(1.0, float(np.abs(rate).max())))
    now, then = (
        Tangent.at(
            model.evaluate("rhs_jacobian", at, inputs),
            model.evaluate("rhs", at, inputs),
            at,
            model.layout,
        ).A
        for at in (state, ahead)
    )
    return bool(np.abs(then - now).max() <= _STEADY * np.abs(now).max())
