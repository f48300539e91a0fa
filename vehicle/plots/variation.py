"""Pictures of studies: bars of sensitivities, bands of tolerances, curves before and after."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, Unpack

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from ...core.quantities import bracketed, display_of, displayed, long_name
from ...pictures.curves import interrupted
from ...pictures.figures import BLUE, ORANGE, typeset, wrapped
from ...pictures.turned import turn
from ..assembly.of import assembly_of
from ..studies.curves import Curves
from ..studies.evaluation import common_positions
from ..studies.goals import Limit
from ..studies.optimise import Optimum
from ..studies.sensitivity import PLACE, Effect, effects
from ..studies.sweep_axes import sweep_axis
from ..studies.tolerance import QUANTILE
from .goals import mark, of_curve
from .panels import FigureOptions, write_panels

# Lines before and after, which also differ in black and white.
_PAIR = ((BLUE, "-"), (ORANGE, "--"))
_MOST_BARS = 10
# Bars have at most the height of these many.
_LEAST_ROOM = 4
# Letters in a line of the label of an axis.
_LETTERS = 28


def write_bars(
    dataset: xr.Dataset,
    path: str | Path,
    names: Sequence[str],
    *,
    at: float = 0.0,
    **how: Unpack[FigureOptions],
) -> Path:
    """Write bars of the largest effects on characteristics, in separate axes for each unit.

    They are those of a result of `sensitivity` at a position [m].
    """
    panels = {}
    for name in names:
        found = list(effects(dataset, name, at))
        # a characteristic without any effect has one panel
        shown = [effect for effect in found if effect.size] or found[:1]
        for unit in dict.fromkeys(effect.unit for effect in shown):
            panels[f"{name} {unit}"] = (name, [effect for effect in shown if effect.unit == unit])

    def draw(axes: Axes, key: str) -> None:
        _bars(axes, dataset, *panels[key])

    return write_panels(draw, [*panels], path, height=2.6, **how)


def write_bands(
    dataset: xr.Dataset,
    path: str | Path,
    names: Sequence[str],
    *,
    limits: Sequence[Limit] = (),
    **how: Unpack[FigureOptions],
) -> Path:
    """Write the bands of characteristics by `tolerance`, and their deviations from nominal."""
    panels = {key: name for name in names for key in (name, f"{name}, deviation")}

    def draw(axes: Axes, key: str) -> None:
        _bands(axes, dataset, panels[key], limits, deviation=key != panels[key])

    return write_panels(draw, [*panels], path, height=3.0, **how)


def write_optimum(found: Optimum, path: str | Path, **how: Unpack[FigureOptions]) -> Path:
    """Write the curves with targets and limits before and after an optimisation."""
    models = {"before": assembly_of(found.start), "after": assembly_of(found.suspension)}
    goals = [*found.targets, *found.limits]
    panels = {f"{goal.name} over {goal.over}": goal for goal in goals}
    positions = {
        over: common_positions([*models.values()], over) for over in {goal.over for goal in goals}
    }

    def draw(axes: Axes, key: str) -> None:
        panel = panels[key]
        along = positions[panel.over]
        quantity, over = panel.quantity, sweep_axis(panel.over).along
        factor, step = (display_of(each.attributes()).factor for each in (quantity, over))
        for (label, model), (colour, dashes) in zip(models.items(), _PAIR, strict=True):
            values = Curves(panel.over, along, (panel.name,)).of(model)[0]
            values, marker = interrupted(factor * values), "o" if along.size == 1 else ""
            axes.plot(step * along, values, dashes, color=colour, label=label, marker=marker)
        mark(axes, of_curve(goals, panel.name, panel.over))
        _around(axes, over.attributes() | {"long_name": over.long_name}, quantity.attributes())

    return write_panels(draw, [*panels], path, height=2.6, **how)


def _bars(axes: Axes, dataset: xr.Dataset, name: str, found: Sequence[Effect]) -> None:
    defined = [effect for effect in found if np.isfinite(effect.size)]
    moved = [e for e in defined if e.size and abs(e.size) > 1e-6 * abs(defined[0].size)]
    title = long_name(dataset[name]).removeprefix("sensitivity of ")
    words = dict(zip(dataset[PLACE].values, dataset["place_name"].values, strict=True))
    places = [str(words[effect.place]) for effect in moved[:_MOST_BARS]]
    values = [effect.size for effect in moved[:_MOST_BARS]]
    if not values:
        nothing = "no effect" if defined else "no derivative here"
        axes.text(0.5, 0.5, nothing, ha="center", va="center", transform=axes.transAxes)
        axes.set_xticks([])
        axes.set_yticks([])
        axes.set_title(title, fontsize=10)
        return
    axes.barh(places, values, color=[BLUE if v > 0.0 else ORANGE for v in values], height=0.7)
    axes.set_ylim(max(len(values), _LEAST_ROOM) - 0.5, -0.5)
    axes.axvline(0.0, color="#888888", linewidth=0.8)
    axes.grid(visible=False, axis="y")
    axes.tick_params(labelsize=8)
    axes.xaxis.set_major_locator(MaxNLocator(nbins=5))
    axes.set_xlabel(typeset(f"[{found[0].unit}]"), fontsize=9)
    axes.set_title(title, fontsize=10)


def _bands(
    axes: Axes, dataset: xr.Dataset, name: str, limits: Sequence[Limit], *, deviation: bool
) -> None:
    """Draw the bands of a characteristic, or of its deviation from the nominal car."""
    data = dataset[name]
    along = next(str(d) for d in data.dims if d != QUANTILE)
    position = displayed(dataset[along])
    nominal = displayed(dataset[f"{name}_nominal"])
    shift = nominal if deviation else np.zeros_like(nominal)
    least, low, _, high, most = displayed(data.transpose(QUANTILE, along)) - shift
    axes.fill_between(position, least, most, color=BLUE, alpha=0.15, label="all cars", linewidth=0)
    axes.fill_between(
        position, low, high, color=BLUE, alpha=0.35, label="90 % of them", linewidth=0
    )
    centre = interrupted(nominal - shift)
    axes.plot(position, centre, color="black", linewidth=1.4, label="nominal")
    words = dict(data.attrs)
    if deviation:
        words["long_name"] = f"{words['long_name']}, deviation"
    else:
        mark(axes, of_curve(limits, name, str(dataset.attrs["over"])))
    _around(axes, dataset[along].attrs, words)


def _around(axes: Axes, along: Mapping[str, Any], values: Mapping[str, Any]) -> None:
    """Label the axes, and mark the design position if it is in their range."""
    first, last = axes.dataLim.intervalx
    if first <= 0.0 <= last:
        axes.axvline(0.0, color="#888888", linewidth=0.8, zorder=1)
    axes.margins(x=0.02)
    axes.set_xlabel(typeset(bracketed(str(along["long_name"]), along)), fontsize=9)
    axes.set_ylabel(wrapped(bracketed(str(values["long_name"]), values), _LETTERS), fontsize=9.5)
    if str(along["long_name"]) == "wheel travel":
        turn(axes)
        axes.xaxis.set_major_locator(MaxNLocator(nbins=5))
