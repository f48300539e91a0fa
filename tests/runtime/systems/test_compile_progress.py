"""Progress of deriving and compiling a mechanism, and the files after an interrupt."""

import io
import os
import signal
import sys
import threading
import time
from pathlib import Path

import kintrafo
import pytest
from kintrafo.generator import progress
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.systems.compile.build import _estimated
from kintrafo.systems.compile.compiler import FLAGS, Compiler, CompilerError, find_compiler

on_linux = pytest.mark.skipif(sys.platform != "linux", reason="looks into /proc")
needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")


@needs_compiler
def test_what_is_done_is_reported_with_how_much_there_is(tmp_path, capfd):
    reported = []
    kintrafo.compile(FOUR_BAR, folder=tmp_path, progress=reported.append)
    places = [
        next(i for i, text in enumerate(reported) if part in text)
        for part in (
            "finding the loops",
            "equations of motion of 3 bodies",
            "differentiating rhs with respect to the state: 1 of 2",
            "differentiating rhs with respect to the state: 2 of 2",
            "common subexpressions",
            "operations in 2 files",
            "1 of 2 files are done",
            "2 of 2 files are done",
        )
    ]
    assert places == sorted(places)
    assert not any("to go" in text or "about" in text for text in reported)  # over in a second
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("terminal", [True, False])
def test_it_is_shown_on_a_terminal_only(tmp_path, monkeypatch, terminal):
    shown = io.StringIO()
    shown.isatty = lambda: terminal
    monkeypatch.setattr(sys, "stderr", shown)
    monkeypatch.setenv("TERM", "xterm")
    kintrafo.compile(FOUR_BAR, folder=tmp_path, backend="numpy")
    assert ("compile four_bar" in shown.getvalue()) == terminal
    assert terminal or not shown.getvalue()


def test_of_what_takes_long_the_rest_is_estimated(monkeypatch):
    clock, reported = iter([0.0, 0.0, 4.0, 8.0]), []
    monkeypatch.setattr(progress.time, "monotonic", lambda: next(clock))
    assert list(progress.counted(reported.append, "solving", "abc")) == ["a", "b", "c"]
    assert reported == [
        "solving: 1 of 3",
        "solving: 2 of 3, 8 s to go",
        "solving: 3 of 3, 4 s to go",
    ]
    monkeypatch.setattr(os, "cpu_count", lambda: 2)
    assert _estimated([20_000, 30_000]) == ""
    assert _estimated([20_000, 160_000]) == ", about 20 s"
    assert _estimated([80_000, 80_000, 80_000]) == ", about 15 s"


def waiting_compiler(folder, monkeypatch):
    """Let CC be a program that starts another one, waits, and writes the numbers of both."""
    script, numbers = folder / "slow-cc", folder / "numbers"
    script.write_text(
        "#!/bin/sh\n"
        '[ "$1" = --version ] && echo slow && exit\n'
        f'sleep 60 &\necho $$ $! >> "{numbers}"\nmktemp > /dev/null\nwait\n'
    )
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    return numbers


def runs(number):
    try:
        os.kill(int(number), 0)
    except ProcessLookupError:
        return False
    # one that has ended stays listed until its new parent has looked
    return "State:\tZ" not in Path(f"/proc/{number}/status").read_text()


@on_linux
@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_ends_the_compilers_at_once_and_leaves_nothing(tmp_path, monkeypatch):
    numbers, cache = waiting_compiler(tmp_path, monkeypatch), tmp_path / "cache"

    def interrupt_when_it_waits():
        for _ in range(1000):
            if numbers.exists() and numbers.read_text().count("\n") == min(2, os.cpu_count()):
                break
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=interrupt_when_it_waits)
    thread.start()
    started = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        kintrafo.compile(FOUR_BAR, folder=cache, backend="c")
    assert time.monotonic() - started < 30.0  # half of what it would have waited
    thread.join()
    deadline = time.monotonic() + 5.0
    while any(map(runs, numbers.read_text().split())) and time.monotonic() < deadline:
        time.sleep(0.01)
    assert not any(map(runs, numbers.read_text().split()))
    assert list(cache.iterdir()) == []


@on_linux
def test_where_one_compiler_fails_the_others_are_not_waited_for(tmp_path, monkeypatch):
    numbers = waiting_compiler(tmp_path, monkeypatch)
    script = tmp_path / "slow-cc"
    script.write_text(
        script.read_text().replace("sleep 60 &", 'case "$*" in *deriv*) exit 3;; esac\nsleep 60 &')
    )
    with pytest.raises(CompilerError, match="exit code 3"):
        kintrafo.compile(FOUR_BAR, folder=tmp_path / "cache", backend="c")
    assert list((tmp_path / "cache").iterdir()) == []
    assert not numbers.exists() or not runs(numbers.read_text().split()[0])


@on_linux
@pytest.mark.parametrize(
    "end", ["kill -9 $$", "echo 'cc: fatal error: Killed signal terminated program cc1'; exit 1"]
)
def test_a_compiler_that_is_killed_is_not_blamed(end, tmp_path, monkeypatch):
    """Either the program that is called, or one that it calls, as by gcc."""
    waiting_compiler(tmp_path, monkeypatch)
    script = tmp_path / "slow-cc"
    script.write_text(script.read_text().replace("sleep 60 &", f"{end}\nsleep 60 &"))
    with pytest.raises(CompilerError, match="killed, as Linux does when memory runs out"):
        kintrafo.compile(FOUR_BAR, folder=tmp_path / "cache", backend="c")


@on_linux
@pytest.mark.parametrize(("own", "level"), [((), "-O1"), (("-O3",), "-O3")])
def test_long_derivatives_are_optimised_less_unless_the_user_says_how_much(own, level, tmp_path):
    log, script = tmp_path / "log", tmp_path / "cc"
    script.write_text(f'#!/bin/sh\necho "$@" >> {log}\n')
    script.chmod(0o700)
    sources = [tmp_path / name for name in ("a.c", "a_derivatives.c", "b_derivatives.c")]
    for source, size in zip(sources, (3_000_000, 3_000_000, 1_000), strict=True):
        source.write_bytes(b"\n" * size)
    Compiler((str(script), *FLAGS, *own), "").build(sources, tmp_path / "library")
    lines = [line.split() for line in log.read_text().splitlines() if "-c" in line.split()]
    levels = {
        Path(line[line.index("-c") + 1]).name: [word for word in line if word.startswith("-O")][-1]
        for line in lines
    }
    usual = own[0] if own else "-O2"
    assert levels == {"a.c": usual, "a_derivatives.c": level, "b_derivatives.c": usual}
