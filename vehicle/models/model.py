"""A suspension together with its compiled equations of motion."""

from functools import cached_property, partial
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.validator import Validator, shown
from ...systems.allowed import LengthLimit
from ...systems.system import System
from ..corner.wheel_loads import with_wheel_loads
from ..kinds import Suspension
from .packaged import equations_of


class Model(System):
    """The compiled equations of one suspension.

    Parameters
    ----------
    suspension : Suspension, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    free_rack : bool, optional
        False: the rack follows a prescribed motion; arm, knuckle and wheel carry mass, as in the
        paper. True: the rack is a third degree of freedom driven by a force, and every moving body
        carries mass. For a suspension with more elements than the paper's, these equations are
        derived and compiled at first use, as by `kintrafo.compile`.
    wheel_loads : bool, optional
        True: loads of a road, a drive shaft and a brake on the wheel are further inputs, which are
        added to the force of the tyre's spring; axes are those of the tyre (ISO 8855: forward,
        left, up). ``contact_force_x``, ``_y``, ``_z`` at the lowest point of the wheel and
        ``center_force_*`` at its centre [N], ``wheel_moment_*``, and about the spin axis
        ``shaft_torque`` from the chassis and ``hub_torque`` from the carrier [N m], positive for a
        wheel that rolls forward. These equations are derived and compiled at first use.

    Attributes
    ----------
    suspension : Suspension
        The data of the file.
    equations : module
        A module of `kintrafo.generated`, the shortest one with all elements of the suspension; or
        equations compiled for it.
    names : Names
        Names of the coordinates of every suspension in these equations.
    parameters, constants, design_state
        Numbers of the equations by name, the constants that follow from them, and the state at
        design.

    Examples
    --------
    >>> from kintrafo import Model
    >>> model = Model("reference_car")
    >>> model.equations.STATE["beta1"]["unit"]
    'rad'
    >>> round(float(model.signal("wheel_center_z", model.design_state)), 12)
    0.3
    """

    NEEDED = 'a kintrafo.Model of a suspension, such as Model("reference_car"), is needed'

    def __init__(
        self,
        suspension: Suspension | str | Path,
        *,
        free_rack: bool = False,
        wheel_loads: bool = False,
    ) -> None:
        with Validator("Model") as given:
            free_rack = given.flag("free_rack", free_rack)
            wheel_loads = given.flag("wheel_loads", wheel_loads)
        suspension = _suspension_of(suspension)
        if not free_rack:
            _refuse_neglected_mass(suspension)
        equations = equations_of(suspension, free_rack=free_rack)
        parameters = suspension.parameters()
        if wheel_loads:
            parameters |= suspension.wheel_load_parameters()
            equations = with_wheel_loads(equations)
        super().__init__(equations, parameters)
        self.suspension = suspension
        self.free_rack = free_rack
        self.wheel_loads = wheel_loads
        self.names = suspension.NAMES

    def __reduce__(self) -> tuple[Any, ...]:
        made = partial(Model, free_rack=self.free_rack, wheel_loads=self.wheel_loads)
        return made, (self.suspension,)

    def of_another(self, suspension: Suspension) -> "Model":
        """Return the model of another suspension, with the same options."""
        return Model(suspension, free_rack=self.free_rack, wheel_loads=self.wheel_loads)

    def of(self, some: NDArray[np.int64]) -> "Model":
        """Return this model: the equations are the same for all rows of an array of positions."""
        return self

    def allowed_lengths(self) -> tuple[LengthLimit, ...]:
        return self.suspension.allowed_lengths()

    @cached_property
    def mirror_image(self) -> "Model":
        """The model of the same suspension on the other side of the vehicle."""
        return self.of_another(self.suspension.mirrored())

    def __repr__(self) -> str:
        side = self.suspension.vehicle.side
        return f"<Model {self.equations.NAME} of a {side} suspension>"


def _suspension_of(given: Any) -> Suspension:
    if isinstance(given, str | Path):
        return Suspension.load(given)
    if isinstance(given, Suspension):
        return given
    problem = f"a Suspension, a name or a path is needed, not {shown(given)}."
    raise InputError([problem], "Model")


def _refuse_neglected_mass(suspension: Suspension) -> None:
    problems = [
        f"[bodies.{body}] mass_kg = {mass:g} kg: the equations with a prescribed rack leave this "
        "body without mass. Set it to zero, or use free_rack=True."
        for body, mass in suspension.neglected_masses().items()
    ]
    if problems:
        raise InputError(problems)
