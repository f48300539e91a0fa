"""See that what is installed has all that is compiled: every method in C, every model in lanes.

Nothing else would show that it is missing: without SUNDIALS, SciPy integrates, and only ensembles
need lanes.
"""

import sys
from importlib import import_module
from pathlib import Path

import kintrafo
from kintrafo import generated
from kintrafo.simulation import solvers
from kintrafo.simulation.lanes import library


def main() -> None:
    """Move a model by each method in C, and every model in lanes."""
    if not solvers.native_available():
        sys.exit(f"incomplete: no method in C, since {solvers.why_not_native()}.")
    if not library.widths():
        sys.exit("incomplete: no lanes, for which it must be built with GCC or Clang.")
    names = sorted(path.stem for path in Path(generated.__path__[0]).glob("*.json"))
    systems = {n: kintrafo.System(import_module(f"{generated.__name__}.{n}")) for n in names}
    crank = systems["slider_crank"]
    for method in solvers.native_methods():
        kintrafo.simulate(crank, (0.0, 0.1), crank.state(), method=method, backend="sundials")
    for name, system in systems.items():
        if library.compiled(system.equations) is None:
            sys.exit(f"incomplete: {name} is not there in lanes.")
        if not kintrafo.ensemble(system, None, (0.0, 1e-3))["success"].all():
            sys.exit(f"{name} does not move in lanes.")
    print(f"complete: {', '.join(solvers.native_methods())} in C, {len(systems)} models in lanes")


if __name__ == "__main__":
    main()
