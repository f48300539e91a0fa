"""Spectra of a car on a rough road, and its responses to the road, over frequency."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
from numpy.typing import NDArray

from ...core.legible import power_of_ten
from ...core.quantities import displayed, heading_of, names_in_words
from ...core.validator import Validator
from ...pictures.curves import draw
from ...pictures.figures import small
from .by_axle import by_axle

_ROAD_WHEEL = "road_wheel"
# Most dimensions: responses of each wheel to the road under each wheel are too many lines.
_MOST = 2
# Least value of an axis, relative to the greatest value of its curve.
_LEAST = 1e-4
# Room for names of lines below the least value, as a factor.
_BELOW = 0.1


def response_figures(response: xr.Dataset) -> dict[str, Figure]:
    """Return spectra and responses over frequency, in logarithmic axes, by their headings.

    The spectra are followed by the responses of the body to the road under each wheel; for one
    wheel by all responses.
    """
    with Validator("response_figures") as given:
        given.dataset(response, over="frequency")
    whole = by_axle(response.drop_vars([n for n, data in response.items() if data.ndim > _MOST]))
    if whole.sizes.get(_ROAD_WHEEL) == 1:
        whole = whole.squeeze(_ROAD_WHEEL, drop=True)
    else:
        whole = whole.assign_coords({_ROAD_WHEEL: names_in_words(whole[_ROAD_WHEEL])})
    by_road = [str(name) for name in whole if str(name).endswith("_by_road")]
    names = [*(str(name) for name in whole if name not in by_road), *by_road]
    return {heading_of(whole[name]): _figure(whole[name]) for name in names}


def _figure(data: xr.DataArray) -> Figure:
    drawn = draw(data.transpose("frequency", ...).to_dataset(), [str(data.name)], alone=False)
    (axes,) = drawn.axes
    _make_logarithmic(axes, displayed(data))
    if _ROAD_WHEEL in data.dims:
        names = list(map(str, data[_ROAD_WHEEL].values))
        axes.legend(axes.get_lines()[: len(names)], names, fontsize=8, ncols=2, loc="lower center")
    return small(drawn)


def _make_logarithmic(axes: Axes, values: NDArray[np.float64]) -> None:
    most = float(np.nanmax(values))
    least = max(_LEAST * most, _BELOW * float(np.nanmin(values)))
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_ylim(least, 3.0 * most)
    axes.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda x, _: f"{x:g}"))
    axes.yaxis.set_major_locator(LogLocator(numticks=6))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda y, _: power_of_ten(round(np.log10(y)))))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
