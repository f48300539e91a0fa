"""A suspension together with its compiled equations of motion."""

from collections.abc import Mapping
from functools import partial
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError
from .generated import macpherson, macpherson_free_rack, macpherson_general
from .input.suspension import Suspension
from .modes import eigenvalues_of

Array = NDArray[np.float64]

# Bodies that the paper's equations leave without mass.
_MASSLESS_IN_THE_PAPER = ("tie_rod", "rack", "upper_strut")


class Model:
    """The compiled equations of one suspension.

    Parameters
    ----------
    suspension : Suspension, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    free_rack : bool, optional
        False: the rack follows a prescribed motion; arm, knuckle and wheel carry mass, as in the
        paper. True: the rack is a third degree of freedom driven by a force, and every moving body
        carries mass.

    Attributes
    ----------
    suspension : Suspension
    equations : module
        The compiled module, `kintrafo.generated.macpherson` or ``macpherson_free_rack``.
    constants : ndarray
        What the compiled functions take for this suspension.
    design_state : ndarray
        State at the design position, at rest.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> model.equations.STATE["beta1"]["unit"]
    'rad'
    >>> round(float(model.signal("wheel_center_z", model.design_state)), 12)
    0.3
    """

    def __init__(self, suspension: Suspension | str | Path, *, free_rack: bool = False) -> None:
        suspension = _suspension_of(suspension)
        parameters = suspension.parameters()
        if not free_rack:
            _refuse_neglected_mass(parameters)
        self.suspension = suspension
        self.free_rack = free_rack
        self.equations: ModuleType = _equations_for(suspension, free_rack=free_rack)
        self.constants: Array = self.equations.prepare(parameters)
        self.design_state = self._design_state(parameters)

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(Model, free_rack=self.free_rack), (self.suspension,)

    def __repr__(self) -> str:
        side = self.suspension.vehicle.side
        return f"<Model {self.equations.NAME} of a {side} suspension>"

    # -- names ----------------------------------------------------------------------------------

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names of the state's elements, in order."""
        return tuple(self.equations.STATE)

    @property
    def input_names(self) -> tuple[str, ...]:
        """Names of the inputs, in order."""
        return tuple(self.equations.INPUTS)

    @property
    def signal_names(self) -> tuple[str, ...]:
        """Names of the physical signals, in order."""
        return tuple(self.equations.SIGNALS)

    # -- building arrays --------------------------------------------------------------------------

    def state(self, **values: float) -> Array:
        """Return a state, at the design position and at rest where nothing is given.

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
        """Return the array of inputs, zero where nothing is given.

        Parameters
        ----------
        values : mapping, optional
            Inputs by name, SI units.

        Returns
        -------
        ndarray, shape (number of inputs,)
        """
        array = np.zeros(len(self.input_names))
        _assign(array, self.input_names, values or {}, "inputs")
        return array

    def _design_state(self, parameters: Mapping[str, float]) -> Array:
        """Return the arm angle of the design position (Eq. 6), everything else zero."""
        state = np.zeros(len(self.state_names))
        state[0] = _design_arm_angle(parameters)
        return state

    # -- evaluation -------------------------------------------------------------------------------

    def evaluate(self, function: str, state: ArrayLike, inputs: ArrayLike | None = None) -> Array:
        """Evaluate a compiled function with the constants of this suspension.

        Parameters
        ----------
        function : str
            Name of a function of `equations`.
        state, inputs : array_like
            One or many, as in the compiled module.

        Returns
        -------
        ndarray
            Shape of the result behind the leading dimensions.
        """
        result: Array = getattr(self.equations, function)(state, inputs, self.constants)
        return result

    def signals(self, state: ArrayLike, inputs: ArrayLike | None = None) -> dict[str, Array]:
        """Return all physical signals by name, in SI units.

        Parameters
        ----------
        state, inputs : array_like
            One or many, as in the compiled module.

        Returns
        -------
        dict
            Name to array over the leading dimensions; see ``equations.SIGNALS`` for units, signs.
        """
        values = self.evaluate("signals", state, inputs)
        return {name: values[..., i] for i, name in enumerate(self.signal_names)}

    def signal(self, name: str, state: ArrayLike, inputs: ArrayLike | None = None) -> Array:
        """Return one physical signal."""
        if name not in self.signal_names:
            message = f"no signal {name!r}; there are {', '.join(self.signal_names)}"
            raise InputError([message], "signals")
        return self.signals(state, inputs)[name]

    def eigenvalues(
        self, state: ArrayLike, inputs: ArrayLike | None = None
    ) -> NDArray[np.complex128]:
        """Return the eigenvalues of the equations linearised at a state, inputs held.

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
        return eigenvalues_of(self.evaluate("rhs_jacobian", state, inputs))


def _assign(array: Array, names: tuple[str, ...], values: Mapping[str, Any], what: str) -> None:
    unknown = [name for name in values if name not in names]
    if unknown:
        raise InputError(
            [f"{what}: {name!r} is not known; there are {', '.join(names)}." for name in unknown]
        )
    for name, value in values.items():
        array[names.index(name)] = value


def _suspension_of(given: Any) -> Suspension:
    if isinstance(given, str | Path):
        return Suspension.load(given)
    if isinstance(given, Suspension):
        return given
    problem = f"a Suspension, a name or a path is needed, not {type(given).__name__}."
    raise InputError([problem], "Model")


def _equations_for(suspension: Suspension, *, free_rack: bool) -> ModuleType:
    """Return the shortest equations that have everything that a suspension has."""
    beyond = suspension.beyond_the_paper()
    if not beyond:
        return macpherson_free_rack if free_rack else macpherson
    if free_rack:
        problem = (
            f"free_rack=True: the equations with a free rack are those of the paper's suspension, "
            f"but this one has {', '.join(beyond)}. Leave that out, or prescribe the rack."
        )
        raise InputError([problem], "Model")
    return macpherson_general


def _refuse_neglected_mass(parameters: Mapping[str, float]) -> None:
    heavy = [body for body in _MASSLESS_IN_THE_PAPER if parameters[f"{body}_mass"] > 0.0]
    if heavy:
        raise InputError(
            [
                f"[bodies.{body}] mass_kg = {parameters[f'{body}_mass']:g} kg: the equations with "
                "a prescribed rack leave this body without mass. Set it to zero, or use "
                "free_rack=True."
                for body in heavy
            ]
        )


def _design_arm_angle(parameters: Mapping[str, float]) -> float:
    """Return beta1 at the design position [rad]: from the upward normal of the hinge to the arm."""
    front, rear, ball = (
        np.array([parameters[f"{point}_{axis}"] for axis in "xyz"])
        for point in ("arm_front", "arm_rear", "ball_joint")
    )
    hinge = (front - rear) / np.linalg.norm(front - rear)
    up = np.array([0.0, 0.0, 1.0])
    up -= hinge * (hinge @ up)
    arm = ball - rear
    arm -= hinge * (hinge @ arm)
    return float(np.arctan2(np.linalg.norm(np.cross(up, arm)), up @ arm))
