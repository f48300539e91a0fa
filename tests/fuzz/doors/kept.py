"""Checkpoints of an ensemble, damaged: computed again or an error, with the same numbers."""

import atexit
import json
import shutil
import tempfile
import warnings
from functools import cache
from pathlib import Path

import kintrafo
import numpy as np
from kintrafo.ensembles.chunks import cutting

from ..attempts import WrongError
from .cache import DAMAGE as OF_FILES

SHORT = 20


@cache
def sound():
    """Return the folder of an ensemble, in chunks of few cars, and its numbers."""
    cutting._FEWEST = cutting._MOST = 4
    folder = Path(tempfile.mkdtemp()) / "kept"
    atexit.register(shutil.rmtree, folder.parent, ignore_errors=True)
    return folder, computed(folder)


def computed(folder):
    """Simulate what is missing, and return the numbers of all."""
    cars = {"damper_rate": np.linspace(1000.0, 2000.0, 10)}
    given = {"signals": ["camber"], "t_eval": [0.0, 0.01]}
    found = kintrafo.ensemble(model(), cars, (0.0, 0.01), kept=folder, **given)
    return bytes(found["camber"].values.tobytes() + found["final_state"].values.tobytes())


@cache
def model():
    """Return the car."""
    return kintrafo.Model("reference_car")


def attempt(random):
    """Damage a copy once to three times; go on from it, and from what is there then."""
    target, values = sound()
    with tempfile.TemporaryDirectory() as name, warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # which tells of damage
        folder = Path(name) / "kept"
        shutil.copytree(target, folder)
        for _ in range(random.integers(1, 4)):
            DAMAGE[random.integers(len(DAMAGE))](random, folder)
        if computed(folder) != values:
            raise WrongError("other numbers than those of a sound one")
        warnings.simplefilter("error", RuntimeWarning)
        if computed(folder) != values:
            raise WrongError("not healed")


def _of_another(random, folder):
    path = folder / "ensemble.json"
    if path.is_file():
        wrong = [[], {}, None, 3, {"equations": 3}, {"equations": []}]
        path.write_text(json.dumps(wrong[random.integers(len(wrong))]))


def _chunks(folder):
    return sorted(path for path in folder.glob("*.npz") if path.is_file())


def _in_the_directory(random, folder):
    """Change one bit of the list of arrays at the end of a file."""
    chunks = _chunks(folder)
    if not chunks:
        return
    path = chunks[random.integers(len(chunks))]
    content = bytearray(path.read_bytes())
    first = content.find(b"PK\x01\x02")
    if first >= 0:
        content[random.integers(first, len(content))] ^= 1 << int(random.integers(8))
        path.write_bytes(content)


def _exchange(random, folder):
    """Exchange two files, each of which is sound."""
    chunks = _chunks(folder)
    if len(chunks) > 1:
        one, other = random.choice(len(chunks), 2, replace=False)
        contents = chunks[one].read_bytes(), chunks[other].read_bytes()
        chunks[other].write_bytes(contents[0])
        chunks[one].write_bytes(contents[1])


DAMAGE = (*OF_FILES, *OF_FILES, _of_another, *(_in_the_directory,) * 8, *(_exchange,) * 2)
