"""``kintrafo mechanism generate``: equations of a user's own mechanism, derived and compiled."""

import time
from pathlib import Path
from types import ModuleType
from typing import Annotated

from ....terminal.console import console, print_json, problems, say
from ..options import FILE, Force, Json, Which, argument, option

EXAMPLES = (
    "kintrafo mechanism generate my_mechanism.py",
    "kintrafo mechanism generate my_mechanism.py --model crane -o equations",
    "kintrafo mechanism generate my_mechanism.py --numpy --json",
)


def command(
    file: Annotated[Path, argument("Python file that declares a mechanism.", "FILE", **FILE)],
    *,
    model: Which = None,
    out: Annotated[
        Path | None,
        option("Write C, Python and report into this folder, too.", "PATH", "--out", "-o"),
    ] = None,
    numpy: Annotated[bool, option("Functions over NumPy arrays instead of compiled C.")] = False,
    parameter_derivatives: Annotated[
        bool, option("Also derivatives with respect to parameters.")
    ] = False,
    force: Force = False,
    json: Json = False,
) -> None:
    """Derive and compile the equations of motion of your own mechanism.

    The file declares it with the classes of kintrafo.generator; docs/mechanisms/own-mechanism.md
    builds one from a sketch. Compiled equations are kept in a cache. Needs the packages of the
    extra "generator": pip install "kintrafo[generator]".
    """
    from ....systems.compile.build import compile_mechanism
    from ....systems.compile.on_terminal import on_terminal

    started = time.perf_counter()
    try:
        with on_terminal("reading the declaration") as progress:
            module = compile_mechanism(
                file,
                name=model,
                backend="numpy" if numpy else "auto",
                parameter_derivatives=parameter_derivatives,
                progress=progress,
            )
    except KeyboardInterrupt:
        problems.print("Stopped: no compiler runs on, and nothing of it is left behind.")
        raise
    seconds = time.perf_counter() - started
    if out is not None:
        _copy(module, out, force=force, declaration=file)
    if json:
        print_json(_facts(module))
    else:
        _show(module, file, model, seconds)


def _facts(module: ModuleType) -> dict[str, object]:
    return {
        "name": module.NAME,
        "file": module.__file__,
        "compiled": bool(module.ADDRESSES),
        "mobility": module.MOBILITY,
        "state": list(module.STATE),
        "inputs": list(module.INPUTS),
        "signals": list(module.SIGNALS),
        "loops": module.LOOPS,
        "operations": module.rhs.operations,
        "hash": module.MECHANISM_HASH,
    }


def _show(module: ModuleType, file: Path, chosen: str | None, seconds: float) -> None:
    """Print a summary of the equations, and Python to use them; `chosen` is the model's name."""
    loops = [" - ".join(loop) for loop in module.LOOPS]
    how = "C" if module.ADDRESSES else "NumPy"
    rows = {
        "coordinates": ", ".join(list(module.STATE)[: module.LAYOUT.positions]),
        "inputs": ", ".join(module.INPUTS) or "none",
        "loops": "\n".join(loops) or "none",
        "right-hand side": f"{module.rhs.operations['total']} operations, {how}",
        "ready after": f"{seconds:.1f} s",
        "files": str(Path(str(module.__file__)).parent),
    }
    say(f"{str(module.__doc__).partition('.')[0]} ({module.NAME})")
    width = max(map(len, rows))
    for name, text in rows.items():
        say(f"  {name:{width}}  {text}".replace("\n", "\n" + " " * (width + 4)))
    console.print()
    call = f'"{file}"' if chosen is None else f'"{file}", name="{chosen}"'
    for line in (
        "import kintrafo",
        f"system = kintrafo.System(kintrafo.compile({call}))",
        "result = kintrafo.simulate(system, (0.0, 1.0), system.state())",
    ):
        say(f"  {line}")


def _copy(module: ModuleType, folder: Path, *, force: bool, declaration: Path) -> None:
    """Copy the sources of a compiled mechanism from the cache to a folder."""
    from ....core.files import refuse, replacing

    source = Path(str(module.__file__)).parent
    copied = [p for p in sorted(source.iterdir()) if p.suffix in (".c", ".h", ".py", ".md")]
    refuse([folder / path.name for path in copied], force=force, inputs=[declaration])
    for path in copied:
        with replacing(folder / path.name, force=force, inputs=[declaration]) as temporary:
            temporary.write_bytes(path.read_bytes())
