"""Bushes: the flexibilities of joints, from a file or a caller."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Any, get_args

import numpy as np
from pydantic import BeforeValidator, WithJsonSchema

from ...core.named_types import Array
from ...core.suggestions import suggestion
from ...core.validator import Validator
from ...core.vectors import cross, unit_vector
from ..input.bush_curve import curve_of
from ..input.curve import Curve, Interpolation
from ..input.toml_file import read_sections
from ..input.units import unit_of
from .structure import FixedJoint, PartJoint, Points, Structure, TelescopeJoint

_STIFFNESSES = {
    "axial_N_per_mm": "stiffness along its axis",
    "radial_N_per_mm": "stiffness normal to its axis; or two, along `radial_axis` and normal to it",
    "tilt_Nm_per_deg": "stiffness against tilting about axes across its own; or two, about "
    "`radial_axis` and about the axis perpendicular to that",
    "torsion_Nm_per_deg": "stiffness against turning about its axis",
    "axial_curve": "instead of a stiffness, lists `mm` and `N`, both rising; see [spring] for "
    "`interpolation`",
    "radial_curve": "instead of a stiffness, lists `mm` and `N`, both rising from 0; see [spring] "
    "for `interpolation`",
}
_DIRECTIONS = {
    "axis": "its axis, chassis axes at design; by default that of the arm, the rod, the strut or "
    "the wheel",
    "radial_axis": "direction of the first of two radial stiffnesses, and the axis of the first of "
    "two against tilting; by default upward",
}
_PAIRS = ("radial_N_per_mm", "tilt_Nm_per_deg")
"""The stiffnesses that may differ between the two directions normal to the axis."""
_KEYS = (*_STIFFNESSES, *_DIRECTIONS)
RACK = "rack"
"""The name, instead of a hardpoint, of the stiffness of the steering along the rack's axis."""
_PER_MM, _PER_DEG = 1e3, 180.0 / np.pi
# Greater numbers are left to the checks [any unit].
_LARGEST = 1e300
# The least and the greatest stiffness of a bush, in its display units.
_SOFTEST, _STIFFEST = 1e-3, 1e12
_NO_DAMPING = (
    "The damping of a bush has no effect: loads and compliance are static, and motions have rigid "
    "joints. Leave it out; for results at a frequency enter the dynamic stiffnesses."
)
# Least angle of two directions that define a plane [rad].
_LEAST_ANGLE = 1e-3


@dataclass(frozen=True)
class Bush:
    """The flexibility of a joint at a hardpoint."""

    point: str
    axes: Array  # own axis and two normal to it, as rows in the chassis axes at design, (3, 3)
    # displacement of the joint's second part along each axis for a unit force on it, (3,) [m/N]
    soft: Array
    # rotation of a bearing about each of two axes normal to that of the wheel for a unit moment,
    # (2,) [rad/(N m)]
    tilt: Array
    tilts_about: Array  # these axes, as rows in the chassis axes at design, (2, 3)
    # stiffnesses of a joint that turns freely without a bush: against torsion about its axis, and
    # against tilting about each of the other two [N m/rad]
    turning: tuple[float, float, float]
    # force over the displacement along each axis, if it is not linear; `soft` is then its
    # derivative at zero
    curves: tuple[Curve | None, Curve | None, Curve | None]

    @property
    def gives_way(self) -> bool:
        """Whether it deflects in a direction in which a rigid joint does not."""
        return bool(self.soft.any() or self.tilt.any())

    def mirrored(self, point: str) -> "Bush":
        """Return its image in the plane y = 0, at another hardpoint."""
        image = np.array([1.0, -1.0, 1.0])
        axes, tilts_about = self.axes * image, self.tilts_about * image
        return replace(self, point=point, axes=axes, tilts_about=tilts_about)

    @property
    def compliance(self) -> Array:
        """Displacement and rotation per force and moment, (6, 6), chassis axes at design."""
        whole = np.zeros((6, 6))
        whole[:3, :3] = self.axes.T @ np.diag(self.soft) @ self.axes
        whole[3:, 3:] = self.tilts_about.T @ np.diag(self.tilt) @ self.tilts_about
        return whole

    def give(self, wrench: Array) -> tuple[Array, Array]:
        """Return its large deflection in chassis axes at design, under a wrench on the second part.

        `wrench` is force and moment, (6,). The result is displacement and rotation, (6,), and their
        derivatives with respect to force and moment, (6, 6).
        """
        slopes = self.compliance
        moved: Array = slopes @ wrench
        axial, radial, _ = self.curves
        if axial is None and radial is None:
            return moved, slopes
        force = self.axes @ wrench[:3]
        shift, by = self.soft * force, np.diag(self.soft)
        if axial is not None:
            shift[0] = axial.place(float(force[0]))
            by[0, 0] = 1.0 / float(axial.rate(shift[:1])[0])
        size = float(np.linalg.norm(force[1:]))
        if radial is not None and size:
            far, along = radial.place(size), force[1:] / size
            outer = np.outer(along, along)
            shift[1:] = far * along
            rate = float(radial.rate(np.array([far]))[0])
            by[1:, 1:] = outer / rate + far / size * (np.eye(2) - outer)
        moved[:3], slopes[:3, :3] = self.axes.T @ shift, self.axes.T @ by @ self.axes
        return moved, slopes


