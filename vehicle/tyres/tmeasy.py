"""TMeasy tyres, from the files of Project Chrono."""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from ...core.errors import InputError
from ...core.legible import legible, short
from ...core.validator import Validator
from ...formulas import tmeasy
from ...formulas.arithmetic import ARRAYS
from ...formulas.magic_formula import Forces
from ..input.commented_json import content, entry
from .tyre import States, SymmetricTyre

_DESIGN = {
    "radius": ("Design", "Unloaded Radius [m]"),
    "width": ("Design", "Width [m]"),
    "friction": ("Coefficient of Friction",),
    "nominal_load": ("Parameters", "Tire Load", "Nominal Vertical Force [N]"),
    "greatest_load": ("Parameters", "Tire Load", "Maximum Vertical Force [N]"),
    "stiffness_x": ("Parameters", "Tire Stiffness", "Longitudinal [N/m]"),
    "stiffness_y": ("Parameters", "Tire Stiffness", "Lateral [N/m]"),
}
_AXES = {
    "x": ("Longitudinal", {
        "slope": "Initial Slopes dFx/dsx [N]",
        "maximum": "Maximum Fx Load [N]",
        "sliding": "Sliding Fx Load [N]",
        "slip_of_maximum": "Slip sx at Maximum Fx",
        "slip_of_sliding": "Slip sx where sliding begins",
    }),
    "y": ("Lateral", {
        "slope": "Initial Slopes dFy/dsy [N]",
        "maximum": "Maximum Fy Load [N]",
        "sliding": "Sliding Fy Load [N]",
        "slip_of_maximum": "Slip sy at Maximum Fy",
        "slip_of_sliding": "Slip sy where sliding begins",
    }),
}  # fmt: skip
_PAIRS = {
    **{f"{axis}_{what}": ("Parameters", section, key)
       for axis, (section, keys) in _AXES.items() for what, key in keys.items()},
    "trail": ("Parameters", "Aligning", "Normalized Trail at Zero Slip sy"),
    "slip_of_zero_trail": ("Parameters", "Aligning", "Slip sy where Trail Changes Sign"),
    "slip_of_no_trail": ("Parameters", "Aligning", "Slip sy where Trail Tends to Zero"),
    "stiffness": ("Parameters", "Tire Stiffness", "Vertical [N/m]"),
    "rolling": ("Parameters", "Dynamic Radius Weighting Coefficients"),
    "resistance": ("Rolling Resistance Coefficients",),
}  # fmt: skip
_NEWER = tuple(
    ("Parameters", "Vertical", key)
    for key in (
        "Nominal Vertical Force [N]",
        "Maximum Vertical Force [N]",
        "Vertical Tire Stiffness [N/m]",
        "Tire Spring Curve Data",
    )
)
_UNKNOWN = 1e-30  # stiffness of the carcass if the file has none [N/m]
_FORMAL = {("Name",), ("Type",), ("Template",)}


