"""An axle that moves on a rig: its motions one after the other, for a player."""

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from markupsafe import Markup

from ....core.named_types import Array
from ....core.quantities import display_of, displayed, long_name
from ....pictures.curves import dimension_along
from ...analysis.characteristics.datasets import dataset
from ...analysis.run import MovingCar, Run
from ...assembly.assembly import Assembly
from ...assembly.by_wheel import WHEEL
from .charts import charts_of
from .page import player
from .scene import scene_of

_MOTIONS = ("bump", "roll", "steer")
_CHARTS = ("camber", "toe", "steer")
# Duration of each motion [s], and its number of positions.
_DURATION, _POSITIONS = 3.0, 75
# Radius of drawn wheels if the file has no tyre [m].
_RADIUS = 0.3


class _RigMotion(NamedTuple):
    """A motion of the rig: states, inputs, curves over time, and the text at each position."""

    states: Array
    inputs: Array
    curves: dict[str, xr.DataArray]
    words: list[str]


def rig_player(assembly: Assembly) -> Markup:
    """Return the part of a page that plays parallel travel, roll and steering of a whole axle.

    It can move with rigid joints.
    """
    motions = list(_motions(assembly))
    states = np.concatenate([motion.states for motion in motions])
    inputs = np.concatenate([motion.inputs for motion in motions])
    count = len(states)
    times = _DURATION / _POSITIONS * np.arange(count)
    curves = {
        name: xr.concat(
            [motion.curves[name] for motion in motions], "time", combine_attrs="override"
        )
        for name in _CHARTS
    }
    over_time = xr.Dataset(curves, {"time": ("time", times, {"units": "s", "long_name": "time"})})
    axle = MovingCar(
        model=assembly.model,
        wheels=assembly.wheels,
        spins=[assembly.names_of(wheel).spin for wheel in assembly.wheels],
        radii=[radius or _RADIUS for radius in assembly.tyre_radii],
        body="",
    )
    rows = np.arange(count)
    scene = scene_of(Run(axle, over_time, states, inputs, np.zeros((count, 2))), rows)
    words = [text for motion in motions for text in motion.words]
    return player(replace(scene, words=words), charts_of(over_time, rows, _CHARTS))


def _motions(assembly: Assembly) -> Iterator[_RigMotion]:
    for motion in _MOTIONS:
        if motion not in assembly.motions:
            continue
        ends = assembly.usual(motion)[[0, -1]]
        swing = np.sin(2.0 * np.pi * np.arange(_POSITIONS) / _POSITIONS)
        along = np.where(swing < 0.0, -ends[0], ends[1]) * swing
        position = assembly.position(motion, along)
        states, inputs = assembly.at_rest(assembly.coordinates_at(position), position.rack)
        found = dataset(assembly, motion, along)
        over = found[dimension_along(found["camber"])]
        curves = found.swap_dims({over.name: "time"})
        curves = curves.drop_vars(set(curves.coords) - {WHEEL})
        unit = display_of(over.attrs).units
        words = [f"{long_name(over)} {value:.1f} {unit}" for value in displayed(over)]
        yield _RigMotion(states, inputs, {name: curves[name] for name in _CHARTS}, words)
