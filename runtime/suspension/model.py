"""A suspension together with its compiled equations of motion."""

from functools import cache, partial
from pathlib import Path
from types import ModuleType
from typing import Any, NamedTuple

from ..core.arguments import Arguments, shown
from ..core.errors import InputError
from ..generated import double_wishbone, macpherson, macpherson_free_rack, macpherson_general
from ..systems.system import System
from .input.suspension import Suspension
from .kinds.macpherson import MacPherson

# Bodies that the paper's equations leave without mass.
_MASSLESS_IN_THE_PAPER = ("tie_rod", "rack", "upper_strut")


class Names(NamedTuple):
    """What the equations call that which every suspension has.

    Attributes
    ----------
    arm, spin : str
        States: angle of the lower arm, which falls as the wheel rises, and of the wheel [rad].
    rack : str
        Relative coordinate, and with a free rack a state: displacement of the rack [m].
    actuator : str
        Input: force of an actuator in the strut, or beside the spring [N].
    """

    arm: str
    spin: str
    rack: str
    actuator: str


# The equations of the paper's suspension, whatever was added to it, keep the paper's names.
_MACPHERSON = Names("beta1", "beta5", "beta9", "strut_force")
_DOUBLE_WISHBONE = Names("arm_angle", "spin_angle", "rack_displacement", "spring_actuator")


class Model(System):
    """The compiled equations of one suspension.

    Parameters
    ----------
    suspension : Suspension, str or Path
        The data, or the name of a packaged data set or path of a TOML file.
    free_rack : bool, optional
        False: the rack follows a prescribed motion; arm, knuckle and wheel carry mass, as in the
        paper. True: the rack is a third degree of freedom driven by a force, and every moving body
        carries mass. For a suspension that has more than the paper's, these equations are derived
        and compiled when they are first needed, as by `kintrafo.compile`.

    Attributes
    ----------
    suspension : Suspension
    equations : module
        `kintrafo.generated.macpherson`, ``macpherson_free_rack``, ``macpherson_general`` or
        ``double_wishbone``; or compiled for this.
    names : Names
        What these equations call the coordinates that every suspension has.
    parameters, constants, design_state
        As of `System`.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> model.equations.STATE["beta1"]["unit"]
    'rad'
    >>> round(float(model.signal("wheel_center_z", model.design_state)), 12)
    0.3
    """

    NEEDED = 'a kintrafo.Model of a suspension, such as Model("reference_car"), is needed'

    def __init__(self, suspension: Suspension | str | Path, *, free_rack: bool = False) -> None:
        with Arguments("Model") as given:
            free_rack = given.flag("free_rack", free_rack)
        suspension = _suspension_of(suspension)
        if not free_rack:
            _refuse_neglected_mass(suspension)
        equations = _equations_for(suspension, free_rack=free_rack)
        super().__init__(equations, suspension.parameters())
        self.suspension = suspension
        self.free_rack = free_rack
        self.names = _MACPHERSON if isinstance(suspension, MacPherson) else _DOUBLE_WISHBONE

    def __reduce__(self) -> tuple[Any, ...]:
        return partial(Model, free_rack=self.free_rack), (self.suspension,)

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


def _equations_for(suspension: Suspension, *, free_rack: bool) -> ModuleType:
    """Return the shortest equations that have everything that a suspension has."""
    if isinstance(suspension, MacPherson):
        return _macpherson(suspension, free_rack=free_rack)
    if free_rack:
        problem = f"free_rack=True: the rack of a {suspension.TITLE} is prescribed. Leave that out."
        raise InputError([problem], "Model")
    return double_wishbone


def _macpherson(suspension: MacPherson, *, free_rack: bool) -> ModuleType:
    if not suspension.beyond_the_paper():
        return macpherson_free_rack if free_rack else macpherson
    return _general_free_rack() if free_rack else macpherson_general


@cache
def _general_free_rack() -> ModuleType:
    """Return the equations with everything, which do not come compiled: they are seldom wanted."""
    from ..systems.compile.build import compile_mechanism, require_generator  # noqa: PLC0415 (an extra)

    require_generator()
    from ..generator.mechanisms.macpherson import GENERAL_FREE_RACK  # noqa: PLC0415

    return compile_mechanism(GENERAL_FREE_RACK)


def neglected_masses(suspension: Suspension) -> dict[str, float]:
    """Return the bodies whose mass counts only with a free rack.

    Parameters
    ----------
    suspension : Suspension

    Returns
    -------
    dict of str to float
        Name to mass [kg], more than zero; empty where the rack may be prescribed.
    """
    rigid = suspension.bodies.rigid()
    masses = {name: rigid[name].mass_kg for name in _MASSLESS_IN_THE_PAPER if name in rigid}
    return {name: mass for name, mass in masses.items() if mass > 0.0}


def _refuse_neglected_mass(suspension: Suspension) -> None:
    problems = [
        f"[bodies.{body}] mass_kg = {mass:g} kg: the equations with a prescribed rack leave this "
        "body without mass. Set it to zero, or use free_rack=True."
        for body, mass in neglected_masses(suspension).items()
    ]
    if problems:
        raise InputError(problems)
