"""Any declared model, compiled, with numbers: those that come with the project, and a user's own.

A model of one's own is derived, emitted and compiled here, with the very module text that the
shipped ones have. What was derived and compiled is kept below build/ for all processes and later
runs, under a name that depends on declaration, generator, compiler and its options, as in
`kintrafo.systems.compile.cache`.
"""

import fcntl
import importlib
import pickle
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np
import pytest
from kintrafo.generator import Formulation
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import MODELS
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.cache import appearing, damage, fingerprint
from kintrafo.systems.compile.compiler import FLAGS, Compiler
from kintrafo.systems.compile.identity import identity, identity_of_derived
from kintrafo.systems.compile.loader import load
from oracle.maximal import Motion, Oracle

from support.kept import KEPT, UNOPTIMISED

# Emitted code gives no warning.
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
COMPILER = Compiler(("gcc", *FLAGS, *UNOPTIMISED, *STRICT), "of the tests")

has_gcc = shutil.which("gcc") is not None
needs_gcc = pytest.mark.skipif(not has_gcc, reason="no gcc")

_derived = {}


def shipped(model):
    """Return the compiled module of a model that comes with the project."""
    return importlib.import_module(f"kintrafo.generated.{model.name}")


def identity_of(model):
    """Return the identity of a model, by which caches know it."""
    return identity(model) or identity_of_derived(generate(model))


def derive(model, *, derivatives=True):
    """Derive a model, once for all processes; what has derivatives serves who needs none, too.

    Parameters
    ----------
    model
        Declaration.
    derivatives
        With those by state and inputs; what ships has them in any case, for the tests that need
        them.
    """
    declared, derivatives = identity_of(model), derivatives or model in MODELS
    found = _derived.get((declared, True)) or _derived.get((declared, derivatives))
    if found is None:
        found = _kept_or_derived(model, derivatives=derivatives)
        _derived[declared, derivatives] = found
    return found


def _kept_or_derived(model, *, derivatives):
    whole, wanted = (_file_of(model, derivatives=with_them) for with_them in (True, derivatives))
    with _one_at_a_time(wanted.parent.name):
        for file in (whole, wanted):
            if file.exists():
                return pickle.loads(file.read_bytes())
        made = generate(model, derivatives=derivatives)
        wanted.parent.mkdir(exist_ok=True)
        temporary = wanted.with_suffix(".new")  # a process that is stopped leaves no half
        temporary.write_bytes(pickle.dumps(made))
        temporary.replace(wanted)
        return made


def _file_of(model, *, derivatives):
    """Return where a derived model is kept."""
    built_by = f"{sys.version} derived" + ("" if derivatives else " without derivatives")
    key = fingerprint(identity_of(model), built_by=built_by)
    return KEPT / f"{model.name}-{key}" / "derived.pickle"


def own(model, *, arrays=not has_gcc, derivatives=True):
    """Return the module of any declared model, compiled once for all processes.

    What has derivatives serves who needs none, too.

    Parameters
    ----------
    model
        Declaration.
    arrays
        Over NumPy arrays instead of compiled C.
    derivatives
        With those by state and inputs. They take half of the time: a test that does not use them
        goes without.
    """
    whole, wanted = (
        _folder_of(model, arrays=arrays, derivatives=with_them) for with_them in (True, derivatives)
    )
    target = wanted if damage(whole) else whole
    with _one_at_a_time(target.name):
        if damage(target):
            with appearing(target) as folder:
                build(
                    derive(model, derivatives=derivatives),
                    folder,
                    None if arrays else COMPILER,
                    name=target.name,
                )
    return load(target)


def _folder_of(model, *, arrays, derivatives):
    """Return where a compiled model is kept."""
    built_by = "numpy" if arrays else " ".join((*COMPILER.command, _version()))
    built_by += "" if derivatives else " without derivatives"
    return KEPT / f"{model.name}-{fingerprint(identity_of(model), built_by=built_by)}"


@cache
def _version():
    found = subprocess.run(["gcc", "--version"], capture_output=True, text=True, check=True)
    return found.stdout.partition("\n")[0]


@contextmanager
def _one_at_a_time(name):
    """Let other processes wait, rather than derive the same model as well."""
    KEPT.mkdir(parents=True, exist_ok=True)
    with (KEPT / f"{name}.lock").open("w") as lock:  # its date is that of the last use
        fcntl.flock(lock, fcntl.LOCK_EX)  # ends where the file is closed, or the process dies
        yield


@dataclass(frozen=True)
class Built:
    """A compiled model with one set of parameters, and the oracle of the same mechanism.

    Parameters
    ----------
    model
        Declaration.
    module
        As those of `kintrafo.generated`.
    parameters
        Value of every parameter, SI units.
    """

    model: Formulation
    module: Any
    parameters: Mapping[str, float]

    @classmethod
    def of(cls, model, module, changes=None):
        """Take the default parameters but for some."""
        defaults = {p.name: p.default for p in model.mechanism.parameters}
        return cls(model, module, defaults | dict(changes or {}))

    @cached_property
    def constants(self):
        return self.module.prepare(self.parameters)

    @cached_property
    def oracle(self):
        """The same mechanism in maximal coordinates."""
        return Oracle(self.model, self.parameters)

    @cached_property
    def at_design(self):
        """All bodies at rest where they were declared."""
        count = len(self.oracle.bodies)
        axes = np.broadcast_to(np.eye(3), (count, 3, 3))
        return Motion(self.oracle.centers, axes, np.zeros((count, 6)))

    @cached_property
    def design(self):
        """The independent coordinates of the design position, as the joints declare them."""
        names = [joint.name for joint in self.model.independent]
        return np.array([self.oracle.driven(self.at_design, j).value[0] for j in names])

    @property
    def size(self):
        """Number of independent coordinates."""
        return len(self.model.independent)

    def __call__(self, function, state, inputs=None):
        """Evaluate a function of the model."""
        return getattr(self.module, function)(state, inputs, self.constants)

    def residuals(self, given, state, inputs):
        """Return the closure residuals of given relative coordinates."""
        return self.module.residuals(given, state, inputs, self.constants)

    def named(self, inputs):
        """Return inputs by name."""
        return dict(zip(self.module.INPUTS, map(float, inputs), strict=True))

    def motion(self, state, inputs):
        """Return poses and twists of all bodies as the model computes them, the ground first."""
        velocities = self("velocities", state, inputs)
        return Motion(
            np.concatenate((np.zeros((1, 3)), self("positions", state, inputs))),
            np.concatenate((np.eye(3)[None], self("orientations", state, inputs))),
            np.concatenate((np.zeros((1, 6)), np.roll(velocities, 3, axis=1))),
        )
