"""Pictures of curves of a motion, with a line at the shown time."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from matplotlib import rc_context
from numpy.typing import NDArray

from ....core.quantities import display_of, displayed, heading_of
from ....pictures.curves import draw, named_values, varying
from ....pictures.figures import STYLE, data_uri, small
from ..by_axle import by_axle
from ..handling import for_print

_SEATS = "seats"
# The drawn curves in their order, if they exist and vary.
_SHOWN = (
    "steering_wheel_angle", "lateral_acceleration", "yaw_rate", "sideslip_angle", "roll_angle",
    "speed", "longitudinal_acceleration", "pitch_angle", "body_acceleration", _SEATS, "heave",
    "pitch", "roll", "fz_front", "fz_rear", "fy_front", "fy_rear", "load", "load_front",
    "load_rear", "travel", "travel_front", "travel_rear", "road", "road_front", "road_rear",
)  # fmt: skip
_DIGITS = 4  # of the greatest value


@dataclass(frozen=True)
class Chart:
    """A curve over time as a picture, and the positions of its values in it."""

    source: str  # the picture, as the address of an image
    words: str  # description of the picture
    # left, right, top and bottom end of its axes, as parts of its width and height
    box: list[float]
    times: list[float]  # times at the left and the right end of its axes [s]
    # name, empty for a single line, and the values at the times of the scene
    lines: list[tuple[str, list[float | None]]]
    decimals: int  # number of decimals of the values as text
    unit: str  # unit of the values

    @property
    def data(self) -> dict[str, Any]:
        """The data with which a page moves its line."""
        return {name: getattr(self, name) for name in ("box", "times", "lines", "decimals", "unit")}


def charts_of(
    motion: xr.Dataset, rows: NDArray[np.intp], names: Sequence[str] | None = None
) -> list[Chart]:
    """Return curves of a motion at outputs of a scene; by default the main ones of a car."""
    dataset = for_print(by_axle(motion.transpose("time", ...)), "time")
    with rc_context(STYLE):
        shown = shown_names(dataset) if names is None else names
        return [_chart(dataset, name, rows) for name in shown]


def shown_names(dataset: xr.Dataset) -> list[str]:
    """Return the names of the main curves of a motion from `by_axle`, in their order."""
    moving = {str(name) for name in varying(dataset)}
    seats = sorted(n for n in moving if n.endswith("_acceleration") and n not in _SHOWN)
    order = [own for name in _SHOWN for own in (seats if name == _SEATS else [name])]
    return [name for name in order if name in moving]


def _chart(dataset: xr.Dataset, name: str, rows: NDArray[np.intp]) -> Chart:
    drawn = small(draw(dataset, [name], alone=False))
    (axes,) = drawn.axes[:1]
    place = axes.get_position()
    data = dataset[name]
    lines = _lines(data)
    greatest = max(float(np.nanmax(np.abs(values))) for _, values in lines)
    decimals = int(np.clip(_DIGITS - 1 - np.floor(np.log10(greatest)), 0, 6))

    def written(values: NDArray[np.float64]) -> list[float | None]:
        return [round(float(v), decimals) + 0.0 if np.isfinite(v) else None for v in values]

    return Chart(
        source=data_uri(drawn),
        words=heading_of(data),
        box=[place.x0, place.x1, 1.0 - place.y1, 1.0 - place.y0],
        times=list(axes.get_xlim()),
        lines=[(words, written(values[rows])) for words, values in lines],
        decimals=decimals,
        unit=display_of(data.attrs).units.replace("^2", "²"),
    )


def _lines(data: xr.DataArray) -> list[tuple[str, NDArray[np.float64]]]:
    """Return the name and the values of each line."""
    values = displayed(data)
    if data.ndim == 1:
        return [("", values)]
    across = next(str(d) for d in data.dims if d != "time")
    values = values if data.dims[0] != "time" else values.T
    return [(name, values[i]) for i, name in named_values(data[across]).items()]
