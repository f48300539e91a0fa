"""Key figures of a tyre over its load: stiffness, friction, load sensitivity, lengths."""

from typing import TYPE_CHECKING, Any

import numpy as np

from ...core.named_types import Array
from ...core.quantities import Display, display_of, variable
from ...core.tabulated import Tabulated, significant
from ...core.validator import Validator
from .tyre import Tyre

if TYPE_CHECKING:
    import xarray as xr

_POINTS = 1201
_GREATEST = {"slip_angle": 0.5, "slip": 1.0}  # of the search [rad], [-]
_SMALL = 1e-4  # inclination of the camber stiffness [rad]
_SHARES = (0.5, 1.0, 1.5)
_STEP = 0.05  # of the load, for the load sensitivity


def key_figures(tyre: Tyre, loads: Any = None) -> "xr.Dataset":
    """Return stiffnesses, friction coefficients, load sensitivity and lengths of a tyre over load.

    Parameters
    ----------
    tyre : Tyre
    loads : array_like, optional
        Loads, in the range of the tyre [N]; by default 0.5, 1 and 1.5 times the nominal load.

    Returns
    -------
    xarray.Dataset
        Over ``load`` [N], at the speed and the pressure of the file: ``cornering_stiffness``
        [N/rad], ``slip_stiffness`` [N], ``camber_stiffness`` [N/rad]; ``friction_lateral``,
        ``friction_driving`` and ``friction_braking``, the greatest forces divided by the load, and
        ``angle_of_friction`` [rad], ``slip_of_driving`` and ``slip_of_braking``, the slips of these
        forces; ``load_sensitivity``, the derivative of ``friction_lateral`` with respect to the
        load [1/N]; ``trail`` [m], ``relaxation_x``, ``relaxation_y`` [m], ``loaded_radius``,
        ``effective_radius`` [m] and ``vertical_stiffness`` [N/m].

    Raises
    ------
    InputError
        If a load is not a number, or outside the range of the tyre.
    """
    from xarray import Dataset  # noqa: PLC0415 (slow to import)

    with Validator("key_figures") as given:
        given.instance("tyre", tyre, Tyre, "a tyre is needed, such as kintrafo.tyres.load returns")
    low, high = tyre.ranges.get("load", (0.0, np.inf))
    usual = np.clip(np.multiply(_SHARES, tyre.nominal_load), low, high)
    with Validator("key_figures") as given:
        chosen = given.array("loads", usual if loads is None else loads, "N", dimensions=(1,))
        if not given.failed and (chosen.min() < max(low, 1.0) or chosen.max() > high):
            given.fail(f"loads: {max(low, 1.0):g} to {high:g} N are allowed for this tyre.")
    at_zero = tyre.evaluate(chosen)
    leaning = [tyre.evaluate(chosen, camber=side * _SMALL).fy for side in (-1.0, 1.0)]
    lateral, angle = _friction(tyre, chosen, "slip_angle", 0)
    driving, slip = _friction(tyre, chosen, "slip", 1)
    braking, braked = _friction(tyre, chosen, "slip", -1)
    around = np.clip([chosen * (1.0 - _STEP), chosen * (1.0 + _STEP)], low, high)
    sides = [_friction(tyre, load, "slip_angle", 0)[0] for load in around]
    values = {
        "cornering_stiffness": (at_zero.cornering_stiffness, "cornering stiffness", "N/rad"),
        "slip_stiffness": (at_zero.slip_stiffness, "slip stiffness", "N"),
        "camber_stiffness": (
            (leaning[0] - leaning[1]) / (2.0 * _SMALL),
            "camber stiffness, positive with the force to where the top leans",
            "N/rad",
        ),
        "friction_lateral": (lateral, "greatest lateral force over load", "1"),
        "angle_of_friction": (angle, "slip angle at this force", "rad"),
        "load_sensitivity": (
            (sides[1] - sides[0]) / (around[1] - around[0]),
            "change of lateral friction for a unit of load",
            "1/N",
        ),
        "friction_driving": (driving, "greatest driving force over load", "1"),
        "slip_of_driving": (slip, "slip at this force", "1"),
        "friction_braking": (braking, "greatest braking force over load", "1"),
        "slip_of_braking": (braked, "slip at this force", "1"),
        "trail": (at_zero.trail, "pneumatic trail without slip", "m"),
        "relaxation_x": (at_zero.relaxation_x, "longitudinal relaxation length", "m"),
        "relaxation_y": (at_zero.relaxation_y, "lateral relaxation length", "m"),
        "loaded_radius": (at_zero.loaded_radius, "loaded radius", "m"),
        "effective_radius": (at_zero.effective_radius, "effective rolling radius", "m"),
        "vertical_stiffness": (at_zero.vertical_stiffness, "vertical stiffness", "N/m"),
    }
    return Dataset(
        {name: variable("load", *described) for name, described in values.items()},
        {"load": variable("load", chosen, "load", "N")},
        {"title": f"key figures of a tyre, {tyre.name}"},
    )


def _friction(tyre: Tyre, loads: Array, over: str, way: int) -> tuple[Array, Array]:
    """Return the greatest force over the load and its slip; `way` 0 searches both signs of slip."""
    most = _GREATEST[over]
    low, high = np.clip(tyre.ranges.get(over, (-most, most)), -most, most)
    start, end = (low, high) if way == 0 else (0.0, high if way > 0 else low)
    along = np.linspace(start, end, _POINTS)
    if over == "slip_angle":
        forces = np.abs(tyre.evaluate(loads[:, None], along).fy)
    else:
        forces = np.abs(tyre.evaluate(loads[:, None], slip=along).fx)
    index = np.argmax(forces, axis=1)
    places = np.arange(len(loads))
    return forces[places, index] / loads, np.abs(along[index]) * (1.0 if way >= 0 else -1.0)


def tabulated(found: "xr.Dataset", head: str = "") -> Tabulated:
    """Return key figures as a table of texts in display units, such as N/deg and mm.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `key_figures`.
    head : str, optional
        Beginning of the title.

    Returns
    -------
    Tabulated
    """
    with Validator("tabulated") as given:
        given.dataset(found, over="load")
        given.text("head", head)
    loads = [f"{load:.0f} N" for load in found["load"].values]
    rows = []
    for name, data in found.data_vars.items():
        unit, factor = _SHOWN.get(str(name), display_of(data.attrs))
        cells = [significant(factor * float(value)) for value in data.values]
        rows.append((str(data.attrs["long_name"]), "-" if unit == "1" else unit, *cells))
    title = f"{head}{found.attrs.get('title', 'key figures')}"
    columns = ("at zero camber", "unit", *loads)
    return Tabulated(title, columns, tuple(rows), frozenset({0, 1}))


_SHOWN = {
    "cornering_stiffness": Display.of("N/deg"),
    "camber_stiffness": Display.of("N/deg"),
    "load_sensitivity": Display.of("1/kN"),
}
