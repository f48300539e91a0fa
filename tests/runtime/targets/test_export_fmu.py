"""Functional mock-up units: importers read and compute the values of this package."""

import ctypes
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import kintrafo
import numpy as np
import pytest
from kintrafo.core.folders import cache_folder
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.targets.emitted import Emitted
from kintrafo.targets.fmi import binaries
from kintrafo.targets.fmi.sources import library_files
from kintrafo.targets.fmi.tables import any_tables
from kintrafo.targets.fmi.xml import powers
from mechanisms.scotch_yokes import WHEEL_ON_A_YOKE
from support.c_text import EMITTED
from support.exported import needs_library, system_named
from support.fmu_importer import DISCARD, ERROR, OK, Fmu
from support.folders import ROOT
from support.kept import UNOPTIMISED
from support.models import STRICT

pytestmark = needs_library
MINGW = "x86_64-w64-mingw32-gcc"
VERSIONS = (2, 3)
NAMES = ("four_bar", "reference_car")
KINDS = ("ModelExchange", "CoSimulation")
SHORT = {"rocker_pin_x": 0.05, "rocker_pin_y": 0.2}
"""Parameters of a coupler that is too short for a whole turn of the crank [m]."""


@pytest.fixture(scope="module")
def fmu(tmp_path_factory):
    """Export a system and unpack it, once for each version."""
    known = {}

    def of(name, version):
        if (name, version) not in known:
            folder = tmp_path_factory.mktemp("fmu")
            path = folder / f"{name}.fmu"
            kintrafo.export_model(system_named(name), path, "fmu", fmi=version, state=start(name))
            known[name, version] = Fmu(path, folder / "unpacked")
        return known[name, version]

    return of


def start(name):
    system = system_named(name)
    return kintrafo.equilibrium(system) if name.endswith("_car") else system.state()


def parameters(values):
    return {f"parameters.{name}": value for name, value in values.items()}


def truth(name, times, **options):
    """Return the states and signals of a motion, to 1e-12 or so."""
    given = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}
    span = (times[0], times[-1])
    return kintrafo.simulate(
        system_named(name), span, start(name), t_eval=times, **given, **options
    )


def variables(name):
    """Return names of states, derivatives, inputs and signals in the order of the arrays."""
    return variables_of(system_named(name))


def variables_of(system):
    rates = [f"der({n})" for n in system.state_names]
    return list(system.state_names), rates, list(system.input_names), list(system.signal_names)


# -- by another importer --------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", [*NAMES, "slider_crank", "prescribed", "moved"])
def test_fmpy_finds_nothing_wrong(tmp_path, name, version):
    validation = pytest.importorskip("fmpy.validation")
    path = tmp_path / "a.fmu"
    kintrafo.export_model(system_named(name), path, "fmu", fmi=version)
    assert validation.validate_fmu(str(path)) == []


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", ["pendulum", "prescribed"])
def test_a_model_without_guards_or_without_states_moves(tmp_path, name, version, kind):
    """Its description has empty tables; the pendulum has no signals and no inputs, either."""
    fmpy = pytest.importorskip("fmpy")
    system, path = system_named(name), tmp_path / "a.fmu"
    kintrafo.export_model(system, path, "fmu", fmi=version)
    names = [*system.state_names, *system.signal_names]
    found = fmpy.simulate_fmu(
        str(path), stop_time=0.2, output_interval=0.1, fmi_type=kind, relative_tolerance=1e-13,
        output=names,
    )  # fmt: skip
    wanted = kintrafo.simulate(
        system, (0.0, 0.2), system.design_state, t_eval=[0.2], method="DOP853", rtol=1e-13
    )
    for given, value in zip(names, [*wanted.y, *wanted.signals.values()], strict=True):
        # the accumulated error of both integrations: 1e-13 a step, hundreds of steps
        assert found[given][-1] == pytest.approx(value[-1], abs=1e-9)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("version", VERSIONS)
def test_a_car_over_a_step_of_the_road_moves_as_by_simulate(fmu, version, kind):
    """FMPy accepts its description, and integrates it by CVode or calls its own steps."""
    fmpy = pytest.importorskip("fmpy")
    validation = pytest.importorskip("fmpy.validation")
    folder = str(fmu("quarter_car", version).folder)
    assert validation.validate_fmu(folder) == []
    times, road = np.linspace(0.0, 0.2, 11), {"road_height": 0.02}
    motion = truth("quarter_car", times, inputs=road)
    states = zip(system_named("quarter_car").state_names, motion.y, strict=True)
    wanted = dict(states) | {"tyre_force": motion.signals["tyre_force"]}
    found = fmpy.simulate_fmu(
        folder, stop_time=0.2, output_interval=0.02, fmi_type=kind, relative_tolerance=1e-12,
        start_values=road, output=[*wanted],
    )  # fmt: skip
    for name, values in wanted.items():
        # the accumulated error of hundreds of steps, 1e-12 each
        scale = max(1.0, np.abs(values).max())
        np.testing.assert_allclose(found[name], values, rtol=0.0, atol=1e-9 * scale)


@pytest.mark.parametrize("version", VERSIONS)
def test_nothing_breaks_the_rules_that_the_schema_has_not(fmu, version):
    """Rules of causality, variability, starts and references, by another tool."""
    operations = pytest.importorskip("fmu_manipulation_toolbox.operations")
    checker = pytest.importorskip("fmu_manipulation_toolbox.checker")
    for name in (*NAMES, "quarter_car"):
        read = operations.FMU(str(fmu(name, version).folder.with_name(f"{name}.fmu")))
        schema, rules = checker.OperationGenericCheck(), checker.OperationSemanticCheck()
        for check in (schema, rules):
            read.apply_operation(check)
        assert schema.compliant_with_version == f"{version}.0"
        assert rules.errors == []


