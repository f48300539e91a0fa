"""The cache of compiled mechanisms, damaged: an error, or the same results."""

import atexit
import json
import os
import shutil
import sys
import tempfile
import warnings
from functools import cache
from pathlib import Path

import kintrafo
import numpy as np
from kintrafo.generator.equations import outputs
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.planning.proposal import model_of
from kintrafo.systems.compile.cache import damage
from kintrafo.systems.compile.compiler import Compiler

from ..attempts import WrongError

SHORT = 6
STATES = np.random.default_rng(8).normal(size=(6, 2)) * [0.3, 2.0]


@cache
def sound():
    """Return the folder of a mechanism and what it computes; from then on nothing is compiled."""
    derived = outputs.generate(model_of(FOUR_BAR))
    outputs.generate = lambda _, **__: derived
    os.environ["CFLAGS"] = "-O0"  # compiled once, and hardly run
    root = Path(tempfile.mkdtemp())
    atexit.register(shutil.rmtree, root, ignore_errors=True)
    values = computed(root)
    (target,) = root.iterdir()
    library = target / "libfour_bar.so"
    if library.exists():
        kept = library.read_bytes()
        Compiler.build = lambda _, __, path, *___: path.write_bytes(kept) and None
    return target, values


def computed(root):
    """Load the mechanism of a cache anew, and compute with it."""
    for name in [name for name in sys.modules if name.startswith("kintrafo_four_bar_")]:
        del sys.modules[name]
    module = kintrafo.compile(FOUR_BAR, folder=root)
    return bytes(module.rhs(STATES).tobytes())


def attempt(random):
    """Damage a copy once to three times; load it, and load it again."""
    target, values = sound()
    with tempfile.TemporaryDirectory() as name:
        root = Path(name)
        folder = root / target.name
        shutil.copytree(target, folder)
        for _ in range(random.integers(1, 4)):
            DAMAGE[random.integers(len(DAMAGE))](random, folder)
        damaged, there = bool(damage(folder)), folder.exists()
        with warnings.catch_warnings(record=True) as shown:
            warnings.simplefilter("always")
            found = computed(root)
        if found != values:
            raise WrongError("other numbers than those of a sound one")
        if (damaged and there) != any("built again" in str(one.message) for one in shown):
            raise WrongError(f"damaged: {damaged}, warned: {[str(one.message) for one in shown]}")
        if damage(folder) or computed(root) != values:
            raise WrongError("not healed")


def _file(random, folder):
    files = sorted(p for p in folder.glob("*") if p.is_file()) or [folder / "manifest.json"]
    return files[random.integers(len(files))]


def _cut(random, folder):
    path = _file(random, folder)
    if path.exists():
        content = path.read_bytes()
        path.write_bytes(content[: int(random.integers(len(content) + 1))])


def _flip(random, folder):
    path = _file(random, folder)
    if path.exists() and path.stat().st_size:
        content = bytearray(path.read_bytes())
        content[random.integers(len(content))] ^= 1 << int(random.integers(8))
        path.write_bytes(content)


def _remove(random, folder):
    if folder.is_dir():
        _file(random, folder).unlink(missing_ok=True)


def _replace_by_another(random, folder):
    one, other = _file(random, folder), _file(random, folder)
    if one.exists() and other.exists():
        one.write_bytes(other.read_bytes())


def _replace_by_no_file(random, folder):
    if not folder.is_dir():
        return
    path = _file(random, folder)
    path.unlink(missing_ok=True)
    how = random.integers(4)
    if how == 0:
        path.mkdir()
    elif how == 1:
        path.symlink_to("nowhere")
    elif how == 2:
        path.symlink_to(path.name)
    else:
        os.mkfifo(path)


def _forbid(random, folder):
    path = _file(random, folder)
    if path.exists():
        path.chmod(0)


def _empty(_, folder):
    if folder.is_dir():
        shutil.rmtree(folder)
        folder.mkdir()


def _away(_, folder):
    if folder.is_dir():
        shutil.rmtree(folder)


def _file_instead(_, folder):
    if folder.is_dir():
        shutil.rmtree(folder)
        folder.write_text("somebody's file")


def _foreign(random, folder):
    if folder.is_dir():
        (folder / "notes.txt").write_bytes(random.bytes(9))
        (folder / "__pycache__").mkdir(exist_ok=True)
        tag = sys.implementation.cache_tag
        (folder / "__pycache__" / f"four_bar.{tag}.pyc").write_bytes(random.bytes(99))


def _manifest(random, folder):
    path = folder / "manifest.json"
    if not path.is_file():
        return
    wrong = [
        [], {}, None, 3, {"files": 3, "folder": folder.name}, {"files": {}, "folder": "another"},
        {"files": {"a": [1]}, "folder": folder.name}, {"files": {"a": ["x", 1]}, "folder": 3},
        {"files": {"../a": [1, "x"]}, "folder": folder.name},
        {"files": {"\0": [1, "x"]}, "folder": folder.name},
    ]  # fmt: skip
    path.write_text(json.dumps(wrong[random.integers(len(wrong))]))


DAMAGE = (
    _cut, _cut, _flip, _flip, _remove, _remove, _replace_by_another, _replace_by_no_file, _forbid,
    _empty, _away, _file_instead, _foreign, _manifest,
)  # fmt: skip
