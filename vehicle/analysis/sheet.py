"""The K&C sheet: kinematic and compliance gradients at design, as in the summary of a rig.

Each gradient has its definition, and its sign in two systems of axes: ISO 8855 (x forward, y left,
z up), in which everything is computed, and SAE J670 with z down (x forward, y right). The 1976
edition of SAE J670 has only these axes; that of 2008 allows both.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from ...core.quantities import attributes, displayed, long_name, unit_or_stroke
from ...core.tabulated import Tabulated, significant
from ...core.validator import Validator
from ..assembly.assembly import HeldAssembly
from ..assembly.by_wheel import WHEEL
from ..assembly.of import given_assembly
from ..models.car.file import ENDS
from ..models.sides import LEFT, RIGHT
from .characteristics.datasets import dataset
from .compliance.flexibility import HELD, WheelSupport
from .compliance.linear import linear

QUANTITY = "quantity"
"""Dimension of the sheet."""

_OF_AXLE = "axle"
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
        ``unit``; ``part`` of the sheet, ``meaning``, ``definition``, the ``characteristic`` alone
        (``toe``), its ``place`` (``front left``, ``front axle``), and the meaning of a positive
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
    rows = [
        row
        for end, held_part in assembly.held_parts.items()
        for row in _rows_of(held_part, end if end in ENDS else "", bushings, held)
        if end != ENDS[1] or row.part != _STEERED  # the rack of a rear axle is fixed
    ]
    sides = _MIRRORED if assembly.symmetric else "different"
    return _dataset(rows, held).assign_attrs(sides=sides)


@dataclass(frozen=True)
class _SheetRow:
    """A quantity of the sheet, of a wheel or of an axle."""

    part: str  # of the sheet
    column: str  # its name in a flat table, such as ``toe_front_left``
    name: str  # that of the characteristic, such as ``toe``
    place: str  # the wheel or the axle, such as ``front left``; '' for a corner
    data: xr.DataArray  # its value at design


def _rows_of(
    assembly: HeldAssembly, end: str, bushings: Mapping[str, Any] | None, held: WheelSupport
) -> Iterator[_SheetRow]:
    """Yield the rows of a suspension or an axle at an end of a car, in the order of the sheet."""
    known: dict[str, xr.DataArray] = {}
    steering = () if assembly.steering_motion is None else (assembly.steering_motion,)
    for motion in (assembly.usual_motion, *steering):
        known = {str(n): d for n, d in dataset(assembly, motion, np.zeros(1)).items()} | known
    parts = {part: [name for name in names if name in known] for part, names in _PARTS.items()}
    if bushings is not None or assembly.has_bushes:
        soft = linear(assembly, bushings, [0.0], held=held).drop_dims(["moved", "by"])
        known |= {str(name): data for name, data in soft.items()}
        parts[_COMPLIANCE] = [str(name) for name in soft]
    at_axle = _OF_AXLE if len(assembly.wheels) > 1 else ""
    for part, names in parts.items():
        for name in names:
            for wheel in assembly.wheels if WHEEL in known[name].dims else ("",):
                data = known[name].sel({WHEEL: wheel}) if wheel else known[name]
                column = "_".join(filter(None, (name, end, wheel)))
                place = " ".join(filter(None, (end, wheel or at_axle)))
                yield _SheetRow(part, column, name, place, data)


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
    heads = ("", *(place or "value" for place in columns))
    heads += ("unit", "in ISO 8855", "in SAE J670, z down")
    words = frozenset({0, *range(len(columns) + 1, len(heads))})
    tables = []
    for part in dict.fromkeys(map(str, found["part"].values)):
        here = found.isel({QUANTITY: np.flatnonzero(found["part"].values == part)})
        rows = tuple(_rows(here, columns))
        held = f", {found.attrs['held']}" if part == _COMPLIANCE else ""
        tables.append(Tabulated(f"{title}{part}{held}", heads, rows, words))
    return tables


def _columns(found: xr.Dataset) -> tuple[str, ...]:
    """Return the places that have columns of values; '' for a corner."""
    return tuple(dict.fromkeys(map(str, found["place"].values)))


def one_page(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return the sheet without the definitions of signs, so that it fits one page.

    The sign of quantities marked with an asterisk is the opposite in SAE J670 with z down. A car
    whose sides are mirror images has one column for each axle, with the values of the left wheels.
    The kinematic gradients have a row for each; then the compliances have a row for each load, and
    at most six columns in a table.
    """
    on_car = any(place.startswith(ENDS[0]) for place in _columns(found))
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
        kind, _, load = own["characteristic"].partition("_by_")
        unit, _, each = own["unit"].partition("/")
        words = own["meaning"].partition(" by ")[2]
        _, comma, together = words.partition(", ")
        row = f"{load.partition('_')[0]}, {together}" if comma else words.removeprefix("a ")
        sae = _in_sae(own["iso_8855_sign"], own["sae_j670_sign"])
        where = own["place"].removesuffix(_OF_AXLE).strip()
        column = "\n".join(filter(None, (_marked(_KINDS[kind], sae), where, f"[{unit}]")))
        cells.setdefault(column, {})[row] = significant(own["iso_8855"], 4)
        per[each] = None
    rows = list(dict.fromkeys(row for column in cells.values() for row in column))
    title = f"Compliance per {' or '.join(per)}{' of each wheel' if len(cells) > 4 else ''}"
    for first in range(0, len(cells), 6):
        columns = list(cells)[first : first + 6]
        body = tuple((row, *(cells[column].get(row, "") for column in columns)) for row in rows)
        yield Tabulated(f"{title}, {found.attrs['held']}", ("", *columns), body)