@pytest.mark.parametrize("version", VERSIONS)
def test_fmpy_builds_the_sources(tmp_path, version):
    build = pytest.importorskip("fmpy.build")
    if shutil.which("cmake") is None:
        pytest.skip("no cmake")
    path = tmp_path / "bar.fmu"
    kintrafo.export_model(system_named("four_bar"), path, "fmu", fmi=version, platforms=())
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path / "bar")
    assert not (tmp_path / "bar/binaries").exists()
    (tmp_path / "build").mkdir()
    build.build_platform_binary(tmp_path / "bar", tmp_path / "build", configuration="Debug")
    found = Fmu(path, tmp_path / "bar").instance()
    assert found.initialise() == OK
    assert found.step(0.0, 0.1) == OK
    wanted = truth("four_bar", np.array([0.0, 0.1])).y[0, -1]
    assert found.get("crank_angle")[0] == pytest.approx(wanted, abs=1e-5)  # of the usual tolerance


@pytest.mark.parametrize("version", VERSIONS)
def test_the_sources_compile_silently(fmu, version, tmp_path):
    sources = sorted(map(str, fmu("four_bar", version).folder.glob("sources/**/*.c")))
    flags = ["-std=c11", *UNOPTIMISED, *STRICT, "-fsyntax-only"]
    subprocess.run(["cc", *flags, *sources], check=True, cwd=tmp_path)


# -- values ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", NAMES)
def test_values_are_the_same_bits(fmu, name, version):
    """Derivatives and outputs at the start are those of the equations."""
    system, at = system_named(name), start(name)
    inputs = getattr(at, "inputs", system.inputs())
    instance = fmu(name, version).instance("ModelExchange")
    assert instance.initialise() == OK
    states, rates, given, signals = variables(name)
    assert instance.get(*states) == at.tolist()
    assert instance.get(*given) == inputs.tolist()
    np.testing.assert_array_equal(instance.get(*rates), system.evaluate("rhs", at, inputs))
    np.testing.assert_array_equal(instance.get(*signals), system.evaluate("signals", at, inputs))
    parameters = instance.get(*(f"parameters.{n}" for n in system.parameters))
    assert parameters == [*system.parameters.values()]
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_the_description_reports_units_starts_and_meanings(fmu, version):
    known = fmu("reference_car", version)
    system = system_named("reference_car")
    for name, entry in system.equations.PARAMETERS.items():
        variable = f"parameters.{name}"
        assert float(known.attribute(variable, "start")) == system.parameters[name]
        assert known.attribute(variable, "description") == entry["meaning"]
        assert known.attribute(variable, "unit") == (
            None if entry["unit"] == "1" else entry["unit"]
        )
    assert known.attribute("tyre_force", "causality") == "output"
    assert known.attribute("road_height", "displayUnit") == "mm"
    reference = known.references["rack_position"] + (version == 2)
    assert known.attribute("rack_velocity", "derivative") == str(reference)
    units = {u.attrib["name"]: u for u in known.root.find("UnitDefinitions")}
    assert units["N s/m"].find("BaseUnit").attrib == {"kg": "1", "s": "-1"}
    assert float(units["m"].find("DisplayUnit").attrib["factor"]) == 1000.0


@pytest.mark.parametrize(
    ("unit_text", "wanted"),
    [
        ("N m/rad", {"kg": 1, "m": 2, "s": -2, "rad": -1}),
        ("kg m^2", {"kg": 1, "m": 2}),
        ("N/m^3", {"kg": 1, "m": -2, "s": -2}),
        ("1", {}),
        ("kg m^2 or kg", None),
    ],
)
def test_units_are_powers_of_base_units(unit_text, wanted):
    assert powers(unit_text) == wanted


# -- derivatives ----------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_those_of_the_linearisation(fmu, name, version):
    system, at = system_named(name), start(name)
    linear = kintrafo.linearise(system, at, getattr(at, "inputs", None))
    instance = fmu(name, version).instance("ModelExchange")
    assert instance.initialise() == OK
    states, rates, given, signals = variables(name)
    unknowns, knowns = [*rates, *signals], [*states, *given]
    wanted = np.block([[linear.A, linear.B], [linear.C, linear.D]])
    found = np.array([instance.derivative(unknowns, knowns, row) for row in np.eye(len(knowns))]).T
    np.testing.assert_array_equal(found, wanted)
    seed = np.random.default_rng(5).normal(size=len(unknowns))
    if version == 3:
        adjoint = instance.derivative(unknowns, knowns, seed, adjoint=True)
        # sums of so many products in another order
        np.testing.assert_allclose(adjoint, seed @ wanted, rtol=1e-12, atol=1e-9)
    assert instance.derivative(unknowns, ["time"], [1.0]) == [0.0] * len(unknowns)
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_derivatives_of_other_variables_are_refused(fmu, version, as_stored):
    instance = fmu("four_bar", version).instance("ModelExchange")
    instance.initialise()
    instance.derivative(["parameters.crank_mass"], ["crank_angle"], [1.0])
    assert instance.status == ERROR
    as_stored(instance.message)
    instance.derivative(["spring_force"], ["parameters.crank_mass"], [1.0])
    assert instance.status == ERROR
    as_stored(instance.message)
    instance.derivative(["spring_force"], ["solver.step"], [1.0])
    assert instance.status == ERROR
    as_stored(instance.message)


