"""The result of a simulation: states, signals, statistics; or an error with a partial result."""

from collections.abc import Callable, Iterator, Mapping
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import OptimizeResult

from ..core.errors import KintrafoError
from ..core.named_types import Array
from ..core.validator import Validator
from ..equations.errors import ModelError
from ..systems.system import System
from .validity import Excursion, bounds_of, excursions

# Roundings by which a time may be beyond the ends of the solution, such as the last of a range.
_ROUNDINGS = 8.0


class SimulationError(KintrafoError, RuntimeError):
    """A simulation that could not be finished.

    Attributes
    ----------
    reason : str
        The cause.
    time : float
        Time at which it ended [s].
    state : ndarray, shape (number of state elements,)
        State at which it ended, SI units.
    partial : Simulation or None
        The result until then.
    advice : str
        What to do about it, in the names of the arguments of `simulate`.
    """

    def __init__(
        self,
        reason: str,
        time: float,
        state: Array,
        partial: "Simulation | None" = None,
        advice: str = "",
    ) -> None:
        self.reason = reason
        self.advice = advice
        self.time = time
        self.state = state
        self.partial = partial
        super().__init__(reason, time, state, partial, advice)

    def __str__(self) -> str:
        return " ".join(filter(None, [f"at t = {self.time:.6g} s: {self.reason}.", self.advice]))

    def advising(self, advice: str) -> "SimulationError":
        """Return the same error with other advice, for those who cannot pass these arguments."""
        return SimulationError(self.reason, self.time, self.state, self.partial, advice)


class Simulation(OptimizeResult):
    """The result of `simulate`: the fields of SciPy's ``solve_ivp``, and the physical signals.

    Attributes
    ----------
    t : ndarray, shape (n,)
        Times [s].
    y : ndarray, shape (number of state elements, n)
        States; rows in the order of ``model.state_names``, SI units.
    signals : Signals
        Physical signals by name, each of shape (n,), SI units; see ``model.equations.SIGNALS``.
        All are computed at the first access to one of them.
    inputs : ndarray, shape (n, number of inputs)
        Inputs at these times, in the order of ``model.input_names``, SI units.
    sol, t_events, y_events, nfev, njev, nlu, status, message, success
        Interpolant of the states, times and states of events, numbers of evaluations, Jacobians and
        factorisations, code and text of the end, and whether the end was reached: fields of
        ``scipy.integrate.solve_ivp``.
    steps : int
        Steps taken.
    error_test_failures, order : int
        Steps that failed the error test, order of the last step; with SUNDIALS only.
    solver : str
        'kintrafo', 'SciPy', or 'SUNDIALS' with its version.
    validity : tuple of Excursion
        Outputs at which the motion is beyond a bound of the model: a strut longer than its
        greatest length, a tyre that pulls. Empty if there are none. It is an attribute alone, not
        a key of the result as a dictionary.
    """

    t: Array
    y: Array
    signals: "Signals"
    inputs: Array
    sol: "DenseOutput | None"
    t_events: list[Array] | None
    y_events: list[Array] | None
    nfev: int
    njev: int
    nlu: int
    steps: int
    error_test_failures: int
    order: int
    status: int
    message: str
    success: bool
    solver: str

    @property
    def validity(self) -> tuple[Excursion, ...]:
        """Bounds of the model that outputs of the motion have passed."""
        model = self.signals.model
        return excursions(model, bounds_of(model), self.t, self.signals)


class DenseOutput:
    """The solution as a function of time, from the polynomials of the steps.

    Attributes
    ----------
    t_min, t_max : float
        First and last time of the solution [s].
    """

    def __init__(self, parts: list[tuple[float, float, Callable[[Array], Array]]]) -> None:
        self._parts = parts
        self._backward = parts[0][1] < parts[0][0]
        self._ends = np.array([end for _, end, _ in parts])
        ends = parts[0][0], parts[-1][1]
        self.t_min, self.t_max = min(ends), max(ends)

    def __call__(self, t: ArrayLike) -> Array:
        """Return the state, shape (n,), or (n, number of times) for an array of times.

        Raises
        ------
        InputError
            If a time is not a number, or by more than rounding before `t_min` or after `t_max`.
        """
        with Validator("sol") as given:
            times = np.atleast_1d(given.array("t", t, "s", dimensions=[0, 1], empty=True))
            if not given.failed:
                self._refuse_outside(given, times)
        sign = -1.0 if self._backward else 1.0
        which = np.searchsorted(sign * self._ends, sign * times, side="left")
        which = np.clip(which, 0, len(self._parts) - 1)
        values = np.empty((times.size, self._parts[0][2](times[:1]).shape[1]))
        for index in np.unique(which):
            chosen = which == index
            values[chosen] = self._parts[index][2](times[chosen])
        return values[0] if np.ndim(t) == 0 else values.T

    def _refuse_outside(self, given: Validator, times: Array) -> None:
        slack = _ROUNDINGS * np.spacing(max(abs(self.t_min), abs(self.t_max)))
        outside = times[(times < self.t_min - slack) | (times > self.t_max + slack)]
        if outside.size:
            given.fail(
                f"t = {outside[0]:.15g} s: the solution is known from {self.t_min:.15g} s to "
                f"{self.t_max:.15g} s. Ask within, or simulate for as long."
            )


class Signals(Mapping[str, Array]):
    """The physical signals of a simulation by name, each of shape (number of outputs,), SI units.

    All of them are computed at the first access to one: they may take longer than the integration.
    Where the model refuses a state, those of a failed simulation are NaN.
    """

    def __init__(self, model: System, y: Array, inputs: Array, *, failed: bool) -> None:
        self._model, self._y, self._inputs, self._failed = model, y, inputs, failed

    @property
    def model(self) -> System:
        """The model whose signals these are."""
        return self._model

    def __getitem__(self, name: str) -> Array:
        """Return one signal."""
        return self._values[name]

    def __iter__(self) -> Iterator[str]:
        """Iterate over the names, in order."""
        return iter(self._model.signal_names)

    def __len__(self) -> int:
        """Return the number of signals."""
        return len(self._model.signal_names)

    def __repr__(self) -> str:
        return f"<Signals {', '.join(self)}>"

    def _ipython_key_completions_(self) -> list[str]:
        """Return the names that a notebook proposes between brackets."""
        return list(self)

    @cached_property
    def _values(self) -> dict[str, Array]:
        if not self._failed:
            return self._model.signals(self._y, self._inputs)
        rows = [self._where_it_closes(*row) for row in zip(self._y, self._inputs, strict=True)]
        return {name: np.array([row.get(name, np.nan) for row in rows]) for name in self}

    def _where_it_closes(self, state: Array, inputs: Array) -> dict[str, float]:
        """Return the signals of one output; empty if the model refuses its state."""
        try:
            values = self._model.signals(state, inputs)
        except ModelError:
            return {}
        return {name: float(value) for name, value in values.items()}
