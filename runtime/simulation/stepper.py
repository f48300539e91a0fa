"""A simulation that is advanced step by step, with inputs that are set between steps."""

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from scipy.interpolate import PPoly

from ..core.errors import InputError
from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator, shown
from ..systems.inputs import derived_inputs, rates_of
from ..systems.state import inputs_of
from ..systems.system import System
from .accuracy import accuracy_of
from .dead_points import meanings
from .result import SimulationError
from .simulate import simulate
from .solvers import (
    FIXED_STEP_METHODS,
    check_jacobian,
    native_available,
    sundials,
    why_not_native,
)

Method = Literal["RK4", "RODASP", "DormandPrince"]

_TOLERANCE = (1e-6, 1e-9)
_MOST_STEPS = 100_000


class Stepper:
    """A simulation that the caller advances step by step, for controllers and simulators.

    Parameters
    ----------
    model : System or Model
    step : float
        Length of a step [s].
    y0 : array_like, optional
        Initial state, see `model.state`, `state_at_height` and `equilibrium`; the design position
        at rest by default.
    inputs : mapping or array_like, optional
        Initial inputs, by name or in the order of ``model.input_names``, SI units. Other inputs
        have the values of `y0` if it comes from `equilibrium` or `state_at_height`, or else zero.
    method : {'RK4', 'RODASP', 'DormandPrince'}, optional
        The classical Runge-Kutta method with four evaluations a step, for real time; a linearly
        implicit method for stiff equations, also at a constant cost; or a method with tolerances,
        which divides each step as necessary.
    rtol, atol : float, array_like, optional
        Tolerances of 'DormandPrince', by default 1e-6 and 1e-9.
    t0 : float, optional
        Initial time [s].

    Attributes
    ----------
    model : System
        The equations.
    length : float
        Length of a step [s]; it cannot be changed.
    state : ndarray, shape (number of state elements,)
        Present state, SI units. `step` writes into this array: copy values that are to be kept.
    inputs : ndarray, shape (number of inputs,)
        Inputs of the next step, in the order of ``model.input_names``, SI units. State and inputs
        may be written to; assigned values are copied into the same array.

    Raises
    ------
    InputError
        If an argument cannot be used, or the model or this build has no compiled solver.

    Notes
    -----
    Inputs are constant within a step. An input whose rate is also an input is integrated: with a
    ``rack_velocity`` the rack position changes, in this step and the next ones.

    A step has the checks of `kintrafo.simulate`, with the same errors: stability of 'RK4', loops
    that cannot close, dead points. A state beyond a bound of the model, such as a strut longer than
    its greatest length, is not an error: `kintrafo.Simulation.validity` reports it for a motion,
    and for a stepper the signals show it. No memory is allocated by a step.

    Examples
    --------
    A damper that a controller sets, 1,000 times a second:

    >>> import kintrafo
    >>> model = kintrafo.Model("reference_car")
    >>> stepper = kintrafo.Stepper(model, 1e-3, kintrafo.state_at_height(model, 0.325))
    >>> force = model.input_names.index("strut_force")
    >>> rate = model.state_names.index("beta1_rate")
    >>> for _ in range(1000):
    ...     stepper.inputs[force] = -200.0 * stepper.state[rate]
    ...     state = stepper.step()
    >>> round(stepper.time, 9), round(float(stepper.signals()["wheel_center_z"]), 4)
    (1.0, 0.3)
    """

    def __init__(
        self,
        model: System,
        step: float,
        y0: ArrayLike | None = None,
        *,
        inputs: Mapping[str, float] | ArrayLike | None = None,
        method: Method = "RK4",
        rtol: float | None = None,
        atol: ArrayLike | None = None,
        t0: float = 0.0,
    ) -> None:
        with Validator("Stepper") as given:
            given.instance("model", model, System, System.NEEDED)
            given.among("method", method, (*FIXED_STEP_METHODS, "DormandPrince"))
            self._length = given.number("step", step, "s", above=0.0)
            if not given.failed:
                _check_solver(given, model)
                check_jacobian(given, model, method)
            if method in FIXED_STEP_METHODS and not (rtol is None and atol is None):
                given.fail(f"method {method!r} has no tolerances: leave out rtol and atol.")
            if not given.failed:
                accuracy = accuracy_of(
                    given,
                    model.design_state.size,
                    rtol=_TOLERANCE[0] if rtol is None else rtol,
                    atol=_TOLERANCE[1] if atol is None else atol,
                    max_step=self._length,
                    first_step=None,
                    max_steps=_MOST_STEPS,
                )
        self.model, self._method, self._accuracy = model, method, accuracy
        self._state, self._inputs = model.design_state.copy(), model.inputs()
        addresses = model.equations.ADDRESSES
        self._motion = sundials.Motion(
            tuple(addresses[name] for name in ("rhs", "rhs_jacobian", "margins")),
            model.layout,
            model.constants,
            self._state,
            self._inputs,
            _moving(model),
            self._length,
            method=method,
            rtol=accuracy.rtol,
            atol=accuracy.atol,
            max_step=self._length,
            max_steps=accuracy.max_steps,
            guards=meanings(model.equations),
            usual_margins=model.usual_margins,
        )
        self._advance = self._motion.advance
        self.reset(model.design_state if y0 is None else y0, inputs=inputs, t0=t0)

    @property
    def length(self) -> float:
        """Length of a step [s]."""
        return self._length

    @property
    def state(self) -> Array:
        """Present state; assigned values are copied into it."""
        return self._state

    @state.setter
    def state(self, values: ArrayLike) -> None:
        _copy("state", values, self._state)

    @property
    def inputs(self) -> Array:
        """Inputs of the next step; assigned values are copied into them."""
        return self._inputs

    @inputs.setter
    def inputs(self, values: ArrayLike) -> None:
        _copy("inputs", values, self._inputs)

    @property
    def time(self) -> float:
        """Present time [s]: the initial time and the number of steps times their length."""
        return self._motion.time

    def step(self, inputs: ArrayLike | None = None) -> Array:
        """Advance by one step, and return the state.

        Parameters
        ----------
        inputs : array_like, shape (number of inputs,), optional
            Inputs of this step, instead of those in `inputs`.

        Returns
        -------
        ndarray
            `state`, the same array each time.

        Raises
        ------
        InputError
            If the number of inputs is not that of the model.
        SimulationError
            As `kintrafo.simulate` over this step, with the state reached. State and time of the
            stepper are as before the step.
        """
        if inputs is not None:
            self.inputs = inputs
        if not self._advance():
            self._fail(self.time)
        return self._state

    def reset(
        self,
        y0: ArrayLike,
        *,
        inputs: Mapping[str, float] | ArrayLike | None = None,
        t0: float = 0.0,
    ) -> None:
        """Start again from another state.

        Parameters
        ----------
        y0, inputs, t0
            Initial state, inputs, and initial time [s]; see `Stepper`.
        """
        with Validator("Stepper") as given:
            state = given.array("y0", y0, last=self.state.size)
            held = inputs_of(y0, self.model.names_of_states)
            start = given.number("t0", t0, "s")
            values = self.model.inputs() if held is None else np.array(held)
            if isinstance(inputs, Mapping):
                for name, value in inputs.items():
                    known = given.among("input", name, self.model.input_names)
                    if known in self.model.input_names:
                        place = self.model.input_names.index(known)
                        values[place] = given.number(f"inputs {shown(name)}", value)
            elif inputs is not None:
                values = given.array("inputs", inputs, last=values.size, empty=True)
            if not given.failed and state.shape != self.state.shape:
                given.fail(f"y0 has the shape {state.shape}: one state is needed.")
            if not given.failed and values.shape != self.inputs.shape:
                given.fail(f"inputs has the shape {values.shape}: those of one state are needed.")
        self._state[:], self._inputs[:] = state, values
        self._motion.begin(start)

    def signals(self) -> dict[str, Any]:
        """Return all present signals by name, SI units; see ``equations.SIGNALS``."""
        return self.model.signals(self.state, self.inputs)

    def _fail(self, start: float) -> None:
        """Raise the error of `simulate` for a step that cannot be taken."""
        span = start, start + self.length
        how = {"step": self.length} if self._method in FIXED_STEP_METHODS else vars(self._accuracy)
        profiles = _profiles(self.model, self.inputs, span)
        try:
            simulate(self.model, span, self.state, inputs=profiles, method=self._method, **how)
        except SimulationError as error:
            if "max_steps" in error.advice:  # not an argument of a stepper
                raise error.advising("Give a shorter step, or loosen rtol.") from None
            raise
        state = self.state.copy()
        reason, advice = "the step could not be taken", "Try a shorter one."
        raise SimulationError(reason, start, state, None, advice)


