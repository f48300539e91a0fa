"""Tables of hardpoints in all spellings, units and axes, and with typing errors."""

import re
import tempfile
from fractions import Fraction
from pathlib import Path

import numpy as np
from kintrafo import Suspension
from kintrafo.core.errors import InputError
from kintrafo.vehicle.files.point_table import merged, read_points, write_merged
from kintrafo.vehicle.kinds import KINDS

from .. import mutations
from ..attempts import RawError, WrongError

SHORT = 100
CARS = {kind: Suspension.load(KINDS[kind].STARTER) for kind in KINDS}
MILLIMETRES = {
    "mm": Fraction(1), "cm": Fraction(10), "m": Fraction(1000), "in": Fraction(254, 10),
    "ft": Fraction(3048, 10),
}  # fmt: skip
SPELT = {
    "mm": ("mm", "MM", "Millimetres"), "cm": ("cm", "centimeter"), "m": ("m", "Meters"),
    "in": ("in", "Inch", "INCHES"), "ft": ("ft", "feet"),
}  # fmt: skip
POINTING = {
    "forward": (1, 0, 0), "rearward": (-1, 0, 0), "left": (0, 1, 0),
    "right": (0, -1, 0), "up": (0, 0, 1), "down": (0, 0, -1),
}  # fmt: skip
CELLS = (
    "", "x", "nan", "inf", "1e400", "1_0", "1,5", "--1", "0x1F", "mm", "[in]", "=1+1", '"', "#",
    "y [mm]", "x", "units: in", "٣", "9" * 400, "é\u2028",
)  # fmt: skip
OPTIONS = (
    {"axes": None}, {"left_handed": True}, {"unit": "in"}, {"sheet": "x"},
)  # fmt: skip
COMMENTS = (
    "# a remark\n", "# units: {0}\n", "# lengths in {0}\n", "# {0}\n", "# units: ells\n", "#\n",
    "# units: {0}, deg\n", "# units: mm\n", "# all coordinates are in {0}.\n",
)  # fmt: skip


def attempt(random):
    """Write the hardpoints of a car as other programs do, read them, and look at each number."""
    car = CARS[str(random.choice(list(CARS)))]
    names = [*random.permutation(car.hardpoints.given())][: random.integers(1, 12)]
    unit = str(random.choice(list(MILLIMETRES)))
    words = _axes(random)
    places = {str(name): _there(car, str(name), unit, words) for name in names}
    rows, how = _table(random, unit, places)
    broken = random.random() < 0.5
    if broken:
        _slip(random, rows)
    content = _written(random, rows, unit, how, broken=broken)
    options = {"axes": " ".join(words), "left_handed": _volume(words) < 0}
    if how == "given":
        options["unit"] = unit
    if broken and random.random() < 0.3:
        options |= OPTIONS[random.integers(len(OPTIONS))]
    with tempfile.TemporaryDirectory() as folder:
        path, new = Path(folder, "points.csv"), Path(folder, "new.toml")
        path.write_bytes(content)
        try:
            table = read_points(path, **options)
            found = merged(table, KINDS[car.suspension].STARTER)
            write_merged(found, new)
        except InputError as error:
            _judge(error, new)
            if not broken:
                raise WrongError(f"{content!r}: {error}") from error
            raise
        read = Suspension.load(new)
    if broken:
        _stand_there(content, table, found)
        return
    if set(found.read) != set(places):
        raise WrongError(f"{content!r}: read was {found.read}")
    for name in places:
        _same(np.array(getattr(read.hardpoints, name)), np.array(getattr(car.hardpoints, name)))


def _written(random, rows, unit, how, *, broken):
    """Return a table as a file has it, with comments and broken bytes where it is broken."""
    delimiter = str(random.choice([",", ";", "\t"]))
    text = "\n".join(delimiter.join(row) for row in rows)
    if broken and random.random() < 0.5:
        comment = COMMENTS[random.integers(len(COMMENTS))].format(unit)
        text = comment + text if random.random() < 0.5 else text.replace("\n", "\n" + comment, 1)
    if how == "comment":
        text = f"# units: {unit}\n{text}"
    content = text.encode("utf-8-sig" if random.random() < 0.2 else "utf-8")
    return mutations.bytes_of(random, content) if broken and random.random() < 0.3 else content


