"""Bushes: how far joints give way, as a file or a caller describes them."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.arguments import Arguments
from ...core.suggestions import suggestion
from ...suspension.input.toml_file import read_sections
from ...suspension.input.vectors import unit_vector
from ...suspension.model import Model
from ...suspension.structure import GROUND, Joint, Telescope
from ..characteristics.from_model import design_axis
from .poses import CENTER, rotated

Array = NDArray[np.float64]

_STIFFNESSES = ("axial_N_per_mm", "radial_N_per_mm", "tilt_Nm_per_deg")
_KEYS = (*_STIFFNESSES, "axis", "radial_axis")
RACK = "rack"
"""In the place of a hardpoint: how stiff the steering holds the rack along its axis."""
_PER_MM, _PER_DEG = 1e3, 180.0 / np.pi
# No bush is softer or stiffer than this, in its units for people.
_SOFTEST, _STIFFEST = 1e-3, 1e12
# Two directions nearer to each other than this angle [rad] tell no plane.
_LEAST_ANGLE = 1e-3


@dataclass(frozen=True)
class Bush:
    """What gives way at a hardpoint.

    Attributes
    ----------
    point : str
    compliance : ndarray, shape (6, 6)
        Displacement and rotation of the joint's second part by unit force and moment on it, in
        the chassis axes at design [m/N], [rad/(N m)].
    """

    point: str
    compliance: Array


def read_bushes(path: str | Path) -> dict[str, Any]:
    """Read a TOML file of bushes.

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
        If it cannot be read, or has something else.
    """
    bushings: dict[str, Any] = read_sections(path, ["bushings"], needed="bushings.POINT")[
        "bushings"
    ]
    return bushings


def bushes_of(given: Arguments, model: Model, described: Mapping[str, Any]) -> list[Bush]:
    """Read bushes by their hardpoints; see `docs/loads.md`."""
    joints = {point: joint for joint in model.suspension.structure().joints for point in joint.at}
    found = []
    for point, table in described.items():
        title = f"[bushings.{point}]"
        if point == RACK:
            continue
        if given.among("bushings at", point, [*joints, RACK]) != point:
            continue
        if not isinstance(table, Mapping):
            given.refuse(f"{title} must be a section, with {', '.join(_KEYS)}.")
            continue
        for key in (key for key in table if key not in _KEYS):
            given.refuse(f"{title} {key} is not known. {suggestion(str(key), _KEYS)}")
        if not any(key in table for key in _STIFFNESSES):
            given.refuse(f"{title}: one of {', '.join(_STIFFNESSES)} is needed, or it is rigid.")
        axes = _axes(given, title, table, model, joints[point])
        compliance = np.zeros((6, 6))
        compliance[:3, :3] = axes.T @ np.diag(_translations(given, title, table)) @ axes
        if "tilt_Nm_per_deg" in table:
            if point == CENTER:
                tilt = _stiffness(given, title, table, "tilt_Nm_per_deg") * _PER_DEG
                spin = design_axis(model.suspension)
                compliance[3:, 3:] = (np.eye(3) - np.outer(spin, spin)) / tilt
            else:
                given.refuse(f"{title} tilt_Nm_per_deg: only a wheel bearing carries a moment.")
        found.append(Bush(str(point), compliance))
    return found


def softness_of_rack(given: Arguments, described: Mapping[str, Any]) -> float:
    """Return how far the rack gives way along its axis [m/N]; zero where nothing is said."""
    if RACK not in described:
        return 0.0
    table, title = described[RACK], f"[bushings.{RACK}]"
    if not isinstance(table, Mapping) or set(table) != {"axial_N_per_mm"}:
        given.refuse(f"{title} must be a section with axial_N_per_mm, and nothing else.")
        return 0.0
    return 1.0 / (_stiffness(given, title, table, "axial_N_per_mm") * _PER_MM)


def _translations(given: Arguments, title: str, table: Mapping[str, Any]) -> list[float]:
    """Return the compliances along the axis and in both directions across it [m/N]."""
    axial = _stiffness(given, title, table, "axial_N_per_mm")
    radial = table.get("radial_N_per_mm", np.inf)
    if isinstance(radial, list | tuple | np.ndarray) and np.ndim(radial):
        if len(radial) != 2:
            given.refuse(f"{title} radial_N_per_mm: a number is needed, or two.")
            return [0.0, 0.0, 0.0]
        both = [_stiffness(given, title, {"radial_N_per_mm": r}, "radial_N_per_mm") for r in radial]
    else:
        both = 2 * [_stiffness(given, title, table, "radial_N_per_mm")]
    return [1.0 / (value * _PER_MM) for value in (axial, *both)]


def _stiffness(given: Arguments, title: str, table: Mapping[str, Any], key: str) -> float:
    """Return a stiffness in its unit for people; infinite where there is none."""
    if key not in table:
        return np.inf
    unit = {"tilt_Nm_per_deg": "N m/deg"}.get(key, "N/mm")
    number = given.number(f"{title} {key}", table[key], unit, least=_SOFTEST, below=_STIFFEST)
    return float(number)


def _axes(
    given: Arguments, title: str, table: Mapping[str, Any], model: Model, joint: Joint
) -> Array:
    """Return the axes of a bush as rows: its own, and the two across it."""
    usual_axis = _usual_axis(model, joint)
    if usual_axis is None and "axis" not in table:
        given.refuse(f"{title} axis is needed: no direction there is that of a bush by itself.")
        return np.eye(3)
    along = _direction(given, title, table, "axis", usual_axis)
    if isinstance(joint, Telescope) and "axial_N_per_mm" in table:
        given.refuse(f"{title} axial_N_per_mm: a telescope carries nothing along its axis.")
    # the first of the radial directions, for two stiffnesses: as upright as it can be
    usual = np.eye(3)[0 if abs(along[2]) > np.cos(_LEAST_ANGLE) else 2]
    aside = _direction(given, title, table, "radial_axis", usual)
    across = np.cross(along, aside)
    if np.linalg.norm(across) < np.sin(_LEAST_ANGLE):
        given.refuse(f"{title} radial_axis lies along the axis: a direction across it is needed.")
        return np.eye(3)
    across /= np.linalg.norm(across)
    return np.stack([along, np.cross(across, along), across])


def _usual_axis(model: Model, joint: Joint) -> Array | None:
    """Return the axis that a bush has where nothing is said, at design."""
    if joint.at == (CENTER,):
        return design_axis(model.suspension)
    return joint.axis(model.suspension.hardpoints.at_design())


def _direction(
    given: Arguments, title: str, table: Mapping[str, Any], key: str, usual: Array | None
) -> Array:
    if key not in table and usual is not None:
        return usual
    values = given.array(f"{title} {key}", table[key], dimensions=[1])
    if values.shape != (3,) or not 1e-6 < np.abs(values).max() < 1e6:
        problem = "three numbers are needed, of which the largest is between 1e-6 and 1e6."
        given.refuse(f"{title} {key}: {problem}")
        return np.array([1.0, 0.0, 0.0])
    return unit_vector(values)


def world_compliance(bush: Bush, joint: Joint, turned: Mapping[str, Array]) -> Array:
    """Return a compliance in chassis axes, the joint's first part having turned, (..., 6, 6)."""
    if joint.first in GROUND:
        return bush.compliance
    return rotated(bush.compliance, turned[joint.first])
