"""Derivatives of characteristics with respect to values of the input file."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from ...core.errors import InputError, KintrafoError
from ...core.named_types import Array, ArrayLike
from ...core.quantities import Display, display_of
from ...core.validator import Validator
from ..analysis.compliance.flexibility import HELD, WheelSupport
from ..assembly.of import assembly_of
from .batch import curves_of_many, moved_by
from .curves import Curves, changed, curves_of, refuse_bushes
from .design_variables import DesignVariable, linkage_of, matching, names_bushes
from .evaluation import Subject, check_subject
from .sweep_axes import known_anywhere

PLACE = "place"
"""Dimension of the values that vary."""

# The shorter of two steps, in SI units. The error of the difference is of fourth order:
# (0.5 mm / 300 mm)^4 = 8e-12 of a curve that changes over 300 mm, and rounding is 1e-15 / 0.5 mm =
# 2e-12 of it per millimetre.
_STEPS = {"m": 5e-4, "rad": 1e-3}
_RELATIVE_STEP = 1e-3
# Size of a value of zero: the products of inertia of a body are below its moments, some hundredths.
_SIZE_OF_ZERO = {"kg m^2": 1e-3}
# Weights of differences of fourth and of second order, by the number of steps: with neighbours on
# both sides, and on one side if the other is impossible, as below a mass of zero.
_BOTH_SIDES = ({-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}, {-1: -1 / 2, 1: 1 / 2})
_ONE_SIDE = ({0: -25 / 12, 1: 4.0, 2: -3.0, 3: 4 / 3, 4: -1 / 4}, {0: -3 / 2, 1: 2.0, 2: -1 / 2})
# If both orders differ by more than these parts of the derivative, and of the greatest one of the
# curve, there is a kink without a derivative, such as the contact of a stop. Those of smooth curves
# differ by some (0.5 mm / 300 mm)^2 = 3e-6 of it.
_KINK, _KINK_OF_GREATEST = 3e-3, 3e-4
# Rounding of a curve, as a part of its greatest value, or of 1 rad, 1 m, ...: solving successive
# loops, and their rates, adds some thousand roundings of 2e-16.
ROUNDING = 1e-12


def sensitivity(
    suspension: Subject,
    places: Sequence[str] | None = None,
    *,
    over: str | None = None,
    positions: ArrayLike | None = None,
    names: Sequence[str] | None = None,
    held: WheelSupport | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the derivatives of characteristics with respect to values of the input file.

    Parameters
    ----------
    suspension : Suspension, Axle, RigidAxle or Car
    places : sequence of str, optional
        The values, named by section and key with dots between them, such as
        ``hardpoints.ball_joint.z``. The name of a hardpoint or of a section represents all of its
        numbers, ``*`` any text. Default: all points of the linkage, which are the hardpoints and
        those of rods, a drag link and a Pitman arm.
    over : str, optional
        Motion along the curves, of which the first is the default. Of a corner 'travel' or 'rack';
        of axles 'bump' (both wheels), 'roll', 'left' or 'right', of steered ones also 'steer' or
        'rack'; of a car 'heave', 'pitch' or 'roll' of its body, its 'speed' on a rough road, or
        the 'lateral_acceleration' of steady turns, both with options after a colon:
        ``speed:road=C``. Of all but cars also 'load', a load case as those of
        `kintrafo.loads.static`: ``load:case=brake`` is a standard case,
        ``load:case=kerb,cases=cases.toml`` one of a file.
    positions : array_like, optional
        Wheel travel, heave, or displacement of the rack [m], roll, pitch or angle of the steering
        wheel [rad], speed [m/s], lateral acceleration [m/s^2], or part of the load case; by default
        the usual range, and the whole load case.
    names : sequence of str, optional
        Characteristics or loads; by default all. A name without wheel is that of all wheels.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Instead of characteristics, compliance by the names of `kintrafo.compliance.linear`, over
        wheel travel, with this support of the wheels; bushes of the file may vary, too.
    progress : callable, optional
        Called with the completed fraction, up to 1.

    Returns
    -------
    xarray.Dataset
        Each characteristic over ``place`` and the positions: its derivative with respect to the
        value, in SI units. The position of each car is measured from its own design position. NaN
        at a kink of a curve, such as the contact of a stop. Values of a section or ``*`` that
        cannot change, such as an inertia of a part without mass, are left out; the attribute
        ``left_out`` names them, and ``message`` has the reason.

    Raises
    ------
    InputError
        If a place or a characteristic is not known, or the suspension has no result for the
        neighbouring values on either side of a value that is named in full.

    Notes
    -----
    Derivatives are differences of fourth order between four neighbouring suspensions for each
    value: of a hardpoint 0.5 mm and 1 mm to either side. If one side is impossible, as for a
    friction of zero, neighbours are on the other side, up to 2 mm.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import Suspension, variation
    >>> car = Suspension.load("reference_car")
    >>> found = variation.sensitivity(car, ["hardpoints.tie_rod_inner.z"], positions=[0.0])
    >>> round(float(np.rad2deg(found["bump_steer"][0, 0])) * 1e-6, 6)  # deg/mm per mm
    0.001124
    """
    with Validator("sensitivity") as given:
        check_subject(given, suspension)
        given.function("progress", progress)
        if not given.failed:
            curves = curves_of(given, suspension, over, positions, names, held)
            patterns = linkage_of(suspension) if places is None else places
            wanted = [*matching(given, suspension, patterns).values()]
            asked = [place for place in wanted if _is_asked_for(place, patterns)]
            refuse_bushes(given, asked, [curves.over])
    soft = curves.over in HELD
    chosen = [place for place in wanted if soft or not place.of_bushes]
    left_out = dict.fromkeys([p.name for p in wanted if p not in chosen], _RIGID)
    found, refused = derivatives(suspension, chosen, curves, progress)
    for place, error in refused.items():
        if _is_asked_for(place, patterns):
            raise error
        left_out[place.name] = _ALONE
    kept = [which for which, place in enumerate(chosen) if place not in refused]
    if not kept:
        raise next(iter(refused.values()))
    dataset = _dataset(curves, [chosen[which] for which in kept], found[kept])
    return dataset.assign_attrs(left_out=", ".join(left_out), message=_message(left_out))


