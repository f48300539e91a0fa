"""The chapter of a car at rest: its data, a view of it, and the loads of its wheels."""

from typing import Any

import numpy as np
import xarray as xr

from ....core.quantities import displayed, heading_of, names_in_words
from ....core.tabulated import Tabulated, number
from ...analysis.ride.rest import car_assembly, of_state, wheels_and_body
from ...analysis.run import MovingCar, Run
from ...assembly.by_wheel import WHEEL
from ...assembly.equilibrium import equilibrium
from ...plots.motion.page import player
from ...plots.motion.scene import scene_of
from .chapter import Chapter


def rest_chapter(subject: Any) -> Chapter:
    """Return the chapter of a car at rest on a level road, with a view of it.

    Parameters
    ----------
    subject : Car or CarModel

    Returns
    -------
    Chapter

    Raises
    ------
    InputError, PositionError
        As from `kintrafo.ride.at_rest`.
    """
    assembly = car_assembly("rest_chapter", subject, riding=False)
    rest = equilibrium(assembly.model)
    state, inputs = np.asarray(rest), np.asarray(rest.inputs)
    found = of_state(assembly, state)
    loads = np.atleast_1d(found["load"].values)
    motion = xr.Dataset(
        {"load": (("time", WHEEL), loads[None]), "road": (("time", WHEEL), 0.0 * loads[None])},
        {"time": [0.0]},
    )
    car = MovingCar.at_rest(assembly, state, inputs)
    run = Run(car, motion, state[None], inputs[None], np.zeros((1, 2)))
    facts = tuple(assembly.described().items())
    return Chapter(
        title="The car at rest",
        words=(assembly.words,),
        tables=(Tabulated("Description", ("", "value"), facts, frozenset({0, 1})), *_tables(found)),
        players=(player(scene_of(run, np.array([0]))),),
    )


def _tables(found: xr.Dataset) -> tuple[Tabulated, ...]:
    """Return a table of the wheels, with a column for each, and one of the body."""
    of_wheels, of_body = wheels_and_body(found)
    wheels = names_in_words(found[WHEEL])
    return tuple(
        Tabulated(title, ("", *heads), tuple((heading_of(d), *_written(d)) for d in some))
        for title, heads, some in (("Wheels", wheels, of_wheels), ("Body", ["value"], of_body))
    )


def _written(data: xr.DataArray) -> list[str]:
    """Return the texts of values: forces with one decimal, others with three."""
    values = displayed(data).ravel()
    return [f"{v:.1f}" if data.attrs["units"] == "N" else number(float(v)) for v in values]
