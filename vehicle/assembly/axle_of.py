"""The assembly of any axle."""

from ..models.car.car import AnyAxle
from ..models.whole_axle import WholeAxle
from .axle import AxleAssembly
from .steered import SteerableAssembly
from .whole_axle import whole_axle_assembly


def axle_assembly(axle: AnyAxle) -> SteerableAssembly:
    """Return an axle of two sides, or one without sides, as an assembly."""
    if isinstance(axle, WholeAxle):
        return whole_axle_assembly(axle.KEY)(axle)
    return AxleAssembly(axle)
