"""kintrafo: closed-form equations of motion for mechanisms with loops, compiled and simulated.

Examples
--------
>>> import kintrafo
>>> model = kintrafo.Model("reference_car")
>>> rest = kintrafo.equilibrium(model)
>>> start = kintrafo.state_at_height(model, 0.325, spin_rate=93.0)
>>> result = kintrafo.simulate(model, (0.0, 1.0), start)
>>> sorted(result.signals)[:3]
['camber', 'damper_force', 'spring_force']
"""

from importlib import import_module
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .errors import InputError, KintrafoError
    from .events import SignalEvent
    from .generated._support import ClosureError, ModelError, ParameterError
    from .input.suspension import Suspension
    from .interpolation import Samples
    from .linearisation import Linearisation, linearise
    from .model import Model
    from .modes import Mode
    from .own import CompilerError, MechanismError, proposals
    from .own import compile_mechanism as compile  # noqa: A004 (what the user calls it)
    from .positions import (
        PositionError,
        Range,
        arm_angles,
        equilibrium,
        road_under_load,
        state_at_height,
        travel_range,
    )
    from .result import Simulation, SimulationError
    from .simulation import simulate
    from .state import State
    from .system import System

__version__ = version("kintrafo")

__all__ = [
    "ClosureError",
    "CompilerError",
    "InputError",
    "KintrafoError",
    "Linearisation",
    "MechanismError",
    "Mode",
    "Model",
    "ModelError",
    "ParameterError",
    "PositionError",
    "Range",
    "Samples",
    "SignalEvent",
    "Simulation",
    "SimulationError",
    "State",
    "Suspension",
    "System",
    "arm_angles",
    "compile",
    "equilibrium",
    "linearise",
    "proposals",
    "road_under_load",
    "simulate",
    "state_at_height",
    "travel_range",
]

# Names are loaded when they are first used: the generator is part of this package, and must run
# where no model has been generated or compiled yet.
_MODULES = {
    ".errors": ("InputError", "KintrafoError"),
    ".events": ("SignalEvent",),
    ".generated._support": ("ClosureError", "ModelError", "ParameterError"),
    ".input.suspension": ("Suspension",),
    ".interpolation": ("Samples",),
    ".linearisation": ("Linearisation", "linearise"),
    ".model": ("Model",),
    ".modes": ("Mode",),
    ".own": ("CompilerError", "MechanismError", "compile_mechanism", "proposals"),
    ".positions": (
        "PositionError",
        "Range",
        "arm_angles",
        "equilibrium",
        "road_under_load",
        "state_at_height",
        "travel_range",
    ),
    ".result": ("Simulation", "SimulationError"),
    ".simulation": ("simulate",),
    ".state": ("State",),
    ".system": ("System",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}
# Where this name would hide one of Python's at home.
_OTHER_NAMES = {"compile": "compile_mechanism"}


# Modules that are themselves part of the interface.
_INTERFACES = (
    "characteristics",
    "checkup",
    "chrono",
    "compare",
    "excitation",
    "export",
    "measurement",
    "plots",
    "roads",
    "scenario",
    "sweep",
)


def __getattr__(name: str) -> Any:
    if name in _INTERFACES:
        return import_module(f".{name}", __name__)
    at_home = _OTHER_NAMES.get(name, name)
    if at_home not in _HOMES:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return getattr(import_module(_HOMES[at_home], __name__), at_home)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_INTERFACES})
