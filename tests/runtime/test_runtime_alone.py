"""The runtime without the application: `vehicle/` is not there, and nothing of it is missed.

What knows a wheel is in `vehicle/`. Everything else, with the generator, is copied into a folder of
its own, as a wheel without the application would install it.
"""

import ast
import os
import re
import shutil
import subprocess
import sys

import pytest
from support.folders import ROOT

RUNTIME = ROOT / "runtime"

# an editable installation finds `vehicle` wherever the rest is
WITHOUT_THIS_CHECKOUT = """
import sys
sys.meta_path[:] = [finder for finder in sys.meta_path if "editable" not in repr(finder).lower()]
"""
MOVE = """
import pkgutil
from importlib import import_module
import kintrafo
from kintrafo.generated import slider_crank

for top in (kintrafo, import_module("kintrafo.generator")):
    for found in pkgutil.walk_packages(top.__path__, f"{top.__name__}."):
        if not found.name.endswith(("__main__", "_fmu")):  # libraries for FMUs are no modules
            import_module(found.name)

crank = kintrafo.System(slider_crank)
motion = kintrafo.simulate(crank, (0.0, 0.1), crank.state())
assert motion.success
assert kintrafo.ensemble(crank, None, (0.0, 0.01))["success"].all()
kintrafo.animate(motion, "motion.html")
kintrafo.export_model(crank, "crank", to="c")
import_module("kintrafo.datasets.export").write(
    import_module("kintrafo.datasets.recording").dataset_of(crank, motion), "motion.csv"
)
import_module("kintrafo.notebook.pages").simulation(motion)

declared = "kintrafo/generator/mechanisms/slider_crank.py"
own = kintrafo.System(kintrafo.compile(declared, folder="cache"))
assert kintrafo.simulate(own, (0.0, 0.1), own.state()).success
assert not any(name.startswith("kintrafo.vehicle") for name in sys.modules)
try:
    kintrafo.Suspension
except ModuleNotFoundError as error:
    assert error.name == "kintrafo.vehicle"
else:
    raise AssertionError("there is an application")
"""


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    """Return a folder with a package `kintrafo` that has no `vehicle`."""
    folder = tmp_path_factory.mktemp("alone")
    unwanted = shutil.ignore_patterns("node_modules")
    shutil.copytree(RUNTIME, folder / "kintrafo", ignore=unwanted)
    for other in ("generated", "generator"):
        shutil.copytree(ROOT / other, folder / "kintrafo" / other, ignore=unwanted)
    return folder


def test_it_compiles_moves_and_shows_a_mechanism(alone):
    environment = {**os.environ, "PYTHONPATH": str(alone)}
    command = [sys.executable, "-c", WITHOUT_THIS_CHECKOUT + MOVE]
    done = subprocess.run(
        command, cwd=alone, env=environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert (alone / "motion.html").exists()


# Words of the parts of a car, as they are in names.
WORDS = re.compile(
    "(car|wheel|axle|suspension|tyre|hardpoint|wishbone|vehicle|road|corner|knuckle|strut|rack)s?"
    "|camber|toe|kingpin|caster|steer|steering|macpherson|bump|chassis"
)
ALLOWED = {
    # what a picture draws as a disc, of any mechanism: its declaration calls it a wheel
    ("systems/skeleton.py", "wheels"),
    ("pages/mechanism/page.py", "wheels"),
    ("pictures/animation.py", "wheels"),
    ("pictures/animation.py", "wheel"),
    # the dimension of an ensemble, which users know by this name
    ("ensembles/variants.py", "CAR"),
}


def names_of(path):
    """Yield what a module calls its things."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef | ast.ClassDef | ast.AsyncFunctionDef):
            yield node.name
        elif isinstance(node, ast.arg):
            yield node.arg
        elif isinstance(node, ast.Name):
            yield node.id
        elif isinstance(node, ast.Attribute):
            yield node.attr


def words_of(name):
    """Return the words of a name: `WheelLoads` and `wheel_loads` have the same."""
    return {word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)}


def test_no_name_of_the_runtime_is_of_a_wheel():
    """The front door hands over names of the application, by their words alone."""
    found = {
        (path.relative_to(RUNTIME).as_posix(), name)
        for path in RUNTIME.rglob("*.py")
        if path != RUNTIME / "__init__.py"
        for name in (*names_of(path), path.stem)
        if any(map(WORDS.fullmatch, words_of(name)))
    }
    assert found == ALLOWED