@pytest.mark.parametrize("version", VERSIONS)
def test_derivatives_by_parameters(tmp_path, version):
    module = kintrafo.compile(FOUR_BAR, parameter_derivatives=True)
    system = kintrafo.System(module)
    path, start_values = tmp_path / "a.fmu", {"crank_angle": 0.3, "crank_angle_rate": 1.5}
    kintrafo.export_model(system, path, "fmu", fmi=version)
    known = Fmu(path, tmp_path / "unpacked")
    names = [*system.parameters]
    knowns = ["crank_angle", *(f"parameters.{name}" for name in names)]
    _, rates, _, signals = variables("four_bar")
    unknowns = [*rates, *signals]
    instance = known.instance("ModelExchange")
    assert instance.initialise(**start_values) == OK
    at = system.state(**start_values)
    found = []
    for name, reference in zip(["crank_angle", *names], knowns, strict=True):
        found.append(instance.derivative(unknowns, [reference], [1.0]))
        by = [kintrafo.derivative(system, f, {name: 1.0}, at) for f in ("rhs", "signals")]
        np.testing.assert_allclose(found[-1], np.concatenate(by), rtol=1e-12, atol=1e-12)
    found = np.array(found)
    seed = np.random.default_rng(3).normal(size=len(knowns))
    # sums of so many products in another order
    along = instance.derivative(unknowns, knowns, seed)
    np.testing.assert_allclose(along, seed @ found, rtol=1e-9, atol=1e-9)
    if version == 3:
        weights = seed[: len(unknowns)]
        adjoint = instance.derivative(unknowns, knowns, weights, adjoint=True)
        np.testing.assert_allclose(adjoint, found @ weights, rtol=1e-9, atol=1e-9)
    instance.free()


def test_parameters_that_cannot_move_alone_are_refused(tmp_path, as_stored):
    """Also beside others, however little they move."""
    module = kintrafo.compile(WHEEL_ON_A_YOKE, parameter_derivatives=True, backend="numpy")
    system = kintrafo.System(module)
    weights = np.ones(system.equations.rhs.shape)
    by = kintrafo.gradient(system, "rhs", weights, system.design_state)
    bound = next(name for name, value in by.items() if np.isnan(value))
    free = next(
        n for n, e in system.equations.PARAMETERS.items() if e["unit"] == "m" and np.isfinite(by[n])
    )
    kintrafo.export_model(system, tmp_path / "a.fmu", "fmu")
    instance = Fmu(tmp_path / "a.fmu", tmp_path / "unpacked").instance("ModelExchange")
    assert instance.initialise() == OK
    rates = variables_of(system)[1]
    found = instance.derivative(rates, [f"parameters.{free}"], [1.0])
    assert sum(found) == pytest.approx(float(by[free]), rel=1e-9)
    for knowns in ([bound], [free, bound]):
        named = [f"parameters.{name}" for name in knowns]
        instance.derivative(rates, named, [1.0, 1e-6][-len(named) :])
        assert instance.status == ERROR
        as_stored(instance.message)
    instance.free()


# -- Co-Simulation --------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("step", "implicit"), [(0.0, 0.0), (1e-4, 0.0), (1e-4, 1.0)])
def test_steps_follow_the_motion(fmu, version, step, implicit):
    """Errors of Dormand and Prince are by the tolerance, of RK4 and RODASP by the step."""
    instance = fmu("reference_car", version).instance()
    wheel = {"beta1_rate": 0.3, "solver.step": step, "solver.implicit": implicit}
    assert instance.initialise(tolerance=1e-12, **wheel) == OK
    times = np.linspace(0.0, 0.3, 31)
    found = [instance.get("beta1", "tyre_force")]
    for time, length in zip(times, np.diff(times), strict=False):
        assert instance.step(time, length) == OK, instance.message
        found.append(instance.get("beta1", "tyre_force"))
    at = start("reference_car")
    at[system_named("reference_car").state_names.index("beta1_rate")] = 0.3
    wanted = kintrafo.simulate(
        system_named("reference_car"), (0.0, 0.3), at, t_eval=times, method="DOP853", rtol=1e-12,
        atol=1e-14,
    )  # fmt: skip
    np.testing.assert_allclose(np.array(found)[:, 0], wanted.y[0], atol=1e-9)
    forces = wanted.signals["tyre_force"]
    np.testing.assert_allclose(np.array(found)[:, 1], forces, atol=1e-9 * 2e5)  # rate of the tyre
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_inputs_go_on_by_their_derivatives(fmu, version):
    """A moving rack has one position and one velocity; within a step it moves at this velocity."""
    instance = fmu("reference_car", version).instance()
    assert instance.initialise(tolerance=1e-12, rack_velocity=0.1) == OK
    for k in range(5):
        assert instance.step(0.02 * k, 0.02) == OK
    times = np.array([0.0, 0.1])
    rack = ([0.0, 0.1], [0.0, 0.01])
    wanted = truth("reference_car", times, inputs={"rack_position": rack}).y[0, -1]
    assert instance.get("beta1")[0] == pytest.approx(wanted, abs=1e-9)
    assert instance.get("rack_position")[0] == pytest.approx(0.01, abs=1e-15)
    instance.free()


def test_slopes_of_inputs(fmu, as_stored):
    """FMI 2.0 sets derivatives of inputs by their order; rates in the equations are inputs, too."""
    instance = fmu("reference_car", 2).instance()
    assert instance.initialise(tolerance=1e-12) == OK
    given = {"road_height": 2, "rack_position": 2}
    assert instance.slopes(given, [4.0, 0.2]) == OK
    assert instance.get("rack_acceleration") == [0.2]
    assert instance.step(0.0, 0.05) == OK
    found = instance.get("road_height", "rack_position", "rack_velocity")
    assert found == pytest.approx([0.5 * 4.0 * 0.05**2, 0.5 * 0.2 * 0.05**2, 0.01], abs=1e-15)
    times = np.linspace(0.0, 0.05, 201)
    inputs = {
        "road_height": (times, 0.5 * 4.0 * times**2),
        "rack_position": (times, 0.5 * 0.2 * times**2),
    }
    wanted = truth("reference_car", np.array([0.0, 0.05]), inputs=inputs).y[0, -1]
    # a cubic through samples of a parabola, whose ends are free
    assert instance.get("beta1")[0] == pytest.approx(wanted, abs=1e-7)
    assert instance.slopes({"road_height": 4}, [1.0]) == ERROR
    as_stored(instance.message)
    assert instance.slopes({"tyre_force": 1}, [1.0]) == ERROR
    as_stored(instance.message)


