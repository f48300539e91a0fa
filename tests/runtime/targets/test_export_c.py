"""The folder of C: what its example prints is what Python computes, digit by digit."""

import subprocess

import kintrafo
import numpy as np
import pytest
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.targets.c_folder import STEP, STEPS
from support.exported import CC, compiled, system_named

needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
NAMES = ("four_bar", "slider_crank", "prescribed", "pendulum", "moved", "reference_car")


def printed(program):
    """Return what an example prints: by kind, name to number."""
    lines = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    found = {}
    for line in lines.splitlines():
        kind, name, value = line.split()
        found.setdefault(kind, {})[name] = float(value)
    return found


def stepped(system, state, inputs):
    """Return the state after the steps of the example, by the same sums in the same order."""

    def rates(y):
        return system.evaluate("rhs", y, inputs)

    for _ in range(STEPS):
        a = rates(state)
        b = rates(state + 0.5 * STEP * a)
        c = rates(state + 0.5 * STEP * b)
        d = rates(state + 1.0 * STEP * c)
        state = state + STEP / 6.0 * (((0.0 + a) + 2.0 * b) + 2.0 * c + d)
    return state


@needs_compiler
@pytest.mark.parametrize("name", NAMES)
def test_the_example_prints_what_python_computes(name, tmp_path):
    system = system_named(name)
    start = kintrafo.equilibrium(system) if name == "reference_car" else system.design_state
    folder = kintrafo.export_model(system, tmp_path / "c", "c", state=start)
    found = printed(compiled(folder))
    inputs = start.inputs if name == "reference_car" else system.inputs()
    wanted = {}
    if system.state_names:
        rates = system.evaluate("rhs", start, inputs)
        wanted["rate"] = dict(zip(system.state_names, rates, strict=True))
        ends = stepped(system, np.asarray(start), inputs)
        wanted["state"] = dict(zip(system.state_names, ends, strict=True))
    if system.signal_names:
        wanted["signal"] = {k: float(v) for k, v in system.signals(start, inputs).items()}
    assert found == wanted


@needs_compiler
@pytest.mark.parametrize("name", ["moved", "prescribed", "pendulum", "four_bar"])
def test_sources_for_jax_compile_silently(name, tmp_path):
    """Also where there is nothing that they could evaluate."""
    header = pytest.importorskip("jax").ffi.include_dir()
    folder = kintrafo.export_model(system_named(name), tmp_path / "c", "c")
    for end in ("ffi", "lanes"):
        source, target = str(folder / f"{name}_{end}.c"), str(tmp_path / "a.o")
        subprocess.run([*CC, "-isystem", header, "-c", source, "-o", target], check=True)


@needs_compiler
def test_another_parameter_set_has_its_own_constants(tmp_path):
    system = kintrafo.System(system_named("four_bar").equations, {"crank_mass": 2.0})
    inputs = {"crank_torque": 3.0}
    folder = kintrafo.export_model(system, tmp_path / "c", "c", inputs=inputs)
    rates = system.evaluate("rhs", system.design_state, system.inputs(inputs))
    assert [*printed(compiled(folder))["rate"].values()] == rates.tolist()


@needs_compiler
def test_nothing_is_allocated(tmp_path):
    """The objects of the equations take nothing but elementary functions from elsewhere."""
    folder = kintrafo.export_model(system_named("reference_car"), tmp_path / "c", "c")
    for name in ("example", "ffi"):
        (folder / f"macpherson_{name}.c").unlink()
    objects = tmp_path / "all.o"
    sources = sorted(map(str, folder.glob("*.c")))
    subprocess.run(
        ["cc", "-std=c99", "-O0", "-r", "-nostdlib", *sources, "-o", str(objects)], check=True
    )
    listed = subprocess.run(["nm", "-u", objects], check=True, capture_output=True, text=True)
    undefined = {line.split()[-1].partition("@")[0] for line in listed.stdout.splitlines()}
    memory = {"memcpy", "memset"}
    elementary = {"sqrt", "fabs", "sin", "cos", "asin", "atan", "atan2", "copysign"}
    hardened = {"__stack_chk_fail", "_GLOBAL_OFFSET_TABLE_"}  # by some compilers
    assert undefined <= elementary | memory | hardened


