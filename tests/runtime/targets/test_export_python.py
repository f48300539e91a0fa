"""Modules for CasADi and JAX: values of the compiled C, derivatives of the emitted Jacobians.

Both libraries differentiate the right-hand side themselves, by the chain rule over its operations;
the Jacobians that are compared with were derived by the generator and are C.
"""

import importlib.util
import re
import subprocess
from functools import cache

import kintrafo
import numpy as np
import pytest
from kintrafo.generator.backends.arrays import differentiable
from kintrafo.generator.backends.casadi.dialect import CASADI
from kintrafo.generator.backends.jax.dialect import JAX
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.simulation.lanes.options import OF_WIDTH
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.targets import python_module
from mechanisms.free_bodies import thrown
from support.exported import CC, compiled, prescribed, system_named
from support.folders import ROOT

CLOSED, OPEN = "four_bar", {"crank_pin_y": 0.3}  # a crank that reaches beyond the dead point
AT_THE_DEAD_POINT = {"crank_angle": 1.5}
# An elementary function of a library is off by a few units in the last place; a closed form near
# a dead point, and an inverse mass matrix, make hundreds of them.
CLOSE = 1e-12


@cache
def system_of(name):
    """Return a mechanism; of one that is declared here, its program over NumPy arrays."""
    if name == "thrown":  # a body that moves freely, with a quaternion
        return kintrafo.System(kintrafo.compile(thrown(), backend="numpy"))
    if name == "prescribed":  # no states: some results are empty
        return kintrafo.System(kintrafo.compile(prescribed(), backend="numpy"))
    return system_named(name)


def loaded(path):
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def module_of(tmp_path_factory):
    """Return the module of a mechanism for a library, each written once."""
    folder = tmp_path_factory.mktemp("modules")

    @cache
    def exported(name, library):
        pytest.importorskip(library)
        path = folder / f"{name}_{library}.py"
        return loaded(kintrafo.export_model(system_of(name), path, library))

    return exported


def places(system, count=3):
    """Return states and inputs around the design position, a wheel off its road among them."""
    random = np.random.default_rng(5)
    for size in (0.0, *[0.05] * (count - 1)):
        states, inputs = len(system.state_names), len(system.input_names)
        state = system.design_state + size * random.standard_normal(states)
        yield state, size * random.standard_normal(inputs)


def assert_close(found, wanted):
    wanted = np.asarray(wanted)
    size = np.max(np.abs(wanted), initial=1e-3)
    np.testing.assert_allclose(np.reshape(found, wanted.shape), wanted, rtol=0, atol=CLOSE * size)


# -- CasADi ---------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "name", ["four_bar", "slider_crank", "reference_car", "thrown", "prescribed"]
)
def test_casadi_has_the_values_and_derivatives_of_c(module_of, name):
    system, module = system_of(name), module_of(name, "casadi")
    constants = module.prepare(parameters=module.parameters())["constants"]
    assert_close(constants.full(), system.constants)
    assert_close(module.design_state(module.parameters()).full(), system.design_state)
    assert np.all(module.conditions(module.parameters()).full() == 1.0)
    for state, inputs in places(system):
        for function in module.LABELS:
            found = getattr(module, function)(state, inputs, constants)
            assert_close(found.full(), system.evaluate(function, state, inputs))
        for function in {"rhs", "signals"} & {*module.LABELS}:
            jacobian = getattr(module, function).jacobian()
            found = jacobian(state, inputs, constants, 0)
            for block, prefix in zip(found, ("", "_input"), strict=False):
                own = system.evaluate(f"{function}{prefix}_jacobian", state, inputs)
                assert_close(block.full(), own)