@pytest.mark.parametrize("version", VERSIONS)
def test_a_motion_that_ends_is_reported(fmu, version, as_stored):
    """A crank is driven to its dead point: the message of the step has the time and the reason."""
    system = kintrafo.System(system_named("four_bar").equations, SHORT)
    torque = {"crank_torque": 10.0}
    with pytest.raises(kintrafo.SimulationError) as refused:
        kintrafo.simulate(system, (0.0, 2.0), system.state(), inputs=torque, method="DormandPrince")
    ends = refused.value.time
    instance = fmu("four_bar", version).instance()
    assert instance.initialise(**torque, **parameters(SHORT)) == OK
    time, length = 0.0, 0.01
    while instance.step(time, length) == OK:
        time += length
    assert time <= ends <= time + length
    # of the usual tolerance
    assert instance.reached.value == pytest.approx(ends, abs=1e-4)
    as_stored(instance.message)
    assert instance.step(instance.reached.value, length) == DISCARD
    as_stored(instance.message)
    assert instance.call("Reset") == OK
    assert instance.initialise() == OK
    assert instance.step(0.0, length) == OK
    instance.free()


# -- Model Exchange -------------------------------------------------------------------------------


def integrated(instance, end, length):
    """Return when the FMU ends a motion that an importer integrates by Runge and Kutta."""
    assert not instance.update()
    assert instance.call("EnterContinuousTimeMode") == OK
    count = len(instance.array("GetContinuousStates", None, 2))
    state, time = np.array(instance.array("GetContinuousStates", None, count)), 0.0

    def rates(after, place):
        instance.place(time + after, place)
        names = "GetDerivatives", "GetContinuousStateDerivatives"
        return np.array(instance.array(*names, count))

    while time < end:
        a = rates(0.0, state)
        b = rates(0.5 * length, state + 0.5 * length * a)
        c = rates(0.5 * length, state + 0.5 * length * b)
        d = rates(length, state + length * c)
        state, time = state + length / 6.0 * (a + 2.0 * b + 2.0 * c + d), time + length
        instance.place(time, state)
        if instance.completed() or "cannot close" in instance.message:  # or a stage is discarded
            break
    return time


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(("torque", "rate"), [(10.0, 0.0), (-5.5, -5.8), (4.3, -5.6), (1.0, 1.0)])
def test_steps_of_an_importer_do_not_pass_a_dead_point(fmu, version, torque, rate):
    """Beyond a dead point the equations have another motion, which a solver accepts."""
    system = kintrafo.System(system_named("four_bar").equations, SHORT)
    given = {"crank_torque": torque, "crank_angle_rate": rate}
    try:
        state, inputs = system.state(crank_angle_rate=rate), {"crank_torque": torque}
        kintrafo.simulate(system, (0.0, 0.5), state, inputs=inputs)
        ends = 0.5
    except kintrafo.SimulationError as refused:
        ends = refused.time
    assert (ends == 0.5) == (torque == 1.0)  # which turns before it
    for length in (1e-3, 4e-3):
        instance = fmu("four_bar", version).instance("ModelExchange")
        assert instance.initialise(**given, **parameters(SHORT)) == OK
        assert integrated(instance, 0.5, length) == pytest.approx(ends, abs=1.5 * length)
        assert ends == 0.5 or "cannot close" in instance.message
        instance.free()


def test_a_motion_from_rest_near_a_dead_point(fmu, as_stored):
    """A spring that is short pulls away from it, a long one pushes into it."""
    equations = system_named("four_bar").equations
    at = -1.2319890578876  # the crank's dead point [rad]
    for free, beside in ((0.3, 1e-6), (0.9, 1e-3), (0.9, 1e-4)):
        values = SHORT | {"spring_free_length": free}
        system = kintrafo.System(equations, values)
        state, ends = system.state(crank_angle=at + beside), 0.1
        if free == 0.9:
            with pytest.raises(kintrafo.SimulationError) as refused:
                kintrafo.simulate(system, (0.0, ends), state)
            ends = refused.value.time
        for length in (1e-3, 4e-3):
            instance = fmu("four_bar", 2).instance("ModelExchange")
            assert instance.initialise(crank_angle=state[0], **parameters(values)) == OK
            assert integrated(instance, 0.1, length) == pytest.approx(ends, abs=1.5 * length)
            instance.free()
    instance = fmu("four_bar", 2).instance("ModelExchange")
    assert instance.initialise(crank_angle=at + 1e-13, **parameters(SHORT)) == OK
    assert integrated(instance, 0.1, 1e-3) == 1e-3
    as_stored(instance.message)
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_events_have_indicators(fmu, version, as_stored):
    known = fmu("reference_car", version)
    names = [n for n in known.references if n.startswith(("events.", "margins."))]
    system = system_named("reference_car")
    instance = known.instance("ModelExchange", logging=True)
    assert instance.initialise() == OK
    assert not instance.update()
    found = dict(zip(names, instance.get(*names), strict=True))
    signals = system.signals(start("reference_car"))
    assert found["events.wheel_leaves_ground"] == signals["tyre_force"] - 0.001
    longest = system.parameters["strut_length_max"]
    assert found["events.strut_fully_extended"] == signals["strut_length"] - longest
    margins = system.evaluate("margins", start("reference_car"))
    for (guard, _), margin in zip(system.equations.GUARDS, margins, strict=True):
        assert found.get(f"margins.{guard}", margin) == margin
    assert instance.array("GetEventIndicators", None, len(names)) == [*found.values()]
    assert instance.set({"road_height": -0.5}) == OK  # the ground falls away
    assert instance.call("EnterContinuousTimeMode") == OK
    assert instance.call("EnterEventMode") == OK
    assert not instance.update()
    as_stored(instance.message)
    instance.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_state_that_is_refused_is_discarded(fmu, version, as_stored):
    instance = fmu("four_bar", version).instance("ModelExchange")
    assert instance.initialise(**parameters(SHORT)) == OK
    assert not instance.update()
    instance.call("EnterContinuousTimeMode")
    assert instance.place(0.1, [-1.5, 0.0]) == OK
    system = kintrafo.System(system_named("four_bar").equations, SHORT)
    with pytest.raises(kintrafo.ClosureError):
        system.evaluate("rhs", [-1.5, 0.0])
    instance.array("GetDerivatives", "GetContinuousStateDerivatives", 2)
    assert instance.status == DISCARD
    as_stored(instance.message)
    instance.call("EnterEventMode")
    assert instance.update()
    as_stored(instance.message)
    instance.free()


