"""Suspensions of Project Chrono: its MacPhersonStrut template, as JSON.

The format is that of Chrono::Vehicle (https://projectchrono.org): points and vectors in metres, in
the axes of the vehicle (ISO 8855), for the *left* side; the right one is its mirror image. What its
files leave open is assumed, and each assumption is told.
"""

import json
import math
import re
from collections.abc import Sequence
from decimal import Decimal
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from ..core.errors import InputError
from ..core.files import reason
from ..core.legible import short
from ..core.vectors import cross
from .kinds import Suspension

Array = NDArray[np.float64]
# strict: neither a text nor true is a number
Finite = Annotated[float, Field(allow_inf_nan=False, strict=True)]
Point = tuple[Finite, Finite, Finite]

TYRE_RATE = 200e3
"""Radial rate of a tyre that no file describes [N/m]."""

_STROKE = 0.1
"""How much longer than at design the extended strut is assumed to be [m]."""

# A point nearer than this to a line lies on it [m].
_ON_THE_LINE = 1e-4
# A text, a comment to the end of the line, a comment between marks. Each of them matches up to the
# end of the file where it is not closed, and never goes back: the time is linear in the length.
_COMMENT = re.compile(r'("(?:[^"\\]|\\.)*+"?)|//[^\n]*+|/\*.*?(\*/|\Z)', re.DOTALL)


class Imported(NamedTuple):
    """A suspension from a file of another program.

    Attributes
    ----------
    suspension : Suspension
        Of the left side.
    assumptions : tuple of str
        What the file leaves open or this project has no place for, one sentence each.
    """

    suspension: Suspension
    assumptions: tuple[str, ...]


class _Part(BaseModel):
    """A part of the file; keys that are not used are let pass, as Chrono itself does."""

    model_config = ConfigDict(extra="ignore", populate_by_name=True)


class _Body(_Part):
    mass: Finite = Field(alias="Mass", ge=0.0)
    com: Point = Field(alias="COM")
    inertia: Point | None = Field(default=None, alias="Inertia")
    moments: Point | None = Field(default=None, alias="Moments of Inertia")
    products: Point = Field(default=(0.0, 0.0, 0.0), alias="Products of Inertia")

    def tensor(self, axes: Array) -> Array:
        """Return the inertia about the centre of mass in the vehicle's axes [kg m^2].

        Parameters
        ----------
        axes : ndarray, shape (3, 3)
            Axes of the body in which the file gives it, in columns.
        """
        xx, yy, zz = self.moments or self.inertia or (0.0, 0.0, 0.0)
        xy, xz, yz = self.products
        local = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        turned: Array = axes @ local @ axes.T
        return turned


class _Spindle(_Body):
    inertia: Point = Field(alias="Inertia")


class _ControlArm(_Body):
    front: Point = Field(alias="Location Chassis Front")
    back: Point = Field(alias="Location Chassis Back")
    upright: Point = Field(alias="Location Upright")

    def axes(self) -> Array:
        """Return Chrono's axes of the arm: x from its rear to its front bearing, z across it."""
        front, back, upright = map(np.array, (self.front, self.back, self.upright))
        z = cross(back - upright, front - upright)
        x = front - back
        if not (np.linalg.norm(z) > 0.0 and np.linalg.norm(x) > 0.0):
            return np.eye(3)  # no triangle: the hardpoints are refused later, by name
        x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
        return np.column_stack((x, cross(z, x), z))


class _Ends(_Part):
    chassis: Point = Field(alias="Location Chassis")
    upright: Point = Field(alias="Location Upright")


class _Strut(_Part):
    mass: Finite = Field(alias="Mass", ge=0.0)


class _Spring(_Ends):
    rate: Finite | None = Field(default=None, alias="Spring Coefficient")
    free_length: Finite = Field(alias="Free Length")
    shortest: Finite | None = Field(default=None, alias="Minimum Length")
    longest: Finite | None = Field(default=None, alias="Maximum Length")


class _Shock(_Ends):
    rate: Finite | None = Field(default=None, alias="Damping Coefficient")
    curve: tuple[tuple[Finite, Finite], ...] | None = Field(default=None, alias="Curve Data")


class _Axle(_Part):
    inertia: Finite = Field(alias="Inertia", ge=0.0)


class _File(_Part):
    name: str = Field(default="MacPherson strut", alias="Name")
    type: Literal["Suspension"] = Field(alias="Type")
    template: Literal["MacPhersonStrut"] = Field(alias="Template")
    camber: Finite = Field(default=0.0, alias="Camber Angle (deg)")
    toe: Finite = Field(default=0.0, alias="Toe Angle (deg)")
    vehicle_axes: bool = Field(default=False, strict=True, alias="Vehicle-Frame Inertia")
    spindle: _Spindle = Field(alias="Spindle")
    upright: _Body = Field(alias="Upright")
    arm: _ControlArm = Field(alias="Control Arm")
    strut: _Strut = Field(alias="Strut")
    tie_rod: _Ends = Field(alias="Tierod")
    spring: _Spring = Field(alias="Spring")
    shock: _Shock = Field(alias="Shock")
    axle: _Axle = Field(alias="Axle")