def test_casadi_takes_derivatives_by_parameters(module_of):
    """Beside it: differences of the compiled C, whose error is the square of their step."""
    system, module = system_of("four_bar"), module_of("four_bar", "casadi")
    casadi = module.casadi
    parameters = casadi.SX.sym("parameters", len(module.PARAMETERS))
    place = [*module.PARAMETERS].index("crank_pin_y")
    state, inputs = next(places(system))
    rates = module.rhs(state, inputs, module.prepare(parameters))
    slope = casadi.Function("slope", [parameters], [casadi.jacobian(rates, parameters)[:, place]])
    step = 1e-5
    ends = [
        kintrafo.System(system.equations, {"crank_pin_y": 0.1 + by}).evaluate("rhs", state, inputs)
        for by in (-step, step)
    ]
    found = slope(module.parameters()).full().ravel()
    np.testing.assert_allclose(found, (ends[1] - ends[0]) / (2 * step), rtol=1e-6, atol=1e-9)


def test_casadi_has_nan_where_a_loop_cannot_close(module_of):
    module = module_of(CLOSED, "casadi")
    system = kintrafo.System(system_of(CLOSED).equations, OPEN)
    state, inputs = system.state(**AT_THE_DEAD_POINT), system.inputs()
    constants = module.prepare(module.parameters(**OPEN))
    for function in {*module.LABELS} - {"margins"}:
        with pytest.raises(kintrafo.ClosureError):
            system.evaluate(function, state, inputs)
        found = getattr(module, function)(state, inputs, constants).full()
        assert np.isnan(found).all(), function  # also elements that are always zero
    jacobian = module.rhs.jacobian()(state, inputs, constants, 0)[0].full()
    assert np.isnan(jacobian).any(axis=1).all()
    margins = module.margins(state, inputs, constants).full().ravel()
    assert np.array([*module.MARGINS])[margins < 0.0].tolist() == ["rocker_closure"]
    assert "cannot close" in module.MARGINS["rocker_closure"]
    assert np.isfinite(module.rhs(system.design_state, inputs, constants).full()).all()


def test_casadi_names_conditions_of_parameters(module_of):
    """With a rod of zero length the constants are NaN, and so are all results of them."""
    module = module_of(CLOSED, "casadi")
    flat = module.parameters(rocker_pin_x=0.3, rocker_pin_y=0.0)  # on the bearing of the rocker
    fulfilled = module.conditions(flat).full().ravel()
    assert len(fulfilled) == len(module.CONDITIONS)
    assert (fulfilled == 0.0).any()
    assert np.isnan(module.prepare(flat).full()).all()


def test_casadi_lets_nothing_be_forgotten(module_of, refused):
    module = module_of(CLOSED, "casadi")
    constants = module.prepare(module.parameters())
    whole = module.rhs(state=module.state(), constants=constants)["rhs"].full()
    assert_close(whole, system_of(CLOSED).evaluate("rhs", module.state().full().ravel(), [0.0]))
    assert np.isnan(module.rhs(state=module.state())["rhs"].full()).all()
    assert np.isnan(module.prepare()["constants"].full()).any()
    refused(ValueError, lambda: module.parameters(crank_mas=1.0))


def test_casadi_has_the_start_that_was_exported(tmp_path):
    pytest.importorskip("casadi")
    system = kintrafo.System(system_of(CLOSED).equations, {"crank_mass": 2.0})
    module = loaded(
        kintrafo.export_model(
            system, tmp_path / "bar.py", "casadi", state=[0.3, 0.1], inputs={"crank_torque": 3.0}
        )
    )
    assert system.parameters == module.PARAMETERS
    constants = module.prepare(module.parameters())
    wanted = system.evaluate("rhs", [0.3, 0.1], [3.0])
    assert_close(module.rhs(module.state(), module.inputs(), constants).full(), wanted)


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
def test_casadi_calls_the_compiled_c(tmp_path):
    """Every block of its derivatives has the bits of the exact Jacobians."""
    casadi = pytest.importorskip("casadi")
    system = kintrafo.System(system_named(CLOSED).equations, OPEN)
    folder = kintrafo.export_model(system, tmp_path / "c", "c")
    library = compiled(folder, "-shared", "-fPIC")
    state, inputs = system.state(crank_angle=0.2, crank_angle_rate=3.0), np.array([2.0])
    for name in ("rhs", "signals"):
        function = casadi.external(f"four_bar_casadi_{name}", str(library))
        assert function.name_in() == ["state", "inputs"]
        wanted = system.evaluate(name, state, inputs)
        assert function(state, inputs).full().ravel().tolist() == wanted.tolist()
        found = function.jacobian()(state, inputs, 0)
        for block, own in zip(found, (f"{name}_jacobian", f"{name}_input_jacobian"), strict=True):
            assert block.is_dense()
            assert block.full().tolist() == system.evaluate(own, state, inputs).tolist()
        with pytest.raises(RuntimeError, match="valuation"):
            function(system.state(**AT_THE_DEAD_POINT), inputs)
        with pytest.raises(RuntimeError, match="Derivatives cannot be calculated"):
            function.jacobian().jacobian()


