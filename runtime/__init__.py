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

from .errors import InputError, KintrafoError
from .events import SignalEvent
from .generated.macpherson import ClosureError, ModelError, ParameterError
from .input.suspension import Suspension
from .model import Model
from .positions import PositionError, Range, equilibrium, state_at_height, travel_range
from .simulation import Simulation, SimulationError, simulate

__version__ = "0.1.0"

__all__ = [
    "ClosureError",
    "InputError",
    "KintrafoError",
    "Model",
    "ModelError",
    "ParameterError",
    "PositionError",
    "Range",
    "SignalEvent",
    "Simulation",
    "SimulationError",
    "Suspension",
    "equilibrium",
    "simulate",
    "state_at_height",
    "travel_range",
]
