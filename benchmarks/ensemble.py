"""Many cars at once: what a right-hand side costs in lanes, and simulated seconds in a second.

``make benchmark-ensemble`` measures the reference car with 100,000 different sets of rates, each
let go from 10 mm of bump. Tolerances are the loosest at which no arm angle of some of the cars is
off by more than 1e-6 rad at any time; the truth is an integration at 1e-12 by another method.
Beside it are a loop over `simulate` and, where they are installed (the extra "peers"), CasADi's
integrator mapped over threads, Exudyn's variation of parameters in processes, and diffrax.
"""

import ctypes
import importlib.util
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from functools import cache, partial
from importlib import import_module, metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import numpy as np
import typer
from kintrafo import Model, System, ensemble, simulate, state_at_height
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from kintrafo.simulation.lanes import library
from kintrafo.simulation.lanes.run import usual_threads
from kintrafo.systems.compile.compiler import find_compiler
from matplotlib import rc_context
from matplotlib.figure import Figure
from rich.console import Console
from rich.markdown import Markdown

from .lanes_arithmetic import least_seconds, operations
from .report import (
    children_seconds,
    count,
    environment,
    fill_page,
    load,
    machine_line,
    markdown_table,
    seconds_of,
    write_json,
)

Array = np.ndarray[Any, np.dtype[np.float64]]

SPAN = (0.0, 1.0)
SAMPLES = np.linspace(*SPAN, 21)
ERROR = 1e-6  # of the arm angle [rad]
CHECKED = 20  # cars whose error is looked at
TOLERANCES = [10.0**-e for e in np.arange(2.0, 11.0, 0.25)]
SIZES = (100, 1_000, 10_000, 100_000)
ONE_BY_ONE = 200  # cars of a loop over simulate, and of other tools some times as many
REPEATS = 3
ROUNDS = 30  # of the calls: so short that some of them are undisturbed
CALLS = 10_000
OTHERS = ("casadi", "exudyn", "diffrax", "jax")
VARIED = ("spring_rate", "damper_rate", "tyre_rate")


@dataclass(frozen=True)
class Call:
    """Time of one right-hand side."""

    lanes: int  # 1: the function of one state
    nanoseconds: float  # for one car, the least of the repetitions


@dataclass(frozen=True)
class Rate:
    """How fast many cars are simulated."""

    what: str
    # threads, or processes
    cars: int
    threads: int
    setting: str  # tolerance, or number of steps
    error: float  # greatest of the arm angles [rad]
    # on the clock, and of all processor cores together: the least of the repetitions. What other
    # programs take is in the first.
    seconds: float
    processor_seconds: float

    @property
    def per_second(self) -> float:
        """Simulated seconds in one second."""
        return self.cars * (SPAN[1] - SPAN[0]) / self.seconds


@cache
def car() -> Model:
    """Return the reference car."""
    return Model("reference_car")


@cache
def start() -> Array:
    """Return the state from which all cars are let go."""
    return np.asarray(state_at_height(car(), 0.310, spin_rate=93.0))


def cars(number: int) -> dict[str, Array]:
    """Return cars whose rates differ by some per cent."""
    rng = np.random.default_rng(1)
    spread = 1.0 + 0.05 * rng.standard_normal((len(VARIED), number))
    return {name: car().parameters[name] * s for name, s in zip(VARIED, spread, strict=True)}


# -- one right-hand side --------------------------------------------------------------------------


def calls(times: int) -> Iterator[Call]:
    """Yield what a right-hand side costs, one by one and in all widths."""
    compiler = find_compiler()
    if compiler is None:
        return
    with TemporaryDirectory() as folder:
        built = Path(folder) / "loop.so"
        source = Path(folder) / "loop.c"
        shutil.copy(Path(__file__).with_name("lanes_loop.c"), source)
        compiler.build([source], built)
        loops = ctypes.CDLL(str(built))
        one = car().equations.ADDRESSES["rhs_rack_held"]
        yield Call(1, _nanoseconds(loops.call_one, one, 1, times))
        for width in library.widths():
            address = library.functions(car().equations, width, "_rack_held")["rhs"]
            yield Call(width, _nanoseconds(getattr(loops, f"call_{width}"), address, width, times))