def test_the_example_does_better_than_a_passive_strut(monkeypatch, capsys):
    """The result is compared with a simulation by another method, with other steps."""
    pytest.importorskip("casadi")
    example = loaded(ROOT / "examples/active_suspension.py")
    monkeypatch.setattr(example, "STEPS", 20)
    example.main()
    pattern = r"at most +(\d+) N: sum ([\d.]+), (\S+) apart from a simulation"
    passive, active = (map(float, found) for found in re.findall(pattern, capsys.readouterr().out))
    (_, worse, first), (most, better, second) = passive, active
    assert most == example.FORCE
    assert better < 0.8 * worse
    assert max(first, second) < 1e-3  # of the fixed steps, rad/s


# -- JAX ------------------------------------------------------------------------------------------


@pytest.fixture
def jax():
    found = pytest.importorskip("jax")
    # the second because compiling takes most of the time
    options = "jax_enable_x64", "jax_disable_most_optimizations"
    for name in options:
        found.config.update(name, True)
    yield found
    for name in options:
        found.config.update(name, False)


def library_for_jax(jax, folder, library, *flags):
    """Return the compiled functions of a folder of C, with lanes on request."""
    ends = ["", "_derivatives", "_values", "_ffi", *(["_lanes"] if flags else [])]
    files = [str(folder / f"four_bar{end}.c") for end in ends]
    headers = ["-isystem", jax.ffi.include_dir()]
    made = [*CC, *flags, "-shared", "-fPIC", *headers, *files, "-o", str(library), "-lm"]
    subprocess.run(made, check=True)
    return library


def test_jax_has_the_values_and_derivatives_of_c(jax, module_of):
    system, module = system_of(CLOSED), module_of(CLOSED, "jax")
    constants = jax.jit(module.prepare)(module.parameters())
    assert_close(constants, system.constants)
    states, inputs = map(np.array, zip(*places(system), strict=True))
    for function in {"rhs", "signals", "orientations"} & {*module.LABELS}:
        found = jax.jit(getattr(module, function))(states, inputs, constants)
        assert_close(found, system.evaluate(function, states, inputs))
    for by, own in ((0, "rhs_jacobian"), (1, "rhs_input_jacobian")):
        slopes = jax.jit(jax.vmap(jax.jacfwd(module.rhs, by), (0, 0, None)))
        assert_close(slopes(states, inputs, constants), system.evaluate(own, states, inputs))

    def first(state):
        return module.rhs(state, inputs[1], constants)[-1]

    own = system.evaluate("rhs_jacobian", states[1], inputs[1])[-1]
    assert_close(jax.jit(jax.grad(first))(states[1]), own)


def test_jax_has_nan_where_a_loop_cannot_close(jax, module_of):
    module = module_of(CLOSED, "jax")
    constants = jax.jit(module.prepare)(module.parameters(**OPEN))
    states = np.stack([module.state(), module.state(**AT_THE_DEAD_POINT)])
    rates = jax.jit(module.rhs)(states, module.inputs(), constants)
    assert np.isnan(rates).tolist() == [[False, False], [True, True]]
    slopes = jax.jit(jax.vmap(jax.jacrev(module.rhs), (0, None, None)))(
        states, module.inputs(), constants
    )
    assert np.isfinite(slopes[0]).all()
    assert np.isnan(slopes[1]).any(axis=-1).all()
    margins = jax.jit(module.margins)(states, module.inputs(), constants)
    assert margins[1, [*module.MARGINS].index("rocker_closure")] < 0.0


@pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
def test_jax_calls_the_compiled_c(jax, tmp_path, refused):
    """Values and derivatives, forward and backward, have the bits of the C."""
    system = kintrafo.System(system_named(CLOSED).equations, OPEN)
    folder = kintrafo.export_model(system, tmp_path / "c", "c")
    library = library_for_jax(jax, folder, tmp_path / "four_bar.so")
    module = loaded(folder / "four_bar_ffi.py")
    assert system.input_names == module.INPUT_NAMES
    refused(RuntimeError, lambda: module.rhs(module.STATE, module.INPUTS))
    module.load(library)
    refused(RuntimeError, lambda: module.load(library))
    states = np.array([[0.2, 3.0], [0.3, -1.0]])
    inputs = np.array([2.0])
    for name in ("rhs", "signals"):
        function = getattr(module, name)
        assert np.array_equal(
            jax.jit(function)(states, inputs), system.evaluate(name, states, inputs)
        )
        assert np.array_equal(
            jax.vmap(function, (0, None))(states, inputs), system.evaluate(name, states, inputs)
        )
        for by, own in ((0, f"{name}_jacobian"), (1, f"{name}_input_jacobian")):
            for way in (jax.jacfwd, jax.jacrev):
                slopes = way(function, by)(states[0], inputs)
                assert np.array_equal(slopes, system.evaluate(own, states[0], inputs)), own
    dead = np.stack([states[0], system.state(**AT_THE_DEAD_POINT)])
    assert np.isnan(module.rhs(dead, inputs)).tolist() == [[False, False], [True, True]]
    with pytest.raises(ValueError, match="cannot be differentiated"):
        jax.hessian(lambda state: module.rhs(state, inputs)[1])(states[0])
    refused(ValueError, lambda: module.rhs(states, np.zeros(2)))
    jax.config.update("jax_enable_x64", False)
    refused(TypeError, lambda: module.rhs(states, inputs))


@pytest.mark.skipif(
    not OF_WIDTH or find_compiler() is None, reason="no C compiler, or built without lanes"
)
@pytest.mark.parametrize("lanes", [[], ["-DFOUR_BAR_LANES"], ["-DFOUR_BAR_LANES", "-march=native"]])
def test_jax_takes_many_states_and_parameters_at_a_time(jax, tmp_path, lanes):
    """Lanes of any width and the remaining rows have the bits of the C, also under vmap."""
    system = system_named(CLOSED)
    # a name is registered once for all in jax.ffi: each library has names of its own
    folder = kintrafo.export_model(system, tmp_path / "c", "c")
    library = library_for_jax(jax, folder, tmp_path / "four_bar.so", *lanes)
    script = folder / "four_bar_ffi.py"
    targets = script.read_text().replace("target, jax", f'target + "{len(lanes)}", jax')
    calls = 'ffi_call(f"{NAME}_ffi_{name}'
    script.write_text(targets.replace(calls, calls + str(len(lanes))))
    module = loaded(script)
    module.load(library)
    random = np.random.default_rng(8)
    count = 2 * 8 + 3
    states = system.design_state + 0.05 * random.standard_normal((count, 2))
    inputs = random.standard_normal((count, 1))
    sets = np.tile(module.PARAMETERS, (count, 1))
    sets[:, module.PARAMETER_NAMES.index("crank_mass")] *= random.uniform(0.5, 2.0, count)
    sets[5, module.PARAMETER_NAMES.index("crank_mass")] = np.nan
    constants = jax.vmap(module.prepare)(sets)
    assert np.isnan(constants[5]).all()
    for name in ("rhs", "signals"):
        function = getattr(module, name)
        found = jax.jit(jax.vmap(function))(states, inputs, constants)
        assert np.isnan(found[5]).all()
        for row in {*range(count)} - {5}:
            other = kintrafo.System(
                system.equations, dict(zip(module.PARAMETER_NAMES, sets[row], strict=True))
            )
            wanted = other.evaluate(name, states[row], inputs[row])
            assert np.array_equal(constants[row], other.constants)
            assert np.array_equal(found[row], wanted), (name, row)
    # each state with each parameter set: nothing is repeated, and each row has its own
    cross = jax.vmap(jax.vmap(module.rhs, (0, 0, None)), (None, None, 0))(states, inputs, constants)
    other_way = module.rhs(states, inputs, constants[:, None])
    assert cross.shape == (count, count, 2)
    assert np.array_equal(cross, other_way, equal_nan=True)
    aligned = np.arange(count)
    assert np.array_equal(
        cross[aligned, aligned], module.rhs(states, inputs, constants), equal_nan=True
    )
    with pytest.raises(TypeError, match="constants and parameters"):
        jax.grad(lambda c: module.rhs(states[0], inputs[0], c)[1])(constants[0])
    with pytest.raises(ValueError, match="cannot be differentiated"):
        jax.grad(lambda p: module.prepare(p)[0])(sets[0])