def _copy(name: str, values: ArrayLike, into: Array) -> None:
    """Copy numbers into an array that stays the same; the step checks whether they are finite."""
    taken: Any = values
    if not (isinstance(taken, np.ndarray) and taken.dtype == into.dtype):
        with Validator("Stepper") as given:
            taken = given.array(name, values, empty=True, finite=False)
    if taken.shape != into.shape:
        needed = f"{into.size} numbers are needed, in a row"
        raise InputError([f"{name} = {shown(values)}: {needed}."], "Stepper")
    into[:] = taken


def _check_solver(given: Validator, model: System) -> None:
    """Refuse equations for which there is no compiled solver."""
    if not native_available():
        given.fail(f"no solver was compiled. {why_not_native()}.")
    elif not (model.equations.ADDRESSES and model.state_names):
        given.fail(f"{model.equations.NAME} has no compiled equations with a state to integrate.")


def _moving(model: System) -> list[tuple[int, int, int]]:
    """Return indices of inputs with rates: of the value, its rate, and the rate's rate or -1.

    A road with a velocity, for example, has no second rate.
    """
    names, derived = model.input_names, derived_inputs(model.equations.INPUTS)
    found = []
    for name in names:
        if name not in derived and (rates := rates_of(name, model.equations.INPUTS)):
            places = [names.index(one) for one in (name, *rates)]
            found.append((places[0], places[1], places[2] if len(places) > 2 else -1))
    return found


def _profiles(model: System, inputs: Array, span: tuple[float, float]) -> dict[str, Any]:
    """Return the inputs of a step for `simulate`, without rates, which follow from the values."""
    profiles: dict[str, Any] = dict(zip(model.input_names, inputs.tolist(), strict=True))
    for value, rate, second in _moving(model):
        row = [0.5 * inputs[second] if second >= 0 else 0.0, inputs[rate], inputs[value]]
        profiles[model.input_names[value]] = PPoly(np.array(row)[:, None], np.array(span))
    return {
        name: profile
        for name, profile in profiles.items()
        if name not in derived_inputs(model.equations.INPUTS)
    }
