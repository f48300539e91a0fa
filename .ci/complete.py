"""Check that the installed package is complete: methods in C, models in lanes, libraries, cars.

No other check detects a missing part: without SUNDIALS, SciPy integrates; only ensembles need
lanes; a compiler replaces the library for an FMU and a compiled car. On Windows,
where wheels have neither SUNDIALS nor lanes nor cars, every model is simulated by SciPy.

Usage: complete.py [--part | --built]. By default all files that fill.py adds are expected; with
--part those that it adds with --part; with --built none of them, as in a checkout.
"""

import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path

import kintrafo
from fill import PART, cars
from kintrafo import generated
from kintrafo.simulation import solvers
from kintrafo.simulation.lanes import library
from kintrafo.systems.compile.packed import packed
from kintrafo.targets.emitted import Emitted
from kintrafo.targets.fmi import binaries
from kintrafo.targets.fmi.sources import library_files
from kintrafo.vehicle.models.car.equations import CarStructure


def main() -> None:
    """Simulate a model by each method in C, and every model in lanes; look for its libraries."""
    filled = () if "--built" in sys.argv[1:] else PART if "--part" in sys.argv[1:] else None
    look_for_libraries(filled)
    if sys.platform == "win32":
        by_scipy()
        return
    if not solvers.native_available():
        sys.exit(f"incomplete: no method in C, since {solvers.why_not_native()}.")
    if not library.widths():
        sys.exit("incomplete: no lanes, for which it must be built with GCC or Clang.")
    if filled != ():
        look_for_cars(part=filled is not None)
    systems = every_system()
    crank = systems["slider_crank"]
    for method in solvers.native_methods():
        kintrafo.simulate(crank, (0.0, 0.1), crank.state(), method=method, backend="sundials")
    for name, system in systems.items():
        if library.compiled(system.equations) is None:
            sys.exit(f"incomplete: {name} is not there in lanes.")
        if not kintrafo.ensemble(system, None, (0.0, 1e-3))["success"].all():
            sys.exit(f"{name} does not move in lanes.")
    print(f"complete: {', '.join(solvers.native_methods())} in C, {len(systems)} models in lanes")


def look_for_cars(*, part: bool) -> None:
    """Refuse packaged cars that are not compiled."""
    for structure in map(CarStructure.of, cars(part)):
        if packed(structure.name, structure.text()) is None:
            sys.exit(f"incomplete: {structure.name} is not compiled.")


def look_for_libraries(filled: tuple[str, ...] | None) -> None:
    """Refuse models without libraries for FMUs; for Windows only those that are named, or all."""
    for name, files in files_of_libraries():
        windows = ("windows",) if filled is None or name in filled else ()
        for platform in (*binaries.HERE, *windows):
            if binaries.shipped(files, name, platform) is None:
                sys.exit(f"incomplete: {name} has no library for FMUs on {platform}.")


def files_of_libraries() -> Iterator[tuple[str, dict[str, str]]]:
    """Yield the names of all models, and the files of their libraries."""
    for name, system in every_system().items():
        yield name, library_files(Emitted(system, system.design_state, system.inputs()))


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
