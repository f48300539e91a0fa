"""Compiled equations of motion together with one set of parameters."""

from collections.abc import Mapping
from functools import cache, cached_property
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..core.named_types import Array, ArrayLike
from ..core.validator import Validator, shown
from ..equations.layout import StateLayout
from .allowed import LengthLimit
from .compile.loader import find
from .modes import eigenvalues_of
from .state import StateNames, inputs_of
from .tangent import Tangent


class System:
    """The compiled equations of one mechanism, with the values of its parameters.

    Parameters
    ----------
    equations : module
        A module of `kintrafo.generated`, or the result of `kintrafo.compile`.
    parameters : mapping, optional
        Values by name, SI units, instead of the declared defaults.

    Attributes
    ----------
    equations : module
        The compiled module.
    parameters : dict
        Value of every parameter, SI units.
    constants : ndarray
        Constants of the compiled functions for these parameters, SI units.
    design_state : ndarray
        State at the design position, at rest, SI units.

    Examples
    --------
    >>> from kintrafo import System
    >>> from kintrafo.generated import four_bar
    >>> system = System(four_bar, {"crank_mass": 2.0})
    >>> system.state_names
    ('crank_angle', 'crank_angle_rate')
    """

    NEEDED = 'a kintrafo.Model, such as Model("reference_car"), or a kintrafo.System is needed'

    def __init__(
        self, equations: ModuleType, parameters: Mapping[str, float] | None = None
    ) -> None:
        with Validator("System") as given:
            if not (isinstance(equations, ModuleType) and hasattr(equations, "PARAMETERS")):
                given.fail(
                    f"equations = {shown(equations)}: a module of kintrafo.generated, or a result "
                    "of kintrafo.compile, is needed. A suspension is a kintrafo.Model."
                )
            given.mapping("parameters", {} if parameters is None else parameters, "names, values")
        self.equations = equations
        self.parameters = _filled(equations, parameters or {})
        self.constants: Array = equations.prepare(self.parameters)
        self.design_state: Array = equations.design_state(self.parameters)

    def __reduce__(self) -> tuple[Any, ...]:
        # modules cannot be pickled
        return _unpickled, (self.equations.__name__, self.equations.__file__, self.parameters)

    def __repr__(self) -> str:
        return f"<System {self.equations.NAME}>"

    @cached_property
    def usual_margins(self) -> Array:
        """Sizes of the margins of the guards: their magnitudes at the design position."""
        margins = self.evaluate("margins", self.design_state)
        return np.where(np.isfinite(margins), np.abs(margins), 0.0)

    # -- names ----------------------------------------------------------------------------------

    @property
    def layout(self) -> StateLayout:
        """Positions, speeds and internal states in the state."""
        return self.equations.LAYOUT

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the state's elements, in order."""
        return tuple(self.equations.STATE)

    @property
    def input_names(self) -> tuple[str, ...]:
        """Names of the inputs, in order."""
        return tuple(self.equations.INPUTS)

    @cached_property
    def names_of_states(self) -> StateNames:
        """Names of the elements and inputs of a `State` of this system."""
        return StateNames(self.state_names, self.input_names)

    @property
    def signal_names(self) -> tuple[str, ...]:
        """Names of the physical signals, in order."""
        return tuple(self.equations.SIGNALS)

    @property
    def event_names(self) -> tuple[str, ...]:
        """Names of the events that a simulation can detect, in the order of their signals."""
        described = self.equations.SIGNALS.values()
        return tuple(name for signal in described for name in signal.get("events", {}))

    # -- building arrays --------------------------------------------------------------------------

    def state(self, **values: float) -> Array:
        """Return a state: the design position at rest, with the given elements.

        Parameters
        ----------
        **values : float
            Elements of the state by name, SI units: ``beta1`` [rad], ``beta5_rate`` [rad/s], ...

        Returns
        -------
        ndarray, shape (number of state elements,)
        """
        state = self.design_state.copy()
        _assign(state, self.state_names, values, "state")
        return state

    def inputs(self, values: Mapping[str, float] | None = None) -> Array:
        """Return an array of inputs, zero except for the given ones.

        Parameters
        ----------
        values : mapping, optional
            Inputs by name, SI units.

        Returns
        -------
        ndarray, shape (number of inputs,)
        """
        array = np.zeros(len(self.input_names))
        _assign(array, self.input_names, {} if values is None else values, "inputs")
        return array

    # -- evaluation -------------------------------------------------------------------------------

    def evaluate(self, function: str, state: ArrayLike, inputs: ArrayLike | None = None) -> Array:
        """Evaluate a compiled function with the constants of this mechanism.

        Parameters
        ----------
        function : str
            Name of a function of `equations`.
        state, inputs : array_like
            One or many, as in the compiled module. By default inputs are those of a `State`, or
            zeros.

        Returns
        -------
        ndarray
            Leading dimensions, then the shape of the function's result.
        """
        with Validator(f"{self.equations.NAME}.{function}") as given:
            given.among("function", function, _functions(self.equations))
            rows, columns = checked_point(given, self, state, inputs)
            if not given.failed:
                given.broadcast("state and inputs", [rows.shape[:-1], columns.shape[:-1]])
        return getattr(self.equations, function)(rows, columns, self.constants)

    def signals(self, state: ArrayLike, inputs: ArrayLike | None = None) -> dict[str, Array]:
        """Return all physical signals by name, in SI units.

        Parameters
        ----------
        state, inputs : array_like
            One or many, as for `evaluate`.

        Returns
        -------
        dict
            By name arrays over the leading dimensions; see ``equations.SIGNALS`` for units and
            signs.
        """
        if not self.signal_names:
            return {}
        values = self.evaluate("signals", state, inputs)
        return {name: values[..., i] for i, name in enumerate(self.signal_names)}

    def signal(self, name: str, state: ArrayLike, inputs: ArrayLike | None = None) -> Array:
        """Return one physical signal.

        Parameters
        ----------
        name : str
            One of `signal_names`.
        state, inputs : array_like
            One state and its inputs, or arrays of them.

        Returns
        -------
        ndarray
            SI units, of the shape of the leading dimensions.
        """
        with Validator("signals") as given:
            given.among("signal", name, self.signal_names)
        return self.signals(state, inputs)[name]

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        """Return limits of lengths that a simulation reports and the equations do not contain."""
        return ()

    def eigenvalues(
        self, state: ArrayLike, inputs: ArrayLike | None = None
    ) -> NDArray[np.complex128]:
        """Return the eigenvalues of the equations linearised at a state, with fixed inputs.

        Parameters
        ----------
        state, inputs : array_like
            One state.

        Returns
        -------
        ndarray of complex
            Eigenvalues of the exact Jacobian of the right-hand side [1/s], those with the largest
            imaginary part first. `kintrafo.linearise` has the modes that belong to them.
        """
        jacobian = self.evaluate("rhs_jacobian", state, inputs)
        if not self.layout.free:
            return eigenvalues_of(jacobian)
        at = self.layout.normalised(np.asanyarray(state, dtype=float))
        jacobian, rate = (self.evaluate(name, at, inputs) for name in ("rhs_jacobian", "rhs"))
        return eigenvalues_of(Tangent.at(jacobian, rate, at, self.layout).A)


