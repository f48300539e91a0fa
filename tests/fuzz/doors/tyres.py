"""Property files of tyres: corrupt, with lost, misspelt or repeated keys; forces by formulas."""

import re
import tempfile
from pathlib import Path

import numpy as np
from cars.tyre_files import FILES
from kintrafo import tyres
from kintrafo.core.errors import InputError
from oracle import magic_formula as oracle

from .. import mutations
from ..attempts import RawError, WrongError

SHORT = 60
VALUES = ("", "x", "nan", "-1e300", "1e-300", "1e999", "0", "-0.0", "1,5", "1_0", "'", "2", "1d-2",
          "9" * 5000, "é\u2028", "$ none", "= 3")  # fmt: skip


def attempt(random):
    """Read a file that was changed; what it does is what the printed equations say."""
    name = str(random.choice(list(FILES)))
    lines = FILES[name].splitlines()
    for _ in range(random.integers(1, 5)):
        i = int(random.integers(len(lines)))
        lines[i] = _changed(random, lines[i])
    text = "\n".join(lines) + "\n"
    content = text.encode("utf-8", "surrogatepass")
    broken = random.random() < 0.2
    if broken:
        content = mutations.bytes_of(random, content)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "own.tir")
        path.write_bytes(content)
        try:
            tyre = tyres.load(path)
        except InputError as error:
            if len(str(error)) > 500 * (len(error.problems) + 1):
                raise RawError(str(error)[:300]) from error
            raise
    _judge(random, tyre)


def _changed(random, line):
    """Return a line with a slip of the hand."""
    key, equals, value = line.partition("=")
    if not equals:
        return line if random.random() < 0.7 else ""
    number = re.match(r"\s*([-+.\deE]+)", value)
    near = float(number[1]) * (1.0 + 0.3 * random.normal()) if number else 0.0
    slips = (
        "",
        f"{key}{equals} {VALUES[random.integers(len(VALUES))]}",
        f"{line}\n{key}{equals} {random.normal():.6g}",
        f"{key.strip()[:-1]}_{key.strip()[-1:]} {equals}{value}",
        *2 * (f"{key}{equals} {near:.6g}",),
    )
    return slips[random.integers(len(slips))]


def _judge(random, tyre):
    """Compare one state with the printed equations, from the numbers that were read."""
    p = oracle.coefficients("\n".join(f"{k} = {v!r}" for k, v in tyre.coefficients.items()))
    load = random.uniform(0.3, 1.5) * tyre.nominal_load
    angle, slip, camber = random.uniform(-0.3, 0.3, 3)
    pressure = tyre.usual_pressure or 1.0
    found = tyre.evaluate(load, angle, slip, camber, extrapolate=True)
    wanted = oracle.evaluate(
        p, load, angle, slip, camber, tyre.usual_speed, pressure, tyre.form.angle
    )
    for name, value in zip(("fx", "fy", "mx", "my", "mz"), wanted, strict=False):
        scale = max(1.0, abs(float(wanted[0])), abs(float(wanted[1])), abs(float(value)))
        # the friction ellipse is smoothed near zero slip
        bound = 1e-2 if not tyre.form.weighted else 1e-7
        if not np.isclose(float(vars(found)[name]), float(value), rtol=bound, atol=bound * scale):
            raise WrongError(f"{name} = {vars(found)[name]}, not {float(value)}: {dict(p)}")
