"""The built extension modules depend on no more than they must."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from kintrafo.equations import _calls
from kintrafo.generated import _macpherson
from kintrafo.simulation import _steps
from kintrafo.simulation.lanes import library
from kintrafo.simulation.solvers import native_available, native_version, sundials
from support.folders import ROOT

OF_EVERY_SYSTEM = {"linux-vdso", "linux-gate", "ld-linux", "libc", "libm", "libpthread"}
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


SET_UP = """#!/bin/sh
mkdir -p .venv/bin build/sundials/include
cat >.venv/bin/python <<'END'
#!/bin/sh
mkdir -p build/package/site
echo "$SUNDIALS_ROOT $*" >>called
END
chmod +x .venv/bin/python
"""


@pytest.mark.skipif(shutil.which("make") is None, reason="no make")
@pytest.mark.parametrize("named", ["", "/opt/other"])
def test_the_first_package_has_what_set_up_has_just_built(tmp_path, named):
    """As the first command in a fresh clone: SUNDIALS is there when the package is built."""
    shutil.copy(ROOT / "Makefile", tmp_path)
    for name in ("pyproject.toml", "setup.py"):
        (tmp_path / name).touch()
    (tmp_path / ".ci").mkdir()
    (tmp_path / ".ci/setup").write_text(SET_UP)
    (tmp_path / ".ci/setup").chmod(0o755)
    environment = {k: v for k, v in os.environ.items() if k not in ("SUNDIALS_ROOT", "MAKEFLAGS")}
    environment |= {"SUNDIALS_ROOT": named} if named else {}
    subprocess.run(["make", "package"], cwd=tmp_path, env=environment, check=True, timeout=60)
    (built,) = [
        line for line in (tmp_path / "called").read_text().splitlines() if "-m build" in line
    ]
    assert built.startswith(f"{named or tmp_path / 'build/sundials'} -m build ")


def complete(missing=""):
    """Run the check of wheels on this checkout, after statements that hide a part of it."""
    script = ROOT / ".ci/complete.py"
    code = f"import runpy, sys\nsys.path.insert(0, {str(script.parent)!r})\n{missing}\n"
    code += f"runpy.run_path({str(script)!r}, run_name='__main__')"
    command = [sys.executable, "-c", code, "--built"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


@pytest.mark.skipif(not (native_available() and library.widths()), reason="built without them")
def test_a_wheel_is_complete():
    done = complete()
    assert (done.returncode, done.stderr) == (0, "")
    assert "BDF" in done.stdout


@pytest.mark.skipif(not (native_available() and library.widths()), reason="built without them")
@pytest.mark.parametrize(
    ("missing", "message"),
    [
        ("from kintrafo.simulation import solvers; solvers.sundials = None", "no method in C"),
        ("from kintrafo.simulation.lanes import library; library.widths = tuple", "no lanes"),
        (
            "import sys; sys.modules['kintrafo.generated._four_bar_lanes'] = None",
            "four_bar is not there in lanes",
        ),
    ],
)
def test_a_wheel_without_something_is_not(missing, message):
    done = complete(missing)
    assert done.returncode == 1
    assert f"incomplete: {message}" in done.stderr
    assert "Traceback" not in done.stderr


def test_every_wheel_is_looked_at():
    """Those of `make wheel`, and those of a release."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    for commands in (
        project["tool"]["cibuildwheel"]["test-command"],
        (ROOT / ".ci/wheel").read_text(encoding="utf-8").splitlines(),
    ):
        assert [
            c
            for c in commands
            if re.search(r"(^|/)python (\{project\}/)?\.ci/complete\.py( \"\$@\")?$", c)
        ]


def test_a_wheel_of_windows_moves_every_model_by_scipy():
    """There are neither SUNDIALS nor lanes in it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    windows = project["tool"]["cibuildwheel"]["windows"]
    assert windows["before-all"] == ""
    assert windows["test-command"] == "python {project}/.ci/complete.py"
    done = complete("import sys, kintrafo.ensembles, kintrafo.generated; sys.platform = 'win32'")
    assert (done.returncode, done.stderr) == (0, "")
    assert "moved by SciPy" in done.stdout


def test_wheels_of_a_release_are_for_three_systems_by_actions_that_stay_as_they_are():
    text = (ROOT / ".github/workflows/release.yml").read_text(encoding="utf-8")
    (systems,) = re.findall(r"os: \[(.*)\]", text)
    assert {name.split("-")[0] for name in systems.split(", ")} == {"ubuntu", "macos", "windows"}
    used = re.findall(r"uses: (\S+)", text)
    assert used
    assert [action for action in used if not re.fullmatch(r"[\w/.-]+@[0-9a-f]{40}", action)] == []


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