_ALONE = "a file with slightly different values is an error (name one in full to see why)"
_RIGID = "bushes have no effect here: joints are rigid"
# Number of names in the message on values that are left out; the dataset has all.
_NAMED = 3


def _is_asked_for(place: DesignVariable, patterns: Sequence[str]) -> bool:
    """Return whether a value is named in full, rather than by a pattern or a section."""
    return any(p == place.name or (place.of_bushes and names_bushes(p)) for p in patterns)


def _message(left_out: Mapping[str, str]) -> str:
    """Return a message on values that are left out, with reasons."""
    parts = []
    for reason in dict.fromkeys(left_out.values()):
        names = [name for name, why in left_out.items() if why == reason]
        more = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
        parts.append(f"{', '.join(names[:_NAMED])}{more}, since {reason}")
    return f"left out: {'; '.join(parts)}" if parts else ""


def derivatives(
    suspension: Subject,
    places: Sequence[DesignVariable],
    curves: Curves,
    progress: Callable[[float], None] | None = None,
) -> tuple[Array, dict[DesignVariable, InputError]]:
    """Return the derivatives of curves in values, (places, names, positions), SI units.

    All neighbours are evaluated together; values without one of them have a difference of their
    own. Derivatives in values without possible neighbours are NaN, with the reason.
    """
    steps = [*_BOTH_SIDES[0]]
    off = np.zeros((len(places) * len(steps), len(places)))
    for which, place in enumerate(places):
        rows = slice(which * len(steps), (which + 1) * len(steps))
        off[rows, which] = step_of(place) * np.array(steps)
    moved = moved_by(places, off)
    [beside], reasons = curves_of_many(suspension, moved, [curves], progress=progress)
    found = np.full((len(places), *beside.shape[1:]), np.nan)
    refused = {}
    for which, place in enumerate(places):
        rows = slice(which * len(steps), (which + 1) * len(steps))
        try:
            if any(reasons[rows]):
                found[which] = _difference(*_neighbours(suspension, place, curves))
            else:
                at = dict(zip(steps, beside[rows], strict=True))
                found[which] = _difference(_BOTH_SIDES, step_of(place), at)
        except InputError as error:
            refused[place] = error
    return found, refused


def _difference(
    orders: Sequence[Mapping[int, float]], step: float, at: Mapping[int, Array]
) -> Array:
    """Return the derivative from curves by the number of steps, NaN at a kink."""
    with np.errstate(invalid="ignore"):  # a turning circle is infinite straight ahead
        fourth, second = (
            np.sum([weight * at[by] for by, weight in order.items()], axis=0) / step
            for order in orders
        )
    rounding = ROUNDING * np.maximum(_greatest(at[1]), 1.0) / abs(step)
    tolerated = _KINK * np.abs(fourth) + _KINK_OF_GREATEST * _greatest(fourth) + rounding
    fourth[np.abs(fourth) <= rounding] = 0.0
    return np.where(np.abs(second - fourth) <= tolerated, fourth, np.nan)


def _neighbours(
    suspension: Subject, place: DesignVariable, curves: Curves
) -> tuple[Sequence[Mapping[int, float]], float, dict[int, Array]]:
    """Return the weights of a possible difference, its step, and curves by the number of steps."""
    size = step_of(place)
    refused = []
    for orders, step in ((_BOTH_SIDES, size), (_ONE_SIDE, size), (_ONE_SIDE, -size)):
        try:
            at = {by: _moved(suspension, place, by * step, curves) for by in orders[0]}
        except InputError as error:
            refused.append(error)
        else:
            return orders, step, at
    raise refused[0]


