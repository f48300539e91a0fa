"""Input files with typing errors, corrupt bytes and impossible values."""

import math
import tempfile
from importlib import resources
from pathlib import Path

import kintrafo.vehicle.data
import tomlkit
from kintrafo import InputError, Model, Suspension

from .. import mutations
from ..attempts import RawError, UnjudgedError, WrongError

FILES = [p for p in resources.files(kintrafo.vehicle.data).iterdir() if p.name.endswith(".toml")]
TEXTS = [path.read_bytes() for path in sorted(FILES, key=lambda path: path.name)]
SHORT = 40
# Words of the libraries below, which help nobody who wrote a hardpoint file.
STRANGE_WORDS = ("Traceback", "validation error", "pydantic", "object at 0x", "For further info")


def attempt(random):
    """Read a file that was changed, and compare what was read with another parser's result."""
    text = TEXTS[random.integers(len(TEXTS))]
    if random.random() < 0.5:
        text = mutations.bytes_of(random, text)
    else:
        data = mutations.nested(random, tomlkit.parse(text).unwrap())
        try:
            text = tomlkit.dumps(data).encode("utf-8", "surrogatepass")
        except (ValueError, TypeError) as error:
            raise UnjudgedError("TOML has no word for it") from error
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "car.toml")
        path.write_bytes(text)
        suspension = read(path)
    check(suspension, text)


def read(path):
    """Read a file; a refusal must name it and speak of it."""
    try:
        return Suspension.load(path)
    except InputError as error:
        message = str(error)
        if str(path) not in message or any(word in message for word in STRANGE_WORDS):
            raise RawError(message) from error
        if len(message) > 500 * (len(error.problems) + 1):
            raise RawError(f"{len(message)} characters: {message[:300]}") from error
        raise


def check(suspension, text):
    """The values are those of the file, and the model is in their position."""
    given = tomlkit.parse(text.decode("utf-8-sig").replace("\r\n", "\n")).unwrap()
    compare(given, suspension.to_dict(), "file")
    for name, value in suspension.parameters().items():
        if not math.isfinite(value):
            raise WrongError(f"{name} = {value}")
    model = Model(suspension)
    unit = 1e-3 if suspension.hardpoints.unit == "mm" else 1.0
    for axis, coordinate in zip("xyz", suspension.hardpoints.wheel_center, strict=True):
        found = float(model.signal(f"wheel_center_{axis}", model.design_state))
        # roundings of the longest distance in the mechanism
        if abs(found - unit * coordinate) > 1e-9 * max(1.0, abs(found)):
            raise WrongError(f"wheel_center_{axis} {found} m, in the file {unit * coordinate} m")


def compare(given, found, place):
    """Compare what another parser reads with what was taken."""
    if isinstance(given, dict):
        for key, value in given.items():
            compare(value, found[key], f"{place}.{key}")
    elif isinstance(given, list):
        for index, (one, other) in enumerate(zip(given, found, strict=True)):
            compare(one, other, f"{place}[{index}]")
    elif (float(given) if type(given) is int else given) != found:
        raise WrongError(f"{place}: {found!r} was taken, and {given!r} stands there")
