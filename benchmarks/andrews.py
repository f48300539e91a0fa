"""Andrews' squeezer: one second-order equation here, a differential-algebraic one elsewhere.

``python -m benchmarks.andrews`` integrates the problem of the IVP test set to 0.03 s: the compiled
model with explicit and implicit methods, and the equations of the book with codes for
differential-algebraic equations, each at several tolerances. It needs the packages of the extra
"peers", and writes a table, JSON and a diagram.
"""

import shutil
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Annotated, Any

import casadi as ca
import numpy as np
import typer
from kintrafo import System, simulate
from kintrafo.generated import andrews
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from kintrafo.simulation.simulate import Method
from matplotlib import rc_context
from matplotlib.figure import Figure
from rich.console import Console
from rich.markdown import Markdown
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from scipy.integrate import solve_ivp
from solve_dae.integrate import solve_dae

from .peers.andrews_dae import ANGLES, END, START, TORQUE, Squeezer
from .report import (
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
Run = Callable[[], tuple[Array, dict[str, int]]]
"""Integrates once; returns the seven angles at the end, and what it took."""

# Known to ten digits in beta and theta; tests/generator/mechanisms/test_andrews.py says why not to
# more.
PUBLISHED = (
    15.81077119629904,
    -15.75637105984298,
    0.04082224013073101,
    -0.5347301163226948,
    0.5244099658805304,
    0.5347301163226948,
    1.048080741042263,
)
_TOLERANCES = (1e-4, 1e-6, 1e-8, 1e-10)
_ROUNDS = 15


@dataclass(frozen=True)
class Solver:
    """A program with a method."""

    name: str
    unknowns: int  # size of the system that is integrated
    # whether no Python runs between the first step and the last, so that a time means something
    compiled: bool
    prepare: Callable[[float], Run]  # from a tolerance to a `Run`


@dataclass(frozen=True)
class Point:
    """Cost of one program at one tolerance."""

    solver: str
    tolerance: float
    digits: float
    evaluations: int
    steps: int
    jacobians: int
    seconds: float | None


# -- this project ---------------------------------------------------------------------------------


def book_angles(beta: float) -> Array:
    """Return the seven angles of the book at an angle of the crank from the start.

    The book counts bodies 4 and 6 from their outer neighbours; the model counts from body 3.
    """
    names = list(andrews.RELATIVE_COORDINATES)
    turned = dict(zip(names, andrews.relative_coordinates([beta, 0.0]), strict=True))
    turned["phi"] = turned["gamma"] + turned["knee_34"] - turned["delta"]
    turned["omega"] = turned["gamma"] + turned["knee_36"] - turned["epsilon"]
    full_turns = np.round((beta + turned["theta"]) / (2.0 * np.pi))
    turned["theta"] -= 2.0 * np.pi * full_turns  # theta follows beta backwards
    return np.array(START) + np.array([turned[name] for name in ANGLES])


def ours(method: Method) -> Solver:
    """Return `kintrafo.simulate` with the compiled model."""
    system = System(andrews)

    def prepare(tolerance: float) -> Run:
        def run() -> tuple[Array, dict[str, int]]:
            result = simulate(
                system,
                (0.0, END),
                system.state(),
                inputs={"drive_torque": TORQUE},
                method=method,
                rtol=tolerance,
                atol=tolerance,
                t_eval=[END],
            )
            taken = {"evaluations": result.nfev, "steps": result.steps, "jacobians": result.njev}
            return book_angles(float(result.y[0, -1])), taken

        return run

    return Solver(f"kintrafo, {method}", 2, compiled=True, prepare=prepare)


# -- differential-algebraic -----------------------------------------------------------------------


def idas() -> Solver:
    """Return IDAS of SUNDIALS through CasADi, accelerations and multipliers algebraic (index 1)."""
    it = Squeezer.of_symbols()
    problem = {
        "x": ca.vertcat(it.angles, it.rates),
        "z": ca.vertcat(it.accelerations, it.multipliers),
        "ode": ca.vertcat(it.rates, it.accelerations),
        "alg": ca.vertcat(it.balance, it.constraint_accelerations),
    }
    begin = {"x0": np.concatenate((START, np.zeros(7))), "z0": np.concatenate(it.start())}

    def prepare(tolerance: float) -> Run:
        options = {"reltol": tolerance, "abstol": tolerance, "max_num_steps": 1_000_000}
        integrator = ca.integrator("squeezer", "idas", problem, 0.0, END, options)

        def run() -> tuple[Array, dict[str, int]]:
            end = np.array(integrator(**begin)["xf"]).ravel()[:7]
            took = integrator.stats()
            return end, {
                "evaluations": took["nfevals"],
                "steps": took["nsteps"],
                "jacobians": took["nlinsetups"],
            }

        return run

    return Solver("IDAS (CasADi), index 1", 27, compiled=True, prepare=prepare)


def radau() -> Solver:
    """Return Radau IIA of order 5 (solve_dae), the constraints on velocities (index 2)."""
    it = Squeezer.of_symbols()
    closed = ca.jtimes(it.constraints, it.angles, it.rates)
    unknown = ca.vertcat(it.angles, it.rates, it.multipliers)
    slopes = ca.SX.sym("s", 20)
    moving = ca.vertcat(slopes[:7] - it.rates, it.balance, closed)
    moving = ca.substitute(moving, it.accelerations, slopes[7:14])
    residual = ca.Function("f", [unknown, slopes], [moving])
    jacobians = ca.Function(
        "j", [unknown, slopes], [ca.jacobian(moving, unknown), ca.jacobian(moving, slopes)]
    )
    accelerations, multipliers = it.start()
    begin = np.concatenate((START, np.zeros(7), multipliers))
    slope = np.concatenate((np.zeros(7), accelerations, np.zeros(6)))

    def prepare(tolerance: float) -> Run:
        def run() -> tuple[Array, dict[str, int]]:
            result = solve_dae(
                lambda _, y, yp: np.array(residual(y, yp)).ravel(),
                (0.0, END),
                begin,
                slope,
                method="Radau",
                rtol=tolerance,
                # no error control of the multipliers, whose order is lower
                atol=np.array([tolerance] * 14 + [1e3] * 6),
                jac=lambda _, y, yp: tuple(np.array(m) for m in jacobians(y, yp)),
            )
            if not result.success:
                raise RuntimeError(result.message)
            taken = {"evaluations": result.nfev, "steps": len(result.t) - 1}
            return result.y[:7, -1], taken | {"jacobians": result.njev}

        return run

    return Solver("Radau IIA (solve_dae), index 2", 20, compiled=False, prepare=prepare)


def solvers() -> Iterator[Solver]:
    """Yield everything that is compared."""
    methods: tuple[Method, ...] = ("DormandPrince", "Verner", "BDF")
    yield from map(ours, methods)
    yield idas()
    yield radau()


# -- measuring ------------------------------------------------------------------------------------


def reference() -> Array:
    """Return the angles at the end from SciPy's DOP853, and see that they are the published ones.

    Raises
    ------
    RuntimeError
        If they differ by more than the published digits are good for.
    """
    result = solve_ivp(
        lambda _, y: andrews.rhs(y, [TORQUE]),
        (0.0, END),
        [0.0, 0.0],
        "DOP853",
        rtol=2.3e-14,
        atol=1e-15,
    )
    angles = book_angles(float(result.y[0, -1]))
    if _digits(angles, np.array(PUBLISHED)) < 7.0:
        message = f"not the published solution: {angles} instead of {PUBLISHED}"
        raise RuntimeError(message)
    return angles


def _digits(angles: Array, exact: Array) -> float:
    """Return the correct digits of the worst of the angles."""
    return float(-np.log10(np.max(np.abs((angles - exact) / exact)) + 1e-17))


def measure(solver: Solver, tolerance: float, exact: Array, rounds: int) -> Point:
    """Integrate at one tolerance, and take the time where it means something."""
    run = solver.prepare(tolerance)
    angles, taken = run()
    seconds = None
    if solver.compiled:
        seconds = timing_of([seconds_of(run) for _ in range(rounds)]).least
    return Point(solver.name, tolerance, _digits(angles, exact), seconds=seconds, **taken)


# -- results --------------------------------------------------------------------------------------


def table(points: list[Point], unknowns: dict[str, int]) -> str:
    """Return the results as Markdown."""
    header = ("program", "unknowns", "tolerance", "digits", "evaluations", "steps")
    header += ("Jacobians", "time [ms]")
    rows = [
        (
            p.solver,
            str(unknowns[p.solver]),
            f"{p.tolerance:.0e}",
            f"{p.digits:.1f}",
            count(p.evaluations),
            count(p.steps),
            count(p.jacobians),
            "-" if p.seconds is None else milliseconds(p.seconds),
        )
        for p in points
    ]
    return markdown_table(header, rows)


_COLOURS = {"kintrafo": BLUE, "IDAS": ORANGE, "Radau": GREEN}
_MARKS = ("o", "s", "^")


def figure(points: list[Point]) -> Figure:
    """Return the work-precision diagrams: evaluations and time against correct digits."""
    drawn = Figure(figsize=(10.0, 4.4), layout="constrained")
    left, right = drawn.subplots(1, 2, sharex=True)
    seen: dict[str, int] = {}
    for name in dict.fromkeys(p.solver for p in points):
        family = next(f for f in _COLOURS if name.startswith(f))
        style = {"color": _COLOURS[family], "marker": _MARKS[seen.get(family, 0)], "label": name}
        seen[family] = seen.get(family, 0) + 1
        of_it = [p for p in points if p.solver == name]
        digits = [p.digits for p in of_it]
        left.plot(digits, [p.evaluations for p in of_it], **style)
        if of_it[0].seconds is not None:
            right.plot(digits, [1e3 * (p.seconds or 0.0) for p in of_it], **style)
    left.set(title="evaluations", ylabel="evaluations", yscale="log")
    right.set(title="processor time", ylabel="time [ms]", yscale="log")
    for axes in (left, right):
        axes.set_xlabel("correct digits of the worst angle")
    drawn.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return drawn


def run(
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("out/benchmark"),
    page: Annotated[
        Path | None, typer.Option(help="Also put table and picture into this page of docs/.")
    ] = None,
) -> None:
    """Integrate Andrews' squeezer as an ordinary and as a differential-algebraic equation."""
    console = Console()
    out.mkdir(parents=True, exist_ok=True)
    compared = list(solvers())
    points = []
    columns = TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn()
    with one_core(), Progress(*columns, console=console) as progress:
        task = progress.add_task("integrating", total=len(compared) * len(_TOLERANCES))
        exact = reference()
        for solver in compared:
            for tolerance in _TOLERANCES:
                progress.update(task, description=solver.name)
                points.append(measure(solver, tolerance, exact, _ROUNDS))
                progress.advance(task)
    machine = environment()
    text = table(points, {s.name: s.unknowns for s in compared})
    with rc_context(STYLE):
        picture = out / "andrews.png"
        figure(points).savefig(picture, dpi=130)
    write_json(
        out / "andrews.json", {"environment": machine, "points": [asdict(p) for p in points]}
    )
    (out / "andrews.md").write_text(text + "\n", encoding="utf-8")
    if page is not None:
        fill_page(page, {"machine": machine_line(machine), "work": text})
        shutil.copy(picture, page.parents[1] / "images" / picture.name)
    console.print(Markdown(text))
    console.print(f"{out / 'andrews.md'} and, beside it, JSON and the diagram")


if __name__ == "__main__":
    typer.run(run)