# -- saved, reset, many ---------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
def test_what_is_saved_goes_on_with_the_same_bits(fmu, version):
    instance = fmu("reference_car", version).instance()
    assert instance.initialise(beta1_rate=0.5) == OK
    assert instance.step(0.0, 0.05) == OK
    saved = instance.save()
    content = instance.bytes_of(saved)
    for k in range(3):
        assert instance.step(0.05 + 0.01 * k, 0.01) == OK
    wanted = instance.get("beta1", "beta5", "tyre_force")
    assert instance.restore(saved) == OK
    other = fmu("reference_car", version).instance()
    assert other.restore(other.from_bytes(content)) == OK
    for one in (instance, other):
        for k in range(3):
            assert one.step(0.05 + 0.01 * k, 0.01) == OK
        assert one.get("beta1", "beta5", "tyre_force") == wanted
    assert other.from_bytes(content[:-1]) is None
    assert other.from_bytes(b"x" * len(content)) is None
    assert other.from_bytes(content[:80] + b"\xff" * (len(content) - 80)) is None
    assert "damaged" in other.message
    for one in (instance, other):
        one.free()


@pytest.mark.parametrize("version", VERSIONS)
def test_a_reset_in_the_middle_begins_anew(fmu, version):
    fresh, used = (fmu("reference_car", version).instance() for _ in range(2))
    assert used.initialise(beta1_rate=0.5, **{"parameters.wheel_mass": 30.0}) == OK
    assert used.step(0.0, 0.03) == OK
    assert used.call("Reset") == OK
    for one in (fresh, used):
        assert one.initialise(beta1_rate=0.2) == OK
        assert one.step(0.0, 0.05) == OK
    assert fresh.get("beta1", "tyre_force") == used.get("beta1", "tyre_force")
    for one in (fresh, used):
        one.free()


def test_a_thousand_instances_need_little_memory(fmu):
    def resident():
        with Path("/proc/self/statm").open() as file:
            return int(file.read().split()[1]) * 4096

    before = resident()
    some = [fmu("reference_car", 2).instance() for _ in range(1000)]
    assert all(one.initialise() == OK for one in some)
    assert all(one.step(0.0, 0.001) == OK for one in some)
    used = resident() - before
    for one in some:
        one.free()
    assert used < 50e6


@pytest.mark.parametrize("version", VERSIONS)
def test_parameters_are_those_that_are_set(fmu, version):
    """One library has any parameter set: constants are computed from the set values."""
    system = kintrafo.System(system_named("four_bar").equations, {"crank_mass": 2.0})
    instance = fmu("four_bar", version).instance("ModelExchange")
    assert instance.initialise(**{"parameters.crank_mass": 2.0}) == OK
    _, rates, *_ = variables("four_bar")
    wanted = system.evaluate("rhs", system.design_state)
    np.testing.assert_array_equal(instance.get(*rates), wanted)
    instance.free()


# -- errors ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"parameters.crank_mass": -1.0}, "crank_mass = -1 kg is out of its range; give 0 kg"),
        (
            {"parameters.crank_pin_x": 0.24, "parameters.crank_pin_y": 0.26},
            "the ends crank_pin and rocker_pin of coupler coincide",
        ),
        ({"solver.step": -1.0}, "solver.step = -1 s: a finite number of 0 s or more"),
        ({"solver.implicit": 0.5}, "solver.implicit = 0.5: 0 or 1 is needed"),
        ({"solver.implicit": 1.0}, "solver.implicit = 1 needs fixed steps: give solver.step"),
    ],
)
def test_parameters_out_of_range(fmu, version, values, words, as_stored):
    instance = fmu("four_bar", version).instance()
    assert instance.initialise(**values) == ERROR
    assert words in instance.message
    assert instance.step(0.0, 0.1) == ERROR
    as_stored(instance.message)
    instance.free()