def _nanoseconds(loop: Any, address: int, width: int, times: int) -> float:
    inputs = np.zeros(len(car().input_names))
    given = [_spread(values, width) for values in (car().constants, start(), inputs, start())]
    pointers = [ctypes.c_void_p(array.ctypes.data) for array in given]
    best = np.inf
    for _ in range(ROUNDS):
        called = partial(loop, ctypes.c_void_p(address), *pointers, ctypes.c_long(times))
        best = min(best, seconds_of(called))
    return best / times / width * 1e9


def _spread(values: Array, width: int) -> Array:
    """Return the same numbers in all lanes, at an address that is one of vectors."""
    memory = np.zeros(values.size * width + 8)
    first = (-memory.ctypes.data % 64) // 8
    aligned = memory[first : first + values.size * width].reshape(-1, width)
    aligned[:] = np.asarray(values)[:, None]
    return aligned


def bound(found: Sequence[Call], times: int) -> str:
    """Return the time of the arithmetic of a right-hand side in the widest lanes, as a text."""
    widest, name = found[-1], car().equations.NAME
    package = car().equations.__name__.rpartition(".")[0]
    file = Path(str(import_module(f"{package}._{name}_lanes").__file__))
    counted = operations(file, f"{name}_rhs_rack_held_{widest.lanes}")
    if counted is None:
        return "Nothing here shows what the compiler made: objdump would."
    least = least_seconds(counted, widest.lanes, times) / widest.lanes * 1e9
    return (
        f"In {widest.lanes} lanes a right-hand side consists of {counted.products} products of "
        f"vectors, {counted.sums} sums and differences, {counted.quotients} quotients and "
        f"{counted.roots} roots. The same number of independent operations takes {least:.1f} ns a "
        "car on this processor. The arithmetic alone would be "
        f"{found[0].nanoseconds / least:.1f} times as fast as one by one; "
        f"{100.0 * least / widest.nanoseconds:.0f} % of this speed is reached."
    )


# -- a second of motion ---------------------------------------------------------------------------


Solver = Callable[[int, Any], Array]
"""From how many of the cars, and a tolerance or number of steps, to their arm angles."""


@cache
def truth(number: int) -> Array:
    """Return the arm angles of some cars, to 1e-11 rad."""
    return one_by_one(number, 1e-12, "DOP853")


def one_by_one(number: int, tolerance: float, method: Any = "DormandPrince") -> Array:
    """Simulate cars one after the other, as a person would in a loop."""
    found, own = np.empty((number, SAMPLES.size)), cars(number)
    for place in range(number):
        parameters = car().parameters | {name: own[name][place] for name in VARIED}
        model = System(car().equations, parameters)
        options = {"rtol": tolerance, "atol": tolerance, "t_eval": SAMPLES, "method": method}
        found[place] = simulate(model, SPAN, start(), **options).y[0]
    return found


def in_lanes(lanes: int, threads: int) -> Solver:
    """Return the ensemble, whose results are the angles alone."""

    def solve(number: int, tolerance: float) -> Array:
        found = ensemble(
            car(), cars(number), SPAN, start(), signals=["beta1"], t_eval=SAMPLES,
            rtol=tolerance, atol=tolerance, lanes=lanes, threads=threads,
        )  # fmt: skip
        angles: Array = found["beta1"].values
        return angles

    return solve


def loosest(solve: Solver, checked: int, settings: Sequence[Any] = TOLERANCES) -> tuple[Any, float]:
    """Return the loosest setting that is accurate enough for some cars, and its error [rad]."""
    for setting in settings:
        error = float(np.abs(solve(checked, setting) - truth(checked)).max())
        if error <= ERROR:
            return setting, error
    message = f"no setting has an error of {ERROR:g} rad"
    raise ValueError(message)