def _of_left_wheels(found: xr.Dataset) -> xr.Dataset:
    """Return the sheet of a car without right wheels, with left ones in the columns of axles."""
    places = found["place"].str
    here = found.isel({QUANTITY: ~places.endswith(RIGHT).values})
    return here.assign(place=here["place"].str.replace(LEFT, _OF_AXLE))


def _marked(words: str, sae: str) -> str:
    return f"{words} *" if sae == _OTHER_SIGN else words


def _in_sae(iso_sign: str, sae_sign: str) -> str:
    """Return how the sign in SAE J670 compares with that in ISO 8855."""
    return "the same" if iso_sign == sae_sign else _OTHER_SIGN


def _rows(here: xr.Dataset, places: Iterable[str]) -> Iterator[tuple[str, ...]]:
    """Yield the rows of a part, each with the values of all places in which it has one sign."""
    found: dict[tuple[str, ...], dict[str, str]] = {}
    keys = ("characteristic", "meaning", "unit", "iso_8855_sign", "sae_j670_sign", "place")
    texts = zip(*(map(str, here[key].values) for key in keys), strict=True)
    for (*row, iso, sae, place), value in zip(texts, here["iso_8855"].values, strict=True):
        cells = found.setdefault((*row, iso, _in_sae(iso, sae)), dict.fromkeys(places, ""))
        cells[place] = significant(float(value))
    for (_, words, *signs), cells in found.items():
        yield (words, *cells.values(), *signs)


def _dataset(rows: Sequence[_SheetRow], held: WheelSupport) -> xr.Dataset:
    iso = np.array([displayed(row.data).item() for row in rows])
    signs = [str(row.data.attrs.get("sign", "")) for row in rows]
    flipped = [sign.replace(_LEFTWARD, _RIGHTWARD) for sign in signs]
    # a zero has no sign
    sae = np.where([a != b for a, b in zip(signs, flipped, strict=True)], 0.0 - iso, iso)
    texts = {
        "part": [row.part for row in rows],
        "unit": [unit_or_stroke(row.data.attrs) for row in rows],
        "meaning": [long_name(row.data) for row in rows],
        "definition": [str(row.data.attrs.get("definition", "")) for row in rows],
        "characteristic": [row.name for row in rows],
        "place": [row.place for row in rows],
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
    attrs = {"title": "K&C sheet at design", "held": HELD[held]}
    return xr.Dataset(ordered, {QUANTITY: [row.column for row in rows]}, attrs)
