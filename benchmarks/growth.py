"""How everything grows with the number of loops: a chain of four-bar linkages, N = 1 to 100.

``python -m benchmarks.growth`` derives, emits, compiles and runs the chain of
`kintrafo.generator.mechanisms.n_four_bar` (benchmark A02 of the IFToMM library is N = 2), and
writes a table, JSON and a diagram. The chain hangs here: standing, it would fall through the
position in which all rockers are level, where every loop is flat and no formulation of the kind has
a unique way on.

Beside it, one large mechanism: a Stewart platform (`benchmarks.large`).

All rockers of the chain stay parallel, so that it is a pendulum for every N; the error of each
run is that against the pendulum's own equation.
"""

import shutil
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import numpy as np
import typer
from kintrafo import System, simulate
from kintrafo.generator import Formulation
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import Derivation, generate
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.generator.mechanisms.stewart_platform import STEWART_PLATFORM
from kintrafo.pictures.figures import BLUE, STYLE
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.compiler import Compiler, find_compiler
from kintrafo.systems.compile.loader import load
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, NullFormatter, StrMethodFormatter
from rich.console import Console
from rich.markdown import Markdown
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from scipy.integrate import solve_ivp
from sympy.core.cache import clear_cache

from . import large
from .report import (
    children_seconds,
    count,
    environment,
    fill_page,
    machine_line,
    markdown_table,
    milliseconds,
    one_core,
    seconds_of,
    timing_of,
    write_json,
)

Array = np.ndarray[Any, np.dtype[np.float64]]

SIZES = (1, 2, 5, 10, 20, 40, 100)
RATE = 2.0  # of the rockers at the start, hanging [rad/s]
DURATION = 1.0  # [s]
TOLERANCE = 1e-9
REACH = 0.1  # of the large mechanism's coordinates from its design position [m, rad]
BATCH = 1000  # states in one call, so that Python's share of a call is small
ROUNDS = 20


@dataclass(frozen=True)
class Point:
    """What a chain of some length costs.

    Attributes
    ----------
    loops, bodies : int
    derive, compile : float
        Processor time of the derivation and of the C compiler [s].
    operations, jacobian_operations : int
        Of one call of ``rhs`` and of ``rhs_jacobian``.
    call : float
        Processor time of one call of ``rhs`` [s].
    evaluations : int
        Calls of ``rhs`` in a simulated second.
    run : float
        Processor time of that [s].
    error : float
        Of the rockers' angle at its end [rad].
    """

    loops: int
    bodies: int
    derive: float
    operations: int
    jacobian_operations: int
    compile: float
    call: float
    evaluations: int
    run: float
    error: float


# -- measuring ------------------------------------------------------------------------------------


def measure(loops: int, compiler: Compiler, rounds: int, advance: Callable[[str], None]) -> Point:
    """Derive, compile and run a chain of some length."""
    model = n_four_bar(loops)
    found: list[Derivation] = []
    clear_cache()  # shorter chains are parts of this one, and SymPy remembers them
    advance(f"N = {loops}: deriving")
    derive = seconds_of(lambda: found.append(generate(model)))
    derived = found[0]
    advance(f"N = {loops}: compiling")
    with TemporaryDirectory() as folder:
        package = Path(folder) / f"{model.name}-growth"
        package.mkdir()
        before = children_seconds()
        build(derived, package, compiler)
        compiling = children_seconds() - before
        module = load(package)
    advance(f"N = {loops}: running")
    system = System(module, hanging(model))
    start = np.array([0.0, RATE])
    states = np.linspace(-0.5, 0.5, BATCH)[:, None] * np.ones(2)
    call = timing_of(
        [seconds_of(lambda: module.rhs(states, None, system.constants)) for _ in range(rounds)]
    )
    runs: list[Any] = []
    run = timing_of(
        [seconds_of(lambda: runs.append(_simulated(system, start))) for _ in range(rounds)]
    )
    return Point(
        loops=loops,
        bodies=len(model.massive),
        derive=derive,
        operations=operations_of(derived.functions["rhs"]).total(),
        jacobian_operations=operations_of(derived.functions["rhs_jacobian"]).total(),
        compile=compiling,
        call=call.least / BATCH,
        evaluations=runs[0].nfev,
        run=run.least,
        error=abs(runs[0].y[0, -1] - pendulum(loops)),
    )


def _simulated(system: System, start: Array) -> Any:
    return simulate(system, (0.0, DURATION), start, rtol=TOLERANCE, atol=TOLERANCE)


def hanging(model: Formulation) -> dict[str, float]:
    """Return the parameters of a chain whose rockers hang from their hinges at the start."""
    given = {p.name: p.default for p in model.mechanism.parameters}
    return {name: -value if name.endswith("_z") else value for name, value in given.items()}


def pendulum(loops: int) -> float:
    """Return the rockers' angle at the end, by the equation of a pendulum.

    N + 1 slender rockers turn, N couplers of the same mass are carried along a circle of their
    length: (N + (N + 1) / 3) L angle'' = -(N + (N + 1) / 2) g sin(angle).
    """
    ratio = (loops + (loops + 1) / 2) / (loops + (loops + 1) / 3)
    motion = solve_ivp(
        lambda _, y: (y[1], -9.81 * ratio * np.sin(y[0])),
        (0.0, DURATION),
        (0.0, RATE),
        "DOP853",
        rtol=1e-13,
        atol=1e-13,
    )
    return float(motion.y[0, -1])


# -- results --------------------------------------------------------------------------------------


