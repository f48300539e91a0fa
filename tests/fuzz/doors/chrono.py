"""Files of Project Chrono: JSON with comments, corrupt, deeply nested, with wrong keys."""

import json
import tempfile
from pathlib import Path

import numpy as np
from kintrafo.core.errors import InputError
from kintrafo.vehicle.files.chrono import read

from .. import keys, mutations
from ..attempts import RawError, WrongError

DATA = Path(__file__).parents[2] / "data/chrono"


def _uncommented(name):
    """Return a file of the tests, whose comments are whole lines."""
    lines = (DATA / name).read_text(encoding="utf-8").splitlines()
    return json.loads("\n".join(x for x in lines if not x.startswith("//")))


def _with_stops(data):
    """Return a file whose spring has stops."""
    spring = data["Spring"] | {"Minimum Length": 0.3, "Maximum Length": 0.55}
    return data | {"Spring": spring}


PLAIN = tuple(_uncommented(f"{name}.json") for name in ("MacPhersonStrut", "DoubleWishbone"))
FILES = PLAIN + tuple(map(_with_stops, PLAIN))
TIRE = _uncommented("RigidTire.json")
SHORT = 150
BUSH = {"Stiffness Linear": 7e7, "Damping Linear": 3.5e4, "DOF": {"Stiffness Linear": 0.5}}
CURVE = [[-1.0, -4000.0], [0.0, 0.0], [1.0, 4000.0]]
OF_ELEMENTS = {
    "Preload": 25.0, "Minimum Length": 0.2, "Maximum Length": 0.6, "Free Length": 0.4,
    "Spring Coefficient": 5e4, "Damping Coefficient": 50.0, "Spring Curve Data": CURVE,
    "Damping Curve Data": CURVE, "Curve Data": CURVE, "Map Data": [[-1.0, 1.0], [1.0, 2.0]],
    "Deformation": [0.3], "Degressivity Compression": 0.1, "Degressivity Expansion": 0.1,
}  # fmt: skip
OF_BODIES = {
    "Bushing Data": BUSH, "Inertia": [0.03, 0.02, 0.04], "Moments of Inertia": [0.03, 0.02, 0.04],
    "Products of Inertia": [1e-4, 2e-4, 3e-4], "Radius": 0.03, "Width": 0.04, "Mass": 2.5,
}  # fmt: skip
OF_FILES = {"Vehicle-Frame Inertia": True, "Camber Angle (deg)": 1.5, "Toe Angle (deg)": 0.5,
            "Output": True, "Camber Angle": 2.0, "Visualization": {"Mesh": "x.obj"}}  # fmt: skip
# what else a key may be called: of no template
UNKNOWN = {"Wishes": [1, 2], "Remark": "none", "Own": {"Deep": {"Deeper": 1.25}}, "Rate": 7.5}
OWN_MASS = {"Mass": 11.5, "Inertia": [0.4, 0.7, 0.4]}
OF_A_TIRE = {"Unloaded Radius": 0.33, "Vertical Stiffness": 2.5e5, "Width": 0.2}
DESIGN = {"Unloaded Radius [m]": 0.33, "Mass [kg]": 11.5, "Inertia [kg.m2]": [0.4, 0.7, 0.4],
          "Rim Radius [m]": 0.2}  # fmt: skip
TIRES = {
    "RigidTire": OWN_MASS | {"Radius": 0.33, "Width": 0.2},
    "TMeasyTire": {"Design": DESIGN, "Load Index": 94},
    "TMsimpleTire": {"Design": DESIGN,
                     "Parameters": {"Vertical": {"Vertical Tire Stiffness [N/m]": 2e5}}},
    "FialaTire": OWN_MASS | {"Fiala Parameters": OF_A_TIRE},
    "Pac89Tire": OWN_MASS | {"Design Parameters": OF_A_TIRE, "Lateral Coefficients": {"a0": 1.65}},
    "Pac02Tire": OWN_MASS | {"Dimension": {"Unloaded Radius": 0.33}, "Scaling": {"LFZO": 1.0}},
    "MFTire": OWN_MASS | {"UNITS": {"LENGTH": "meter"}, "DIMENSION": {"UNLOADED_RADIUS": 0.33}},
    "ReissnerTire": {"Tire Radius": 0.33, "Rim Radius": 0.2},
}  # fmt: skip
MORE_OF_TIRES = OF_A_TIRE | OWN_MASS | {"Vertical Curve Data": CURVE, "Radius": 0.3}
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


