"""Options and fixtures of all tests.

Modules with a long import are imported inside functions: the process that distributes the tests
reads this file, too, and the other processes wait for it.
"""

from __future__ import annotations

import atexit
import gc
import os
import re
import resource
import signal
import sys
from contextlib import contextmanager
from dataclasses import replace
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import HealthCheck, settings
from support import kept, messages
from support.folders import ROOT

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator
    from pathlib import Path
    from types import ModuleType

    import xarray as xr
    from kintrafo.generator.equations.outputs import Derivation

    Pages = dict[str, tuple[Hashable, ...]]
    """Groups of curves by name, with their variables."""

# SymPy reads this variable at its import. Some tests import SymPy before
# `kintrafo.generator.memory`.
os.environ.setdefault("SYMPY_CACHE_SIZE", "None")

# As many processes as cores run tests: their threads would only wait for each other.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

# The time of an example depends on the machine and its load.
settings.register_profile(
    "calm", deadline=None, max_examples=50, suppress_health_check=[HealthCheck.too_slow]
)
settings.load_profile("calm")

# Models that tests compile like a user are compiled once for all processes and later runs, in a
# separate cache. Without optimisation this takes a tenth of the time, and without contraction the
# bits are the same.
os.environ["KINTRAFO_CACHE"] = str(kept.KEPT / "cache")
os.environ.setdefault("CFLAGS", " ".join(kept.UNOPTIMISED))

# Files that take more than 0.5 % of the time of all tests, the first one 10 %.
_LONGEST = (
    "test_examples.py",
    "test_fuzz.py",
    "test_mechanisms.py",
    "test_handling.py",
    "test_export_fmu.py",
    "test_car_studies.py",
    "test_iteration_loops.py",
    "test_wheel_loads.py",
    "test_export_python.py",
    "test_benchmarks.py",
    "test_copies.py",
    "test_parameter_derivatives.py",
    "test_own_mechanism.py",
    "test_variation.py",
    "test_rolling_tyre.py",
    "test_free_base.py",
    "test_driving_car.py",
    "test_ride.py",
    "test_ensemble_cluster.py",
    "test_car.py",
    "test_emitted_c.py",
    "test_car_loads.py",
    "test_loads_of_assemblies.py",
    "test_command_line.py",
    "test_loads.py",
    "test_ensemble.py",
    "test_iteration.py",
    "test_motion_gradient.py",
    "test_sanitizers.py",
    "test_fit.py",
    "test_iteration_branches.py",
    "test_closed_before_iterated.py",
    "test_status.py",
    "test_axles.py",
    "test_compliance_of_assemblies.py",
    "test_report_browser.py",
    "test_cli_commands.py",
    "test_motion_sensitivity.py",
    "test_derivation_report.py",
    "test_goals_under_loads.py",
    "test_native_build.py",
    "test_assumptions.py",
    "test_golden.py",
)


_MEMORY = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
MUCH = _MEMORY // 4 // (1024 if sys.platform == "linux" else 1)
"""Growth of memory after which cycles of objects are freed, in the unit of ``ru_maxrss``: a quarter
of the memory for each of two processes. The search takes some 3 s for 1 GiB."""
_most = 0


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--update-baseline",
        action="store_true",
        help="store the present operation counts in tests/generator/backends/operation_counts",
    )
    parser.addoption(
        "--update-messages",
        action="store_true",
        help="store the present messages in tests/golden/messages.json",
    )


def pytest_sessionstart(session: pytest.Session) -> None:
    """Remove models that tests compiled long ago, before workers start."""
    if not hasattr(session.config, "workerinput"):
        kept.forget()


