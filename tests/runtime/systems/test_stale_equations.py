"""Compiled equations follow every edit of a declaration, of its code and of files that it reads."""

import json
import math
import os
import sys
from copy import deepcopy
from dataclasses import fields

import kintrafo
import pytest
from kintrafo.equations import Equations
from kintrafo.equations.errors import ModelError
from kintrafo.generated import four_bar as four_bar_equations
from kintrafo.generator.declare.declared import parts
from kintrafo.generator.mechanisms import front_axle
from kintrafo.systems.compile.identity import identity
from kintrafo.vehicle.cli import app
from typer.testing import CliRunner

FORCE = """
from dataclasses import dataclass
from kintrafo import generator as g
import law
RATE = {constant}
@dataclass(frozen=True)
class Mine(g.Force):
    joint: g.Revolute
    @property
    def identity(self):
        return "Mine", "spring"
    def act(self, at):
        q, _ = at.hinge(self.joint.name)
        return g.Action({{at.coordinate(self.joint.name): {source} * RATE * law.of(q)}})
GROUND = g.Ground("ground")
ARM = g.Body("arm", 1.0, g.flat("com", (0.0, 0.0)), 1.0)
A = g.hinge("A", GROUND, ARM, g.flat("a", (0.0, 0.0)))
M = g.Mechanism(
    name="edited", title="t", joints=(A,), forces=(Mine(A),), coordinates=(A.angle("q", "q"),)
)
"""
HELPER = "from pack.inner import FACTOR\n\ndef of(q):\n    return {helper} * FACTOR * q\n"
NUMBERS = {"constant": 2.0, "source": 3.0, "helper": 5.0, "inner": 7.0}


def written(folder, numbers):
    """Write the declaration, what it imports, and what that imports; all of the same size."""
    (folder / "pack").mkdir(exist_ok=True)
    for name, text in {
        "mine.py": FORCE.format(**numbers),
        "law.py": HELPER.format(**numbers),
        "pack/__init__.py": "",
        "pack/inner.py": f"FACTOR = {numbers['inner']}\n",
    }.items():
        (folder / name).write_text(text)
        os.utime(folder / name, (1e9, 1e9))  # Python trusts compiled bytes by date and size
    return folder / "mine.py"


def acceleration(file, cache):
    return kintrafo.compile(file, folder=cache, backend="numpy").rhs([[1.0, 0.0]])[0, 1]


def test_every_edit_counts(tmp_path):
    """The moment of inertia and the angle are one: the acceleration is the product."""
    for numbers in (NUMBERS, *(NUMBERS | {edited: 9.0} for edited in NUMBERS), NUMBERS):
        found = acceleration(written(tmp_path, numbers), tmp_path / "cache")
        assert found == pytest.approx(math.prod(numbers.values()), rel=1e-15)
    assert len(list((tmp_path / "cache").iterdir())) == 1 + len(NUMBERS)


def test_what_was_imported_before_is_no_obstacle_and_stays(tmp_path, monkeypatch):
    """A notebook has imported the helper; the file is run with the one that is there now."""
    file = written(tmp_path, NUMBERS)
    monkeypatch.syspath_prepend(tmp_path)
    import law

    assert acceleration(file, tmp_path / "cache") == pytest.approx(210.0)
    written(tmp_path, NUMBERS | {"helper": 6.0})
    assert acceleration(file, tmp_path / "cache") == pytest.approx(252.0)
    assert sys.modules.pop("law") is law
    assert "pack" in sys.modules  # by `law`, not by the mechanism
    for name in ("pack", "pack.inner"):
        sys.modules.pop(name)


def test_the_c_that_is_written_is_that_of_now(tmp_path, monkeypatch):
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "cache"))
    texts = []
    for source in (3.0, 4.0):
        file = written(tmp_path, NUMBERS | {"source": source})
        to = ("-o", str(tmp_path / "out"), "--force")
        done = CliRunner().invoke(app, ["mechanism", "generate", str(file), "--numpy", *to])
        assert done.exit_code == 0, done.output
        texts.append((tmp_path / "out" / "edited.c").read_text())
    assert "210.0" in texts[0]
    assert "280.0" in texts[1]


def test_a_class_of_the_generator_is_taken_from_the_cache(tmp_path, monkeypatch):
    from kintrafo.generator.equations import outputs
    from kintrafo.generator.mechanisms.four_bar import FOUR_BAR

    kintrafo.compile(FOUR_BAR, folder=tmp_path, backend="numpy")
    monkeypatch.setattr(outputs, "generate", None)
    kintrafo.compile(FOUR_BAR, folder=tmp_path, backend="numpy")


def test_every_field_counts():
    """Also those that the text of a declaration leaves out: an axle has images of one side."""
    (model,) = front_axle.MODELS
    known = identity(model)
    assert known == identity(deepcopy(model))
    kinds, tried = set(), 0
    for part in parts(model):
        if type(part) in kinds:
            continue
        kinds.add(type(part))
        for entry in fields(part):
            if entry.name == "order":  # counted in this process; the lists have that order
                continue
            value = getattr(part, entry.name)
            object.__setattr__(part, entry.name, "another")
            try:
                changed = identity(model)
            finally:
                object.__setattr__(part, entry.name, value)
            assert changed != known, (type(part), entry.name)
            tried += 1
    assert tried > 100
    assert identity(model) == known


def test_what_is_not_known_is_not_kept_by_its_text():
    (model,) = front_axle.MODELS
    changed = deepcopy(model)
    object.__setattr__(changed, "title", json)
    assert identity(changed) is None


def test_code_of_other_equations_than_the_manifest_describes_is_refused(refused):
    """Arrays of the manifest's sizes would be too small for it."""
    ours, code = four_bar_equations.MECHANISM_HASH, four_bar_equations.ADDRESSES
    Equations.beside(str(four_bar_equations.__file__), code, ours)
    refused(
        ModelError,
        lambda: Equations.beside(str(four_bar_equations.__file__), code, "0" * len(ours)),
    )
