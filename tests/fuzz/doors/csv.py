"""Measured roads and rack motions: tables in all dialects, and corrupt tables."""

import tempfile
from pathlib import Path

import numpy as np
from kintrafo.core.errors import InputError
from kintrafo.vehicle.analysis.measurement import measured

from .. import mutations
from ..attempts import RawError, WrongError

SHORT = 300
FACTORS = {
    "road_height_mm": 1e-3, "road_height_m": 1.0, "rack_position_mm": 1e-3, "rack_position_m": 1.0,
    "strut_force_N": 1.0, "spring_actuator_N": 1.0,
}  # fmt: skip
ODD = (
    "Road Height (in)",
    "roadheight mm",
    "TIME [s]",
    "mm",
    "time (furlong)",
    "road_height",
    "[m]",
)
CELLS = ("", " ", "nan", "inf", "-inf", "1e400", "1e308", "-1e308", "x", "1,5", "1.5.2", "1_0", "٣",
         '"', "=1+1", "0x10", "1e-400", "--1", "1 2")  # fmt: skip


def attempt(random):
    """Write a table, as it should be or not, and read it."""
    times = np.sort(random.uniform(0.0, 10.0, random.integers(1, 12))).round(3)
    values = random.normal(0.0, 20.0, times.size).round(3)
    distance = random.random() < 0.3
    first = "distance_m" if distance else str(random.choice(["time_s", "time_ms"]))
    name = str(random.choice(list(FACTORS)))
    delimiter = str(random.choice([",", ";", "\t"]))
    decimal = "." if delimiter == "," else str(random.choice([".", ","]))
    spelt, units = _spelt(random, first, name)
    cells = [[*spelt, "remark"]]
    cells += [[f"{t}", f"{v}", "x"] for t, v in zip(times, values, strict=True)]
    broken = random.random() < 0.7
    if broken:
        row, column = random.integers(len(cells)), random.integers(3)
        cells[row][column] = str(random.choice([*CELLS, *FACTORS, "time_s", "distance_m", *ODD]))
    rows = [delimiter.join(row) for row in cells]
    text = "\r\n".join([rows[0], *(row.replace(".", decimal) for row in rows[1:])])
    text = _with_units(random, text, units, delimiter)
    content = text.encode(str(random.choice(["utf-8", "utf-8-sig"])))
    if broken and random.random() < 0.5:
        content = mutations.bytes_of(random, content)
    speeds = [10.0, None, 0.0, float("nan"), 1e-308, 1e308]
    speed = speeds[random.integers(len(speeds))] if random.random() < 0.2 else None
    if distance and speed is None and random.random() < 0.8:
        speed = 10.0
    # nothing is wrong with a table of two times or more, of which a distance has its speed
    sound = not broken and times[-1] > times[0] and speed == (10.0 if distance else None)
    try:
        found = read(content, speed)
    except InputError as error:
        if sound:
            raise WrongError(f"{text}: {error}") from error
        raise
    check(found)
    if not broken:
        scale = {"time_s": 1.0, "time_ms": 1e-3, "distance_m": 1.0 / (speed or 1.0)}[first]
        _same(found.times, scale * (times - times[0]))
        (samples,) = found.values.values()
        _same(samples, FACTORS[name] * values)


def _spelt(random, *names):
    """Return names of columns in one of the forms that people write, and units that follow."""
    parts = [name.rpartition("_") for name in names]
    labels = [name.replace("_", str(random.choice(["_", " ", "-", ""]))) for name, _, _ in parts]
    if random.random() < 0.5:
        labels = [label.title() for label in labels]
    units = [unit for _, _, unit in parts]
    how = random.random()
    if how < 0.3:
        return [*names], []
    if how < 0.5:
        return [f"{label} [{unit}]" for label, unit in zip(labels, units, strict=True)], []
    if how < 0.7:
        return [f"{label} ({unit})" for label, unit in zip(labels, units, strict=True)], []
    return labels, units


def _with_units(random, text, units, delimiter):
    """Return a table with its units in a row of their own, or in a comment."""
    if not units:
        return text
    head, _, rest = text.partition("\r\n")
    row = delimiter.join([*units, ""])
    if units[0] == units[1] or random.random() < 0.5:
        return f"{head}\r\n{row}\r\n{rest}"
    if random.random() < 0.5:
        return f"{head}\r\n# {row}\r\n{rest}"
    # both are stated at once: only where no two are of one kind
    if {*units} & {"m", "mm"} and len({*units} & {"m", "mm"}) > 1:
        return f"{head}\r\n{row}\r\n{rest}"
    return f"# units: {', '.join(units)}\r\n{text}"


def read(content, speed):
    """Read a table; a refusal must name the file, or the speed that it was given."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "road.csv")
        path.write_bytes(content)
        try:
            return measured(path, speed=speed)
        except InputError as error:
            if str(path) not in str(error) and "speed =" not in str(error):
                raise RawError(str(error)) from error
            raise


def check(found):
    """Numbers are finite, times rise from zero, and each value has its time."""
    if found.times[0] != 0.0 or np.any(np.diff(found.times) < 0.0):
        raise WrongError(f"times {found.times}")
    for name, samples in {"times": found.times, **found.values}.items():
        if samples.shape != found.times.shape or not np.all(np.isfinite(samples)):
            raise WrongError(f"{name} {samples}")


def _same(found, expected):
    # two roundings of each value, and one of the difference from the first time
    if not np.allclose(found, expected, rtol=1e-12, atol=1e-13 * (1.0 + np.abs(expected).max())):
        raise WrongError(f"{found} instead of {expected}")