@cache
def _functions(equations: ModuleType) -> tuple[str, ...]:
    """Return the names of the functions of states and inputs."""
    return tuple(name for name, made in vars(equations).items() if hasattr(made, "labels"))


def _unpickled(name: str, file: str, parameters: Mapping[str, float]) -> System:
    return System(find(name, file), parameters)


def _filled(equations: ModuleType, values: Mapping[str, float]) -> dict[str, float]:
    """Return values for all parameters: the defaults, replaced by the given ones."""
    known = {name: entry["default"] for name, entry in equations.PARAMETERS.items()}
    units = {name: entry["unit"] for name, entry in equations.PARAMETERS.items()}
    with Validator(equations.NAME) as given:
        checked = {
            given.among("parameter", name, known): given.number(
                f"parameter {shown(name)}",
                value,
                units.get(name, ""),
            )
            for name, value in values.items()
        }
    return known | checked


def _assign(array: Array, names: tuple[str, ...], values: Mapping[str, Any], what: str) -> None:
    with Validator(what) as given:
        for name, value in given.mapping(what, values, "names and values").items():
            number = given.number(f"{what} {shown(name)}", value)
            array[names.index(given.among("element", name, names))] = number


def checked_point(given: Validator, system: System, state: Any, inputs: Any) -> tuple[Array, Array]:
    """Return checked states and inputs; without inputs those of a `State`, or zeros."""
    rows = given.array("state", state, last=len(system.state_names), empty=True, finite=False)
    # with given inputs, too: a `State` of another system is an error
    held = inputs_of(state, system.names_of_states)
    columns = held if inputs is None else inputs
    count = len(system.input_names)
    if columns is None:
        return rows, np.zeros(count)
    return rows, given.array("inputs", columns, last=count, empty=True, finite=False)
