"""Files of Project Chrono: JSON with comments, broken, deep, and with values of no car."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from kintrafo.core.errors import InputError
from kintrafo.suspension.chrono import read

from .. import mutations
from ..attempts import RawError, WrongError

if TYPE_CHECKING:
    from numpy.random import Generator

DATA = Path(__file__).parents[2] / "data/chrono"


def _uncommented(name: str) -> dict[str, Any]:
    """Return a file of the tests, whose comments are whole lines."""
    lines = (DATA / name).read_text(encoding="utf-8").splitlines()
    found: dict[str, Any] = json.loads("\n".join(x for x in lines if not x.startswith("//")))
    return found


FILES = tuple(_uncommented(f"{name}.json") for name in ("MacPhersonStrut", "DoubleWishbone"))
TIRE = _uncommented("RigidTire.json")
SHORT = 100
COMMENTS = ('// a comment with "quotes"\n', "/* of\nlines */", "/**/", "//\n", "/* // */", "")
# What of the file has a place of its own in ours, by template: hardpoint, path to it.
BOTH = {"tie_rod_inner": ("Tierod", "Location Chassis"), "wheel_center": ("Spindle", "COM")}
POINTS = {
    "MacPhersonStrut": BOTH
    | {
        "arm_front": ("Control Arm", "Location Chassis Front"),
        "ball_joint": ("Control Arm", "Location Upright"),
        "strut_top": ("Spring", "Location Chassis"),
    },
    "DoubleWishbone": BOTH
    | {
        "upper_arm_rear": ("Upper Control Arm", "Location Chassis Back"),
        "lower_ball_joint": ("Lower Control Arm", "Location Upright"),
        "spring_seat": ("Spring", "Location Arm"),
    },
}


def attempt(random: Generator) -> None:
    """Read a file that was changed, with comments between its lines."""
    strut, tire = FILES[random.integers(len(FILES))], TIRE
    if random.random() < 0.8:
        strut = mutations.nested(random, strut)
    if random.random() < 0.2:
        tire = mutations.nested(random, TIRE)
    text = _commented(random, strut).encode("utf-8", "surrogatepass")
    broken = random.random() < 0.4
    if broken:
        text = mutations.bytes_of(random, text)
    with tempfile.TemporaryDirectory() as folder:
        path, other = Path(folder, "strut.json"), Path(folder, "tire.json")
        path.write_bytes(text)
        other.write_text(json.dumps(tire), encoding="utf-8")
        try:
            found = read(path, tire=other if random.random() < 0.5 else None)
        except InputError as error:
            _judge(error)
            raise
    if not broken:
        check(found.suspension, strut)


def _commented(random: Generator, data: Any) -> str:
    lines = json.dumps(data, indent=1).splitlines()
    return "\n".join(
        line + (COMMENTS[random.integers(len(COMMENTS))] if random.random() < 0.3 else "")
        for line in lines
    )


def _judge(error: InputError) -> None:
    said = str(error)
    if len(said) > 500 * (len(error.problems) + 1):
        raise RawError(f"{len(said)} characters: {said[:300]}") from error


def check(suspension: Any, given: dict[str, Any]) -> None:
    """Points and masses are those of the file."""
    for name, (part, key) in POINTS[given["Template"]].items():
        found = np.array(getattr(suspension.hardpoints, name))
        if not np.allclose(found, given[part][key], rtol=1e-12, atol=1e-12):
            raise WrongError(f"{name} = {found} m, in the file {given[part][key]}")
    mass = suspension.bodies.knuckle.mass_kg
    if mass != given["Upright"]["Mass"]:
        raise WrongError(f"upright {mass} kg, in the file {given['Upright']['Mass']}")
    for name, value in suspension.parameters().items():
        if not np.isfinite(value):
            raise WrongError(f"{name} = {value}")
