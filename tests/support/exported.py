"""Systems that are exported in tests, and their compiled programs."""

import importlib
import subprocess
from dataclasses import replace
from functools import cache

import kintrafo
import pytest
from kintrafo import generator as g
from kintrafo.generator.mechanisms import four_bar
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.targets.fmi import binaries

from support.kept import UNOPTIMISED
from support.models import STRICT, own

CC = ("cc", "-std=c99", *UNOPTIMISED, "-ffp-contract=off", *STRICT)

needs_library = pytest.mark.skipif(
    find_compiler() is None or not binaries.HERE, reason="no compiler for Linux on x86-64"
)


@cache
def system_named(name):
    """Return a small mechanism, without states, guards or signals, a suspension or a car."""
    if name == "reference_car":
        return kintrafo.Model("reference_car")
    if name in ("quarter_car", "rigid_axle"):
        return kintrafo.model_of(kintrafo.load(name))
    if name == "prescribed":
        return kintrafo.System(own(prescribed()))
    if name == "pendulum":
        return kintrafo.System(own(_pendulum()))
    if name == "moved":
        return kintrafo.System(own(_moved()))
    return kintrafo.System(importlib.import_module(f"kintrafo.generated.{name}"))


def prescribed():
    """Return the four-bar linkage with a prescribed angle of its rocker."""
    plain = tuple(f for f in four_bar.FOUR_BAR.forces if not isinstance(f, g.JointForce))
    given = {four_bar.D: g.Motion("drive", "rad", "angle of the rocker")}
    mechanism = replace(four_bar.FOUR_BAR, forces=plain)
    return g.Formulation("prescribed", "A four-bar that is turned", mechanism, (), prescribed=given)


def _pendulum():
    """Return a pendulum: no guards, no signals, no inputs."""
    body = g.Body("body", 2.0, g.flat("com", (0.3, -0.1)), 0.05)
    turn = g.hinge("turn", g.Ground("ground"), body, g.flat("pin", (0.0, 0.0)))
    weight = g.Weight(upward=g.Direction("upward", fixed=(0, 1, 0)))
    angle = turn.angle("angle", "angle of the pendulum")
    mechanism = g.Mechanism("pendulum", "A pendulum", (turn,), (weight,), (angle,))
    return g.Formulation("pendulum", "A pendulum", mechanism, (turn,))


def _moved():
    """Return the pendulum with a prescribed angle: no states, no signals."""
    free = _pendulum()
    mechanism = replace(free.mechanism, forces=())
    given = {free.independent[0]: g.Motion("drive", "rad", "angle of the pendulum")}
    return g.Formulation("moved", "A pendulum that is turned", mechanism, (), prescribed=given)


def compiled(folder, *flags):
    """Compile all C files of a folder that need no other library into a program."""
    program = folder.with_suffix(".exe")
    others = ("_ffi", "_lanes")
    files = sorted(str(file) for file in folder.glob("*.c") if not file.stem.endswith(others))
    subprocess.run([*CC, *flags, *files, "-o", str(program), "-lm"], check=True)
    return program
