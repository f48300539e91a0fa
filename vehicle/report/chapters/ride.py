"""The chapter of the ride of a car: modes, responses to a rough road, and a bump."""

from typing import Any

import xarray as xr
from matplotlib import rc_context

from ....core.quantities import long_name, names_in_words
from ....core.tabulated import Tabulated, significant
from ....core.units import KM_PER_H
from ....pictures.figures import STYLE
from ... import roads
from ...analysis import ride
from ...analysis.ride.rest import car_assembly
from ...assembly.by_wheel import WHEEL
from ...plots.motion.animate import played
from ...plots.ride import response_figures
from .chapter import Chapter, ChapterPicture, not_valid

# A rough road, and the speed on it [m/s].
_CLASS, _SPEED = "B", 80.0 / KM_PER_H
# A bump: height, length and place [m], speed over it [m/s], and duration of the motion [s].
_HEIGHT, _LENGTH, _AT, _SLOWLY, _DURATION = 0.04, 2.0, 2.0, 30.0 / KM_PER_H, 3.0


def ride_chapter(subject: Any) -> Chapter:
    """Return the chapter of the ride of a car: modes, responses, and a player of a bump.

    Parameters
    ----------
    subject : Car or CarModel
        The ride of a car that drives is that of the same files with ``car = "roll"``.

    Returns
    -------
    Chapter

    Raises
    ------
    InputError, PositionError, SimulationError
        As from `kintrafo.ride.modes`, `response` and `over`.
    """
    whole = car_assembly("ride_chapter", subject, riding=False)
    assembly = whole.riding()
    modes, response = ride.modes(assembly), ride.response(assembly, _SPEED, _CLASS)
    bump = roads.bump(_HEIGHT, _LENGTH, at=_AT, end=_SLOWLY * _DURATION)
    run = ride.run(assembly, bump, _SLOWLY, duration=_DURATION)
    with rc_context(STYLE):
        figures = response_figures(response)
        panels = tuple(ChapterPicture.of(figure, words) for words, figure in figures.items())
    words = [
        "Modes and responses are those of the exact linearisation at rest, without friction.",
        f"The rough road is of class {_CLASS} of ISO 8608, at {KM_PER_H * _SPEED:g} km/h.",
        f"The car is shown over {bump.words} at {KM_PER_H * _SLOWLY:g} km/h, from rest.",
    ]
    if whole.drives:
        words.append("The body does not travel here: it heaves, pitches and rolls.")
    return Chapter(
        title="Ride",
        words=(" ".join(words), *not_valid(run.motion.attrs["not_valid"])),
        tables=(_modes(modes), _levels(response)),
        panels=panels,
        players=(played(run),),
    )


def _modes(found: xr.Dataset) -> Tabulated:
    numbers = [found[name].values for name in ("frequency", "damping_ratio")]
    columns = names_in_words(found["mode"]), *numbers
    rows = tuple((name, f"{f:.2f}", f"{d:.3f}") for name, f, d in zip(*columns, strict=True))
    return Tabulated("Modes", ("mode", "frequency [Hz]", "damping ratio"), rows)


def _levels(response: xr.Dataset) -> Tabulated:
    """Return the RMS of accelerations, wheel loads and travels, by wheel if there are several."""
    rows = []
    for name, data in response.items():
        for key, words in _RMS.items():
            if key in data.attrs:
                unit, factor = _UNITS.get(str(name), ("m/s^2", 1.0))
                what = long_name(data).removeprefix("spectrum of ")
                rows += [
                    (f"{what} [{unit}]", f"{words} {wheel}".strip(), significant(factor * value))
                    for wheel, value in _by_wheel(data, data.attrs[key])
                ]
    return Tabulated("On the rough road", ("", "", "value"), tuple(rows), frozenset({0, 1}))


def _by_wheel(data: xr.DataArray, value: Any) -> list[tuple[str, float]]:
    if WHEEL not in data.dims:
        return [("", value)]
    return list(zip(names_in_words(data[WHEEL]), value, strict=True))


_RMS = {"rms": "RMS", "weighted_rms": "RMS weighted by W_k of ISO 2631-1"}
_UNITS = {"load_psd": ("N", 1.0), "travel_psd": ("mm", 1e3)}