@pytest.mark.parametrize(
    ("values", "fine"),
    [({"ixx": 0.05}, True), ({"ixx": 1.0}, False), ({"ixy": 0.5}, False), ({"ixx": -0.01}, False)],
)
def test_inertia_of_no_body(fmu, values, fine):
    """The FMU refuses it like `prepare` in Python, which checks the principal moments."""
    system = system_named("reference_car")
    body = next(n for n in system.parameters if n.endswith("_inertia_xx")).removesuffix(
        "_inertia_xx"
    )
    named = {f"{body}_inertia_{key[1:]}": value for key, value in values.items()}
    try:
        kintrafo.System(system.equations, {**system.parameters, **named})
        accepted = True
    except kintrafo.ParameterError:
        accepted = False
    assert accepted == fine
    instance = fmu("reference_car", 2).instance("ModelExchange")
    status = instance.initialise(**{f"parameters.{n}": v for n, v in named.items()})
    assert (status == OK) == fine, instance.message


@pytest.mark.parametrize("version", VERSIONS)
def test_calls_that_make_no_sense(fmu, version, as_stored):
    known = fmu("four_bar", version)
    assert known.instance(token="{of another}").handle is None
    instance = known.instance()
    assert instance.step(0.0, 0.1) == ERROR
    as_stored(instance.message)
    assert instance.initialise() == OK
    for time, length, words in (
        (0.0, 0.0, "a step of 0 s"),
        (0.0, float("nan"), "a step of nan s"),
        (0.5, 0.1, "begins at 0.5 s, and the instance is at 0 s"),
    ):
        assert instance.step(time, length) == ERROR
        assert words in instance.message
    assert instance.set({"spring_force": 1.0}) == ERROR
    as_stored(instance.message)
    assert instance.set({"crank_torque": 1.0, "parameters.crank_mass": 1.0}) == ERROR
    as_stored(instance.message)
    assert instance.get("crank_torque") == [0.0]  # all or nothing
    assert instance.set({"crank_torque": float("inf")}) == ERROR
    instance.get(10_000)
    assert instance.status == ERROR
    as_stored(instance.message)
    instance.array("GetDerivatives", "GetContinuousStateDerivatives", 2)
    assert instance.status == ERROR
    as_stored(instance.message)
    assert instance.step(0.0, 0.1) == OK
    assert instance.call("Terminate") == OK
    assert instance.step(0.1, 0.1) == ERROR
    instance.free()
    nobody = known.instance()
    nobody.free()
    nobody.handle = None
    assert nobody.call("Terminate") == ERROR


def test_every_function_of_fmi_3_is_there(fmu):
    library = fmu("four_bar", 3).library
    header = (fmu("four_bar", 3).folder / "sources/fmi3Functions.h").read_text()
    names = {line.split()[1] for line in header.splitlines() if line.startswith("#define fmi3")}
    wanted = {n for n in names if f"fmi3FullName({n})" in header}
    assert len(wanted) > 70
    assert all(hasattr(library, name) for name in wanted)
    library.fmi3InstantiateScheduledExecution.restype = ctypes.c_void_p
    assert library.fmi3InstantiateScheduledExecution(*[None] * 10) is None


def test_what_cannot_be_exported(tmp_path, refused):
    system = system_named("four_bar")
    for options in ({"fmi": 1}, {"platforms": ["amiga"]}, {"speed": 1}):
        with refused(kintrafo.InputError):
            kintrafo.export_model(system, tmp_path / "a.fmu", "fmu", **options)
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, tmp_path / "a.zip", "fmu"))
    (tmp_path / "a.fmu").write_text("a year of work")
    refused(kintrafo.InputError, lambda: kintrafo.export_model(system, tmp_path / "a.fmu", "fmu"))
    assert [file.name for file in tmp_path.iterdir()] == ["a.fmu"]
    assert (tmp_path / "a.fmu").read_text() == "a year of work"


def test_an_export_again_has_the_same_bytes(tmp_path):
    paths = [tmp_path / name for name in ("a.fmu", "b.fmu")]
    for path in paths:
        kintrafo.export_model(system_named("four_bar"), path, "fmu")
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_the_command(kintrafo, tmp_path, ends):
    code, out, err = kintrafo("export", "four_bar", "--to", "fmu", "--fmi", 3)
    assert (code, out.strip()) == (0, "four_bar.fmu"), err
    with zipfile.ZipFile(tmp_path / "four_bar.fmu") as archive:
        assert "binaries/x86_64-linux/four_bar.so" in archive.namelist()
    code, _, err = kintrafo("export", "four_bar", "--to", "fmu", "--platform", "none")
    with zipfile.ZipFile(tmp_path / "four_bar.fmu") as archive:
        assert not any(name.startswith("binaries") for name in archive.namelist())
    ends(2, "export", "four_bar", "--to", "c", "--fmi", 3)
    ends(2, "export", "four_bar", "--to", "fmu", "--platform", "amiga")


def test_a_start_at_which_nothing_can_move_is_refused(tmp_path, refused):
    system = kintrafo.System(system_named("four_bar").equations, SHORT)
    for to in ("fmu", "c"):
        with refused(kintrafo.ClosureError):
            kintrafo.export_model(system, tmp_path / "a.fmu", to, state=[-1.55, 0.0])
    assert not [*tmp_path.iterdir()]


@pytest.mark.parametrize(
    "name", ["andrews", "four_bar", "macpherson_free_rack", "multi_link", "push_rod", "twist_beam"]
)
def test_shipped_models_can_be_exported(tmp_path, name):
    """Tables compile silently, and FMPy finds nothing wrong with descriptions."""
    validation = pytest.importorskip("fmpy.validation")
    path, folder = tmp_path / "a.fmu", tmp_path / "unpacked"
    version = VERSIONS[len(name) % 2]
    kintrafo.export_model(kintrafo.System(EMITTED[name]), path, "fmu", fmi=version, platforms=())
    assert validation.validate_fmu(str(path)) == []
    with zipfile.ZipFile(path) as archive:
        archive.extractall(folder)
    tables = [str(folder / "sources" / file) for file in ("model.c", "numbers.c")]
    flags = ["-std=c11", *UNOPTIMISED, *STRICT, "-fsyntax-only"]
    subprocess.run(["cc", *flags, *tables], check=True, cwd=tmp_path)