def _axes(random):
    """Return three axes that are one of each pair, as a car's own in a third of the attempts."""
    if random.random() < 0.3:
        return ["forward", "left", "up"]
    pairs = (("forward", "rearward"), ("left", "right"), ("up", "down"))
    return [str(random.choice(pairs[i])) for i in random.permutation(3)]


def _volume(words):
    return float(np.linalg.det([POINTING[word] for word in words]))


def _there(car, name, unit, words):
    """Return the coordinates of a point in other axes and another unit, as texts."""
    place = [Fraction(value) for value in getattr(car.hardpoints, name)]
    assert car.hardpoints.unit == "mm"
    along = [sum(d * p for d, p in zip(POINTING[word], place, strict=True)) for word in words]
    return [repr(float(value / MILLIMETRES[unit])) for value in along]


def _table(random, unit, places):
    """Return the cells of a table, and where its unit stands."""
    how = str(random.choice(["brackets", "parentheses", "ending", "row", "comment", "given"]))
    spelt = str(random.choice(SPELT[unit]))
    axis = {
        "brackets": "{} [{}]", "parentheses": "{} ({})", "ending": "{}_{}",
    }.get(how, "{}")  # fmt: skip
    capitals = random.random() < 0.5
    heading = [str(random.choice(["point", "Name", "Feature Name", "hard-point"]))]
    heading += [axis.format("XYZ"[i] if capitals else "xyz"[i], spelt) for i in range(3)]
    rows = [heading, *([["", spelt, spelt, f"[{spelt}]"]] if how == "row" else [])]
    rows += [[_spelling(random, name), *cells] for name, cells in places.items()]
    order = [*random.permutation(4)]
    if random.random() < 0.3:
        rows = [[row[i] for i in order] for row in rows]
    if random.random() < 0.3:
        rows = [[*row, "remark" if row is rows[0] else ""] for row in rows]
    return rows, how


def _spelling(random, name):
    words = name.split("_")
    joint = str(random.choice(["_", " ", "-", ""]))
    if random.random() < 0.5:
        words = [word.capitalize() for word in words]
    return joint.join(words).upper() if random.random() < 0.2 else joint.join(words)


def _slip(random, rows):
    """Change one or two cells, or rows: lost, doubled, or doubled in another spelling."""
    for _ in range(random.integers(1, 3)):
        at = int(random.integers(len(rows)))
        how = random.random()
        if how < 0.5 and rows[at]:
            rows[at][random.integers(len(rows[at]))] = CELLS[random.integers(len(CELLS))]
        elif how < 0.75:
            again = [cell.upper() if random.random() < 0.5 else cell for cell in rows[at]]
            rows.insert(int(random.integers(len(rows) + 1)), again)
        elif len(rows) > 1:
            del rows[at]


def _judge(error, new):
    if new.exists():
        raise WrongError(f"refused and written: {error}") from error
    if len(str(error)) > 2100 * (len(error.problems) + 1):
        raise RawError(f"{len(str(error))} characters") from error


def _stand_there(content, table, found):
    """Every coordinate that was taken is a number of the file; no point was taken twice."""
    text = content.decode("utf-8-sig").replace(",", " ").replace(";", " ")
    numbers = {
        abs(float(n)) for n in re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", text)
    }
    numbers |= {abs(float(f"{a}.{b}")) for a, b in re.findall(r"(\d+),(\d+)", content.decode())}
    keys = [re.sub(r"[\W_]+", "", name).casefold() for name in table.points]
    if len({*keys}) < len(keys):
        raise WrongError(f"points {[*table.points]}")
    for name in found.read.values():
        if not {abs(value) for value in table.points[name]} <= numbers:
            raise WrongError(f"{name} at {table.points[name]} is not there: {text}")


def _same(found, expected):
    # a rounding of the conversion to the other unit, and one of that back
    if not np.allclose(found, expected, rtol=4.5e-16, atol=0.0):
        raise WrongError(f"{found} instead of {expected}")
