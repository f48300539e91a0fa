"""How times are taken, and how results are written: Markdown, JSON, blocks of a page."""

import json
import os
import platform
import re
import resource
import shlex
import statistics
import subprocess
import sysconfig
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import asdict, dataclass, is_dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

from kintrafo.simulation.lanes.run import usual_threads
from kintrafo.simulation.solvers import native_available, native_version

NO_SUNDIALS = (
    "SUNDIALS is not built in: only the methods of SciPy are shown, and the paper's protocol, "
    "which needs a method that steps onto every output, is left out."
)

# -- times --------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Timing:
    """Processor times of repetitions of the same work [s]."""

    least: float
    median: float
    most: float
    repeats: int

    @property
    def spread(self) -> float:
        """How much longer than the shortest the middle repetition took, as a part of it."""
        return self.median / self.least - 1.0


def timing_of(seconds: Sequence[float]) -> Timing:
    """Summarise repetitions."""
    return Timing(min(seconds), statistics.median(seconds), max(seconds), len(seconds))


def seconds_of(call: Callable[[], object]) -> float:
    """Return the processor time of one call in this thread [s].

    What other programs take from the processor meanwhile is not in it.
    """
    before = time.thread_time()
    call()
    return time.thread_time() - before


def children_seconds() -> float:
    """Return the processor time of all ended programs that this one has started [s]."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


@contextmanager
def one_core() -> Iterator[None]:
    """Keep this process on one processor core, where the system can."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    before = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {max(before)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, before)


# -- the machine --------------------------------------------------------------------------------


def environment() -> dict[str, str]:
    """Return what the times depend on; nothing that names a person, a host or a day."""
    return {
        "processor": _processor(),
        "system": f"{platform.system()} {platform.machine()}",
        "compiler": _compiler(),
        "Python": platform.python_version(),
        "SUNDIALS": native_version() if native_available() else "not built in",
        "SciPy": version("scipy"),
        "NumPy": version("numpy"),
    }


def _processor() -> str:
    information = Path("/proc/cpuinfo")
    if information.exists():
        found = re.search(r"^model name\s*:\s*(.+)$", information.read_text(), re.MULTILINE)
        if found:
            return found[1].strip()
    if platform.system() == "Darwin":
        return _first_line(["sysctl", "-n", "machdep.cpu.brand_string"])
    return platform.processor() or "unknown"


def _compiler() -> str:
    command = os.environ.get("CC") or sysconfig.get_config_var("CC") or "cc"
    return _first_line([shlex.split(command)[0], "--version"])


def _first_line(command: list[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return (done.stdout.splitlines() or ["unknown"])[0].strip()


# -- numbers ------------------------------------------------------------------------------------


def power(value: float) -> str:
    """Return a number in two digits and a power of ten, such as 9.4e-6."""
    mantissa, exponent = f"{value:.1e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def milliseconds(seconds: float) -> str:
    """Return a time in milliseconds, with three digits."""
    value = 1e3 * seconds
    return f"{value:.0f}" if value >= 100.0 else f"{value:.3g}"


def count(number: float) -> str:
    """Return a whole number in groups of three."""
    return f"{round(number):,}".replace(",", " ")


def load() -> str:
    """Return the load of the machine, as a sentence."""
    return f"Load average of the {usual_threads()} cores: {os.getloadavg()[0]:.0f}."


# -- writing ------------------------------------------------------------------------------------


def markdown_table(header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a Markdown table: the first column to the left, the others to the right.

    Examples
    --------
    >>> print(markdown_table(["method", "steps"], [["BDF", "472"]]))
    | method | steps |
    |:-------|------:|
    | BDF    |   472 |
    """
    columns = list(zip(header, *rows, strict=True))
    widths = [max(3, *(len(cell) for cell in column)) for column in columns]

    def line(cells: Sequence[str]) -> str:
        rest = (cell.rjust(width) for cell, width in zip(cells[1:], widths[1:], strict=True))
        return "| " + " | ".join([cells[0].ljust(widths[0]), *rest]) + " |"

    rule = [":" + "-" * (widths[0] + 1), *("-" * (width + 1) + ":" for width in widths[1:])]
    return "\n".join([line(header), "|" + "|".join(rule) + "|", *(line(row) for row in rows)])


def machine_line(machine: Mapping[str, str]) -> str:
    """Return the machine in one line."""
    return (
        f"Processor time on one core of: {machine['processor']} ({machine['system']}); "
        f"{machine['compiler']}; SUNDIALS {machine['SUNDIALS']}; SciPy {machine['SciPy']}; "
        f"Python {machine['Python']}."
    )


def write_json(path: Path, data: Mapping[str, Any]) -> None:
    """Write results, dataclasses included, as JSON."""
    text = json.dumps(data, indent=2, default=_plain, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    if is_dataclass(value) and not isinstance(value, type):
        return asdict(value)
    if isinstance(value, complex):
        return {"real": value.real, "imaginary": value.imag}
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(type(value).__name__)


def fill_page(page: Path, blocks: Mapping[str, str]) -> None:
    """Replace the blocks of a page, each between two comments, with new results.

    Parameters
    ----------
    page : Path
        With lines ``<!-- begin NAME -->`` and ``<!-- end NAME -->``.
    blocks : mapping
        Text of each block by name; those that the page does not have are left out.
    """
    text = page.read_text(encoding="utf-8")
    for name, block in blocks.items():
        begin, end = f"<!-- begin {name} -->", f"<!-- end {name} -->"
        before, found, rest = text.partition(begin)
        if found:
            text = f"{before}{begin}\n{block}\n{end}{rest.partition(end)[2]}"
    page.write_text(text, encoding="utf-8")