@dataclass(frozen=True)
class TMeasy(SymmetricTyre):
    """A tyre of TMeasy: curves given by slope, maximum and sliding force at two loads.

    Attributes
    ----------
    values : dict of str to float
        Values by name, in SI units; names of values at the two loads end in ``_1`` and ``_2``.
    """

    law: ClassVar[str] = "tmeasy"
    CONTACT_LAW: ClassVar[str] = "TMeasyContact"
    values: Mapping[str, float]
    name: str = "TMeasy"
    left_out: tuple[str, ...] = ()

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the tyre of a file of Project Chrono (JSON, template TMeasyTire).

        Parameters
        ----------
        path : str or pathlib.Path

        Raises
        ------
        InputError
            If the file cannot be read, a key is missing, or values are impossible.
        """
        data = content(path)
        if data.get("Template") != "TMeasyTire":
            found = short(legible(repr(data.get("Template"))))
            problem = f'"Template" is {found}; of JSON files "TMeasyTire" can be read.'
            raise InputError([problem], str(path))
        if not isinstance(data.get("Parameters"), dict):
            problem = (
                '"Parameters" are missing. Those of a load index or a bearing capacity are not '
                "estimated here: add them."
            )
            raise InputError([problem], str(path))
        older, used = _as_older(data)
        reader = _TmeasyReader(older)
        values = dict(reader.values())
        problems = reader.problems or [*_impossible(values)]
        if problems:
            raise InputError(problems, str(path))
        values["friction_measured"] = values["friction"]
        values["load_1"], values["load_2"] = _polynomial(values)
        return cls(values, left_out=tuple(_unread(data, used)))

    @property
    def nominal_load(self) -> float:  # type: ignore[override] # read only
        """Load of the values with ``_1`` in their names [N]; those with ``_2`` have twice it."""
        return self.values["nominal_load"]

    @property
    def radius(self) -> float:  # type: ignore[override] # read only
        """Unloaded radius [m]."""
        return self.values["radius"]

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:  # type: ignore[override] # read only
        """Range of the load, up to the greatest one of the file [N]."""
        return {"load": (0.0, self.values["greatest_load"])}

    def _values(self) -> dict[str, float]:
        return {key: self.values[key] for key in tmeasy.COEFFICIENTS} | {"vxlow": self.lowest_speed}

    def with_friction(self, friction: float) -> Self:
        """Return the tyre on a road with another coefficient of friction.

        Parameters
        ----------
        friction : float
            Coefficient of friction of the road, above zero; the file has that of the measurement.
        """
        with Validator(self.name) as given:
            friction = given.number("friction", friction, above=0.0)
        return replace(self, values={**self.values, "friction": friction})

    def _state(self, at: States) -> tuple[Forces, dict[str, Any]]:
        p = self.values
        deflection, stiffness = tmeasy.deflection_of(ARRAYS, p, at.load)
        length = 2.0 * np.sqrt(self.radius * deflection)
        found = tmeasy.forces(ARRAYS, p, at.contact(), length)
        weight = tmeasy.by_load(
            at.load, self.nominal_load, p["rolling_1"], p["rolling_2"], quadratic=False
        )
        static = self.radius - deflection
        return found, {
            "relaxation_x": _length(found.slip_stiffness, p["stiffness_x"]),
            "relaxation_y": _length(-found.cornering_stiffness, p["stiffness_y"]),
            "loaded_radius": static,
            "effective_radius": static + np.minimum(weight, 1.0) * deflection,
            "vertical_stiffness": stiffness,
        }


def _length(stiffness: Any, carcass: float) -> Any:
    """Return a relaxation length [m]; NaN if the stiffness of the carcass is unknown."""
    return stiffness / carcass if carcass > _UNKNOWN else np.full_like(stiffness, np.nan)


def _polynomial(p: Mapping[str, float]) -> tuple[float, float]:
    """Return the linear and the quadratic coefficient of the load over the deflection."""
    once, twice = p["stiffness_1"] ** 2, p["stiffness_2"] ** 2
    return math.sqrt(2.0 * once - twice), (twice - once) / (4.0 * p["nominal_load"])


class _TmeasyReader:
    """The numbers of a file and the problems found in it."""

    def __init__(self, data: Mapping[str, Any]) -> None:
        self._data, self.problems = data, list[str]()

    def values(self) -> Iterator[tuple[str, float]]:
        """Yield names and numbers; 0 for each number that is missing or wrong."""
        for name, place in _DESIGN.items():
            yield name, self._number(place, entry(self._data, place))
        for name, place in _PAIRS.items():
            found = entry(self._data, place)
            if not isinstance(found, list) or len(found) != 2:
                self._refuse(place, found, "two numbers are needed, in brackets")
                found = [0.0, 0.0]
            yield f"{name}_1", self._number(place, found[0])
            yield f"{name}_2", self._number(place, found[1])

    def _number(self, place: tuple[str, ...], value: Any) -> float:
        if (
            isinstance(value, bool)
            or not isinstance(value, int | float)
            or not math.isfinite(value)
        ):
            self._refuse(place, value, "a finite number is needed")
            return 0.0
        return float(value)

    def _refuse(self, place: tuple[str, ...], value: Any, needed: str) -> None:
        state = "is missing" if value is None else f"= {short(legible(repr(value)))}"
        problem = f'"{" > ".join(place)}" {state}: {needed}.'
        if problem not in self.problems:
            self.problems.append(problem)


def _unread(
    data: Mapping[str, Any], used: frozenset[tuple[str, ...]], above: tuple[str, ...] = ()
) -> Iterator[str]:
    """Yield the places of unused keys."""
    for key, value in data.items():
        place = (*above, key)
        if place in used:
            continue
        if isinstance(value, dict) and any(one[: len(place)] == place for one in used):
            yield from _unread(value, used, place)
        else:
            yield legible(short(" > ".join(place)))


def _as_older(data: Mapping[str, Any]) -> tuple[dict[str, Any], frozenset[tuple[str, ...]]]:
    """Return the data in the older form of the template, and the places of the used keys.

    The newer form has its vertical stiffness as one number or as a curve, one coefficient of
    rolling resistance, and no carcass; its rolling radius includes a third of the deflection.
    """
    used = frozenset((*_FORMAL, *_DESIGN.values(), *_PAIRS.values()))
    given = data["Parameters"].get("Vertical")
    if not isinstance(given, dict):
        return dict(data), used
    nominal: Any = given.get("Nominal Vertical Force [N]")
    usable = isinstance(nominal, int | float) and not isinstance(nominal, bool)
    most = given.get("Maximum Vertical Force [N]", 3.5 * nominal if usable else None)
    stiffness = given.get("Vertical Tire Stiffness [N/m]")
    pair = None if stiffness is None else [stiffness, stiffness]
    if pair is None and usable:
        pair = _of_curve(given.get("Tire Spring Curve Data"), float(nominal))
    resistance = data.get("Rolling Resistance Coefficient")
    parameters = {
        **data["Parameters"],
        "Tire Load": {
            "Nominal Vertical Force [N]": nominal,
            "Maximum Vertical Force [N]": most,
        },
        "Tire Stiffness": {
            "Longitudinal [N/m]": _UNKNOWN,
            "Lateral [N/m]": _UNKNOWN,
            "Vertical [N/m]": pair,
        },
        "Dynamic Radius Weighting Coefficients": [2.0 / 3.0, 2.0 / 3.0],
    }
    older = {**data, "Parameters": parameters}
    if resistance is not None:
        older["Rolling Resistance Coefficients"] = [resistance, resistance]
    return older, used | {("Rolling Resistance Coefficient",), *_NEWER}


def _of_curve(curve: Any, nominal: float) -> list[float] | None:
    """Return the stiffness [N/m] at both loads of a parabola fitted to a curve of the force."""
    try:
        points = np.asarray(curve, dtype=np.float64)
    except (TypeError, ValueError):
        return None
    if points.ndim != 2 or points.shape[1] != 2 or len(points) < 3:
        return None
    deflection, force = points.T
    both = np.column_stack([deflection, deflection * deflection])
    (first, second), *_ = np.linalg.lstsq(both, force, rcond=None)
    loads = nominal * np.array([1.0, 2.0])
    return [float(x) for x in np.sqrt(np.maximum(first * first + 4.0 * second * loads, 0.0))]


def _impossible(p: Mapping[str, float]) -> Iterator[str]:
    """Yield a problem for each impossible value."""
    places = _DESIGN | _PAIRS
    may_be_zero = ("trail_", "resistance_", "rolling_")
    for name, value in p.items():
        place = " > ".join(places.get(name, places.get(name[:-2], (name,))))
        if value < 0.0 or (value == 0.0 and not name.startswith(may_be_zero)):
            yield f'"{place}" = {value:g}: more than zero is needed.'
    for end in "12":
        for axis, (section, keys) in _AXES.items():
            first, last = p[f"{axis}_slip_of_maximum_{end}"], p[f"{axis}_slip_of_sliding_{end}"]
            if not first < last:
                yield (
                    f'"{section}": {keys["slip_of_sliding"]!r} = {last:g} must be greater than '
                    f"{keys['slip_of_maximum']!r} = {first:g}."
                )
            if p[f"{axis}_sliding_{end}"] > p[f"{axis}_maximum_{end}"]:
                yield f'"{section}": the force of sliding is greater than the maximum.'
    for name in (f"{axis}_{what}" for axis in "xy" for what in ("slope", "maximum", "sliding")):
        once, twice = p[f"{name}_1"], p[f"{name}_2"]
        greatest = p["greatest_load"] / max(p["nominal_load"], 1e-9)
        least = 2.0 * once - 0.5 * twice - (once - 0.5 * twice) * greatest
        if not least > 0.0:
            yield (
                f'"{" > ".join(_PAIRS[name])}" = [{once:g}, {twice:g}] makes it vanish within the '
                'greatest load. Correct it, or "Maximum Vertical Force [N]".'
            )
    if p["stiffness_2"] ** 2 >= 2.0 * p["stiffness_1"] ** 2:
        yield '"Vertical [N/m]": the second number is more than 1.41 times the first.'
