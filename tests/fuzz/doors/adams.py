"""Subsystems of Adams/Car: typing errors, unknown keys, corrupt bytes, other units."""

import re
import tempfile
from pathlib import Path

import numpy as np
from cars.adams_files import MILLIMETRES, rows_of, subsystem
from kintrafo import Suspension
from kintrafo.core.errors import InputError
from kintrafo.vehicle.files.adams_car import imported, read
from kintrafo.vehicle.files.point_table import write_merged
from kintrafo.vehicle.kinds import KINDS

from .. import keys, mutations
from ..attempts import RawError, WrongError

SHORT = 100
CARS = {kind: Suspension.load(KINDS[kind].STARTER) for kind in KINDS}
CELLS = (
    "", "x", "1", "-1e300", "nan", "inf", "1e999", "1,5", "1_0", "'", '"', "'left'", "'single'",
    "$", "!", "[UNITS]", "(x)", "{x}", "LENGTH = 'm'", "9" * 5000, "é\x85\u2028", "0x1F", "1d3",
)  # fmt: skip
MORE = """
[NSPRING_ASSEMBLY]
 USAGE  =  'ride_spring'
 PROPERTY_FILE  =  'own.spr'
 VALUE_TYPE  =  'preload'
 USER_VALUE  =  5000.0
"""
SPRING = """
[UNITS]
 LENGTH  =  'mm'
 FORCE  =  'newton'
[CURVE]
{disp  force}
-50.0  -2250.0
100.0  4500.0
"""
# Lines that a subsystem may have besides, by the block that they stand in; "" for its end. What
# stands in them is what must be listed.
LINES = (
    ("PARAMETER", " 'zeta_7'  'single'  'real'  7.25"),
    ("HARDPOINT", " 'nowhere'  'left/right'  7.25  -300.5  200.0"),
    ("UNITS", " PRESSURE  =  'bar'"),
    ("NSPRING_ASSEMBLY", " INSTALLED_LENGTH  =  251.5"),
    ("SUBSYSTEM_HEADER", " OWNER  =  'nobody'"),
    ("", "[DAMPER_ASSEMBLY]\n USAGE  =  'ride_damper'\n PROPERTY_FILE  =  'own.dpr'"),
    ("", "[OWN_TABLE]\n{own_name  own_value}\n 'first_row'  7.25"),
)
COMMENTS = "(COMMENTS)\n{comment_string}\n'zeta_8 of nobody'\n"
NAMES = (None, None, None, {"wheel_center": "lca_outer"}, {"x": "y"}, {"spring_top": "x"})


def attempt(random):
    """Import a subsystem that was changed, or one with a line more, or misspelt."""
    if random.random() < 0.4:
        _attempt_keys(random)
    else:
        _attempt_values(random)


def _attempt_keys(random):
    """Add a line, or spell a name otherwise: it is used, listed with its value, or refused."""
    kind = str(random.choice(list(CARS)))
    wheel = {"wheel.camber_deg": -1.25, "wheel.toe_deg": 0.75}
    text = subsystem(CARS[kind].with_changes(wheel), more=MORE)
    spring = random.random() < 0.5
    if random.random() < 0.5:
        block, line = LINES[random.integers(len(LINES))]
        bare, text = text, _with_line(text, block, line)
        if block and random.random() < 0.3:
            text = _with_line(text, block, COMMENTS.rstrip())
        words = [word for word in re.split(r"[\s'=\[\]{}]+", line) if word[:4] not in ("", "own_")]
    else:
        lines = text.splitlines()
        rows = [i for i, row in enumerate(lines) if re.match(r" ('?)\w+", row)]
        at = rows[random.integers(len(rows))]
        name = re.findall(r"\w+", lines[at])[0]
        # no blank at the end, which pads
        other = keys.respelt(random, name).rstrip().replace(":", "_")
        row = lines.pop(at)
        bare = "\n".join(lines) + "\n"
        lines.insert(at, row.replace(name, other, 1))
        text = "\n".join(lines) + "\n"
        words = [other, *re.findall(r"[-\w.]+", lines[at].partition(other)[2])[-1:]]
        if other.lower() == name.lower():  # the same to Adams/Car, be it read or of no use
            words = []
    after, left_out = _result(text, kind, spring=spring)
    lost = [word for word in words if word.lower().removesuffix(".0") not in left_out.lower()]
    if lost and not _does_more(bare, after, kind, spring=spring):
        raise WrongError(f"{lost} of {words} are lost: {left_out}")


def _does_more(bare, after, kind, *, spring):
    """Return whether without a line something else came of a file, or nothing."""
    try:
        return bool(_result(bare, kind, spring=spring)[0] != after)
    except InputError:
        return True


def _with_line(text, block, line):
    """Return a file with a line more at the end of a block; at its own end without one."""
    if not block:
        return f"{text}{line}\n"
    begin = text.index(f"[{block}]\n")
    end = text.find("\n[", begin + 1)
    end = text.rfind("\n$", begin, end) if text.rfind("\n$", begin, end) > 0 else end
    end = len(text) - 1 if end < 0 else end
    return f"{text[:end]}\n{line}{text[end:]}"


