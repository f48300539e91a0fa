"""Plain C: emitted sources with the numbers of one parameter set, a CMake file and an example."""

from collections.abc import Iterable, Mapping
from contextlib import ExitStack, suppress
from importlib.metadata import version
from importlib.resources import files as resources
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.files import Paths, as_input_errors, replacing
from ..simulation import lanes
from ..simulation.lanes.own import HEADERS, READER
from .casadi_external import externals
from .emitted import Emitted
from .jax_ffi import handlers
from .target import Target
from .text import environment

STEPS, STEP = 100, 1e-4
"""Number of steps of the example, and their length [s]."""

_TEMPLATES = {
    "{name}_values.h": "values.h.jinja",
    "{name}_values.c": "values.c.jinja",
    "{name}_example.c": "example.c.jinja",
    "{name}_casadi.c": "casadi.c.jinja",
    "{name}_ffi.c": "ffi.c.jinja",
    "{name}_ffi.py": "ffi.py.jinja",
    "{name}_lanes.c": "lanes.c.jinja",
    "CMakeLists.txt": "CMakeLists.txt.jinja",
    "README.txt": "README.txt.jinja",
}


def check(path: Path) -> None:
    """Refuse the path of something that is not a folder."""
    with as_input_errors(path):
        if path.exists() and not path.is_dir():
            problem = "there is something here that is not a folder. Give the name of a folder."
            raise InputError([problem], str(path))


def write(emitted: Emitted, path: Path, *, force: bool, read: Paths) -> Path:
    """Write a folder of C, which may exist without other files; see `export_model`."""
    texts = files(emitted)
    _refuse_others(path, texts)
    listed = list(read)
    new = not path.exists()
    try:
        with ExitStack() as stack:  # all files are complete before the first one appears
            for name, text in texts.items():
                target = stack.enter_context(replacing(path / name, force=force, inputs=listed))
                target.write_text(text, encoding="utf-8", newline="\n")
    except BaseException:
        if new:
            with suppress(OSError):
                path.rmdir()  # it is empty
        raise
    return path


def files(emitted: Emitted) -> dict[str, str]:
    """Return the files of the folder by name."""
    templates, headers = environment("c_files"), _of_lanes(emitted)
    known = _known(emitted) | {"lanes": [*headers]}
    made = {
        name.format(name=emitted.name): templates.get_template(template).render(known)
        for name, template in _TEMPLATES.items()
    }
    return {**emitted.sources, **headers, **made}


def _of_lanes(emitted: Emitted) -> dict[str, str]:
    """Return the headers that compile emitted equations for vectors, by name."""
    named = {"lanes.h": READER} | {name: name for name in HEADERS}
    if not _iterating(emitted.manifest):
        del named["follow.h"]  # only for loops without a closed form
    here = resources(lanes)
    return {name: (here / file).read_text(encoding="utf-8") for name, file in named.items()}


def _known(emitted: Emitted) -> dict[str, Any]:
    """Return the data of the templates."""
    system, manifest = emitted.system, emitted.manifest
    compiled = emitted.compiled()
    costs = {"prepare": manifest["prepare"]["operations"]}
    costs |= {name: entry["operations"] for name, entry in compiled.items()}
    functions = ["prepare", "design_state", "rhs", "signals", "bounded", "margins"]
    iterating = [manifest["functions"][name].get("stage", name) for name in _iterating(manifest)]
    return {
        "name": emitted.name,
        "upper": emitted.name.upper(),
        "title": emitted.title,
        "version": version("kintrafo"),
        "sources": [name for name in emitted.sources if name.endswith(".c")],
        "parameters": list(system.parameters.items()),
        "constants": _numbered(system.equations.CONSTANTS, system.constants),
        "states": _numbered(system.state_names, emitted.state),
        "inputs": _numbered(system.input_names, emitted.inputs),
        "signals": system.signal_names,
        "described_inputs": list(manifest["inputs"].items()),
        "described_signals": list(manifest["signals"].items()),
        "costs": list(costs.items()),
        "iterates": list(dict.fromkeys(iterating)),
        "renamed": [*functions, *(f"rhs_{held}" for held in manifest["held_variants"])],
        # kB of intermediate results, if each has its own place
        "stack": 1 + max(8 * counts["total"] for counts in costs.values()) // 1000,
        "externals": externals(emitted),
        "handlers": handlers(emitted),
        "steps": STEPS,
        "step": STEP,
    }


def _iterating(manifest: Mapping[str, Any]) -> list[str]:
    return [name for name, function in manifest["functions"].items() if "iterates" in function]


def _numbered(names: Iterable[str], values: Iterable[float]) -> list[tuple[str, float]]:
    return [(name, float(value)) for name, value in zip(names, values, strict=True)]


def _refuse_others(path: Path, texts: Mapping[str, str]) -> None:
    """Refuse a folder with other files, and a path that is not a folder."""
    check(path)
    with as_input_errors(path):
        found = path.iterdir() if path.exists() else ()
        others = sorted(entry.name for entry in found if entry.name not in texts)
    if others:
        shown = ", ".join(others[:3]) + (", ..." if len(others) > 3 else "")
        problem = f"this folder holds other files: {shown}. Name a new folder, or an empty one."
        raise InputError([problem], str(path))


TARGET = Target("c", "_c", write, check, folder=True)
