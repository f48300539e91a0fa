"""The built extension modules depend on no more than they must."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from kintrafo.equations import _calls
from kintrafo.generated import _macpherson
from kintrafo.simulation import _steps
from kintrafo.simulation.solvers import native_available, native_version, sundials

OF_EVERY_SYSTEM = {"linux-vdso", "linux-gate", "ld-linux", "libc", "libm", "libpthread"}
ROOT = Path(__file__).parent.parent
ARCHIVES = [
    *ROOT.glob("build/sundials/lib/libsundials_cvode.a"),
    *Path("/usr/lib").glob("*-linux-gnu/libsundials_cvode.a"),
]

needs_ldd = pytest.mark.skipif(shutil.which("ldd") is None, reason="no ldd")


def needed(module):
    """Return the shared libraries that a module needs, without their versions."""
    shown = subprocess.run(["ldd", module.__file__], capture_output=True, text=True, check=True)
    names = re.findall(r"^\s*(?:/\S*/)?([\w.+-]+)[.]so", shown.stdout, re.MULTILINE)
    return {name.removesuffix("-x86-64").removesuffix("-aarch64") for name in names}


def test_without_a_compiler_it_is_said_what_to_install(tmp_path):
    places = [option for name in ("lib", "temp") for option in (f"--build-{name}", tmp_path / name)]
    done = subprocess.run(
        [sys.executable, "setup.py", "--quiet", "build_ext", *places],
        cwd=ROOT,
        env=os.environ | {"CC": "no-such-compiler"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "there is no compiler no-such-compiler" in done.stderr
    assert "apt-get install gcc" in done.stderr
    assert "Traceback" not in done.stderr


@needs_ldd
@pytest.mark.parametrize("module", [_macpherson, _calls, _steps])
def test_a_model_needs_nothing_but_the_c_library(module):
    assert needed(module) <= OF_EVERY_SYSTEM


@needs_ldd
@pytest.mark.skipif(not native_available(), reason="built without SUNDIALS")
@pytest.mark.skipif(
    not ARCHIVES or "SUNDIALS_ROOT" in os.environ or "CONDA_PREFIX" in os.environ,
    reason="not built with the static libraries of this folder or of the system",
)
def test_sundials_is_linked_statically():
    found = needed(sundials)
    assert not [name for name in found if "sundials" in name]
    if int(native_version().split(".")[0]) < 7:  # Debian's 7.x has MPI in its core
        assert found <= OF_EVERY_SYSTEM
