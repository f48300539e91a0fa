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
    from .core.errors import InputError, KintrafoError
    from .core.optional import MissingPackageError
    from .ensembles import ensemble
    from .ensembles.chunks.queue import ClusterError
    from .equations.errors import ClosureError, ModelError, ParameterError
    from .pages.animation import animate
    from .simulation.backwards import MotionGradient, motion_gradient
    from .simulation.events import SignalEvent
    from .simulation.forwards import MotionSensitivity, motion_sensitivity
    from .simulation.interpolation import Samples
    from .simulation.result import Simulation, SimulationError
    from .simulation.simulate import simulate
    from .simulation.stepper import Stepper
    from .systems.compile import CompilerError, MechanismError, proposals, write_derivation
    from .systems.compile import compile_mechanism as compile  # noqa: A004 (the public name)
    from .systems.derivatives import derivative, design_derivative, gradient
    from .systems.linearisation import Linearisation, linearise
    from .systems.modes import Mode
    from .systems.rest import rest
    from .systems.state import State
    from .systems.system import System
    from .targets.export import export_model
    from .vehicle.assembly.equilibrium import equilibrium
    from .vehicle.assembly.of import model_of
    from .vehicle.files.loading import load
    from .vehicle.kinds import Suspension
    from .vehicle.models.axle import Axle
    from .vehicle.models.axle.equations import AxleModel
    from .vehicle.models.car import Car
    from .vehicle.models.car.equations import CarModel
    from .vehicle.models.model import Model
    from .vehicle.models.positions import (
        AngleRange,
        PositionError,
        arm_angles,
        road_under_load,
        state_at_height,
        travel_range,
    )
    from .vehicle.models.rigid_axle import RigidAxle
    from .vehicle.models.rigid_axle.model import RigidAxleModel

__version__: str

__all__ = [
    "AngleRange",
    "Axle",
    "AxleModel",
    "Car",
    "CarModel",
    "ClosureError",
    "ClusterError",
    "CompilerError",
    "InputError",
    "KintrafoError",
    "Linearisation",
    "MechanismError",
    "MissingPackageError",
    "Mode",
    "Model",
    "ModelError",
    "MotionGradient",
    "MotionSensitivity",
    "ParameterError",
    "PositionError",
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
    "model_of",
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

# Names are loaded at first use: the generator is part of this package and must run where no model
# has been generated or compiled yet.
_MODULES = {
    ".vehicle.assembly.equilibrium": ("equilibrium",),
    ".vehicle.assembly.of": ("model_of",),
    ".core.errors": ("InputError", "KintrafoError"),
    ".core.optional": ("MissingPackageError",),
    ".ensembles.chunks.queue": ("ClusterError",),
    ".simulation.events": ("SignalEvent",),
    ".equations.errors": ("ClosureError", "ModelError", "ParameterError"),
    ".vehicle.models.axle": ("Axle",),
    ".vehicle.models.axle.equations": ("AxleModel",),
    ".vehicle.models.car": ("Car",),
    ".vehicle.models.car.equations": ("CarModel",),
    ".vehicle.kinds": ("Suspension",),
    ".simulation.interpolation": ("Samples",),
    ".simulation.backwards": ("MotionGradient", "motion_gradient"),
    ".simulation.forwards": ("MotionSensitivity", "motion_sensitivity"),
    ".systems.derivatives": ("derivative", "design_derivative", "gradient"),
    ".systems.linearisation": ("Linearisation", "linearise"),
    ".systems.rest": ("rest",),
    ".vehicle.files.loading": ("load",),
    ".vehicle.models.model": ("Model",),
    ".systems.modes": ("Mode",),
    ".systems.compile": (
        "CompilerError",
        "MechanismError",
        "compile_mechanism",
        "proposals",
        "write_derivation",
    ),
    ".vehicle.models.positions": (
        "PositionError",
        "AngleRange",
        "arm_angles",
        "road_under_load",
        "state_at_height",
        "travel_range",
    ),
    ".vehicle.models.rigid_axle": ("RigidAxle",),
    ".vehicle.models.rigid_axle.model": ("RigidAxleModel",),
    ".simulation.result": ("Simulation", "SimulationError"),
    ".pages.animation": ("animate",),
    ".simulation.simulate": ("simulate",),
    ".simulation.stepper": ("Stepper",),
    ".ensembles": ("ensemble",),
    ".systems.state": ("State",),
    ".systems.system": ("System",),
    ".targets.export": ("export_model",),
}
_HOMES = {name: module for module, names in _MODULES.items() for name in names}
# Public names that would hide one of Python's in their own module.
_OTHER_NAMES = {"compile": "compile_mechanism"}


# Public modules by name.
_INTERFACES = {
    "adams_car": ".vehicle.files.adams_car",
    "characteristics": ".vehicle.analysis.characteristics",
    "checkup": ".vehicle.analysis.checkup",
    "chrono": ".vehicle.files.chrono",
    "compare": ".vehicle.analysis.compare",
    "compliance": ".vehicle.analysis.compliance",
    "excitation": ".vehicle.analysis.excitation",
    "export": ".datasets.export",
    "handling": ".vehicle.analysis.handling",
    "loads": ".vehicle.analysis.loads",
    "measurement": ".vehicle.analysis.measurement",
    "plots": ".vehicle.plots",
    "point_table": ".vehicle.files.point_table",
    "report": ".vehicle.report",
    "rig": ".vehicle.analysis.rig",
    "ride": ".vehicle.analysis.ride",
    "road_profiles": ".vehicle.roads",
    "roads": ".vehicle.analysis.roads",
    "scenario": ".vehicle.analysis.scenario",
    "schema": ".vehicle.files.schema",
    "sheet": ".vehicle.analysis.sheet",
    "starter": ".vehicle.data.starter",
    "sweep": ".vehicle.analysis.sweep",
    "topology": ".systems.topology",
    "tyres": ".vehicle.tyres",
    "variation": ".vehicle.studies",
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
