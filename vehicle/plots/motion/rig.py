"""An axle that moves on a rig: its motions one after the other, for a player."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
import xarray as xr
from markupsafe import Markup

from ....core.named_types import Array
from ....core.quantities import display_of, displayed, long_name
from ....pictures.curves import dimension_along
from ....systems.system import System
from ...analysis.characteristics.datasets import dataset
from ...analysis.run import Run
from ...assembly.assembly import Assembly
from ...assembly.by_wheel import WHEEL
from ...assembly.car import CarAssembly
from .charts import charts_of
from .page import player
from .scene import scene_of

_MOTIONS = ("bump", "roll", "steer")
_CHARTS = ("camber", "toe", "steer")
# Time of each motion [s], and positions in it.
_DURATION, _POSITIONS = 3.0, 75
# Radius of the drawn wheels without one in the file [m].
_RADIUS = 0.3


@dataclass(frozen=True)
class _OnARig:
    """An axle with the properties that pictures of a moving car need; its body is held."""

    model: System
    wheels: Sequence[str]
    spins: Sequence[str]
    radii: Sequence[float]
    body: str = ""
    assembly: CarAssembly | None = None


class _Part(NamedTuple):
    """A motion: states, inputs, curves over time, and the text at each position."""

    states: Array
    inputs: Array
    curves: dict[str, xr.DataArray]
    words: list[str]


def on_a_rig(assembly: Assembly) -> Markup:
    """Return the part of a page that plays parallel travel, roll and steering of an axle.

    Parameters
    ----------
    assembly : Assembly
        An axle with equations of its own for both wheels; it must move with rigid joints.
    """
    parts = list(_parts(assembly))
    count = sum(len(part.states) for part in parts)
    times = _DURATION / _POSITIONS * np.arange(count)
    curves = {
        name: xr.concat([part.curves[name] for part in parts], "time", combine_attrs="override")
        for name in _CHARTS
    }
    motion = xr.Dataset(curves, {"time": ("time", times, {"units": "s", "long_name": "time"})})
    states, inputs = (np.concatenate([part[i] for part in parts]) for i in (0, 1))
    car = _OnARig(
        assembly.model,
        assembly.wheels,
        [assembly.names_of(wheel).spin for wheel in assembly.wheels],
        [radius or _RADIUS for radius in assembly.tyre_radii],
    )
    rows = np.arange(count)
    scene = scene_of(Run(car, motion, states, inputs, np.zeros((count, 2))), rows)
    words = [text for part in parts for text in part.words]
    return player(replace(scene, words=words), charts_of(motion, rows, _CHARTS))


def _parts(assembly: Assembly) -> Iterator[_Part]:
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
        yield _Part(states, inputs, {name: curves[name] for name in _CHARTS}, words)