def timed(
    what: str,
    solve: Solver,
    sizes: tuple[int, ...],
    threads: int,
    settings: Sequence[Any] = TOLERANCES,
) -> Iterator[Rate]:
    """Yield how fast one way is, for every number of cars."""
    setting, error = loosest(solve, min(CHECKED, sizes[0]), settings)
    label = f"{setting} steps" if isinstance(setting, int) else f"{setting:.0e}"
    for number in sizes:
        taken = []
        for _ in range(REPEATS):
            before = time.perf_counter(), processor_time()
            solve(number, setting)
            taken.append((time.perf_counter() - before[0], processor_time() - before[1]))
        clock, processor = map(min, zip(*taken, strict=True))
        yield Rate(what, number, threads, label, error, clock, processor)


def processor_time() -> float:
    """Return how long all cores have worked for this process and those that it has ended [s]."""
    return time.process_time() + children_seconds()


def rates(sizes: tuple[int, ...], report: Callable[[str], None]) -> Iterator[Rate]:
    """Yield how fast all ways are."""
    cores = usual_threads()
    report("a loop over simulate")
    yield from timed("a loop over `simulate`", one_by_one, (min(ONE_BY_ONE, sizes[-1]),), 1)
    for lanes in library.widths():
        for threads in sorted({1, cores}):
            report(f"{lanes} lanes, {threads} threads")
            what = f"`ensemble`, {lanes} lanes"
            yield from timed(what, in_lanes(lanes, threads), sizes, threads)