def attempt(random):
    """Read a file that was changed, or one with a key more, or misspelt."""
    if random.random() < 0.5:
        _attempt_keys(random)
    else:
        _attempt_values(random)


def _attempt_values(random):
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
        how = random.random()
        try:
            if how < 0.3:
                found = read(path, points_only=True)
            else:
                found = read(path, tire=other if how < 0.7 else None)
        except InputError as error:
            _judge(error)
            raise
    if not broken:
        check(found.suspension, strut, points_only=how < 0.3)


def _attempt_keys(random):
    """Add a key, or spell one otherwise: it is used, listed with its value, or refused."""
    of_tire = random.random() < 0.3
    points_only = not of_tire and random.random() < 0.4
    if of_tire:
        template = str(random.choice(list(TIRES)))
        data = {"Name": "own", "Type": "Tire", "Template": template} | TIRES[template]
    else:
        data = FILES[random.integers(len(FILES))]

    def result(changed):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "file.json")
            path.write_text(json.dumps(changed), encoding="utf-8")
            if of_tire:
                found = read(DATA / "MacPhersonStrut.json", tire=path)
            else:
                found = read(path, points_only=points_only)
        return found.suspension.to_dict(), "\n".join(found.left_out)

    before, _ = result(data)
    every = list(keys.places(data))
    place = every[random.integers(len(every))]
    if random.random() < 0.5:
        less, value = keys.without(data, place)
        _judge_respelt(result, before, less, (*place[:-1], keys.respelt(random, place[-1])), value)
        return
    changed = json.loads(json.dumps(data))
    known = MORE_OF_TIRES if of_tire else OF_ELEMENTS | OF_BODIES | OF_FILES
    offered = known if random.random() < 0.7 else UNKNOWN
    key = str(random.choice(list(offered)))
    holder = keys.holder_of(changed, place)
    if key not in holder:
        holder[key] = offered[key]
        after, left_out = result(changed)
        if after == before and not _is_listed(key, offered[key], left_out):
            raise WrongError(f"{(*place[:-1], key)} = {offered[key]} is lost")


def _judge_respelt(result, before, less, place, value):
    """A key that does something is refused in another spelling, any other is listed."""
    try:
        matters = result(less)[0] != before
    except InputError:
        matters = True
    keys.holder_of(less, place)[place[-1]] = value
    after, left_out = result(less)
    if matters and after != before:
        raise WrongError(f"{place} is another spelling, and its value is lost: {left_out}")
    if after == before and not matters and not _is_listed(place[-1], value, left_out):
        raise WrongError(f"{place} = {value} is lost")


def _is_listed(key, value, left_out):
    """Return whether a key and its value stand there, or those within it."""
    if isinstance(value, dict):
        return all(_is_listed(inner, one, left_out) for inner, one in value.items())
    return f"{key} = {json.dumps(value)}"[:80] in left_out


def _commented(random, data):
    lines = json.dumps(data, indent=1).splitlines()
    return "\n".join(
        line + (COMMENTS[random.integers(len(COMMENTS))] if random.random() < 0.3 else "")
        for line in lines
    )


def _judge(error):
    message = str(error)
    if len(message) > 500 * (len(error.problems) + 1):
        raise RawError(f"{len(message)} characters: {message[:300]}") from error


def check(suspension, given, *, points_only=False):
    """Points and masses are those of the file."""
    for name, (part, key) in POINTS[given["Template"]].items():
        found = suspension.hardpoints.metres(name)
        if not np.allclose(found, given[part][key], rtol=1e-12, atol=1e-12):
            raise WrongError(f"{name} = {found} m, in the file {given[part][key]}")
    mass = suspension.bodies.knuckle.mass_kg
    if not points_only and mass != given["Upright"]["Mass"]:
        raise WrongError(f"upright {mass} kg, in the file {given['Upright']['Mass']}")
    for name, value in suspension.parameters().items():
        if not np.isfinite(value):
            raise WrongError(f"{name} = {value}")