def pytest_itemcollected(item: pytest.Item) -> None:
    """Mark tests that compare with an oracle: last bits of numbers depend on the processor."""
    if _compares(getattr(item, "module", None)):
        item.add_marker("numbers")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files that take longest, so that no process waits for one at the end."""
    places = {name: place for place, name in enumerate(_LONGEST)}
    items.sort(key=lambda item: places.get(item.path.name, len(places)))


def pytest_configure(config: pytest.Config) -> None:
    """Switch off Python's search for cycles of objects, which visits all derived expressions.

    Refuse to store messages in several processes, of which each would write the file.
    """
    if config.getoption("--update-messages") and config.getoption("numprocesses", None):
        raise pytest.UsageError("--update-messages needs one process: leave out -n")
    gc.disable()


def pytest_collection_finish() -> None:
    """Exclude imported objects from the search for cycles: they are never freed."""
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_unconfigure(config: pytest.Config) -> None:
    """End a worker process at once, after its results are sent.

    Otherwise Python frees all derived expressions one by one, which takes longer than the ten
    seconds after which workers are killed.
    """
    if hasattr(config, "workerinput"):
        if "kintrafo.generator.memory" in sys.modules:
            atexit.unregister(sys.modules["kintrafo.generator.memory"].forget)
        atexit._run_exitfuncs()
        os._exit(0)


@pytest.fixture(scope="module", autouse=True)
def _memory_of_files_is_freed() -> Iterator[None]:
    """Free remembered expressions, and cycles of objects after files that took much memory."""
    global _most  # noqa: PLW0603 (of this process)
    yield
    if "kintrafo.generator.memory" in sys.modules:
        sys.modules["kintrafo.generator.memory"].forget()
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    if most > _most + MUCH:
        gc.collect()
        gc.freeze()
        _most = most


@cache
def _compares(module: ModuleType | None) -> bool:
    """Return whether the module of a test uses an oracle."""

    def home(value: object) -> str:
        return str(getattr(value, "__module__", None) or getattr(value, "__name__", ""))

    names = vars(module or object).values()
    return any(
        home(value).startswith(("oracle", "support.models", "cars.instants")) for value in names
    )


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Let Python handle interrupts, which programs in the background of a script ignore."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def kintrafo(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> Callable[..., tuple[int, str, str]]:
    """Run a command line in an empty folder; return exit code, stdout and stderr."""
    from kintrafo.vehicle import cli
    from typer import main as typer_main

    monkeypatch.chdir(tmp_path)
    if not hasattr(typer_main.get_command, "cache_info"):  # the same commands in every run
        typer_main.get_command = cache(typer_main.get_command)

    def run(*arguments: object) -> tuple[int, str, str]:
        monkeypatch.setattr("sys.argv", ["kintrafo", *map(str, arguments)])
        code = 0
        try:
            cli.run()
        except SystemExit as end:
            code = int(end.code or 0)
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run


@pytest.fixture
def as_stored(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Callable[..., None]]:
    """Compare errors or texts with the messages that are stored for this test."""
    so_far = messages.StoredMessages(
        request.node, update=request.config.getoption("--update-messages")
    )

    folder = re.compile(rf"{re.escape(str(tmp_path))}|{re.escape(str(tmp_path.parent))}/[\w-]+")

    def compare(*errors: object) -> None:
        for error in errors:
            so_far.hear(folder.sub("FOLDER", str(error)).replace(str(ROOT), "PROJECT"))

    yield compare
    so_far.end()


@pytest.fixture
def refused(as_stored: Callable[..., None]) -> Callable[..., Any]:
    """Assert that calls raise one kind of error, and compare its messages with those stored.

    Without calls, ``with refused(error):`` has one.
    """

    @contextmanager
    def block(error: type[Exception]) -> Iterator[pytest.ExceptionInfo[Exception]]:
        with pytest.raises(error) as found:
            yield found
        as_stored(found.value)

    def compare(error: type[Exception], *calls: Callable[[], object]) -> Any:
        if not calls:
            return block(error)
        caught = []
        for call in calls:
            with pytest.raises(error) as found:
                call()
            caught.append(found.value)
        as_stored(*caught)
        return caught[0]

    return compare


@pytest.fixture
def ends(
    kintrafo: Callable[..., tuple[int, str, str]], as_stored: Callable[..., None]
) -> Callable[..., str]:
    """Assert that a command has an exit code, and compare its messages with those stored.

    It returns the messages in one line.
    """

    def compare(code: int, *arguments: object) -> str:
        found, out, err = kintrafo(*arguments)
        assert found == code, err
        assert not out or code != 2, out
        message = " ".join(re.sub("[╭─╮│╰╯]", " ", err).split())
        as_stored(message)
        return message

    return compare


@pytest.fixture(scope="session")
def derived() -> Callable[[str], Derivation]:
    """Derive a model that comes with the project, by name: once for all tests and later runs."""
    from kintrafo.generator.mechanisms import MODELS
    from support.models import derive

    shipped = {model.name: model for model in MODELS}
    return lambda name: derive(shipped[name])


@pytest.fixture
def coarse_report(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reduce the positions in reports, for tests that do not need numbers between them."""
    from kintrafo.vehicle.report.grid import Grid, GridAxis

    grid = Grid(GridAxis(-0.03, 0.015, 5), GridAxis(-0.03, 0.015, 5))
    monkeypatch.setattr("kintrafo.vehicle.report.page.reachable_grid", lambda _: grid)