@pytest.mark.parametrize("version", VERSIONS)
def test_casadi_has_the_equations_with_their_derivatives(fmu, version):
    casadi = pytest.importorskip("casadi")
    system, at, torque = system_named("four_bar"), [0.3, 0.2], [2.0]
    dae = casadi.DaeBuilder("bar", str(fmu("four_bar", version).folder))
    assert dae.x() == list(system.state_names)
    assert dae.u() == list(system.input_names)
    assert dae.y() == list(system.signal_names)
    function = dae.create("f", ["x", "u"], ["ode", "y"])
    rates, signals = (np.array(part).ravel() for part in function(at, torque))
    np.testing.assert_array_equal(rates, system.evaluate("rhs", at, torque))
    np.testing.assert_array_equal(signals, system.evaluate("signals", at, torque))
    found, linear = function.jacobian()(x=at, u=torque), kintrafo.linearise(system, at, torque)
    for name, matrix in (("ode_x", linear.A), ("ode_u", linear.B), ("y_x", linear.C)):
        np.testing.assert_array_equal(np.array(found[f"jac_{name}"]), matrix)


def test_a_platform_without_a_compiler(tmp_path, monkeypatch, refused):
    """The error names what to install, and nothing is written; sources alone need none."""
    system, path = system_named("prescribed"), tmp_path / "a.fmu"
    without_compilers(monkeypatch)
    for platform in ("windows", "linux"):
        with refused(kintrafo.CompilerError):
            kintrafo.export_model(system, path, "fmu", platforms=[platform])
    assert not [*tmp_path.iterdir()]
    kintrafo.export_model(system, path, "fmu", platforms=())
    with zipfile.ZipFile(path) as archive:
        assert not any(name.startswith("binaries") for name in archive.namelist())


def without_compilers(monkeypatch):
    monkeypatch.setattr(binaries.shutil, "which", lambda _: None)
    monkeypatch.setattr(binaries, "find_spec", lambda _: None)
    monkeypatch.setattr(binaries, "find_compiler", lambda: None)


def test_another_processor_has_no_library(tmp_path, monkeypatch):
    """A folder of libraries for x86-64 never has one for another processor."""
    monkeypatch.setattr(binaries, "HERE", ())
    with pytest.raises(kintrafo.CompilerError, match="x86-64"):
        kintrafo.export_model(
            system_named("prescribed"), tmp_path / "a.fmu", "fmu", platforms=["linux"]
        )
    assert not [*tmp_path.iterdir()]


# -- models that come with the project ------------------------------------------------------------


def test_tables_of_shipped_models_are_committed():
    """If this test fails, run ``make generate``."""
    wanted = {
        f"{name}_{file}": text
        for name, module in EMITTED.items()
        for file, text in any_tables(module.equations.manifest).items()
    }
    found = {path.name: path.read_text() for path in (ROOT / "generated/fmu").iterdir()}
    assert found.keys() == wanted.keys()
    assert [name for name in wanted if found[name] != wanted[name]] == []


@pytest.mark.parametrize("name", sorted(EMITTED))
def test_a_shipped_library_is_used_for_its_sources_only(name):
    """If this fails, run ``make build``: the built files are not those of the sources."""
    system = kintrafo.System(EMITTED[name])
    sources = library_files(Emitted(system, system.design_state, system.inputs()))
    library = binaries.shipped(sources, name, "linux")
    assert len(library) < 1_500_000
    assert f"{sys.base_prefix}/lib".encode() not in library  # where Python is here
    changed = dict(sources)
    changed["model.c"] += " "
    assert binaries.shipped(changed, name, "linux") is None
    renamed = {f"{path}x" if path == "instance.h" else path: text for path, text in sources.items()}
    assert binaries.shipped(renamed, name, "linux") is None
    assert binaries.shipped(sources, f"{name}_of_another_name", "linux") is None


def test_a_shipped_library_computes_what_a_compiled_one_does(tmp_path, monkeypatch):
    """One that is compiled now, by other options: the same bits after each step."""
    path, motions = tmp_path / "a.fmu", []
    for folder in ("shipped", "compiled"):
        kintrafo.export_model(system_named("four_bar"), path, "fmu", force=True)
        instance = Fmu(path, tmp_path / folder).instance()
        assert instance.initialise(crank_torque=2.0) == OK
        motions.append([])
        for k in range(5):
            assert instance.step(0.05 * k, 0.05) == OK
            motions[-1].append(instance.get("crank_angle", "spring_force"))
        instance.free()
        monkeypatch.setattr(binaries, "shipped", lambda *_: None)
        # compiled as one program, the numbers of the sources would be constants in it
        monkeypatch.setenv("CFLAGS", "-flto")
    assert motions[0] == motions[1]


