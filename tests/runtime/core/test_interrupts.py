"""Ctrl-C ends what runs, wherever it comes; what must be done as a whole is done before."""

import os
import pkgutil
import signal
import subprocess
import sys
import threading
import time

import pytest
from kintrafo.core import interrupts
from kintrafo.core.files import replacing
from kintrafo.core.threads import shared_out

pytestmark = pytest.mark.skipif(os.name == "nt", reason="signals are sent to processes")

LOST = {
    "a weak reference": """
class A: pass
def interrupt(_): signal.raise_signal(signal.SIGINT)
one = A()
reference = weakref.ref(one, interrupt)
del one
""",
    "a finaliser": """
class A:
    def __del__(self): signal.raise_signal(signal.SIGINT)
A()
""",
    "a callback from C": """
order = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
def compare(*_):
    signal.raise_signal(signal.SIGINT)
    return 0
ctypes.CDLL(None).qsort((ctypes.c_int * 2)(1, 2), 2, 4, order(compare))
""",
    "a clause that takes all": """
try:
    signal.raise_signal(signal.SIGINT)
except BaseException:
    pass
""",
    "another error": """
try:
    signal.raise_signal(signal.SIGINT)
except BaseException:
    raise RuntimeError
""",
    "one after another": """
class A:
    def __del__(self): signal.raise_signal(signal.SIGINT)
A(); A(); A()
""",
    "the end": """
import atexit
atexit.register(signal.raise_signal, signal.SIGINT)
signal.raise_signal(signal.SIGINT)
""",
}
BEGIN = "import ctypes, signal, time, weakref\n"
END = "\nfor _ in range(3000): time.sleep(0.01)\n"


@pytest.mark.parametrize("where", LOST)
def test_none_is_lost(tmp_path, where):
    """In what the command line imports first, as anywhere else: nothing is printed, and 130."""
    (tmp_path / "typer.py").write_text(BEGIN + LOST[where] + END, encoding="utf-8")
    begun = time.monotonic()
    done = subprocess.run(
        [sys.executable, "-m", "kintrafo", "--help"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, b"", b"")
    assert time.monotonic() - begun < 20.0  # of the 30 s that it would go on


def test_a_library_that_warns_of_an_interrupt_is_interrupted(tmp_path):
    """As Matplotlib, whose import goes on without 3D axes after errors in theirs."""
    warning = """
try:
    signal.raise_signal(signal.SIGINT)
except BaseException:
    __import__("warnings").warn("Unable to import Axes3D")
"""
    (tmp_path / "matplotlib.py").write_text(f"{BEGIN}{warning}{END}", encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-m", "kintrafo", "characteristics", "reference_car", "--plot", "a.png"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        cwd=tmp_path,
        capture_output=True,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert (done.returncode, done.stderr) == (130, b"")


def test_after_the_end_a_command_is_not_interrupted():
    """Ctrl-C at the end of the interpreter does not interrupt the command, which is complete."""
    late = "import atexit, signal; atexit.register(signal.raise_signal, signal.SIGINT)"
    late += "; from kintrafo.__main__ import run; run()"
    done = subprocess.run(
        [sys.executable, "-c", late, "--version"],
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("kintrafo ")


def test_what_was_asked_to_ignore_interrupts_ignores_them(tmp_path):
    (tmp_path / "typer.py").write_text(f"{BEGIN}signal.raise_signal(2)\nraise SystemExit(7)")
    done = subprocess.run(
        [sys.executable, "-m", "kintrafo", "--help"],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        check=False,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_IGN),
    )
    assert (done.returncode, done.stderr) == (7, b"")


@pytest.mark.usefixtures("interruptible")
def test_what_is_held_is_done_first():
    done = []

    def twice():
        with interrupts.held():
            signal.raise_signal(signal.SIGINT)
            signal.raise_signal(signal.SIGINT)
            done.append("first")

    with pytest.raises(KeyboardInterrupt):
        twice()
    assert done == ["first"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    with pytest.raises(ValueError, match="own"), interrupts.held():
        raise ValueError("own")
    thread = threading.Thread(target=lambda: interrupts.held().__enter__())  # sees no signals
    thread.start()
    thread.join()
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.usefixtures("interruptible")
@pytest.mark.parametrize(
    "step", ["tempfile.mkdtemp", "written.note", "Path.replace", "shutil.rmtree", ""]
)
def test_files_are_whole_and_nothing_is_left(tmp_path, monkeypatch, step):
    """Interrupted in any step of writing: what is there is as it was, or as it should be."""
    path, early = tmp_path / "a.csv", step in ("tempfile.mkdtemp", "")
    home, _, name = f"kintrafo.core.files.{step}".rpartition(".")
    real = getattr(pkgutil.resolve_name(home), name) if step else None

    def interrupted(*given, **options):
        signal.raise_signal(signal.SIGINT)
        return real(*given, **options)

    def write():
        with replacing(path) as temporary:
            temporary.write_text("all")
            if not step:
                signal.raise_signal(signal.SIGINT)

    with monkeypatch.context() as patched:
        if step:
            patched.setattr(f"{home}.{name}", interrupted)
        with pytest.raises(KeyboardInterrupt):
            write()
    assert [entry.name for entry in tmp_path.iterdir()] == ([] if early else ["a.csv"])
    assert early or path.read_text() == "all"


def test_nothing_is_written_after_an_interrupt(tmp_path, monkeypatch):
    """Other code has caught the interrupt."""
    monkeypatch.setattr(interrupts._heard, "any", True)
    with pytest.raises(KeyboardInterrupt), replacing(tmp_path / "a.csv") as temporary:
        temporary.write_text("all")
    assert not [*tmp_path.iterdir()]


def test_threads_learn_that_no_call_waits():
    """The results of some parts come; one that takes long ends as soon as another is wrong."""
    taken = []

    def do(part, unwanted):
        if part == 1:
            raise ValueError("wrong")
        for _ in range(int(2000 * (part == 2))):
            if unwanted():
                raise InterruptedError
            time.sleep(0.01)
        return part

    begun = time.monotonic()
    with pytest.raises(ValueError, match="wrong"):
        shared_out(do, [0, 1, 2, *range(3, 400)], taken.append, 2)
    assert time.monotonic() - begun < 10.0  # of 20 s
    assert len(taken) < 400
