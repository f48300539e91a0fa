"""The walks of docs/contributing.md: each is done on a copy of the sources, and must be found.

The copy is made of links; a folder in which a file is added or changed has its own list of them.
What is added is a file that exists, under other names, and the file it is from is taken away where
both would do the same.
"""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from support.folders import ROOT

TEXT = (ROOT / "docs/contributing.md").read_text(encoding="utf-8")


def source(path, *changes):
    """Return the text of a source with some words replaced, each of which it has."""
    text = (ROOT / path).read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, (path, old)
        text = text.replace(old, new)
    return text


WALKS = {
    "A kind of suspension": {
        "vehicle/kinds/hanging_rod.py": source(
            "vehicle/kinds/pull_rod.py",
            ("class PullRod(", "class HangingRod("),
            ('Literal["pull_rod"]', 'Literal["hanging_rod"]'),
            ('"pull_rod_car"', '"hanging_rod_car"'),
        ),
        "vehicle/data/hanging_rod_car.toml": source(
            "vehicle/data/pull_rod_car.toml",
            ('suspension = "pull_rod"', 'suspension = "hanging_rod"'),
        ),
    },
    "A closed form": {
        "generator/closed_forms/guide.py": source(
            "generator/closed_forms/prismatic.py", ("PrismaticByLength", "GuideByLength")
        ),
        "generator/closed_forms/prismatic.py": None,
    },
    "A force, a law, a path": {
        "generator/declare/forces/push.py": source(
            "generator/declare/forces/joint_force.py", ("JointForce", "Push")
        )
    },
    "A joint": {
        "generator/declare/joints.py": source("generator/declare/joints.py")
        + '''

@declared
@dataclass(frozen=True)
class Pivot(Revolute):
    """A hinge, by another name."""

    kind: ClassVar[str] = "pivot"
''',
        "generator/declare/__init__.py": source(
            "generator/declare/__init__.py",
            ("    Revolute,\n", "    Pivot,\n    Revolute,\n"),
            (' "Revolute",', ' "Pivot", "Revolute",'),
        ),
    },
    "A back end": {
        "generator/backends/plain/__init__.py": source("generator/backends/numpy/__init__.py"),
        "generator/backends/plain/dialect.py": source("generator/backends/numpy/dialect.py"),
        "generator/backends/plain/printer.py": source("generator/backends/numpy/printer.py"),
        "generator/backends/files.py": source(
            "generator/backends/files.py", (".numpy.printer", ".plain.printer")
        ),
    },
    "An analysis": {
        "vehicle/analysis/rig_motions.py": '''"""Motions of a rig that each wheel can make."""

from typing import Any

import xarray as xr

from ..assembly.by_wheel import WHEEL, stacked, wheel_coordinate
from ..assembly.of import assembly_of


def motions(subject: Any) -> xr.Dataset:
    """Return the number of the motions of a rig, for each wheel."""
    assembly = assembly_of(subject)
    counts = stacked((), [len(assembly.motions) for _ in assembly.wheels], {})
    return xr.Dataset({"motions": counts}, {WHEEL: wheel_coordinate(assembly.wheels)})
'''
    },
    "An assembly": {
        "vehicle/assembly/bench.py": '''"""A suspension on a bench: a corner."""

from dataclasses import dataclass

from ..models.model import Model
from .corner import CornerAssembly


@dataclass(frozen=True)
class Bench:
    """A suspension that is tested alone."""

    model: Model


class BenchAssembly(CornerAssembly):
    """A corner on a bench."""

    def __init__(self, bench: Bench) -> None:
        super().__init__(bench.model)
''',
        "vehicle/assembly/of.py": source(
            "vehicle/assembly/of.py",
            ("from .car import", "from .bench import Bench, BenchAssembly\nfrom .car import"),
            (
                "    Model: CornerAssembly,\n",
                "    Model: CornerAssembly,\n    Bench: BenchAssembly,\n",
            ),
        ),
    },
    "A command": {
        "vehicle/cli/describe.py": source(
            "vehicle/cli/schema.py", ("kintrafo schema", "kintrafo describe")
        ),
        "vehicle/cli/__init__.py": source(
            "vehicle/cli/__init__.py",
            ("    export,\n", "    describe,\n    export,\n"),
            ("(report, export)", "(report, export, describe)"),
        ),
    },
}

# what the page has a walk change; all other files of a walk are new
CHANGED = {
    "generator/closed_forms/prismatic.py",
    "generator/declare/joints.py",
    "generator/declare/__init__.py",
    "generator/backends/files.py",
    "vehicle/assembly/of.py",
    "vehicle/cli/__init__.py",
}