def _greatest(values: Array) -> Array:
    """Return the greatest finite absolute value of each row, (rows, 1)."""
    sizes = np.where(np.isfinite(values), np.abs(values), 0.0)
    return sizes.max(axis=1, initial=0.0, keepdims=True)


def step_of(place: DesignVariable) -> float:
    """Return the step of a difference, SI units."""
    if place.si_unit in _STEPS:
        return _STEPS[place.si_unit]
    return _RELATIVE_STEP * (abs(place.value) or _SIZE_OF_ZERO.get(place.unit, 1.0)) * place.to_si


def _moved(suspension: Subject, place: DesignVariable, by: float, curves: Curves) -> Array:
    try:
        return curves.of(assembly_of(changed(suspension, place.moved(by))))
    except KintrafoError as error:
        problem = (
            f"{place.name}: with {by / place.to_si:+g} {place.unit} there is no neighbour to "
            f"compare with, since {error}"
        )
        raise InputError([problem], "sensitivity") from None


def _dataset(curves: Curves, places: Sequence[DesignVariable], values: Array) -> xr.Dataset:
    along = curves.along
    data = {
        name: xr.Variable((PLACE, along.name), values[:, i], _attributes(curves, name, places))
        for i, name in enumerate(curves.names)
    }
    labels = {"long_name": "value of the input file that is changed"}
    coordinates = {
        PLACE: xr.Variable(PLACE, [place.name for place in places], labels),
        "place_unit": xr.Variable(PLACE, [place.si_unit for place in places]),
        "place_display_unit": xr.Variable(PLACE, [place.unit for place in places]),
        "place_display_factor": xr.Variable(PLACE, [1.0 / place.to_si for place in places]),
        "place_name": xr.Variable(PLACE, [place.words for place in places]),
        along.name: xr.Variable(along.name, curves.positions, along.attributes()),
    }
    return xr.Dataset(data, coordinates, {"title": f"sensitivity over {along.long_name}"})


def _attributes(curves: Curves, name: str, places: Sequence[DesignVariable]) -> dict[str, Any]:
    """Return the attributes of a derivative; its display unit needs one unit of all values."""
    quantity = curves.quantity(name)
    attributes = quantity.attributes()
    shown = display_of(attributes)
    units = {(place.si_unit, place.unit, place.to_si) for place in places}
    si_unit, unit, to_si = (
        next(iter(units)) if len(units) == 1 else ("place_unit", "place_unit", 1.0)
    )
    attributes |= {"units": _per(quantity.units, si_unit)}
    shown = Display(_per(shown.units, unit, " per "), shown.factor * to_si)
    return attributes | {
        "long_name": f"sensitivity of {quantity.long_name}",
        "sign": "positive if the quantity grows with the value",
        "display_units": shown.units,
        "display_factor": shown.factor,
    }


def _per(unit: str, other: str, link: str = "/") -> str:
    """Return the unit of a derivative."""
    if other in ("", "1"):
        return unit
    if (unit == "1" or link == "/") and set(" /") & set(other):
        other = f"({other})"
    return f"1/{other}" if unit == "1" else f"{unit}{link}{other}"


class Effect(NamedTuple):
    """The effect of a value of the input file on a characteristic.

    Attributes
    ----------
    place : str
        The value's name.
    size : float
        The derivative of the characteristic with respect to the value, in the display units of
        both.
    unit : str
        Unit of `size`, such as 'deg/mm per mm'.
    """

    place: str
    size: float
    unit: str


def effects(dataset: xr.Dataset, name: str, at: float = 0.0) -> Iterator[Effect]:
    """Return the effect of each value on a characteristic at a position, the largest first.

    Values are grouped by their units, since a millimetre and a degree cannot be compared.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of `sensitivity`.
    name : str
        Characteristic.
    at : float, optional
        Position along the curves, SI units; the nearest one of the dataset is used.

    Returns
    -------
    iterator of Effect

    Raises
    ------
    InputError
        If an argument cannot be used.
    """
    with Validator("effects") as given:
        given.dataset(dataset, over=PLACE)
        if not given.failed:
            given.among("name", name, [str(n) for n, d in dataset.items() if PLACE in d.dims])
        given.number("at", at)
    return _effects(dataset, name, at)


def _effects(dataset: xr.Dataset, name: str, at: float) -> Iterator[Effect]:
    data = dataset[name]
    along = next(str(d) for d in data.dims if d != PLACE)
    column = data.sel({along: at}, method="nearest").values
    shown = display_of(known_anywhere(name).attributes())
    units = dataset["place_display_unit"].values.tolist()
    sizes = column * shown.factor / dataset["place_display_factor"].values
    found = [
        Effect(str(place), float(size), _per(shown.units, unit, " per "))
        for place, size, unit in zip(dataset[PLACE].values, sizes, units, strict=True)
    ]
    for unit in dict.fromkeys(effect.unit for effect in found):
        same = [effect for effect in found if effect.unit == unit]
        yield from sorted(same, key=lambda e: -abs(e.size) if np.isfinite(e.size) else 1.0)
