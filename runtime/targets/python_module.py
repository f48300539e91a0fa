"""A Python module of the equations with the numbers of one parameter set, for CasADi or JAX."""

import warnings
from collections.abc import Mapping
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..core.errors import InputError
from ..core.files import Paths, replacing
from ..systems.compile.build import derived_again, require_generator
from .emitted import Emitted
from .target import Target
from .text import environment

if TYPE_CHECKING:
    from ..generator.backends.text import Dialect
    from ..generator.equations.outputs import Derivation

ENDING = ".py"
MOST_OF_JAX = 3000
"""Operations of a right-hand side that XLA compiles within about 15 s.

The time grows with their cube: 1 s for the 1,154 of an axle, 95 s for the 5,385 of a car.
"""


def check(library: str, path: Path) -> None:
    """Refuse files that are not modules or would hide a library, and missing packages."""
    if path.suffix != ENDING or path.stem in (library, "numpy"):
        stem = path.stem or "model"
        problem = f"the name of a module such as {stem}_{library}{ENDING} is needed."
        raise InputError([problem], str(path))
    require_generator()


def write_casadi(emitted: Emitted, path: Path, *, force: bool, read: Paths) -> Path:
    """Write functions of CasADi; see `_write`."""
    _refuse_iterations("casadi", emitted)
    return _write("casadi", emitted, path, force=force, read=read)


def write_jax(emitted: Emitted, path: Path, *, force: bool, read: Paths) -> Path:
    """Write functions over arrays of JAX, with a warning if they are long; see `_write`."""
    _refuse_iterations("jax", emitted)
    count = emitted.manifest["functions"]["rhs"]["operations"]["total"]
    if count > MOST_OF_JAX:
        message = (
            f"{emitted.name}: the right-hand side has {count} operations. Above {MOST_OF_JAX} XLA "
            "takes minutes to compile it, longer with derivatives. Export to 'c' instead, whose "
            "compiled functions JAX calls by jax.ffi with their derivatives."
        )
        warnings.warn(message, RuntimeWarning, stacklevel=4)
    return _write("jax", emitted, path, force=force, read=read)


def _write(library: str, emitted: Emitted, path: Path, *, force: bool, read: Paths) -> Path:
    """Write a module with the template, and by the back end, of a library; see `export_model`."""
    from ..generator.backends.casadi.dialect import CASADI  # noqa: PLC0415 (an extra)
    from ..generator.backends.jax.dialect import JAX  # noqa: PLC0415 (an extra)

    dialect = {"casadi": CASADI, "jax": JAX}[library]
    with replacing(path, force=force, inputs=read) as temporary:
        facts = _facts(emitted, derived_again(emitted.system.equations), dialect)
        text = environment("python_files").get_template(f"{library}.py.jinja").render(facts)
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return path


def _refuse_iterations(library: str, emitted: Emitted) -> None:
    functions = emitted.manifest["functions"].values()
    loops = {block for function in functions for block in function.get("iterates", ())}
    if loops:
        problem = (
            f"{', '.join(sorted(loops))}: Newton's method solves a loop of these equations. "
            f"{library!r} has equations in closed form only. Export to 'c', whose functions "
            "casadi.external and jax.ffi call with their derivatives, or to 'fmu'."
        )
        raise InputError([problem], emitted.name)


def _facts(emitted: Emitted, derived: "Derivation", dialect: "Dialect") -> Mapping[str, Any]:
    """Return the data of the templates."""
    from ..generator.backends.arrays import differentiable, exported  # noqa: PLC0415 (an extra)
    from ..generator.program.floors import ROUNDING  # noqa: PLC0415 (an extra)

    system, manifest = emitted.system, emitted.manifest
    conditions = [f"{entry['meaning']}: {entry['remedy']}" for entry in manifest["assumptions"]]
    return {
        "name": emitted.name,
        "title": emitted.title,
        "version": version("kintrafo"),
        "state": _valued(manifest["state"], emitted.state),
        "inputs": _valued(manifest["inputs"], emitted.inputs),
        "parameters": _valued(manifest["parameters"], system.parameters.values()),
        "constants": len(system.constants),
        "functions": [_described(function) for function in differentiable(derived)],
        "guards": manifest["guards"],
        "conditions": conditions,
        "rounding": repr(ROUNDING),
        "code": exported(derived, dialect),
    }


def _valued(described: Mapping[str, Mapping[str, Any]], values: Any) -> list[dict[str, str]]:
    """Return names, exact values, units and meanings."""
    return [
        {"name": name, "value": repr(float(value)), "unit": of["unit"], "meaning": of["meaning"]}
        for (name, of), value in zip(described.items(), values, strict=True)
    ]


def _described(function: Any) -> dict[str, Any]:
    return {
        "name": function.name,
        "doc": function.doc,
        "labels": list(function.labels),
        "shape": tuple(map(int, function.shape)),
        "count": int(np.prod(function.shape)),
    }


CASADI = Target("casadi", f"_casadi{ENDING}", write_casadi, partial(check, "casadi"), derives=True)
JAX = Target("jax", f"_jax{ENDING}", write_jax, partial(check, "jax"), derives=True)
