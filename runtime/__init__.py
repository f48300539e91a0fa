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
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .assembly.equilibrium import equilibrium
    from .core.errors import InputError, KintrafoError
    from .equations.errors import ClosureError, ModelError, ParameterError
    from .report.animation import animate
    from .simulation.backwards import MotionGradient, motion_gradient
    from .simulation.events import SignalEvent
    from .simulation.forwards import MotionSensitivity, motion_sensitivity
    from .simulation.interpolation import Samples
    from .simulation.result import Simulation, SimulationError
    from .simulation.simulate import simulate
    from .simulation.stepper import Stepper
    from .study.ensembles import ensemble
    from .suspension.axle import Axle
    from .suspension.axle.equations import AxleModel
    from .suspension.kinds import Suspension
    from .suspension.loading import load
    from .suspension.model import Model
    from .suspension.positions import (
        PositionError,
        Range,
        arm_angles,
        road_under_load,
        state_at_height,
        travel_range,
    )
    from .suspension.rigid import RigidAxle
    from .suspension.rigid.model import RigidAxleModel
    from .systems.compile import CompilerError, MechanismError, proposals, write_derivation
    from .systems.compile import compile_mechanism as compile  # noqa: A004 (what the user calls it)
    from .systems.derivatives import derivative, design_derivative, gradient
    from .systems.linearisation import Linearisation, linearise
    from .systems.modes import Mode
    from .systems.rest import rest
    from .systems.state import State
    from .systems.system import System
    from .targets.export import export_model

__version__: str

__all__ = [
    "Axle",
    "AxleModel",
    "ClosureError",
    "CompilerError",
    "InputError",
    "KintrafoError",
    "Linearisation",
    "MechanismError",
    "Mode",
    "Model",
    "ModelError",
    "MotionGradient",
    "MotionSensitivity",
    "ParameterError",
    "PositionError",
    "Range",
    "RigidAxle",
    "RigidAxleModel",
    "Samples",
    "SignalEvent",
    "Simulation",
    "SimulationError",
    "State",
    "Stepper",
    "Suspension",
    "System",
    "animate",
    "arm_angles",
    "compile",
    "derivative",
    "design_derivative",
    "ensemble",
    "equilibrium",
    "export_model",
    "gradient",
    "linearise",
    "load",
    "motion_gradient",
    "motion_sensitivity",
    "proposals",
    "rest",
    "road_under_load",
    "simulate",
    "state_at_height",
    "travel_range",
    "write_derivation",
]

# Names are loaded when they are first used: the generator is part of this package, and must run
# where no model has been generated or compiled yet.
_MODULES = {
    ".assembly.equilibrium": ("equilibrium",),
    ".core.errors": ("InputError", "KintrafoError"),
    ".simulation.events": ("SignalEvent",),
    ".equations.errors": ("ClosureError", "ModelError", "ParameterError"),
    ".suspension.axle": ("Axle",),
    ".suspension.axle.equations": ("AxleModel",),
    ".suspension.kinds": ("Suspension",),
    ".simulation.interpolation": ("Samples",),
    ".simulation.backwards": ("MotionGradient", "motion_gradient"),
    ".simulation.forwards": ("MotionSensitivity", "motion_sensitivity"),
    ".systems.derivatives": ("derivative", "design_derivative", "gradient"),
    ".systems.linearisation": ("Linearisation", "linearise"),
    ".systems.rest": ("rest",),
    ".suspension.loading": ("load",),
    ".suspension.model": ("Model",),
    ".systems.modes": ("Mode",),
    ".systems.compile": (
        "CompilerError",
        "MechanismError",
        "compile_mechanism",
        "proposals",
        "write_derivation",
    ),
    ".suspension.positions": (
        "PositionError",
        "Range",
        "arm_angles",
        "road_under_load",
        "state_at_height",
        "travel_range",
    ),
    ".suspension.rigid": ("RigidAxle",),
    ".suspension.rigid.model": ("RigidAxleModel",),
    ".simulation.result": ("Simulation", "SimulationError"),
    ".report.animation": ("animate",),
    ".simulation.simulate": ("simulate",),
    ".simulation.stepper": ("Stepper",),
    ".study.ensembles": ("ensemble",),
    ".systems.state": ("State",),
    ".systems.system": ("System",),
    ".targets.export": ("export_model",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}
# Where this name would hide one of Python's at home.
_OTHER_NAMES = {"compile": "compile_mechanism"}


# Modules that are themselves part of the interface, and where they are.
_INTERFACES = {
    "adams_car": ".suspension.adams_car",
    "characteristics": ".study.characteristics",
    "checkup": ".study.checkup",
    "chrono": ".suspension.chrono",
    "compare": ".study.compare",
    "compliance": ".study.compliance",
    "excitation": ".study.excitation",
    "export": ".study.export",
    "loads": ".study.loads",
    "measurement": ".study.measurement",
    "plots": ".plots",
    "point_table": ".suspension.point_table",
    "report": ".report",
    "rig": ".study.rig",
    "roads": ".simulation.roads",
    "scenario": ".study.scenario",
    "schema": ".suspension.schema",
    "sheet": ".study.sheet",
    "starter": ".suspension.starter",
    "sweep": ".study.sweep",
    "topology": ".systems.topology",
    "variation": ".study.variation",
}


def __getattr__(name: str) -> Any:
    if name in _INTERFACES:
        return import_module(_INTERFACES[name], __name__)
    if name == "__version__":
        from importlib.metadata import version  # noqa: PLC0415 (slow to import)

        return version(__name__)
    at_home = _OTHER_NAMES.get(name, name)
    if at_home not in _HOMES:
        message = f"module {__name__!r} has no attribute {name!r}"
        raise AttributeError(message)
    return getattr(import_module(_HOMES[at_home], __name__), at_home)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_INTERFACES})


import_module(".notebook", __name__).register()