def test_jax_refuses_single_precision_and_other_shapes(jax, module_of, refused):
    module = module_of(CLOSED, "jax")
    constants = system_named(CLOSED).constants
    refused(
        ValueError,
        lambda: module.rhs(np.zeros(1), module.inputs(), constants),
        lambda: module.inputs(torque=1.0),
    )
    jax.config.update("jax_enable_x64", False)
    refused(TypeError, lambda: module.rhs(np.zeros(2), np.zeros(1), constants))


# -- errors ---------------------------------------------------------------------------------------


def test_what_cannot_be_exported_is_refused(tmp_path, refused):
    def export(of="four_bar", name="bar_casadi.py", **options):
        kintrafo.export_model(system_named(of), tmp_path / name, "casadi", **options)

    refused(
        kintrafo.InputError,
        lambda: export("multi_link"),
        lambda: export(name="bar.txt"),
        lambda: export(name="casadi.py"),
        lambda: export(fmi=2),
    )
    assert not [*tmp_path.iterdir()]
    (tmp_path / "bar_casadi.py").write_text("by hand")
    refused(kintrafo.InputError, export)


def test_jax_warns_of_many_operations(tmp_path, monkeypatch):
    """The warning comes before the derivation, and not with CasADi."""
    monkeypatch.setattr(python_module, "MOST_OF_JAX", 100)
    monkeypatch.setattr(python_module, "_write", lambda library, *_, **__: library)
    count = system_named(CLOSED).equations.equations.manifest["functions"]["rhs"]["operations"]
    with pytest.warns(RuntimeWarning, match=f"{count['total']} .* 100 .* jax.ffi"):
        kintrafo.export_model(system_named(CLOSED), tmp_path / "a.py", "jax")
    kintrafo.export_model(system_named(CLOSED), tmp_path / "a.py", "casadi")


def test_equations_must_be_those_of_their_declaration(tmp_path, monkeypatch, refused):
    held = system_named("prescribed")  # compiled before, or elsewhere
    refused(kintrafo.InputError, lambda: kintrafo.export_model(held, tmp_path / "a.py", "jax"))
    system = kintrafo.System(kintrafo.compile(FOUR_BAR, backend="numpy"))
    monkeypatch.setattr(system.equations, "MECHANISM_HASH", "another")
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, tmp_path / "a.py", "jax"))
    assert not [*tmp_path.iterdir()]


def test_libraries_spell_the_same_functions():
    assert CASADI.functions.keys() == JAX.functions.keys() == NUMPY.functions.keys()


def test_derivatives_by_parameters_add_nothing(derived):
    """Equations that were compiled with them are exported without."""
    plain = derived("trailing_arm")
    added = generate(plain.formulation, parameter_derivatives=True)
    assert [f.name for f in differentiable(added)] == [f.name for f in differentiable(plain)]


def test_the_same_export_has_the_same_bytes(tmp_path):
    system = system_named("slider_crank")
    for name in ("first.py", "second.py"):
        kintrafo.export_model(system, tmp_path / name, "jax")
    first, second = (path.read_bytes() for path in sorted(tmp_path.iterdir()))
    assert first == second
