"""Any declared model, compiled, with numbers: those that come with the project, and a user's own.

A model of one's own is derived, emitted and compiled here in a folder, with the very module text
that the shipped ones have.
"""

from __future__ import annotations

import importlib
import shutil
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import FLAGS, Compiler
from kintrafo.systems.compile.loader import load
from oracle.maximal import Motion, Oracle

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from types import ModuleType

    from kintrafo.generator import Model
    from kintrafo.generator.equations.outputs import GeneratedModel
    from oracle.constraints import Array

# Emitted code gives no warning.
STRICT = ("-Wall", "-Wextra", "-Wpedantic", "-Werror")
# Compiling takes a tenth of the time, and without contraction the bits are the same.
UNOPTIMISED = "-O0"

needs_gcc = pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")


def shipped(model: Model) -> ModuleType:
    """Return the compiled module of a model that comes with the project."""
    return importlib.import_module(f"kintrafo.generated.{model.name}")


def own(derived: GeneratedModel, folder: Path) -> ModuleType:
    """Emit and compile a derived model in a folder."""
    target = folder / f"{derived.model.name}-{folder.name}"
    target.mkdir()
    build(derived, target, Compiler(("gcc", *FLAGS, UNOPTIMISED, *STRICT), "of the tests"))
    return load(target)


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

    model: Model
    module: Any
    parameters: Mapping[str, float]

    @classmethod
    def of(cls, model: Model, module: Any, changes: Mapping[str, float] | None = None) -> Built:
        """Take the default parameters but for some."""
        defaults = {p.name: p.default for p in model.mechanism.parameters}
        return cls(model, module, defaults | dict(changes or {}))

    @cached_property
    def constants(self) -> Array:
        constants: Array = self.module.prepare(self.parameters)
        return constants

    @cached_property
    def oracle(self) -> Oracle:
        """The same mechanism in maximal coordinates."""
        return Oracle(self.model, self.parameters)

    @cached_property
    def at_design(self) -> Motion:
        """All bodies at rest where they were declared."""
        count = len(self.oracle.bodies)
        axes = np.broadcast_to(np.eye(3), (count, 3, 3))
        return Motion(self.oracle.centers, axes, np.zeros((count, 6)))

    @cached_property
    def design(self) -> Array:
        """The independent coordinates of the design position, as the joints declare them."""
        names = self.model.independent
        return np.array([self.oracle.driven(self.at_design, j).value[0] for j in names])

    @property
    def size(self) -> int:
        """Number of independent coordinates."""
        return len(self.model.independent)

    def __call__(self, function: str, state: Array, inputs: Array | None = None) -> Array:
        """Evaluate a function of the model."""
        found: Array = getattr(self.module, function)(state, inputs, self.constants)
        return found

    def residuals(self, given: Array, state: Array, inputs: Array) -> Array:
        """Return the closure residuals of given relative coordinates."""
        found: Array = self.module.residuals(given, state, inputs, self.constants)
        return found

    def named(self, inputs: Array) -> dict[str, float]:
        """Return inputs by name."""
        return dict(zip(self.module.INPUTS, map(float, inputs), strict=True))

    def motion(self, state: Array, inputs: Array) -> Motion:
        """Return poses and twists of all bodies as the model computes them, the ground first."""
        velocities = self("velocities", state, inputs)
        return Motion(
            np.concatenate((np.zeros((1, 3)), self("positions", state, inputs))),
            np.concatenate((np.eye(3)[None], self("orientations", state, inputs))),
            np.concatenate((np.zeros((1, 6)), np.roll(velocities, 3, axis=1))),
        )
