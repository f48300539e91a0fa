"""The chapter about a car at rest: what it is, how it looks, and what its wheels carry."""

from typing import Any

import numpy as np
import xarray as xr

from ....core.quantities import displayed, heading_of
from ....core.tabulated import Tabulated, number
from ...analysis.ride.rest import of_state
from ...analysis.ride.subject import car_assembly, riding_car
from ...analysis.run import Run
from ...assembly.by_wheel import WHEEL
from ...assembly.equilibrium import equilibrium
from ...plots.motion.page import player
from ...plots.motion.scene import scene_of
from .chapter import Chapter


def rest_chapter(subject: Any) -> Chapter:
    """Return the chapter of a car that rests on a level road, with a view of it.

    Parameters
    ----------
    subject : Car or CarModel

    Returns
    -------
    Chapter

    Raises
    ------
    InputError, PositionError
        As of `kintrafo.ride.at_rest`.
    """
    assembly = car_assembly("rest_chapter", subject, riding=False)
    model = assembly.model
    rest = equilibrium(model)
    state, inputs = np.asarray(rest), np.asarray(rest.inputs)
    found = of_state(assembly, state)
    loads = np.atleast_1d(found["load"].values)
    motion = xr.Dataset(
        {"load": (("time", WHEEL), loads[None]), "road": (("time", WHEEL), 0.0 * loads[None])},
        {"time": [0.0]},
    )
    car = riding_car(assembly, state, inputs)
    run = Run(car, motion, state[None], inputs[None], np.zeros((1, 2)))
    facts = tuple(assembly.described().items())
    described = Tabulated("What it is", ("", "value"), facts, frozenset({0, 1}))
    return Chapter(
        title="The car at rest",
        words=(assembly.words,),
        tables=(described, *_tables(found)),
        players=(player(scene_of(run, np.array([0]))),),
    )


def _tables(found: xr.Dataset) -> tuple[Tabulated, ...]:
    """Return what is of the wheels, a column for each, and what is of the body."""
    of_body = [data for data in found.values() if str(data.name) in _OF_BODY]
    of_wheels = [data for data in found.values() if str(data.name) not in _OF_BODY]
    wheels = [str(name).replace("_", " ") for name in found[WHEEL].values.ravel()]
    sheets = []
    for title, heads, some in (
        ("Wheels", wheels, of_wheels), ("Body", ["value"], of_body),
    ):  # fmt: skip
        rows = tuple((heading_of(d), *_written(d)) for d in some)
        sheets.append(Tabulated(title, ("", *heads), rows))
    return tuple(sheets)


def _written(data: xr.DataArray) -> list[str]:
    """Return values with the digits that matter: a tenth of a newton, thousandths of others."""
    values = displayed(data).ravel()
    return [f"{v:.1f}" if data.attrs["units"] == "N" else number(float(v)) for v in values]


_OF_BODY = ("heave", "pitch", "roll")