FOUND = """
import sys
import kintrafo
from dataclasses import fields, replace
from kintrafo.generator import Pivot
from kintrafo.generator.backends import files
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.closed_forms.catalogue import CATALOGUE
from kintrafo.generator.declare.forces import KINDS as FORCES
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import four_bar, slider_crank
from kintrafo.vehicle import cli
from kintrafo.vehicle.analysis.rig_motions import motions
from kintrafo.vehicle.assembly.bench import Bench
from kintrafo.vehicle.assembly.of import assembly_of

# a kind: its file, data set and equations are found
cars = [kintrafo.load(name) for name in ("hanging_rod_car", "pull_rod_car")]
assert type(cars[0]).__name__ == "HangingRod"
over = kintrafo.characteristics.over
one, other = (over(kintrafo.Model(car), "travel", [0.0, 0.02]) for car in cars)
assert one["camber"].equals(other["camber"])

# a closed form closes the loop that the one it replaces closed
forms = {form.__name__ for form in CATALOGUE.closed}
assert "GuideByLength" in forms and "PrismaticByLength" not in forms
generate(slider_crank.MODELS[0])

# a force acts as the one that it is a copy of
push = next(kind for kind in FORCES if kind.__name__ == "Push")
(model,) = four_bar.MODELS
spring, torque = model.mechanism.forces
pushed = replace(model.mechanism, forces=(spring, push(torque.joint, torque.input)))
derived = generate(replace(model, mechanism=pushed))
assert "crank_torque" in files.manifest(derived)

# a joint like a hinge needs no other file: the crank turns on it as on the hinge
pivots = [
    Pivot(**{f.name: getattr(joint, f.name) for f in fields(joint)})
    for joint in model.mechanism.joints[:1]
]
swap = dict(zip(model.mechanism.joints, pivots))
assert pivots[0].kind == "pivot"
turned = replace(
    model.mechanism,
    joints=(*pivots, *model.mechanism.joints[1:]),
    forces=(spring, push(pivots[0], torque.input)),
    coordinates=tuple(
        replace(c, joint=swap.get(c.joint, c.joint)) for c in model.mechanism.coordinates
    ),
)
independent = tuple(swap.get(joint, joint) for joint in model.independent)
same = generate(replace(model, mechanism=turned, independent=independent))
assert operations_of(same.emitted["rhs"]) == operations_of(derived.emitted["rhs"])

# a back end writes the functions of a mechanism of a user's own
texts = files.own_files(derived, None)
assert files.numpy_source.__module__.endswith("plain.printer")
assert "numpy" in texts["_four_bar.py"]

# an analysis and an assembly: each takes what the other brings
bench = Bench(kintrafo.Model("reference_car"))
assert type(assembly_of(bench)).__name__ == "BenchAssembly"
for subject, count in ((bench, 1), (kintrafo.load("reference_axle"), 2)):
    assert motions(subject)["wheel"].size == count

# a command
sys.argv = ["kintrafo", "describe", "--help"]
assert "describe" in cli.COMMANDS
cli.run()
"""


def link(place, target):
    place.symlink_to(target, target_is_directory=target.is_dir())


@pytest.fixture
def copy(tmp_path):
    """Return a folder in which ``kintrafo`` has the files of all walks."""
    package = tmp_path / "kintrafo"
    package.mkdir()
    for item in (ROOT / "runtime").iterdir():
        link(package / item.name, item)
    for name in ("generator", "generated", "vehicle"):
        link(package / name, ROOT / name)
    for files in WALKS.values():
        for path, text in files.items():
            place = own_folder(package, Path(path).parent.parts) / Path(path).name
            place.unlink(missing_ok=True)
            if text is not None:
                place.write_text(text, encoding="utf-8")
    return tmp_path


def own_folder(package, parts):
    """Return a folder of the copy, with links to what is in it in place of one to itself."""
    here, there = package, ROOT
    for part in parts:
        here, there = here / part, there / part
        if here.is_symlink():
            here.unlink()
        if not here.is_dir():
            here.mkdir()
            for item in there.iterdir() if there.exists() else ():
                link(here / item.name, item)
    return here


def test_a_walk_changes_no_other_file():
    assert {path for files in WALKS.values() for path in files if (ROOT / path).exists()} == CHANGED


def test_the_walks_are_done_on_a_copy(copy):
    done = subprocess.run(
        [sys.executable, "-c", FOUND],
        cwd=copy,
        env={
            "PYTHONPATH": str(copy),
            "PATH": "/usr/bin:/bin",
            "KINTRAFO_CACHE": str(copy / "cache"),
        },
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert "kintrafo describe" in done.stdout


def section(name):
    (text,) = re.findall(rf"^### {re.escape(name)}\n(.*?)(?=^##)", TEXT, re.MULTILINE | re.DOTALL)
    return text


@pytest.mark.parametrize("name", WALKS)
def test_a_walk_names_the_folders_of_its_files(name):
    text = section(name)
    for path in WALKS[name]:
        parts = Path(path)
        where = (f"{parts.parent.as_posix()}/", parts.parent.parent.as_posix(), parts.name)
        assert any(words in text for words in where), path


def test_the_walk_of_a_joint_names_every_file_that_distinguishes_joints():
    """Those of closed forms and mechanisms are found in their folders."""
    text = section("A joint")
    for path in sorted((ROOT / "generator").rglob("*.py")):
        folder, name = path.parent.name, path.relative_to(ROOT).as_posix()
        if folder in ("closed_forms", "mechanisms") or path.name == "__init__.py":
            continue
        if re.search(
            r"isinstance\(.*\b(Universal|Cylindrical)\b", path.read_text(encoding="utf-8")
        ):
            assert name.removeprefix("generator/") in text, name