@pytest.mark.parametrize("name", ["reference_car", "rigid_axle", "four_bar"])
def test_an_fmu_of_a_shipped_model_needs_no_compiler(tmp_path, name):
    """A person without one exports it; FMPy simulates it as `simulate` does."""
    fmpy = pytest.importorskip("fmpy")
    folder, cache = str(tmp_path), tmp_path / "cache"
    alone = {"PATH": folder, "HOME": folder, "KINTRAFO_CACHE": str(cache)}
    command = [sys.executable, "-m", "kintrafo", "export", name, "--to", "fmu"]
    subprocess.run(command, check=True, cwd=tmp_path, env=alone)
    assert [*cache.glob("fmu_*")] == []  # nothing was compiled
    system = system_named(name)
    times = np.linspace(0.0, 0.1, 3)
    found = fmpy.simulate_fmu(
        str(tmp_path / f"{name}.fmu"), stop_time=0.1, output_interval=0.05, fmi_type=KINDS[1],
        relative_tolerance=1e-12, output=[*system.state_names],
    )  # fmt: skip
    wanted = kintrafo.simulate(
        system, (0.0, 0.1), system.design_state, t_eval=times, method="DOP853", rtol=1e-12,
        atol=1e-14,
    )  # fmt: skip
    for state, values in zip(system.state_names, wanted.y, strict=True):
        # the accumulated error of hundreds of steps, 1e-12 each
        np.testing.assert_allclose(found[state], values, atol=1e-9 * max(1, np.abs(values).max()))


# -- Windows --------------------------------------------------------------------------------------


@pytest.mark.skipif(shutil.which(MINGW) is None, reason=f"{MINGW} is not installed")
def test_a_library_for_windows(tmp_path):
    """The library exports the functions of FMI only, and contains no path of this machine."""
    path = tmp_path / "a.fmu"
    kintrafo.export_model(system_named("four_bar"), path, "fmu", platforms=["linux", "windows"])
    with zipfile.ZipFile(path) as archive:
        content = archive.read("binaries/win64/four_bar.dll")
    assert content[:2] == b"MZ"
    (tmp_path / "a.dll").write_bytes(content)
    shown = subprocess.run(
        ["x86_64-w64-mingw32-objdump", "-p", str(tmp_path / "a.dll")],
        check=True, capture_output=True, text=True,
    ).stdout  # fmt: skip
    table = shown.partition("[Ordinal/Name Pointer] Table")[2].partition("\n\n")[0]
    exported = {line.split()[-1] for line in table.splitlines() if "[" in line}
    assert {"fmi2DoStep", "fmi3DoStep"} <= exported
    assert {name[:4] for name in exported} == {"fmi2", "fmi3"}
    for folder in (ROOT, cache_folder(), Path.home()):
        assert f"{folder}/".encode() not in content
    # with both libraries
    assert path.stat().st_size < 400_000


def a_few_libraries(prefix):
    """Return variables for Wine with the libraries of a console program: all take 15 s, 700 MB."""
    variables = {"WINEPREFIX": str(prefix), "WINEDEBUG": "-all"}
    installed = Path(shutil.which("wine")).resolve().parents[1]
    places = (f"{where}/wine/x86_64-windows" for where in ("lib*", "lib*/*"))
    folder = next((f for p in places for f in installed.glob(p)), None)
    if folder is None:
        return variables
    system = prefix / "drive_c/windows/system32"
    system.mkdir(parents=True)
    for name in ("kernel32", "kernelbase", "msvcrt", "ntdll", "ucrtbase"):
        (system / f"{name}.dll").symlink_to(folder / f"{name}.dll")
    # rundll32 would install all others
    return variables | {"WINEDLLOVERRIDES": "rundll32.exe=d"}


@pytest.mark.slow
@pytest.mark.skipif(
    None in (shutil.which(MINGW), shutil.which("wine")), reason=f"{MINGW} or wine is not installed"
)
def test_windows_computes_the_same_bits(tmp_path):
    """Every variable, at the start and after each step, by both kinds."""
    path = tmp_path / "a.fmu"
    system = system_named("four_bar")
    kintrafo.export_model(system, path, "fmu", platforms=["linux", "windows"])
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    root = ET.parse(tmp_path / "modelDescription.xml").getroot()
    count = len(root.findall("ModelVariables/ScalarVariable"))
    given = [root.attrib["guid"], str(len(system.state_names)), str(count)]
    environment = os.environ | a_few_libraries(tmp_path / "prefix")
    printed = []
    for compiler, library, before in (
        ("cc", "binaries/linux64/four_bar.so", []),
        (MINGW, "binaries/win64/four_bar.dll", ["wine"]),
    ):
        program = tmp_path / f"{compiler}.exe"
        files = [
            f"-I{tmp_path / 'sources'}",
            str(ROOT / "tests/support/fmu_steps.c"),
            "-o",
            str(program),
        ]
        linked = ["-ldl"] if compiler == "cc" else []
        subprocess.run([compiler, "-std=c11", *files, *linked], check=True)
        command = [*before, str(program), str(tmp_path / library), *given]
        done = subprocess.run(command, check=True, capture_output=True, env=environment)
        printed.append(done.stdout.decode().splitlines())
    assert len(printed[0]) == 53
    assert not any("0000000000000000 " * count in line for line in printed[0])
    assert printed[0] == printed[1]


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_no_access_is_beyond_what_is_kept(fmu, tmp_path):
    """With sanitizers: every access, leak and undefined operation ends the program."""
    known = fmu("four_bar", 2)
    sources = sorted(map(str, known.folder.glob("sources/**/*.c")))
    program = tmp_path / "driver"
    flags = ["-std=c11", "-O0", "-fsanitize=address,undefined", "-fno-sanitize-recover=undefined"]
    include = f"-I{known.folder / 'sources'}"
    driver = str(ROOT / "tests/support/fmu_driver.c")
    made = ["gcc", *flags, include, driver, *sources, "-o", str(program), "-lm"]
    subprocess.run(made, check=True)
    called = [str(program), known.token, str(len(known.references))]
    ended = subprocess.run(called, capture_output=True, text=True, check=False)
    assert ended.returncode == 0, ended.stderr
    assert ended.stdout.endswith("done\n")
    assert "damper_rate = -1 N s/m is out of its range" in ended.stdout
