"""The K&C sheet: kinematic and compliance gradients at design, as in the summary of a rig.

Each gradient has its definition, and its sign in two systems of axes: ISO 8855 (x forward, y left,
z up), in which everything is computed, and SAE J670 with z down (x forward, y right). The 1976
edition of SAE J670 has only these axes; that of 2008 allows both.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import numpy as np
import xarray as xr

from ...core.quantities import attributes, displayed, long_name, unit_or_stroke
from ...core.tabulated import Tabulated, significant
from ...core.validator import Validator
from ..assembly.assembly import HeldAssembly
from ..assembly.by_wheel import flat, without_side
from ..assembly.of import given_assembly
from ..models.car.file import ENDS
from ..models.sides import SIDES
from .characteristics.datasets import dataset
from .compliance.flexibility import HELD, WheelSupport
from .compliance.linear import linear

QUANTITY = "quantity"
"""Dimension of the sheet."""

_SIDES = ("_left", "_right")
_LEFTWARD, _RIGHTWARD = "to the left", "to the right"
_STEERED, _COMPLIANCE = "steered", "compliance"
# Characteristics by the part of the sheet; those that an assembly does not have are left out.
_PARTS = {
    "at rest": (
        "toe", "camber", "caster", "kingpin_inclination", "trail", "steering_axis_offset",
        "scrub_radius", "hub_trail", "spindle_offset", "track",
    ),
    "in bump": (
        "bump_steer", "camber_gradient", "caster_gradient", "heave_steer", "motion_ratio",
        "damper_motion_ratio", "wheel_rate", "ride_rate", "roll_center_height_kinematic",
        "swing_arm_length_kinematic", "side_view_swing_arm_angle", "side_view_hub_angle",
        "anti_dive", "anti_lift_braked", "anti_lift_driven", "anti_squat",
    ),
    "in roll": (
        "roll_center_height", "roll_center_lateral", "roll_steer", "roll_camber", "jacking",
        "wheel_rate_alone", "roll_motion_ratio", "roll_moment_gradient", "roll_stiffness",
        "roll_stiffness_springs", "roll_stiffness_bar", "bar_share", "roll_stiffness_with_tyres",
    ),
    _STEERED: ("steer_gradient", "steering_ratio"),
}  # fmt: skip
_OTHER_SIGN, _MIRRORED = "the other sign", "mirror images"
# Headings of compliances on one page. Displacements count inward by a lateral force, and rearward
# by the others.
_KINDS = {
    "toe": "toe-in",
    "camber": "camber",
    "displacement": "inward or\nrearward",
    "patch_displacement": "contact\npatch",
    "axle_steer": "axle\nsteer",
    "axle_lateral": "axle\nto left",
    "axle_longitudinal": "axle\nforward",
}


def sheet(
    subject: Any, bushings: Mapping[str, Any] | None = None, *, held: WheelSupport = "height"
) -> xr.Dataset:
    """Return the kinematic and compliance gradients at design, with definitions and signs.

    Parameters
    ----------
    subject : Suspension, Model, Axle, AxleModel, RigidAxle, RigidAxleModel, Car or CarModel
        Of a car, the sheet has both axles, or the corner of a quarter car; its body is held.
    bushings : mapping, optional
        As in `kintrafo.compliance.linear`, instead of those of the file. Without bushes the sheet
        has no compliance. An error for a car, whose bushes are those of the files of its axles.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of the wheels under the loads of the compliance, see `kintrafo.compliance.linear`.

    Returns
    -------
    xarray.Dataset
        Over ``quantity``, the names of the characteristics and compliances, of a wheel or an axle
        with its place at the end, such as ``toe_left``, ``toe_front_left`` and ``track_front``: the
        values with the signs of ``iso_8855`` and of ``sae_j670`` (z down), in the display units of
        ``unit``; ``part`` of the sheet, ``meaning``, ``definition``, and the meaning of a positive
        value in ``iso_8855_sign`` and ``sae_j670_sign``.

    Raises
    ------
    InputError
        If an argument cannot be used.

    Notes
    -----
    Toe, camber and quantities relative to the inside of the car have the same sign in both systems.
    Quantities that are positive to the left in ISO 8855, such as steer angles, have the other sign
    in SAE J670 with z down.

    Examples
    --------
    >>> from kintrafo import load, sheet
    >>> found = sheet.sheet(load("reference_car"))
    >>> row = found.sel(quantity="steer_gradient")
    >>> float(row["iso_8855"]) == -float(row["sae_j670"]), str(row["unit"].values)
    (True, 'deg/mm')
    """
    with Validator("sheet") as given:
        assembly = given_assembly(given, subject, cars=True)
        given.among("held", held, HELD)
        if bushings is not None and assembly.body_moves:
            given.fail(
                "bushings: the bushes of a car are [bushings] in the files of its axles. Leave the "
                "argument out, or give an axle."
            )
    found = dict(
        (name, data) if end not in ENDS else _placed(name, data, end)
        for end, held_part in assembly.held_parts.items()
        for name, data in _of_axle(held_part, bushings, held)
        if end != ENDS[1] or data[0] != _STEERED  # the rack of a rear axle is fixed
    )
    sides = _MIRRORED if assembly.symmetric else "different"
    return _dataset(found, held).assign_attrs(sides=sides)


def _of_axle(
    assembly: HeldAssembly, bushings: Mapping[str, Any] | None, held: WheelSupport
) -> Iterator[tuple[str, tuple[str, xr.DataArray]]]:
    """Yield the quantities of a suspension or an axle with the parts of the sheet, by name."""
    yield from _kinematic(assembly)
    if bushings is not None or assembly.has_bushes:
        soft = flat(linear(assembly, bushings, [0.0], held=held)).drop_dims(["moved", "by"])
        yield from ((str(name), (_COMPLIANCE, data)) for name, data in soft.items())


def _placed(
    name: str, row: tuple[str, xr.DataArray], end: str
) -> tuple[str, tuple[str, xr.DataArray]]:
    """Return the name and the row of a quantity with the end of a car before its side."""
    side, (part, data) = _place(name), row
    words = f"{_without_place(long_name(data), side)}, {end}{side.replace('_', ' ')}"
    return f"{without_side(name)}_{end}{side}", (part, data.assign_attrs(long_name=words))


def tabulated(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return the sheet as tables, one for each of its parts.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `sheet`.
    title : str
        Text with which the titles of the tables begin.

    Returns
    -------
    list of Tabulated
        Each with its title, the names of its columns, and rows in display units.
    """
    with Validator("tabulated") as given:
        given.dataset(found, over=QUANTITY)
        given.text("title", title)
    columns = _columns(found)
    heads = ("", *columns.values(), "unit", "in ISO 8855", "in SAE J670, z down")
    words = frozenset({0, *range(len(columns) + 1, len(heads))})
    tables = []
    for part in dict.fromkeys(map(str, found["part"].values)):
        here = found.isel({QUANTITY: np.flatnonzero(found["part"].values == part)})
        rows = tuple(_rows(here, columns))
        held = f", {found.attrs['held']}" if part == _COMPLIANCE else ""
        tables.append(Tabulated(f"{title}{part}{held}", heads, rows, words))
    return tables


