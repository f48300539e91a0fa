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
    from .linearisation import Linearisation, linearise
    from .model import Model
    from .modes import Mode
    from .positions import (
        PositionError,
        Range,
        arm_angles,
        equilibrium,
        road_under_load,
        state_at_height,
        travel_range,
    )
    from .simulation import Simulation, SimulationError, simulate
    from .system import System

__version__ = version("kintrafo")

__all__ = [
    "ClosureError",
    "InputError",
    "KintrafoError",
    "Linearisation",
    "Mode",
    "Model",
    "ModelError",
    "ParameterError",
    "PositionError",
    "Range",
    "SignalEvent",
    "Simulation",
    "SimulationError",
    "Suspension",
    "System",
    "arm_angles",
    "equilibrium",
    "linearise",
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
    ".linearisation": ("Linearisation", "linearise"),
    ".model": ("Model",),
    ".modes": ("Mode",),
    ".positions": (
        "PositionError",
        "Range",
        "arm_angles",
        "equilibrium",
        "road_under_load",
        "state_at_height",
        "travel_range",
    ),
    ".simulation": ("Simulation", "SimulationError", "simulate"),
    ".system": ("System",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}


# Modules that are themselves part of the interface.
_INTERFACES = (
    "characteristics",
    "checkup",
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
    if name not in _HOMES:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return getattr(import_module(_HOMES[name], __name__), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_INTERFACES})
