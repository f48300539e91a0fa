"""All characteristics of a suspension over the grid."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from ...core.named_types import Array
from ..analysis.characteristics.datasets import over
from ..analysis.characteristics.groups import group_of
from ..assembly.corner_kinematics import gaps
from ..assembly.measures.corner import AT_STOPS
from ..models.model import Model
from ..models.positions import arm_angles, design_height
from .grid import Grid
from .plotted import has_pole
from .poses import racks_of

if TYPE_CHECKING:
    from xarray import DataArray, Dataset


@dataclass(frozen=True)
class CharacteristicCurve:
    """One characteristic over wheel travel and rack displacement."""

    name: str
    over: Literal["travel", "rack"]  # abscissa of the chart
    # words for the reader
    label: str
    definition: str
    sign: str
    group: str  # its heading
    unit: str  # display unit
    factor: float  # from the SI unit to the display unit
    values: Array  # in SI units; NaN where it is not defined, (travels, racks)

    @property
    def key(self) -> str:
        """Unique name of the curve on the page."""
        return self.name if self.over == "travel" else f"{self.name}_over_rack"

    @property
    def jumps(self) -> bool:
        """Whether it jumps at the contact of a stop."""
        return self.name in AT_STOPS

    @property
    def reciprocal(self) -> bool:
        """Whether the reciprocal of the values is smoother: they have a pole, and no zero.

        The length of a swing arm is infinite where the wheel moves straight, a turning circle
        straight ahead; their curvatures, which are interpolated, are zero there.
        """
        return has_pole(self.values) and bool(np.all(np.abs(self.values) > 0.0))

    @property
    def smooth(self) -> Array:
        """The interpolated values or reciprocals, shape (travels, racks)."""
        return 1.0 / self.values if self.reciprocal else self.values

    def through_design(self, grid: Grid) -> Array:
        """Return the curve with the other coordinate at zero, SI units."""
        if self.over == "travel":
            return self.values[:, grid.rack.zero]
        return self.values[grid.travel.zero, :]


def printed(unit: str) -> str:
    """Return a unit for print: empty for a pure number, with a superscript for a square."""
    return "" if unit == "1" else unit.replace("^2", "\u00b2")


def curves(
    model: Model, travel: Array, rack: Array, *, report: Callable[[str], None] = lambda _: None
) -> list[CharacteristicCurve]:
    """Return all characteristics at every combination of travels and rack displacements [m].

    Those over travel are the first, then those over rack displacement, without undefined ones.
    """
    report("characteristics over wheel travel")
    rack = racks_of(model, rack)
    lengthwise = [over(model, "travel", travel, rack_position=float(r)) for r in rack]
    found = _stacked(lengthwise, "wheel_travel", "travel")
    if model.suspension.steered():
        report("characteristics over rack displacement")
        crosswise = [over(model, "rack", rack, travel=float(t)) for t in travel]
        found += _stacked(crosswise, "rack_position", "rack")
    return [curve for curve in found if np.isfinite(curve.values).any()]


def gaps_on(model: Model, grid: Grid) -> list[Array]:
    """Return the open gap of each stop that closes on the grid, (travels, racks) [m].

    It is negative where the stop is compressed.
    """
    rack = racks_of(model, grid.rack.values)
    angles = arm_angles(model, design_height(model) + grid.travel.values[:, None], rack)
    return [gap for gap in gaps(model, angles, rack) if gap.min() <= 0.0 < gap.max()]


def _stacked(
    cuts: "Sequence[Dataset]", coordinate: str, over: Literal["travel", "rack"]
) -> list[CharacteristicCurve]:
    """Return the variables along a coordinate, each joined from cuts through the grid."""
    axis = 1 if over == "travel" else 0
    return [
        _curve(variable, over, np.stack([cut.variables[name].values for cut in cuts], axis=axis))
        for name, variable in cuts[0].data_vars.items()
        if variable.dims == (coordinate,) and np.issubdtype(variable.dtype, np.floating)
    ]


def _curve(
    variable: "DataArray", over: Literal["travel", "rack"], values: Array
) -> CharacteristicCurve:
    words = variable.attrs
    name = str(variable.name)
    return CharacteristicCurve(
        name=name,
        over=over,
        label=str(words.get("long_name", name.replace("_", " "))),
        definition=str(words.get("definition", "")),
        sign=str(words.get("sign", "")),
        group=group_of(name),
        unit=printed(str(words.get("display_units", words.get("units", "1")))),
        factor=float(words.get("display_factor", 1.0)),
        values=values,
    )