@pytest.fixture
def few_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reduce GIFs to every tenth frame, for tests that do not need smooth motion."""
    from kintrafo.pages import animation

    whole = animation.frames

    def fewer(*arguments: Any) -> tuple[Any, Any]:
        wanted, rows = whole(*arguments)
        return wanted[::10], rows[::10]

    for name in ("kintrafo.pages.animation", "kintrafo.vehicle.plots.motion.animate"):
        monkeypatch.setattr(import_module(name), "frames", fewer)


@pytest.fixture
def coarse_drives(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lengthen the sampling times of commands' manoeuvres, for tests that do not need numbers."""
    from kintrafo.vehicle.analysis import handling

    whole = handling.load_manoeuvre

    def coarse(given: Any, changes: dict[str, Any]) -> Any:
        found = whole(given, changes)
        if hasattr(found, "step_ms"):
            found = whole(given, changes | {"step_ms": 5.0, "output_step_ms": 20.0})
        return found

    monkeypatch.setattr(handling, "load_manoeuvre", coarse)


@pytest.fixture
def few_generations(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shorten the search for a front, for tests that do not need a good one."""
    from kintrafo.vehicle import studies as variation

    whole = variation.pareto

    def short(*arguments: object, **given: object) -> variation.Front:
        return whole(*arguments, **(given | {"population": 12, "generations": 3}))

    monkeypatch.setattr(variation, "pareto", short)


@pytest.fixture
def one_picture(monkeypatch: pytest.MonkeyPatch) -> None:
    """Repeat the first picture in all chapters, and the first free bodies in all load cases.

    Drawing all pictures takes seconds.
    """
    from kintrafo.vehicle.plots.loads import free_bodies
    from kintrafo.vehicle.report.chapters.chapter import ChapterPicture

    _draw_roughly(monkeypatch)
    whole = ChapterPicture.of
    drawn: list[ChapterPicture] = []

    def first(figure: Any, words: str, ending: Any = "svg") -> ChapterPicture:
        if not drawn:
            drawn.append(whole(figure, words, ending))
        return replace(drawn[0], words=words)

    monkeypatch.setattr(ChapterPicture, "of", first)
    of_command: dict[tuple[str, ...], Any] = {}

    def first_bodies(*given: Any, **options: Any) -> Any:
        command = tuple(sys.argv)
        if command not in of_command:
            of_command[command] = free_bodies(*given, **options)
        return of_command[command]

    for place in ("plots.loads", "report.chapters.loads"):
        monkeypatch.setattr(f"kintrafo.vehicle.{place}.free_bodies", first_bodies)


@pytest.fixture
def rough_drawings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw coarse figures without a layout of their parts, which takes longest."""
    _draw_roughly(monkeypatch)


def _draw_roughly(monkeypatch: pytest.MonkeyPatch) -> None:
    from matplotlib.figure import Figure
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    whole = Figure.savefig

    def coarse(figure: Figure, file: Any, **given: Any) -> None:
        whole(figure, file, **(given | {"dpi": 40}))

    monkeypatch.setattr(Figure, "savefig", coarse)
    monkeypatch.setattr(Figure, "draw_without_rendering", lambda _: None)
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: {})


@pytest.fixture
def first_page_of_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw only the first group of curves; drawing all groups takes seconds."""
    _draw_pages(monkeypatch, lambda _: {})


@pytest.fixture
def each_page_of_curves_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Draw the groups of curves that no earlier figure has, or else the first."""
    drawn: set[str] = set()

    def fresh(pages: Pages) -> Pages:
        new = {name: page for name, page in pages.items() if name not in drawn}
        drawn.update(new)
        return new

    _draw_pages(monkeypatch, fresh)


def _draw_pages(monkeypatch: pytest.MonkeyPatch, wanted: Callable[[Pages], Pages]) -> None:
    """Draw the wanted pages, or the first one if none is wanted."""
    from kintrafo.vehicle.plots.curves import grouped

    _draw_roughly(monkeypatch)

    def some(dataset: xr.Dataset, *goals: Any) -> Pages:
        pages = grouped(dataset, *goals)
        return wanted(pages) or dict([next(iter(pages.items()))])

    monkeypatch.setattr("kintrafo.vehicle.plots.curves.grouped", some)


@pytest.fixture(scope="module")
def driver() -> Iterator[Any]:
    """Return the object that starts browsers."""
    playwright = pytest.importorskip("playwright.sync_api", reason="playwright is not installed")
    with playwright.sync_playwright() as running:
        yield running.chromium


@pytest.fixture(scope="module")
def browser(driver: Any) -> Iterator[Any]:
    """Return a browser in which the processor draws WebGL, as on machines without graphics."""
    from support.browser import SOFTWARE_GL, running

    with running(driver, *SOFTWARE_GL) as launched:
        yield launched
