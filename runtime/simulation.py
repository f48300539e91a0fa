"""Integrate the equations of motion."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import solve_ivp
from scipy.optimize import OptimizeResult

from .errors import InputError, KintrafoError
from .generated.macpherson import ModelError
from .model import Model
from .signals import Signal, TimeInputs, time_inputs

Array = NDArray[np.float64]
Method = Literal["BDF", "Radau", "LSODA", "RK45", "DOP853"]

_IMPLICIT = ("BDF", "Radau", "LSODA")
_METHODS = (*_IMPLICIT, "RK45", "DOP853")


class SimulationError(KintrafoError, RuntimeError):
    """A simulation that could not be finished.

    Attributes
    ----------
    time : float
        Time at which it happened [s].
    state : ndarray
        State at which it happened.
    """

    def __init__(self, reason: str, time: float, state: Array) -> None:
        self.time = time
        self.state = state
        super().__init__(reason, time, state)

    def __str__(self) -> str:
        return f"at t = {self.time:.6g} s: {self.args[0]}"


class Simulation(OptimizeResult):
    """The result of `simulate`: the fields of SciPy's ``solve_ivp``, and the physical signals.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    y : ndarray, shape (number of state elements, n)
        States; rows in the order of ``model.state_names``, SI units.
    signals : dict
        Physical signals by name, each of shape (n,), SI units; see ``model.equations.SIGNALS``.
    inputs : ndarray, shape (n, number of inputs)
    sol, t_events, y_events, nfev, njev, nlu, status, message, success
        As in ``scipy.integrate.solve_ivp``.
    """


def simulate(
    model: Model,
    t_span: tuple[float, float],
    y0: ArrayLike,
    *,
    inputs: Mapping[str, Signal] | None = None,
    method: Method = "BDF",
    t_eval: Sequence[float] | Array | None = None,
    rtol: float = 1e-6,
    atol: float | Sequence[float] | Array = 1e-9,
    max_step: float = np.inf,
    first_step: float | None = None,
    dense_output: bool = False,
    events: Callable[..., float] | Sequence[Callable[..., float]] | None = None,
) -> Simulation:
    """Integrate the equations of motion of a suspension.

    Parameters
    ----------
    model : Model
    t_span : tuple of float
        First and last time [s].
    y0 : array_like
        Initial state, see `model.state`, `state_at_height` and `equilibrium`.
    inputs : mapping, optional
        Time-varying inputs by name: numbers, samples ``(times, values)``, or functions of time.
    method : str, optional
        'BDF' (Gear's formulas), 'Radau', 'LSODA', 'RK45' or 'DOP853'. The implicit ones use the
        exact Jacobian.
    t_eval, rtol, atol, max_step, first_step, dense_output, events
        As in ``scipy.integrate.solve_ivp``.

    Returns
    -------
    Simulation

    Raises
    ------
    InputError
        If an argument cannot be used.
    SimulationError
        If a loop cannot close on the way, or the solver gives up; says when and where.

    Examples
    --------
    >>> from kintrafo import Model, simulate, state_at_height
    >>> model = Model("reference_car")
    >>> start = state_at_height(model, 0.325, spin_rate=93.0)
    >>> result = simulate(model, (0.0, 1.0), start)
    >>> result.success, bool(abs(result.signals["wheel_center_z"][-1] - 0.3) < 1e-6)
    (True, True)
    """
    y0 = np.asarray(y0, dtype=np.float64)
    _check_arguments(model, t_span, y0, method)
    given = time_inputs(model, inputs, t_span)
    right_hand_side = _RightHandSide(model, given)
    options: dict[str, Any] = {"jac": right_hand_side.jacobian} if method in _IMPLICIT else {}
    options |= {"t_eval": t_eval, "max_step": max_step, "first_step": first_step}
    options |= {"rtol": rtol, "atol": atol, "dense_output": dense_output, "events": events}
    try:
        result = solve_ivp(right_hand_side, t_span, y0, method, **options)
    except ModelError as error:
        raise SimulationError(str(error), right_hand_side.time, right_hand_side.state) from error
    if not result.success:
        raise SimulationError(str(result.message), float(result.t[-1]), result.y[:, -1])
    input_table = given.at(result.t)
    simulation = Simulation()
    simulation.update(result)
    simulation.update(inputs=input_table, signals=model.signals(result.y.T, input_table))
    return simulation


def _check_arguments(model: Model, t_span: tuple[float, float], y0: Array, method: str) -> None:
    problems = []
    if method not in _METHODS:
        problems.append(f"method {method!r} is not known; there are {', '.join(_METHODS)}.")
    if y0.shape != model.design_state.shape:
        problems.append(
            f"y0 has shape {y0.shape}; the state of {model.equations.NAME} has the elements "
            f"{', '.join(model.state_names)}."
        )
    if not (np.all(np.isfinite(t_span)) and t_span[0] != t_span[1]):
        problems.append(f"t_span = {t_span}: two different finite times are needed.")
    if problems:
        raise InputError(problems, "simulate")


class _RightHandSide:
    """The compiled right-hand side and its Jacobian as SciPy calls them.

    Where the rack stands still, the variant without its velocity and acceleration is used.
    """

    def __init__(self, model: Model, inputs: TimeInputs) -> None:
        variant = "_rack_held" if inputs.rack_held else ""
        self._function = getattr(model.equations, f"rhs{variant}")
        self._derivative = getattr(model.equations, f"rhs_jacobian{variant}")
        self._constants = model.constants
        self._inputs = inputs
        self.time = 0.0
        self.state: Array = model.design_state

    def __call__(self, time: float, state: Array) -> Array:
        self.time, self.state = time, state
        result: Array = self._function(state, self._inputs(time), self._constants)
        return result

    def jacobian(self, time: float, state: Array) -> Array:
        """Return the exact derivative with respect to the state."""
        result: Array = self._derivative(state, self._inputs(time), self._constants)
        return result