class _Tire(_Part):
    type: Literal["Tire"] = Field(default="Tire", alias="Type")
    radius: Finite | None = Field(alias="Radius", gt=0.0)
    mass: Finite = Field(alias="Mass", ge=0.0)
    inertia: Point = Field(alias="Inertia")


_USUAL = _Tire(Radius=None, Mass=20.0, Inertia=(0.8, 1.0, 0.8))
"""Of a passenger car, with its rim; where no file of a tire is given."""


# -- reading --------------------------------------------------------------------------------------


def read(path: str | Path, *, tire: str | Path | None = None) -> Imported:
    """Read a suspension of Project Chrono.

    Parameters
    ----------
    path : str or Path
        JSON file of the template "MacPhersonStrut".
    tire : str or Path, optional
        JSON file of a tire with radius, mass and inertia.

    Returns
    -------
    Imported
        The left suspension, and what had to be assumed.

    Raises
    ------
    InputError
        If a file is not JSON or not of this kind, or no suspension can be like this.
    """
    given = _File.model_validate(_checked(_File, path))
    wheel = _USUAL if tire is None else _Tire.model_validate(_checked(_Tire, tire))
    data = {
        "vehicle": {"side": "left"},
        "hardpoints": _hardpoints(given),
        "wheel": _alignment(given),
        "strut": _strut(given),
        "tyre": _tyre(given, wheel),
        "rack": {"axis": [0.0, 1.0, 0.0]},
        "gravity": {"acceleration_m_per_s2": 9.81},
        "bodies": _bodies(given, wheel),
    }
    if given.shock.curve is not None:
        data["damper"] = _curve(given.shock.curve)
    suspension = Suspension.from_dict(data, str(path))
    return Imported(suspension, tuple(_assumptions(given, wheel)))


def _checked(model: type[BaseModel], path: str | Path) -> dict[str, Any]:
    """Return the content of a file if it is of a kind; say what is wrong if not."""
    data = _json(path)
    try:
        model.model_validate(data)
    except ValidationError as error:
        details = error.errors()
        # of another kind of file, nothing else is worth telling
        other = [detail for detail in details if detail["type"] == "literal_error"]
        raise InputError([_problem(d) for d in other or details], str(path)) from None
    return data


def _json(path: str | Path) -> dict[str, Any]:
    """Read JSON that may have comments, as Chrono allows."""
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
        data = json.loads(_COMMENT.sub(_without_comment, text))
    except OSError as error:
        raise InputError([f"cannot be read: {reason(error)}"], str(path)) from error
    except UnicodeDecodeError as error:
        raise InputError(["is no text. Give a JSON file."], str(path)) from error
    except json.JSONDecodeError as error:
        problem = f"Line {error.lineno} is not valid JSON: {error.msg}."
        raise InputError([problem], str(path)) from error
    except RecursionError as error:
        problem = "has lists or keys in each other too deeply. Give a file of Project Chrono."
        raise InputError([problem], str(path)) from error
    except ValueError as error:  # Python's limit of 4300 digits
        problem = "has a number of thousands of digits. Write it with an exponent, as 1.5e6."
        raise InputError([problem], str(path)) from error
    if not isinstance(data, dict):
        raise InputError(["has no keys. Give a file of Project Chrono's templates."], str(path))
    return data


def _without_comment(found: re.Match[str]) -> str:
    """Return what stands for a text or a comment; the lines keep their numbers."""
    is_text, is_open = found[1] is not None, found[2] == ""
    return found[0] if is_text or is_open else "\n" * found[0].count("\n") or " "


def _problem(detail: Any) -> str:
    place = " > ".join(str(part) for part in detail["loc"])
    given = short(json.dumps(detail["input"], default=str))
    if detail["type"] == "missing":
        return f'"{place}" is missing. Add it, in SI units.'
    if detail["type"] == "literal_error":
        return f'"{place}" is {given}; only {detail["ctx"]["expected"]} can be read.'
    return f'"{place}" = {given}: {detail["msg"].lower()}.'


# -- converting -----------------------------------------------------------------------------------


def _hardpoints(given: _File) -> dict[str, Any]:
    """Return the points; the strut's axis is that of the spring, as in Chrono's joint."""
    points = {
        "arm_front": given.arm.front,
        "arm_rear": given.arm.back,
        "ball_joint": given.arm.upright,
        "strut_top": given.spring.chassis,
        "strut_lower": given.spring.upright,
        "tie_rod_outer": given.tie_rod.upright,
        "tie_rod_inner": given.tie_rod.chassis,
        "wheel_center": given.spindle.com,
    }
    return {"unit": "m"} | {name: list(point) for name, point in points.items()}