def longer_half(points: list[Point]) -> list[Point]:
    """Return the points of the longer chains, where the share of a start no longer counts."""
    return points[len(points) // 2 :]


def slope(points: list[Point], quantity: str) -> float:
    """Return the exponent of growth: that of the straight line through the longer chains."""
    logarithms = [(np.log(p.loops), np.log(getattr(p, quantity))) for p in longer_half(points)]
    return float(np.polyfit(*np.transpose(logarithms), 1)[0])


def table(points: list[Point]) -> str:
    """Return the results as Markdown."""
    header = ("N", "bodies", "derive [s]", "operations of rhs", "of its Jacobian", "compile [s]")
    header += ("one rhs [µs]", "evaluations", "1 s of motion [ms]", "error [rad]")
    rows = [
        (
            str(p.loops),
            str(p.bodies),
            f"{p.derive:.2g}",
            count(p.operations),
            count(p.jacobian_operations),
            f"{p.compile:.2g}",
            f"{1e6 * p.call:.2g}",
            count(p.evaluations),
            milliseconds(p.run),
            f"{p.error:.0e}",
        )
        for p in points
    ]
    return markdown_table(header, rows)


_PANELS = {
    "derive": ("derivation", "processor time [s]", 1.0),
    "operations": ("operations of rhs", "operations", 1.0),
    "compile": ("compilation", "processor time [s]", 1.0),
    "call": ("one call of rhs", "processor time [µs]", 1e6),
}


def figure(points: list[Point]) -> Figure:
    """Return four diagrams over the number of loops, both axes logarithmic."""
    drawn = Figure(figsize=(9.0, 6.4), layout="constrained")
    for axes, (quantity, (title, label, unit)) in zip(
        drawn.subplots(2, 2, sharex=True).flat, _PANELS.items(), strict=True
    ):
        values = [unit * getattr(p, quantity) for p in points]
        _panel(axes, [p.loops for p in points], values)
        exponent = slope(points, quantity)
        axes.set(title=f"{title}: N to the power {exponent:.2f}", ylabel=label)
    drawn.axes[0].legend(frameon=False)
    for axes in drawn.axes[2:]:
        axes.set_xlabel("number of loops N")
    return drawn


def _panel(axes: Axes, loops: list[int], values: list[float]) -> None:
    """Draw one quantity, with a line of slope one through the last point to compare with."""
    proportional = [values[-1] * n / loops[-1] for n in loops]
    style = {"color": "#999999", "linestyle": "--", "linewidth": 1.0}
    axes.plot(loops, proportional, label="proportional to N", **style)
    axes.plot(loops, values, color=BLUE, marker="o", label="measured")
    axes.set(xscale="log", yscale="log", xticks=loops)
    axes.yaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.set_minor_formatter(NullFormatter())


def slopes_text(points: list[Point]) -> str:
    """Return the exponents of growth as a sentence."""
    named = {
        "the derivation": "derive",
        "the number of operations of `rhs`": "operations",
        "the compilation": "compile",
        "the time of one `rhs`": "call",
    }
    found = [f"{what} as N^{slope(points, quantity):.2f}" for what, quantity in named.items()]
    least = longer_half(points)[0].loops
    return f"From N = {least} on: {', '.join(found[:-1])} and {found[-1]}."


def run(
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("out/benchmark"),
    page: Annotated[
        Path | None, typer.Option(help="Also put table and picture into this page of docs/.")
    ] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Short chains, few repetitions.")] = False,
) -> None:
    """Measure how derivation, code and run time grow with the number of loops."""
    console = Console()
    compiler = find_compiler()
    if compiler is None:
        console.print("There is no C compiler: on Debian, apt-get install gcc libc6-dev.")
        raise typer.Exit(1)
    out.mkdir(parents=True, exist_ok=True)
    sizes, rounds = ((1, 2, 3), 2) if quick else (SIZES, ROUNDS)
    generate(n_four_bar(1))  # so that no import counts
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with Progress(*columns, console=console) as progress:
        task = progress.add_task("growth", total=3 * len(sizes) + 1)

        def advance(what: str) -> None:
            progress.update(task, description=what, advance=1)

        with one_core():
            points = [measure(loops, compiler, rounds, advance) for loops in sizes]
            advance("a large mechanism")
            declared = n_four_bar(1) if quick else STEWART_PLATFORM
            one = large.measure(declared, compiler, rounds, REACH)
    _write(points, one, out, page)
    console.print(Markdown(table(points)))
    console.print(Markdown(large.table(one)))
    console.print(f"{slopes_text(points)} {out / 'growth.md'} and, beside it, JSON and diagram")


def _write(points: list[Point], one: large.Large, out: Path, page: Path | None) -> None:
    """Write table, JSON and diagram, and fill the page."""
    machine = environment()
    blocks = {
        "machine": machine_line(machine),
        "slopes": slopes_text(points),
        "growth": table(points),
        "large": large.table(one),
    }
    (out / "growth.md").write_text("\n\n".join(blocks.values()) + "\n", encoding="utf-8")
    data = {"environment": machine, "points": [asdict(p) for p in points]}
    data |= {"large": asdict(one)}
    write_json(out / "growth.json", data)
    with rc_context(STYLE):
        figure(points).savefig(out / "growth.png", dpi=130)
    if page is not None:
        fill_page(page, blocks)
        shutil.copy(out / "growth.png", page.parents[1] / "images" / "growth.png")


if __name__ == "__main__":
    typer.run(run)
