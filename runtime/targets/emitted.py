"""The exported data: emitted sources, numbers of one parameter set, places of results."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from ..core.errors import InputError
from ..core.named_types import Array
from ..systems.compile.shipped import sources_of
from ..systems.system import System


class Result(NamedTuple):
    """A result of a C function."""

    function: str  # C function
    size: int  # number of elements that it computes
    # first element of the result, and number of its elements
    start: int
    length: int


@dataclass(frozen=True)
class Emitted:
    """The emitted C of a system, with its numbers."""

    system: System
    # at the start
    state: Array
    inputs: Array

    @property
    def name(self) -> str:
        """Name of the equations, with which all their C names begin."""
        return str(self.manifest["name"])

    @property
    def title(self) -> str:
        """Title of the mechanism."""
        return str(self.manifest["title"])

    @property
    def manifest(self) -> dict[str, Any]:
        """Manifest of the equations: names, units, meanings, guards, functions."""
        return self.system.equations.equations.manifest

    @cached_property
    def sources(self) -> dict[str, str]:
        """The emitted files by name; an `InputError` is raised if one is missing."""
        files = sources_of(self.system.equations)
        missing = [name for name, path in files.items() if not path.is_file()]
        if missing:
            problem = (
                f"the C code of {self.name} is incomplete: {', '.join(missing)} is missing. "
                "Compile the mechanism again, or install kintrafo again."
            )
            raise InputError([problem], str(next(iter(files.values())).parent))
        return {name: path.read_text(encoding="utf-8") for name, path in files.items()}

    def result(self, name: str) -> Result | None:
        """Return the place of a result; None if the mechanism does not have it."""
        return result_of(self.manifest, name)

    def compiled(self) -> dict[str, dict[str, Any]]:
        """Return the manifest's entries of C functions of constants, state and inputs, by name."""
        functions = self.manifest["functions"].items()
        stages: dict[str, dict[str, Any]] = self.manifest["stages"]
        return {n: f for n, f in functions if "stage" not in f and n != "residuals"} | stages


def result_of(manifest: Mapping[str, Any], name: str) -> Result | None:
    """Return the place of a result of some equations; None if they do not have it."""
    functions, stages = manifest["functions"], manifest["stages"]
    described = functions.get(name)
    if described is None:
        return None
    count = int(np.prod(described["shape"]))
    stage = described.get("stage", name)
    size = stages[stage]["size"] if stage in stages else count
    return Result(f"{manifest['name']}_{stage}", size, described.get("start", 0), count)