def _alignment(given: _File) -> dict[str, float]:
    """Return camber and toe as seen from the front and from above.

    Chrono turns the spindle by toe about the vertical and then by camber about its own axis.
    """
    camber, toe = math.radians(given.camber), math.radians(given.toe)
    projected = math.degrees(math.atan2(math.tan(camber), math.cos(toe)))
    return {"camber_deg": projected, "toe_deg": given.toe}


def _strut(given: _File) -> dict[str, float]:
    if given.spring.rate is None:
        problem = (
            '"Spring > Spring Coefficient" is missing: a spring by a curve cannot be read. Enter a '
            "rate in N/m."
        )
        raise InputError([problem], given.name)
    length = float(np.linalg.norm(np.subtract(given.spring.chassis, given.spring.upright)))
    strut = {
        "length_max_mm": round(_mm(length + _STROKE), 3),
        "spring_rate_N_per_m": given.spring.rate,
        "spring_free_length_mm": _mm(given.spring.free_length),
    }
    if given.shock.curve is None:
        strut["damper_rate_N_s_per_m"] = given.shock.rate or 0.0
    return strut


def _curve(points: Sequence[tuple[float, float]]) -> dict[str, list[float]]:
    """Return a damper curve; in Chrono it is over the rate of the length, positive in rebound."""
    ordered = sorted((-velocity, -force) for velocity, force in points)
    return {
        "velocity_m_per_s": [velocity + 0.0 for velocity, _ in ordered],
        "force_N": [force + 0.0 for _, force in ordered],
    }


def _tyre(given: _File, tire: _Tire) -> dict[str, float]:
    touching = {"rate_N_per_m": TYRE_RATE, "free_height_mm": _mm(given.spindle.com[2])}
    return touching | ({} if tire.radius is None else {"radius_mm": _mm(tire.radius)})


def _bodies(given: _File, tire: _Tire) -> dict[str, dict[str, Any]]:
    own = np.eye(3) if given.vehicle_axes else given.arm.axes()
    return {
        "control_arm": _rigid(given.arm, own),
        "knuckle": _rigid(given.upright, np.eye(3)),
        "wheel": _wheel(given, tire),
    }


def _rigid(body: _Body, axes: Array) -> dict[str, Any]:
    tensor = body.tensor(axes)
    elements = {"xx": (0, 0), "yy": (1, 1), "zz": (2, 2), "xy": (0, 1), "xz": (0, 2), "yz": (1, 2)}
    return {
        "mass_kg": body.mass,
        "com_mm": list(map(_mm, body.com)),
        **{f"inertia_{name}_kg_m2": float(tensor[at]) for name, at in elements.items()},
    }


def _wheel(given: _File, tire: _Tire) -> dict[str, float]:
    """Return the body that turns with the wheel: spindle, axle shaft and tire."""
    across, along, other = np.array(given.spindle.inertia) + tire.inertia
    return {
        "mass_kg": given.spindle.mass + tire.mass,
        "inertia_spin_kg_m2": float(along) + given.axle.inertia,
        "inertia_diametral_kg_m2": float(across + other) / 2.0,
    }


def _mm(metres: float) -> float:
    """Return a length in millimetres, with the digits that it has in metres."""
    return float(Decimal(repr(metres)).scaleb(3))


def _assumptions(given: _File, tire: _Tire) -> list[str]:
    """Return what the file leaves open, and what has no place here."""
    told = [
        "rack: moves along y; the file of the steering is not read",
        f"tyre: {TYRE_RATE / 1e3:g} N/mm, just touching at design",
        f"strut: {1e3 * _STROKE:g} mm longer when fully extended than at design",
    ]
    if tire is _USUAL:
        told.append(
            f"wheel: {_USUAL.mass:g} kg, {_USUAL.inertia[1]:g} kg m^2 about its axis and "
            f"{_USUAL.inertia[0]:g} kg m^2 across it; give a tire for its own"
        )
    if given.strut.mass > 0.0:
        told.append(f"upper strut: its mass of {given.strut.mass:g} kg is left out")
    if not _damps_along_the_strut(given):
        told.append("damper: acts along the strut's axis, not between points of its own")
    if given.spring.shortest is not None or given.spring.longest is not None:
        told.append("stops: the shortest and longest length of the spring are left out")
    return told


def _damps_along_the_strut(given: _File) -> bool:
    start, end = np.array(given.spring.upright), np.array(given.spring.chassis)
    line = (end - start) / np.linalg.norm(end - start)
    offsets = [cross(np.array(p) - start, line) for p in (given.shock.chassis, given.shock.upright)]
    return bool(max(np.linalg.norm(offset) for offset in offsets) < _ON_THE_LINE)