def beside(most: int, report: Callable[[str], None]) -> Iterator[Rate]:
    """Yield how fast the widest lanes are, and other tools, those that are installed.

    Exudyn comes before diffrax: processes cannot be forked when JAX has begun its threads.
    """
    cores, widest = usual_threads(), library.widths()[-1]
    many = (min(50 * ONE_BY_ONE, most),)
    yield from timed(f"`ensemble`, {widest} lanes", in_lanes(widest, cores), many, cores)
    if importlib.util.find_spec("casadi"):
        from .peers.casadi_map import mapped as by_casadi  # noqa: PLC0415 (may not be installed)

        report("CasADi")
        solve = by_casadi(start(), SPAN, SAMPLES, cars, cores)
        fewer = (min(5 * ONE_BY_ONE, most),)
        yield from timed("CasADi CVODES, jit, `map`", solve, fewer, cores)
    if importlib.util.find_spec("exudyn"):
        from .peers.exudyn_cars import STEPS, varied  # noqa: PLC0415 (may not be installed)

        report("Exudyn")
        solve = varied(start(), SAMPLES, cars, cores)
        few = (min(ONE_BY_ONE // 10, most),)
        yield from timed("Exudyn, variation of parameters", solve, few, cores, STEPS)
    if importlib.util.find_spec("diffrax"):
        from .peers.diffrax_cars import mapped as by_diffrax  # noqa: PLC0415 (may not be installed)

        report("diffrax")
        solve = by_diffrax(car(), start(), SPAN, SAMPLES, cars, cores)
        yield from timed("diffrax Tsit5, `vmap`", solve, many, cores)


def iterating(most: int) -> str:
    """Return the time of a car on five links, whose loops iterate, as a text."""
    model = Model("multi_link_car")
    height = float(model.signal("wheel_center_z", model.design_state))
    begin = state_at_height(model, height - 0.010)
    few, many = min(ONE_BY_ONE // 10, most), min(5 * ONE_BY_ONE, most)

    def rates(number: int) -> Array:
        return model.parameters["damper_rate"] * np.linspace(0.9, 1.1, number)

    def in_a_loop() -> None:
        for rate in rates(few).tolist():
            one = System(model.equations, model.parameters | {"damper_rate": rate})
            simulate(one, SPAN, begin, method="DormandPrince")

    def together() -> None:
        ensemble(model, {"damper_rate": rates(many)}, SPAN, begin)

    alone, in_lanes = _processor_times(in_a_loop) / few, _processor_times(together) / many
    return (
        f"For a second of motion, one of {count(many)} cars on five links, whose loops iterate, "
        f"takes {_rounded(1e6 * in_lanes)} µs of a core in {library.widths()[-1]} lanes, and "
        f"{_rounded(1e6 * alone)} µs in a loop over `simulate` by the same method and tolerances, "
        f"{_rounded(alone / in_lanes, digits=2)} times as long."
    )


def _processor_times(call: Callable[[], None]) -> float:
    """Return the least time of some calls, of all cores [s]."""
    taken = []
    for _ in range(REPEATS):
        before = processor_time()
        call()
        taken.append(processor_time() - before)
    return min(taken)


# -- results --------------------------------------------------------------------------------------


def table_of_calls(found: list[Call]) -> str:
    """Return the costs of a right-hand side as Markdown."""
    header = ("right-hand side", "ns a car", "speed-up")
    rows = [
        (
            "one by one" if call.lanes == 1 else f"{call.lanes} lanes",
            f"{call.nanoseconds:.1f}",
            f"{found[0].nanoseconds / call.nanoseconds:.1f}",
        )
        for call in found
    ]
    return markdown_table(header, rows)


def table_of_rates(found: list[Rate]) -> str:
    """Return the rates as Markdown: of each way that of the most cars."""
    header = (
        "", "threads", "cars", "tolerance", "error [rad]", "processor time per car [µs]",
        "simulated seconds per second",
    )  # fmt: skip
    largest = {(rate.what, rate.threads): rate for rate in found}.values()
    rows = [
        (
            rate.what,
            str(rate.threads),
            count(rate.cars),
            rate.setting,
            f"{rate.error:.0e}",
            _rounded(_of_a_core(rate)),
            count(float(f"{rate.per_second:.2g}")),
        )
        for rate in largest
    ]
    return markdown_table(header, rows)


def table_of_others(found: list[Rate]) -> str:
    """Return the costs of other tools as Markdown, against the first way."""
    header = (
        "", "threads", "cars", "tolerance", "error [rad]", "processor time per car [µs]",
        "relative time",
    )  # fmt: skip
    rows = [
        (
            rate.what,
            str(rate.threads),
            count(rate.cars),
            rate.setting,
            f"{rate.error:.0e}",
            _rounded(_of_a_core(rate)),
            _rounded(_of_a_core(rate) / _of_a_core(found[0]), digits=2),
        )
        for rate in found
    ]
    return markdown_table(header, rows)


def _beside() -> str:
    """Return the versions of the other tools and the load of the machine, as a text."""
    there = [name for name in OTHERS if importlib.util.find_spec(name)]
    versions = ", ".join(f"{name} {metadata.version(name)}" for name in there)
    return f"{versions}. {load()}"


def _rounded(number: float, digits: int = 3) -> str:
    """Return a number in so many digits."""
    short = f"{number:.{digits}g}"
    return count(float(short)) if number >= 100.0 else short


def sentence(found: list[Rate]) -> str:
    """Return the least time of a car, as a text."""
    best, loop = min(found, key=_of_a_core), found[0]
    cost, before = _of_a_core(best), _of_a_core(loop)
    return (
        f"For a second of motion, one of {count(best.cars)} cars takes {cost:.2g} µs of a core by "
        f"{best.what}, and {float(f'{before:.2g}'):.0f} µs by a loop over `simulate`, "
        f"{float(f'{before / cost:.2g}'):.0f} times as long."
    )


def share(costs: Sequence[Call], found: list[Rate]) -> str:
    """Return the part of the right-hand sides in the time of a car, as a text."""
    best = min(found, key=_of_a_core)
    tolerance = float(best.setting)
    options = {"rtol": tolerance, "atol": tolerance, "t_eval": SAMPLES}
    alone = simulate(car(), SPAN, start(), method="DormandPrince", **options)
    spent = alone.nfev * costs[-1].nanoseconds / 1e3
    return (
        f"The nominal car takes {alone.steps} steps with {alone.nfev} right-hand sides for the "
        f"second. In {costs[-1].lanes} lanes these take {spent:.1f} µs, "
        f"{100.0 * spent / _of_a_core(best):.0f} % of the time of one car."
    )


def _of_a_core(rate: Rate) -> float:
    """Return how long a core works for one car [µs]."""
    return rate.processor_seconds / rate.cars * 1e6


def figure(found: list[Rate]) -> Figure:
    """Draw how the rate grows with the number of cars."""
    drawn = Figure(figsize=(6.4, 3.6), layout="constrained")
    axes = drawn.subplots()
    tools = dict.fromkeys(rate.what for rate in found)
    known = (ORANGE, "#56b4e9", BLUE, "#cc79a7", GREEN, "#000000", "#999999")
    colours = dict(zip(tools, known, strict=False))
    for what, threads in dict.fromkeys((rate.what, rate.threads) for rate in found):
        own = [rate for rate in found if (rate.what, rate.threads) == (what, threads)]
        label = f"{what.replace('`', '')}, {threads} thread{'s' * (threads > 1)}"
        axes.plot(
            [rate.cars for rate in own],
            [rate.per_second for rate in own],
            "o-" if threads == 1 else "s--",
            color=colours[what],
            label=label,
        )
    axes.set(xscale="log", yscale="log", xlabel="cars", ylabel="simulated seconds in one second")
    axes.legend(frameon=False, fontsize=8)
    return drawn


def run(
    out: Annotated[Path, typer.Option(help="Folder for the results.")] = Path("out/benchmark"),
    page: Annotated[
        Path | None, typer.Option(help="Also put tables and picture into this page of docs/.")
    ] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Few cars, no other tools.")] = False,
    others: Annotated[
        bool, typer.Option("--others", help="Only these, and what iterates.")
    ] = False,
) -> None:
    """Measure many cars at once."""
    console = Console()
    if not library.widths():
        console.print("kintrafo was built without lanes, for which it needs GCC or Clang.")
        raise typer.Exit(1)
    out.mkdir(parents=True, exist_ok=True)
    sizes, times = ((2, 4), 1000) if quick else (SIZES, CALLS)
    machine = environment()
    words = machine_line(machine).replace("Processor time on one core of", "Measured on")
    blocks, data = {}, {"environment": machine}
    with console.status("one right-hand side") as status:
        if not others:
            costs, found = list(calls(times)), list(rates(sizes, status.update))
            blocks |= {"machine": words, "calls": table_of_calls(costs)}
            blocks |= {"bound": bound(costs, times)}
            blocks |= {"rates": table_of_rates(found), "sentence": sentence(found)}
            blocks |= {"share": share(costs, found)}
            data |= {"calls": costs, "rates": [asdict(rate) for rate in found]}
        blocks["iterating"] = iterating(sizes[-1])
        compared = [] if quick else list(beside(sizes[-1], status.update))
    if len(compared) > 1:
        blocks |= {"others": table_of_others(compared), "machine others": f"{words} {_beside()}"}
        data |= {"others": [asdict(rate) for rate in compared]}
    text = "\n\n".join(blocks.values())
    (out / "ensemble.md").write_text(text + "\n", encoding="utf-8")
    write_json(out / "ensemble.json", data)
    if page is not None:
        fill_page(page, blocks)
    if not others:
        _draw([*found, *compared[1:]], out / "ensemble.png", page)
    console.print(Markdown(text))


def _draw(found: list[Rate], file: Path, page: Path | None) -> None:
    """Write the picture, also for the page."""
    with rc_context(STYLE):
        figure(found).savefig(file, dpi=130)
    if page is not None:
        shutil.copy(file, page.parents[1] / "images" / file.name)


if __name__ == "__main__":
    typer.run(run)
