"""Ctrl-C at any time of a long command: a quick end, exit code 130, complete outputs.

A command runs as a process of its own, from when it has begun to import kintrafo. A file of its
outputs is either what was there before, or what the command writes when nobody interrupts it;
nothing that it started runs on.
"""

import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
from contextlib import suppress
from functools import cache
from importlib.resources import files
from pathlib import Path

from ..attempts import RawError, UnjudgedError, WrongError

SHORT = 2
SECONDS = 60.0
# What a busy machine may take for what takes a part of a second otherwise.
_SOON = 8.0
_STUDIES = Path(__file__).parents[2] / "data" / "studies"
_RIGID = """
[tolerances]
"hardpoints.spring_seat.y" = 1.0
"""
_MECHANISM = "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"
CAR = "reference_car"
OVER = ("-o", "a.csv", "--plot", "a.png", "--force")
LONG = (
    ("characteristics", CAR, "--positions", "--step", "0.05", *OVER),
    ("characteristics", CAR, "--step", "0.5", *OVER),
    ("characteristics", "reference_axle", "--over", "roll", *OVER),
    ("simulate", CAR, "--duration", "60", "--road-sine", "5", "--road-frequency", "9", *OVER),
    ("simulate", CAR, "--duration", "5", "--road-step", "20", "--method", "Radau", *OVER),
    ("loads", CAR, *OVER),
    ("compliance", "soft.toml", *OVER),
    ("compliance", "soft.toml", "--nonlinear", *OVER),
    ("sheet", "soft.toml", "-o", "a.csv", "--force"),
    ("compare", CAR, "double_wishbone_car", *OVER),
    ("sensitivity", CAR, *OVER),
    ("tolerance", CAR, "tolerances.toml", "--cars", "10000", *OVER),
    ("tolerance", "rigid_axle", "rigid.toml", "--cars", "3000", *OVER),
    ("optimise", CAR, "goals.toml", "-o", "a.toml", "--force"),
    ("pareto", CAR, "front.toml", "--population", "60", "--generations", "60", *OVER),
    ("sweep", CAR, "strut.damper_rate_N_s_per_m=500:3000:3000", *OVER),
    ("report", CAR, "a.html", "--force"),
    ("mechanism", "animate", CAR, "a.gif", "--force"),
    ("paper", "out", "--force"),
    ("mechanism", "derivation", "mechanism.py", "-o", "a.md", "--force"),
    ("mechanism", "generate", "mechanism.py", "-o", "out", "--force"),
    ("mechanism", "topology", "mechanism.py"),
)
NAMES = ("a.csv", "a.png", "a.toml", "a.html", "a.gif", "a.md")
# The program of a process, which prints a line when it begins. A test run in the background of a
# shell ignores Ctrl-C, and so would its processes.
_BEGIN = (
    "import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
    "import kintrafo.__main__ as m; print('begun', flush=True); m.run()"
)


@cache
def _sources():
    """Return what the commands read: names of files, and texts."""
    read = {path.name: path.read_text(encoding="utf-8") for path in _STUDIES.glob("*.toml")}
    soft = files("kintrafo.vehicle.data").joinpath(f"{CAR}.toml").read_text(encoding="utf-8")
    return {
        **read,
        "soft.toml": f"{soft}\n{read['bushes.toml']}",
        "rigid.toml": _RIGID,
        "mechanism.py": _MECHANISM,
    }


def attempt(random):
    """Interrupt a command once, as a terminal or as another program does."""
    # few are late: a test run, which tries seeds 0 and 1, waits 2.0 s and 0.8 s
    after = 12.0 * random.random() ** 4
    command, whole_group = LONG[random.integers(len(LONG))], bool(random.integers(2))
    with tempfile.TemporaryDirectory() as name:
        folder = _filled(Path(name))
        before = contents(folder / "work")
        code, message, took = interrupted(folder, command, after, whole_group=whole_group)
        shown = (
            f"{' '.join(command)} after {after:.3f} s, {took:.2f} s more: "
            f"{code}, {message[-900:]!r}"
        )
        left = contents(folder / "work")
        strange = [path.name for path in folder.rglob(".*")]
    if code is None:
        raise WrongError(f"{shown}: runs on")
    if took > _SOON:
        raise WrongError(f"{shown}: too late")
    if code not in (0, _INTERRUPTED):
        raise WrongError(shown)
    if message.replace(_STOPPED, "").strip():
        raise RawError(shown)
    if strange:
        raise WrongError(f"{shown}: left {strange}")
    changed = {path for path in left if left[path] != before.get(path)}
    if changed and any(left[path] != whole(command).get(path) for path in changed):
        raise WrongError(f"{shown}: half written: {changed}")
    if code == 0:  # what comes after the end of a command does not interrupt it
        if left != whole(command):
            raise WrongError(f"{shown}: not done")
        raise UnjudgedError(f"{shown}: done before")


_INTERRUPTED = 130
_STOPPED = "Stopped: no compiler runs on, and nothing of it is left behind."


def _filled(folder):
    (folder / "work").mkdir()
    for name, text in _sources().items():
        (folder / "work" / name).write_text(text, encoding="utf-8")
    for name in NAMES:
        (folder / "work" / name).write_text("before", encoding="utf-8")
    return folder


def started(folder, command):
    """Start a command in a session of its own; it has begun when this returns."""
    environment = {**os.environ, "KINTRAFO_CACHE": str(folder / "cache")}
    with (folder / "said").open("w") as message:
        process = subprocess.Popen(
            [sys.executable, "-c", _BEGIN, *command],
            cwd=folder / "work",
            env=environment,
            stdout=subprocess.PIPE,
            stderr=message,
            text=True,
            start_new_session=True,
        )
    assert process.stdout
    assert process.stdout.readline() == "begun\n"
    return process


def interrupted(folder, command, after, *, whole_group):
    """Return the exit code, what was said as an error, and how long it took after the signal."""
    process = started(folder, command)
    drained = threading.Thread(target=process.stdout.read)  # a pipe that is full would stop it
    drained.start()
    with suppress(subprocess.TimeoutExpired):
        process.wait(after)
    begun = time.monotonic()
    running = process.poll() is None
    with suppress(ProcessLookupError):
        (os.killpg if whole_group else os.kill)(process.pid, signal.SIGINT)
    code = None
    with suppress(subprocess.TimeoutExpired):
        code = process.wait(4.0 * _SOON)
    took = time.monotonic() - begun if running else 0.0
    alone = not _session(process.pid)
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    drained.join()
    return code if alone else None, (folder / "said").read_text(), took


def _session(leader):
    """Return what runs in a session, a moment after it should have ended."""
    for _ in range(20):
        found = [
            path.name
            for path in Path("/proc").glob("[0-9]*")
            if int(path.name) != leader and _leader_of(path) == leader
        ]
        if not found:
            break
        time.sleep(0.05)
    return found


def _leader_of(process):
    try:
        fields = (process / "stat").read_text().rpartition(")")[2].split()
    except OSError:
        return -1
    return -1 if fields[0] == "Z" else int(fields[3])


@cache
def whole(command):
    """Return what a command leaves that nobody interrupts."""
    with tempfile.TemporaryDirectory() as name:
        folder = _filled(Path(name))
        process = started(folder, command)
        process.communicate()
        return contents(folder / "work")


def contents(folder):
    """Return all files by their names."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file()
    }