def test_the_readme_has_the_costs_of_the_header(tmp_path):
    folder = kintrafo.export_model(system_named("four_bar"), tmp_path / "c", "c")
    readme = (folder / "README.txt").read_text(encoding="utf-8")
    for name in ("rhs", "signals", "linearisation"):
        counts = getattr(system_named("four_bar").equations, name).operations
        (line,) = [ln for ln in readme.splitlines() if ln.split()[:1] == [name]]
        assert f" {counts['total']} operations" in line
    assert "iterate," not in readme
    iterating = kintrafo.export_model(system_named("multi_link"), tmp_path / "m", "c")
    assert "These functions iterate" in (iterating / "README.txt").read_text(encoding="utf-8")


def test_equations_without_a_compiler_have_their_c_all_the_same(tmp_path):
    from kintrafo.generator.mechanisms.four_bar import FOUR_BAR

    system = kintrafo.System(kintrafo.compile(FOUR_BAR, backend="numpy"))
    folder = kintrafo.export_model(system, tmp_path / "c", "c")
    assert "four_bar_rhs(" in (folder / "four_bar.c").read_text(encoding="utf-8")


# -- errors ---------------------------------------------------------------------------------------


def test_what_cannot_be_used_is_refused(tmp_path, refused):
    system = system_named("four_bar")
    refused(
        kintrafo.InputError,
        lambda: kintrafo.export_model(system, tmp_path / "c", "matlab"),
        lambda: kintrafo.export_model(system, tmp_path / "c", "c", fmi=2),
        lambda: kintrafo.export_model(system, tmp_path / "c", "c", inputs={"crank_torq": 1.0}),
        lambda: kintrafo.export_model(system, tmp_path / "c", "c", state=[1.0]),
        lambda: kintrafo.export_model("reference_car", tmp_path / "c", "c"),
    )
    assert not [*tmp_path.iterdir()]


def test_a_folder_with_other_files_is_left_alone(tmp_path, refused):
    system, folder = system_named("four_bar"), tmp_path / "own"
    folder.mkdir()
    (folder / "thesis.tex").write_text("a year of work")
    for force in (False, True):
        with refused(kintrafo.InputError):
            kintrafo.export_model(system, folder, "c", force=force)
    assert [file.name for file in folder.iterdir()] == ["thesis.tex"]
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, folder / "thesis.tex", "c"))


def test_nothing_is_half_written(tmp_path, refused):
    """No file appears if one must not be replaced; a later export replaces all of them."""
    system, folder = system_named("four_bar"), tmp_path / "c"
    folder.mkdir()
    (folder / "four_bar.h").write_text("by hand")
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, folder, "c"))
    assert [file.name for file in folder.iterdir()] == ["four_bar.h"]
    kintrafo.export_model(system, folder, "c", force=True)
    assert len([*folder.iterdir()]) == 15
    kintrafo.export_model(system, folder, "c")


def test_damaged_equations_are_named(tmp_path, monkeypatch, refused):
    system = system_named("four_bar")
    monkeypatch.setitem(system.equations.equations.manifest, "sources", ["gone.c"])
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, tmp_path / "c", "c"))


def test_the_command(kintrafo, tmp_path, ends):
    code, out, _ = kintrafo("export", "reference_car", "--to", "c")
    assert (code, out.strip()) == (0, "reference_car_c")
    assert (tmp_path / "reference_car_c/macpherson_values.c").exists()
    code, out, _ = kintrafo("export", "four_bar", "--to", "c", "-o", "bar", "--json")
    assert code == 0
    assert '"equations": "four_bar"' in out
    ends(2, "export", "four_bar", "--to", "matlab")
    ends(2, "export", "four_bra", "--to", "c")