def _result(text, kind, *, spring):
    """Return what an import gives, and what it lists as left out."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "front.sub").write_text(text, encoding="utf-8")
        if spring:
            Path(folder, "own.spr").write_text(SPRING, encoding="utf-8")
        found = imported(read(Path(folder, "front.sub")), kind=kind)
        new = Suspension.load(write_merged(found, Path(folder, "new.toml")))
    return new.to_dict(), "\n".join(found.left_out)


def _attempt_values(random):
    """Import a subsystem that was changed, and look at what came of each of its hardpoints."""
    kind = str(random.choice(list(CARS)))
    car = CARS[kind] if random.random() < 0.5 else CARS[kind].mirrored()
    unit = str(random.choice(list(MILLIMETRES)))
    text = subsystem(car, unit=unit, rows=_moved(random, rows_of(car, unit)), more=MORE)
    untouched = random.random() < 0.2
    if not untouched:
        text = _slipped(random, text)
    content = text.encode("latin-1", "replace") if random.random() < 0.3 else text.encode()
    if not untouched and random.random() < 0.3:
        content = mutations.bytes_of(random, content)
    how = {
        "side": (None, "left", "right")[random.integers(3)],
        "kind": kind if random.random() < 0.7 else None,
        "base": KINDS[kind].STARTER if random.random() < 0.3 else None,
        "names": NAMES[random.integers(len(NAMES))],
    }
    with tempfile.TemporaryDirectory() as folder:
        path, new = Path(folder, "front.sub"), Path(folder, "new.toml")
        path.write_bytes(content)
        _spring(random, Path(folder, "own.spr"))
        try:
            found = imported(read(path), **how)
            write_merged(found, new)
        except InputError as error:
            _judge(error)
            if new.exists():
                raise WrongError(f"refused and written: {error}") from error
            raise
        _check(content.decode("latin-1"), found, Suspension.load(new), how)


def _spring(random, path):
    """Write the file of a spring, with slips of the hand or broken; or none."""
    if random.random() < 0.7:
        content = _slipped(random, SPRING).encode()
        path.write_bytes(mutations.bytes_of(random, content) if random.random() < 0.3 else content)


def _moved(random, rows):
    """Move every hardpoint by a little."""
    if random.random() < 0.3:
        return rows
    by = random.normal(0.0, 0.001, 3)
    return [
        (n, s, x * (1.0 + by[0]), y * (1.0 + by[1]), z * (1.0 + by[2])) for n, s, x, y, z in rows
    ]


def _slipped(random, text):
    """Change one to three lines: a cell, the order, a line that is lost or there twice."""
    lines = text.splitlines()
    for _ in range(random.integers(1, 4)):
        at = int(random.integers(len(lines)))
        cells = re.split(r"(\s{2,})", lines[at])
        one = int(random.integers(len(cells)))
        how = random.random()
        if how < 0.5:
            cells[one] = CELLS[random.integers(len(CELLS))]
            lines[at] = "".join(cells)
        elif how < 0.7:
            lines[at] = "  ".join(random.permutation(cells).tolist())
        elif how < 0.85:
            lines.insert(at, lines[random.integers(len(lines))])
        elif len(lines) > 1:
            del lines[at]
    return ("\n", "\r\n", "\r")[random.integers(3)].join(lines)


def _judge(error):
    message = str(error)
    if len(message) > 1500 * (len(error.problems) + 1):
        raise RawError(f"{len(message)} characters: {message[:300]}") from error


def _check(text, found, car, how):
    """Every hardpoint that was read stands in a row of the file, in its unit and its axes."""
    text = re.sub(r"\r\n?", "\n", text)
    units = re.findall(r"(?im)^\s*LENGTH\s*=\s*['\"]?\s*(\w+)", text)
    scales = {MILLIMETRES.get(unit.lower(), {"m": 1000.0}.get(unit.lower())) for unit in units}
    if how["side"] and car.vehicle.side != how["side"]:
        raise WrongError(f"{car.vehicle.side} side, asked for was {how['side']}")
    for ours, theirs in found.read.items():
        here = 1000.0 * car.hardpoints.metres(ours)
        expected = np.array([here[0], abs(here[1]), here[2]])
        numbers = [_numbers(line) for line in text.split("\n") if _named(line, theirs)]
        near = any(
            len(row) == 3
            and scale
            and np.allclose([-row[0], abs(row[1]), row[2]], expected / scale, rtol=1e-9)
            for row in numbers
            for scale in scales
        )
        if not near:
            raise WrongError(f"{ours} = {here} mm is no row of {theirs}: {numbers}, {units}")
    outboard = car.hardpoints.metres("wheel_center")[1] * car.vehicle.sign
    if not outboard > 0.0:
        raise WrongError(f"the wheel is {outboard} m outboard")
    if found.spring is not None:
        curve = np.array(found.spring.curve or [(0.0, 0.0), (1.0, found.spring.rate)])
        if not (np.diff(curve[:, 0]) > 0.0).all() or not (np.diff(curve[:, 1]) >= 0.0).all():
            raise WrongError(f"{found.spring}")
    if not all(np.isfinite(value) for value in car.parameters().values()):
        raise WrongError("a parameter is not finite")


def _named(line, name):
    return name in re.findall(r"[^\s'\",]+", line.lower())


def _numbers(line):
    found = re.findall(r"(?:^|[\s,'\"])([-+]?[\d.]+(?:[edED][-+]?\d+)?)(?=$|[\s,'\"$!])", line)
    try:
        return [float(one.lower().replace("d", "e")) for one in found]
    except ValueError:
        return []