def read_bushes(path: str | Path) -> dict[str, Any]:
    """Return the bushes in a TOML file.

    Parameters
    ----------
    path : str or pathlib.Path

    Returns
    -------
    dict
        The tables of ``bushings`` by hardpoint.

    Raises
    ------
    InputError
        If it cannot be read, or has other sections.
    """
    sections = read_sections(path, ["bushings"], needed="bushings.POINT")
    return dict(sections["bushings"])


def described_bushings(
    given: Validator, bushings: Any, of_the_file: Mapping[str, Any] | None
) -> dict[str, Any]:
    """Return given bushes; those of the hardpoint file for None."""
    if bushings is None and of_the_file is None:
        given.fail(
            "bushings: none are given, and the hardpoint file has none. Give them, or add a "
            "section [bushings.POINT] for each hardpoint with a bush: a line with its stiffness "
            "radial_N_per_mm is enough."
        )
    found = of_the_file or {} if bushings is None else bushings
    return dict(given.mapping("bushings", found, "hardpoints and stiffnesses"))


def mirrored_bushings(described: Mapping[str, Any]) -> dict[str, Any]:
    """Return the images of bushes in the plane y = 0; other objects than tables are unchanged."""
    return {
        point: {k: [v[0], 0.0 - v[1], v[2]] if k in _DIRECTIONS else v for k, v in table.items()}
        if isinstance(table, Mapping)
        else table
        for point, table in described.items()
    }