def _columns(found: xr.Dataset) -> dict[str, str]:
    """Return the headings of the columns of values, by the place at the end of a name."""
    places = {_place(str(name)) for name in found[QUANTITY].values}
    of_car = {
        f"_{end}{side}": f"{end} {side.removeprefix('_') or 'axle'}"
        for end in ENDS
        for side in (*_SIDES, "")
        if f"_{end}{side}" in places
    }
    if of_car:
        return of_car
    on_axle = not places.isdisjoint(_SIDES)
    return dict(zip((*_SIDES, ""), (*SIDES, "axle"), strict=True)) if on_axle else {"": "value"}


def _place(name: str) -> str:
    """Return the wheel or axle at the end of a name, such as ``_left``; empty without one."""
    return name.removeprefix(without_side(name))


def one_page(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return the sheet without the definitions of signs, so that it fits one page.

    The sign of quantities marked with an asterisk is the opposite in SAE J670 with z down. A car
    whose sides are mirror images has one column for each axle, with the values of the left wheels.
    The kinematic gradients have a row for each; then the compliances have a row for each load, and
    at most six columns in a table.
    """
    on_car = any(place.startswith(f"_{ENDS[0]}") for place in _columns(found))
    if on_car and found.attrs["sides"] == _MIRRORED:
        found = _of_left_wheels(found)
        title += ", left wheels"
    rows = []
    for part in tabulated(found.isel({QUANTITY: found["part"].values != _COMPLIANCE}), ""):
        values = part.columns[1:-3]
        rows += [(part.title.upper(), *("" for _ in values), "")]
        rows += [(_marked(name, sae), *cells, unit) for name, *cells, unit, _, sae in part.rows]
    heads = ("", *values, "unit")
    kinematic = Tabulated(title, heads, tuple(rows), frozenset({0, len(heads) - 1}))
    return [kinematic, *_by_load(found.isel({QUANTITY: found["part"].values == _COMPLIANCE}))]


def _by_load(found: xr.Dataset) -> Iterator[Tabulated]:
    """Yield tables of the compliances with a row for each load and a column for each quantity."""
    cells: dict[str, dict[str, str]] = {}
    per: dict[str, None] = {}
    for name in map(str, found[QUANTITY].values):
        own = {key: data.item() for key, data in found.sel({QUANTITY: name}).items()}
        stem = without_side(name)
        kind, _, load = stem.partition("_by_")
        unit, _, each = own["unit"].partition("/")
        side = _place(name)
        words = _without_place(own["meaning"], side).partition(" by ")[2]
        _, comma, together = words.partition(", ")
        row = f"{load.partition('_')[0]}, {together}" if comma else words.removeprefix("a ")
        sae = _in_sae(own["iso_8855_sign"], own["sae_j670_sign"])
        where = side.replace("_", " ").strip()
        column = "\n".join(filter(None, (_marked(_KINDS[kind], sae), where, f"[{unit}]")))
        cells.setdefault(column, {})[row] = significant(own["iso_8855"], 4)
        per[each] = None
    rows = list(dict.fromkeys(row for column in cells.values() for row in column))
    title = f"Compliance per {' or '.join(per)}{' of each wheel' if len(cells) > 4 else ''}"
    for first in range(0, len(cells), 6):
        columns = list(cells)[first : first + 6]
        body = tuple((row, *(cells[column].get(row, "") for column in columns)) for row in rows)
        yield Tabulated(f"{title}, {found.attrs['held']}", ("", *columns), body)


def _without_place(meaning: str, place: str) -> str:
    """Return a meaning without the wheel or axle at its end, which a name ends in."""
    return meaning.removesuffix(f", {place.replace('_', ' ').strip()}")


def _of_left_wheels(found: xr.Dataset) -> xr.Dataset:
    """Return the sheet of a car without right wheels, and left ones named by their axles."""
    left, right = _SIDES
    names = [str(name) for name in found[QUANTITY].values]
    here = found.isel({QUANTITY: [not name.endswith(right) for name in names]})
    here = here.assign_coords(
        {QUANTITY: [n.removesuffix(left) for n in names if not n.endswith(right)]}
    )
    meanings = [str(m).removesuffix(" left") for m in here["meaning"].values]
    return here.assign(meaning=(QUANTITY, meanings))


def _marked(words: str, sae: str) -> str:
    return f"{words} *" if sae == _OTHER_SIGN else words


def _in_sae(iso_sign: str, sae_sign: str) -> str:
    """Return how the sign in SAE J670 compares with that in ISO 8855."""
    return "the same" if iso_sign == sae_sign else _OTHER_SIGN


def _rows(here: xr.Dataset, places: Iterable[str]) -> Iterator[tuple[str, ...]]:
    """Yield the rows of a part, each with the values of all places in which it has one sign."""
    found: dict[tuple[str, ...], dict[str, str]] = {}
    for name in map(str, here[QUANTITY].values):
        own = here.sel({QUANTITY: name})
        meaning, unit, iso, sae = (
            str(own[key].values) for key in ("meaning", "unit", "iso_8855_sign", "sae_j670_sign")
        )
        stem, place = without_side(name), _place(name)
        row = stem, _without_place(meaning, place), unit, iso, _in_sae(iso, sae)
        cells = found.setdefault(row, dict.fromkeys(places, ""))
        cells[place] = significant(float(own["iso_8855"]))
    for (_, words, *signs), cells in found.items():
        yield (words, *cells.values(), *signs)


def _kinematic(assembly: HeldAssembly) -> Iterator[tuple[str, tuple[str, xr.DataArray]]]:
    """Yield the characteristics at design with the parts of the sheet, by their names."""
    known: dict[str, xr.DataArray] = {}
    steering = () if assembly.steering_motion is None else (assembly.steering_motion,)
    for motion in (assembly.usual_motion, *steering):
        curves = flat(dataset(assembly, motion, np.zeros(1)))
        known = {str(name): data for name, data in curves.items()} | known
    for part, stems in _PARTS.items():
        for stem in stems:
            for name in (stem, *(f"{stem}{side}" for side in _SIDES)):
                if name in known:
                    yield name, (part, known[name])


def _dataset(rows: Mapping[str, tuple[str, xr.DataArray]], held: WheelSupport) -> xr.Dataset:
    iso = np.array([displayed(data).item() for _, data in rows.values()])
    signs = [str(data.attrs.get("sign", "")) for _, data in rows.values()]
    flipped = [sign.replace(_LEFTWARD, _RIGHTWARD) for sign in signs]
    # a zero has no sign
    sae = np.where([a != b for a, b in zip(signs, flipped, strict=True)], 0.0 - iso, iso)
    texts = {
        "part": [part for part, _ in rows.values()],
        "unit": [unit_or_stroke(data.attrs) for _, data in rows.values()],
        "meaning": [long_name(data) for _, data in rows.values()],
        "definition": [str(data.attrs.get("definition", "")) for _, data in rows.values()],
        "iso_8855_sign": signs,
        "sae_j670_sign": flipped,
    }
    words = "value at design with the sign of"
    data = {name: xr.Variable(QUANTITY, each) for name, each in texts.items()}
    values = {
        "iso_8855": xr.Variable(QUANTITY, iso, attributes(f"{words} ISO 8855", "")),
        "sae_j670": xr.Variable(QUANTITY, sae, attributes(f"{words} SAE J670, z down", "")),
    }
    ordered = {"part": data.pop("part")} | values | data
    return xr.Dataset(
        ordered, {QUANTITY: [*rows]}, {"title": "K&C sheet at design", "held": HELD[held]}
    )
