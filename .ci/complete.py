"""Check that the installed package is complete: methods in C, models in lanes, libraries for FMUs.

No other check detects a missing part: without SUNDIALS, SciPy integrates; only ensembles need
lanes; a compiler replaces the library for an FMU. On Windows, where wheels have none of these,
every model is simulated by SciPy.
"""

import sys
from importlib import import_module
from pathlib import Path

import kintrafo
from kintrafo import generated
from kintrafo.simulation import solvers
from kintrafo.simulation.lanes import library
from kintrafo.targets.emitted import Emitted
from kintrafo.targets.fmi import binaries
from kintrafo.targets.fmi.sources import library_files


def main() -> None:
    """Simulate a model by each method in C, and every model in lanes; look for its library."""
    if sys.platform == "win32":
        by_scipy()
        return
    if not solvers.native_available():
        sys.exit(f"incomplete: no method in C, since {solvers.why_not_native()}.")
    if not library.widths():
        sys.exit("incomplete: no lanes, for which it must be built with GCC or Clang.")
    systems = every_system()
    crank = systems["slider_crank"]
    for method in solvers.native_methods():
        kintrafo.simulate(crank, (0.0, 0.1), crank.state(), method=method, backend="sundials")
    for name, system in systems.items():
        if library.compiled(system.equations) is None:
            sys.exit(f"incomplete: {name} is not there in lanes.")
        if not kintrafo.ensemble(system, None, (0.0, 1e-3))["success"].all():
            sys.exit(f"{name} does not move in lanes.")
        if binaries.HERE and not has_library_for_fmus(system):
            sys.exit(f"incomplete: {name} has no library for FMUs.")
    print(f"complete: {', '.join(solvers.native_methods())} in C, {len(systems)} models in lanes")


def has_library_for_fmus(system: kintrafo.System) -> bool:
    """Return whether an FMU of a system is written without a compiler."""
    emitted = Emitted(system, system.design_state, system.inputs())
    return binaries.shipped(library_files(emitted), emitted.name) is not None


def by_scipy() -> None:
    """Simulate every model by SciPy."""
    systems = every_system()
    for name, system in systems.items():
        if not kintrafo.simulate(system, (0.0, 1e-3), system.state(), backend="scipy").success:
            sys.exit(f"{name} does not move.")
    print(f"complete: {len(systems)} models, moved by SciPy")


def every_system() -> dict[str, kintrafo.System]:
    """Return a system of each model by name."""
    names = sorted(path.stem for path in Path(generated.__path__[0]).glob("*.json"))
    return {n: kintrafo.System(import_module(f"{generated.__name__}.{n}")) for n in names}


if __name__ == "__main__":
    main()