def _plain(value: Any) -> Any:
    """Return tables, lists and numbers as in a file, without None."""
    if isinstance(value, Mapping):
        return {key: _plain(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(inner) for inner in value]
    whole = isinstance(value, int) and not isinstance(value, bool)
    return float(value) if whole and abs(value) < _LARGEST else value


def _schema_of(key: str, words: str) -> dict[str, Any]:
    """Return the JSON Schema of a key."""
    number = {"type": "number", "exclusiveMinimum": 0.0}
    numbers = {"type": "array", "items": {"type": "number"}}
    unit = unit_of(key)
    found: dict[str, Any] = {"description": words} | ({"x-unit": unit} if unit else {})
    if key in _DIRECTIONS:
        return found | numbers | {"minItems": 3, "maxItems": 3}
    if key.endswith("_curve"):
        lists = {name: {**numbers, "minItems": 2} for name in ("mm", "N")}
        properties = {**lists, "interpolation": {"enum": [*get_args(Interpolation)]}}
        return found | {"type": "object", "properties": properties, "required": [*lists]}
    if key in _PAIRS:
        return found | {"anyOf": [number, {**numbers, "minItems": 2, "maxItems": 2}]}
    return found | number


BUSH_SCHEMA: dict[str, Any] = {
    "type": "object",
    "additionalProperties": False,
    "properties": {k: _schema_of(k, words) for k, words in (_STIFFNESSES | _DIRECTIONS).items()},
}
"""JSON Schema of the section of a bush, ``Bushing``."""

Bushings = Annotated[
    dict[str, Any],
    BeforeValidator(_plain),
    WithJsonSchema({"type": "object", "additionalProperties": {"$ref": "#/$defs/Bushing"}}),
]
"""The section of bushes in a hardpoint file."""


def bushes_of(
    given: Validator,
    described: Mapping[str, Any],
    structure: Structure,
    design: Points,
    spin: Array,
) -> list[Bush]:
    """Return the bushes described by hardpoint; see `docs/suspension/compliance.md`.

    `structure` has their joints, `design` the hardpoints at design [m]; `spin` is the axis of the
    wheel at design, pointing outboard, (3,).
    """
    joints = {point: joint for joint in structure.joints for point in joint.at}
    known = [*joints, *[RACK for joint in structure.joints if joint.first == RACK]]
    found = []
    for point, table in described.items():
        title = f"[bushings.{point}]"
        if given.among(title, point, known) != point or point == RACK:
            continue
        if not isinstance(table, Mapping):
            given.fail(f"{title} must be a section, with {', '.join(_KEYS)}.")
            continue
        for key in (str(key) for key in table if key not in _KEYS):
            damps = any(word in key for word in ("damp", "N_s", "loss"))
            meant = _NO_DAMPING if damps else suggestion(key, _KEYS)
            given.fail(f"{title} {key} is not known. {meant}")
        if not any(key in table for key in _STIFFNESSES):
            given.fail(f"{title}: one of {', '.join(_STIFFNESSES)} is needed, or it is rigid.")
        is_bearing = isinstance(joints[point], FixedJoint)
        if "torsion_Nm_per_deg" in table and is_bearing:
            given.fail(f"{title} torsion_Nm_per_deg: the brake holds the wheel about its axis.")
        torsion, _ = _turning(given, title, table, "torsion_Nm_per_deg")
        tilt = _turning(given, title, table, "tilt_Nm_per_deg")
        soft = _translations(given, title, table)
        axial, radial = (_curve(given, title, table, which) for which in ("axial", "radial"))
        curves = (axial, radial, radial)
        axes = _axes(given, title, table, joints[point], design, spin)
        bush = Bush(
            point=str(point),
            axes=axes,
            soft=np.array([_at_rest(c) if c else s for s, c in zip(soft, curves, strict=True)]),
            tilt=np.array([1.0 / rate if is_bearing and rate else 0.0 for rate in tilt]),
            # a bearing tilts about axes normal to that of the wheel, not of the bush
            tilts_about=_across(given, title, table, spin)
            if is_bearing and "axis" in table
            else axes[1:],
            turning=(0.0, 0.0, 0.0) if is_bearing else (torsion, *tilt),
            curves=curves,
        )
        found.append(bush)
    return found


def _turning(
    given: Validator, title: str, table: Mapping[str, Any], key: str
) -> tuple[float, float]:
    """Return stiffnesses against rotation about two axes [N m/rad]; zero without the key."""
    if key not in table:
        return 0.0, 0.0
    first, second = _pair(given, title, table, key)
    return first * _PER_DEG, second * _PER_DEG


def _curve(given: Validator, title: str, table: Mapping[str, Any], which: str) -> Curve | None:
    """Return the axial or the radial curve, if any."""
    key, rate = f"{which}_curve", f"{which}_N_per_mm"
    if key not in table:
        return None
    if rate in table:
        given.fail(f"{title}: {key} and {rate} both give the stiffness. Keep one.")
    return curve_of(given, f"{title} {key}", table[key], odd=which == "radial")


def _at_rest(curve: Curve) -> float:
    """Return the flexibility of a relaxed bush [m/N]."""
    return 1.0 / float(curve.rate(np.zeros(1))[0])


def refuse_rigid(given: Validator, bushes: Sequence[Bush], rack: float) -> None:
    """Refuse bushes if none of them deflects."""
    if not (rack or given.failed or any(bush.gives_way for bush in bushes)):
        given.fail(
            "bushings: one or more are needed that deflect, by axial_N_per_mm, radial_N_per_mm, a "
            "curve, or the tilt of the wheel bearing."
        )


def left_out(bushes: Sequence[Bush]) -> str:
    """Return the effects of bushes that a linear analysis neglects, for a sentence, or ""."""
    return "torsion and tilting of the bushes" if any(any(b.turning) for b in bushes) else ""


def softness_of_rack(given: Validator, described: Mapping[str, Any]) -> float:
    """Return the flexibility of the rack along its axis [m/N]; zero if not described."""
    if RACK not in described:
        return 0.0
    table, title = described[RACK], f"[bushings.{RACK}]"
    if not isinstance(table, Mapping) or set(table) != {"axial_N_per_mm"}:
        given.fail(f"{title} must be a section with axial_N_per_mm, and nothing else.")
        return 0.0
    return 1.0 / (_stiffness(given, title, table, "axial_N_per_mm") * _PER_MM)


def _translations(given: Validator, title: str, table: Mapping[str, Any]) -> list[float]:
    """Return the flexibilities along the axis and in both directions normal to it [m/N]."""
    axial = _stiffness(given, title, table, "axial_N_per_mm")
    both = _pair(given, title, table, "radial_N_per_mm")
    return [1.0 / (value * _PER_MM) for value in (axial, *both)]


def _pair(given: Validator, title: str, table: Mapping[str, Any], key: str) -> tuple[float, float]:
    """Return the two stiffnesses of a key, which may have one number for both."""
    value = table.get(key)
    if not (isinstance(value, list | tuple) or (isinstance(value, np.ndarray) and value.ndim)):
        both = _stiffness(given, title, table, key)
        return both, both
    if key not in _PAIRS or len(value) != 2:
        words = "a number is needed, or two." if key in _PAIRS else "a number is needed."
        given.fail(f"{title} {key}: {words}")
        return np.inf, np.inf
    first, second = (_stiffness(given, title, {key: each}, key) for each in value)
    return first, second


def _stiffness(given: Validator, title: str, table: Mapping[str, Any], key: str) -> float:
    """Return a stiffness in its display unit; infinite without the key."""
    if key not in table:
        return np.inf
    unit = "N m/deg" if key.endswith("Nm_per_deg") else "N/mm"
    number = given.number(f"{title} {key}", table[key], unit, least=_SOFTEST, below=_STIFFEST)
    return float(number)


def _axes(
    given: Validator,
    title: str,
    table: Mapping[str, Any],
    joint: PartJoint,
    design: Points,
    spin: Array,
) -> Array:
    """Return the axes of a bush as rows: its own, and two normal to it."""
    usual_axis = spin if isinstance(joint, FixedJoint) else joint.axis(design)
    if usual_axis is None and "axis" not in table:
        given.fail(f"{title} axis is needed: a bush at this point has no default axis.")
        return np.eye(3)
    along = _direction(given, title, table, "axis", usual_axis)
    if isinstance(joint, TelescopeJoint):
        for key in (key for key in ("axial_N_per_mm", "axial_curve") if key in table):
            given.fail(f"{title} {key}: a telescope carries no force along its axis.")
        if "axis" in table:
            given.fail(f"{title} axis: that of a telescope is its own. Leave it out.")
    return np.stack([along, *_across(given, title, table, along)])


def _across(given: Validator, title: str, table: Mapping[str, Any], along: Array) -> Array:
    """Return the radial directions, (2, 3): by default the first one is as upright as possible."""
    usual = np.eye(3)[0 if abs(along[2]) > np.cos(_LEAST_ANGLE) else 2]
    aside = _direction(given, title, table, "radial_axis", usual)
    across = cross(along, aside)
    if np.linalg.norm(across) < np.sin(_LEAST_ANGLE):
        given.fail(f"{title} radial_axis lies along the axis: a direction across it is needed.")
        return np.eye(3)[1:]
    across /= np.linalg.norm(across)
    return np.stack([cross(across, along), across])


def _direction(
    given: Validator, title: str, table: Mapping[str, Any], key: str, usual: Array | None
) -> Array:
    if key not in table and usual is not None:
        return usual
    values = given.array(f"{title} {key}", table[key], dimensions=[1])
    if values.shape != (3,) or not 1e-6 < np.abs(values).max() < 1e6:
        problem = "three numbers are needed, the largest between 1e-6 and 1e6."
        given.fail(f"{title} {key}: {problem}")
        return np.array([1.0, 0.0, 0.0])
    return unit_vector(values)
