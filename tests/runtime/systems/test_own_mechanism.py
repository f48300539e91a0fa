"""Mechanisms that a user declares: the page about them, the cache, compilers, NumPy, mistakes."""

import importlib
import multiprocessing
import pickle
import re
import shutil
import subprocess
import sys
import warnings
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from kintrafo import generator
from kintrafo.generator import Formulation, JointForce, Mechanism
from kintrafo.generator.mechanisms.andrews import MODELS as ANDREWS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.mechanisms.four_bar import MODELS as FOUR_BAR_MODELS
from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK
from kintrafo.generator.planning.proposal import Proposal, model_of, proposals
from kintrafo.systems.compile import build as own_build
from kintrafo.systems.compile import declaration
from kintrafo.systems.compile.cache import cache_folder
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.cli import app
from mechanisms import iterated_loops
from support.changes import with_default
from support.folders import ROOT
from support.work_on_compiling import simulated_end, what_is_needed
from typer.testing import CliRunner

EXAMPLE = ROOT / "examples/pushrod_suspension.py"
STEERING = ROOT / "examples/steering_gear.py"
BICYCLE = ROOT / "examples/bicycle.py"
LIMB = ROOT / "examples/limb_in_flight.py"
PAGE = (ROOT / "docs/mechanisms/own-mechanism.md").read_text(encoding="utf-8")

needs_compiler = pytest.mark.skipif(find_compiler() is None, reason="no C compiler")


@pytest.fixture(scope="module")
def filling(tmp_path_factory):
    return tmp_path_factory.mktemp("cache")


@pytest.fixture(autouse=True)
def shared_cache(filling, monkeypatch):
    """Tests have a cache together, and so compile each mechanism once."""
    monkeypatch.setenv("KINTRAFO_CACHE", str(filling))


@pytest.fixture
def cache(tmp_path, monkeypatch):
    """A cache of its own, for a test that looks at what is in it."""
    monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture(scope="module")
def pushrod(filling):
    return kintrafo.compile(EXAMPLE, folder=filling)


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)


class TestPage:
    def test_declarations_are_those_of_the_examples(self):
        examples = [path.read_text(encoding="utf-8") for path in (EXAMPLE, STEERING, LIMB, BICYCLE)]
        shown = [block for block in blocks("python") if "import kintrafo" not in block]
        assert len(shown) == 11
        assert all(any(block in example for example in examples) for block in shown)

    def test_the_use_of_it_prints_what_it_says(self, tmp_path, monkeypatch, capsys):
        shutil.copy(EXAMPLE, tmp_path)
        monkeypatch.chdir(tmp_path)
        used = [block for block in blocks("python") if "import kintrafo" in block]
        assert len(used) == 2
        for block, printed in zip(used, blocks("text"), strict=False):
            exec(compile(block, "own-mechanism.md", "exec"), {})
            assert capsys.readouterr().out == printed

    def test_the_steering_gear_prints_what_it_says(self, monkeypatch, capsys):
        monkeypatch.chdir(ROOT)
        (used,) = (block for block in blocks("py") if "import kintrafo" in block)
        exec(compile(used, "own-mechanism.md", "exec"), {})
        assert capsys.readouterr().out in blocks("none")

    def test_the_error_is_the_one_printed(self, pushrod):
        system = kintrafo.System(pushrod)
        with pytest.raises(kintrafo.ClosureError) as caught:
            system.signals(system.state(arm_angle=-0.6))
        assert str(caught.value) in {" ".join(block.split()) for block in blocks("text")}


class TestExample:
    def test_motion_ratio_against_the_rod_solved_by_bisection(self, pushrod):
        """The rocker's angle is where the rod has its length: found without the closed form."""
        system = kintrafo.System(pushrod)
        for angle in (-0.12, 0.0, 0.05, 0.15):
            state = system.state(arm_angle=angle)
            rocker = system.evaluate("relative_coordinates", state)[1]
            solved = rocker_by_bisection(system.parameters, angle, rocker)
            # bisection goes down to half an ulp of 0.5 rad; the closed form rounds twenty times
            assert rocker == pytest.approx(solved, abs=20 * 2.2e-16)

    def test_energy_is_kept_without_damping(self, pushrod):
        # in the air: a tyre held in the plane of a wheel that tilts has no potential
        floating = {"damper_rate": 0.0, "tyre_rate": 0.0, "spring_free_length": 0.24}
        system = kintrafo.System(pushrod, floating)
        start = system.state(arm_angle=0.02)
        result = kintrafo.simulate(
            system, (0.0, 1.0), start, method="DOP853", rtol=1e-12, atol=1e-13
        )
        energy = [total_energy(system, state) for state in result.y.T]
        moving = np.ptp([kinetic_energy(system, state) for state in result.y.T])
        assert moving > 1.0
        # the relative error of the integration, kept over some hundred steps
        assert np.ptp(energy) < 1e-9 * moving


def turned(vector, axis, angle):
    """Rotate about an axis (Rodrigues)."""
    axis = axis / np.linalg.norm(axis)
    cos, sin = np.cos(angle), np.sin(angle)
    return vector * cos + np.cross(axis, vector) * sin + axis * (axis @ vector) * (1.0 - cos)


def place(parameters, name):
    return np.array([parameters[f"{name}_{axis}"] for axis in "xyz"])


def rocker_by_bisection(parameters, arm_angle, near):
    names = ("arm_front", "arm_rear", "rod_lower", "rod_upper", "rocker_pivot", "rocker_axis")
    front, rear, lower, upper, pivot, axis = (place(parameters, name) for name in names)
    end = rear + turned(lower - rear, front - rear, arm_angle)

    def excess(angle):
        at = pivot + turned(upper - pivot, axis, angle)
        return np.linalg.norm(at - end) - np.linalg.norm(upper - lower)

    low, high = near - 0.2, near + 0.2
    assert excess(low) * excess(high) < 0.0
    while (middle := (low + high) / 2) not in (low, high):
        low, high = (low, middle) if excess(low) * excess(middle) <= 0.0 else (middle, high)
    return middle


def kinetic_energy(system, state):
    rate = state[1:]
    return 0.5 * float(rate @ system.evaluate("mass_matrix", state) @ rate)


def total_energy(system, state):
    values, signals = system.parameters, system.signals(state)
    heights = system.evaluate("positions", state)[:, 2]
    masses = [values[f"{body}_mass"] for body in system.equations.BODIES]
    weight = values["gravity"] * float(heights @ masses)
    pressed = values["spring_free_length"] - signals["coilover_length"]
    return (
        kinetic_energy(system, state) + weight + 0.5 * values["spring_rate"] * float(pressed) ** 2
    )


@needs_compiler
class TestCache:
    def test_what_is_there_is_not_made_again(self, cache, monkeypatch):
        first = kintrafo.compile(FOUR_BAR)
        (made,) = cache.iterdir()
        monkeypatch.setattr(own_build, "build", None)
        reported = []
        assert kintrafo.compile(FOUR_BAR, progress=reported.append) is first
        assert not reported
        assert list(cache.iterdir()) == [made]

    @pytest.mark.parametrize("what", ["joint", "default", "flags", "backend"])
    def test_a_change_makes_another_one(self, cache, monkeypatch, what):
        kintrafo.compile(SLIDER_CRANK)
        changed, backend = SLIDER_CRANK, "auto"
        if what == "joint":
            joints = [
                replace(j, name="renamed") if j.name == "C" else j for j in SLIDER_CRANK.joints
            ]
            changed = replace(SLIDER_CRANK, joints=tuple(joints))
        elif what == "default":
            changed = with_default(SLIDER_CRANK, piston_mass=0.123)
        elif what == "flags":
            monkeypatch.setenv("CFLAGS", "-O1")
        else:
            backend = "numpy"
        kintrafo.compile(changed, backend=backend)
        assert len(list(cache.iterdir())) == 2

    def test_processes_at_a_time_leave_one(self, cache):
        """And all of them find it: no address and no hash seed is in its name."""
        context = multiprocessing.get_context("spawn")
        with ProcessPoolExecutor(1, mp_context=context) as pool:
            pool.submit(what_is_needed).result()  # imported: both begin at once
            there = pool.submit(simulated_end, 0.1)
            here = simulated_end(0.1)
            assert there.result() == here
        reported = []
        kintrafo.compile(FOUR_BAR, progress=reported.append)
        assert not reported
        assert [p.name.startswith("four_bar-") for p in cache.iterdir()] == [True]

    def test_systems_go_to_other_processes(self):
        system = kintrafo.System(kintrafo.compile(FOUR_BAR), {"crank_mass": 0.7})
        again = pickle.loads(pickle.dumps(system))
        assert again.equations is system.equations
        np.testing.assert_array_equal(again.constants, system.constants)

    def test_nothing_is_left_of_a_failure(self, cache, monkeypatch):
        monkeypatch.setenv("CFLAGS", "-no-such-option-for-any-compiler")
        with pytest.raises(kintrafo.CompilerError, match="no-such-option") as caught:
            kintrafo.compile(FOUR_BAR)
        assert 'backend="numpy"' in str(caught.value)
        assert not list(cache.iterdir())

    def test_a_folder_that_cannot_be_written(self, tmp_path):
        (tmp_path / "file").write_text("")
        with pytest.raises(kintrafo.InputError, match="KINTRAFO_CACHE"):
            kintrafo.compile(FOUR_BAR, folder=tmp_path / "file" / "cache")

    def test_it_is_the_users_by_default(self, monkeypatch):
        monkeypatch.delenv("KINTRAFO_CACHE")
        assert cache_folder().name == "kintrafo"


@pytest.fixture
def no_compiler(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)


class TestWithoutCompiler:
    @pytest.mark.usefixtures("no_compiler")
    def test_numpy_says_so_once_and_gives_the_same(self):
        own_build._warn_once.cache_clear()
        with pytest.warns(RuntimeWarning, match=r"NumPy evaluates.*apt-get install gcc"):
            own = kintrafo.compile(FOUR_BAR)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            kintrafo.compile(FOUR_BAR)
        assert own.ADDRESSES == {}
        shipped = kintrafo.System(importlib.import_module("kintrafo.generated.four_bar"))
        system = kintrafo.System(own)
        end = kintrafo.simulate(system, (0.0, 0.5), system.state(crank_angle=0.1), rtol=1e-9)
        other = kintrafo.simulate(
            shipped, (0.0, 0.5), shipped.state(crank_angle=0.1), rtol=1e-9, backend="scipy"
        )
        assert end.solver == "SciPy"
        # the same steps of the same solver, on values that differ by rounding at most
        np.testing.assert_allclose(end.y[:, -1], other.y[:, -1], rtol=1e-10)

    @pytest.mark.usefixtures("no_compiler")
    def test_compiled_was_asked_for(self):
        with pytest.raises(kintrafo.CompilerError, match="apt-get install gcc"):
            kintrafo.compile(FOUR_BAR, backend="c")

    def test_a_compiler_that_there_is_not(self, monkeypatch):
        monkeypatch.setenv("CC", "no-such-compiler")
        with pytest.raises(kintrafo.CompilerError, match="CC = no-such-compiler"):
            kintrafo.compile(FOUR_BAR)

    @pytest.mark.parametrize(
        ("variable", "text"), [("CC", "gcc '-O2"), ("CFLAGS", '-DNAME="x'), ("CFLAGS", "-O1 \\")]
    )
    def test_a_quotation_that_nothing_closes(self, monkeypatch, variable, text, refused):
        monkeypatch.setenv(variable, text)
        refused(kintrafo.CompilerError, lambda: kintrafo.compile(FOUR_BAR))

    def test_native_methods_need_c(self, refused):
        system = kintrafo.System(kintrafo.compile(FOUR_BAR, backend="numpy"))
        refused(
            kintrafo.InputError,
            lambda: kintrafo.simulate(system, (0.0, 1.0), system.state(), method="Verner"),
        )


@pytest.mark.parametrize("model", [*FOUR_BAR_MODELS, *ANDREWS], ids=lambda model: model.name)
def test_numpy_computes_what_c_computes(model):
    """Both have the same program; only sines and cosines come from different libraries."""
    shipped = kintrafo.System(importlib.import_module(f"kintrafo.generated.{model.name}"))
    system = kintrafo.System(kintrafo.compile(model, backend="numpy"))
    random = np.random.default_rng(5)
    states = 0.05 * random.standard_normal((4, 3, len(system.state_names)))
    inputs = random.standard_normal((3, len(system.input_names)))
    for name in shipped.equations.ADDRESSES.keys() - {"prepare", "design_state", "residuals"}:
        ours, theirs = (s.evaluate(name, states, inputs) for s in (system, shipped))
        # a last digit of a sine, magnified by what is small of large: a margin beside a squared
        # length, an acceleration beside what it is the difference of
        size = np.abs(theirs).max() + 1e-300
        assert np.abs(ours - theirs).max() <= 1e-12 * size, name
    np.testing.assert_array_equal(system.constants, shipped.constants)
    np.testing.assert_allclose(system.design_state, shipped.design_state, rtol=1e-15)
    given = shipped.evaluate("relative_coordinates", states[0], inputs)
    closures = [
        s.equations.residuals(given, states[0], inputs, s.constants) for s in (system, shipped)
    ]
    np.testing.assert_allclose(*closures, atol=1e-14)


def test_numpy_refuses_what_c_refuses(refused):
    own = kintrafo.compile(EXAMPLE, backend="numpy")
    system = kintrafo.System(own)
    states = np.stack([system.state(arm_angle=a) for a in (0.0, -0.6)])
    refused(kintrafo.ClosureError, lambda: system.evaluate("rhs", states))
    refused(
        kintrafo.ParameterError,
        lambda: kintrafo.System(own, {"rocker_axis_x": 0.0, "rocker_axis_y": 0.0}),
    )
    refused(ValueError, lambda: system.evaluate("rhs", [0.0]))


class TestProposals:
    def test_of_the_mechanisms_that_come_with_the_project(self):
        free = replace(FOUR_BAR, forces=())  # a torque on the crank keeps the crank independent
        assert list(proposals(FOUR_BAR)) == [Proposal(("A",))]
        closed = [Proposal(("A",)), Proposal(("D",))]
        assert list(proposals(free)) == [*closed, Proposal(("B",))]  # an elbow

    def test_all_bodies_are_massive(self):
        model = model_of(FOUR_BAR)
        assert model.independent == (FOUR_BAR.joint("A"),)
        assert [body.name for body in model.massive] == ["crank", "coupler", "rocker"]

    def test_what_is_not_reported_is_not_proposed(self, refused):
        whole = iterated_loops.STEPHENSON.mechanism
        far = tuple(c for c in whole.coordinates if c.joint.name == "arm_hinge")
        with refused(kintrafo.MechanismError):
            kintrafo.compile(replace(whole, coordinates=far))


def write(folder, text):
    path = folder / "mine.py"
    path.write_text(text, encoding="utf-8")
    return path


IMPORTS = """
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR as first
from dataclasses import replace
from itertools import pairwise
"""


PENDULUM = """
from kintrafo.generator import *
GROUND = Ground("ground")
UPPER = Body("upper", 1.0, (0.0, 0.0, -1.0))
LOWER = Body("lower", 1.0, (0.0, 0.0, -2.0))
AXIS = Direction("axis", (1.0, 0.0, 0.0))
SHOULDER = Revolute("shoulder", GROUND, UPPER, Line(Point("pivot", (0.0, 0.0, 0.0)), AXIS))
ELBOW = Revolute("elbow_hinge", UPPER, LOWER, Line(Point("elbow", (0.0, 0.0, -1.0)), AXIS))
PENDULUM = Mechanism(
    name="double_pendulum",
    title="Double pendulum",
    joints=(SHOULDER, ELBOW),
    forces=(Weight(),),
    coordinates=(
        SHOULDER.angle("first", "angle of the upper rod"),
        ELBOW.angle("second", "angle between the rods"),
    ),
)
"""


def test_a_chain_without_loops_inputs_and_signals(tmp_path):
    """Two point masses on rods of 1 m: the textbook's frequencies are those of 2 -+ sqrt(2)."""
    system = kintrafo.System(kintrafo.compile(write(tmp_path, PENDULUM)))
    assert system.equations.LOOPS == ()
    linear = kintrafo.linearise(system, system.state())
    assert linear.B.shape == (4, 0)
    assert linear.C.shape == (0, 4)
    assert linear.D.shape == (0, 0)
    expected = sorted(np.sqrt(9.81 * (2.0 + np.array([-1.0, 1.0]) * np.sqrt(2.0))) / (2.0 * np.pi))
    found = sorted(mode.natural_frequency for mode in linear.modes)
    np.testing.assert_allclose(found, expected, rtol=1e-12)
    result = kintrafo.simulate(system, (0.0, 1.0), system.state(first=1.0))
    assert result.success
    assert result.signals == {}


@needs_compiler
def test_what_has_no_mass_may_lie_between(refused):
    """Two slides along one line: the outer one moves a mass, against the inner one none."""
    along = generator.Direction("along", (1.0, 0.0, 0.0))
    bodies = [generator.Body(n, 1.0, (0.0, 0.0, 0.0), (0.1, 0.1, 0.1)) for n in ("inner", "outer")]
    pairs = pairwise([generator.Ground("ground"), *bodies])
    slides = [generator.Prismatic(f"slide_{i}", *pair, along) for i, pair in enumerate(pairs)]
    pushes = (JointForce(s, generator.Input(f"f{i}", "N", "push")) for i, s in enumerate(slides))
    mechanism = Mechanism(
        name="telescope",
        title="Two slides along one line",
        joints=tuple(slides),
        coordinates=tuple(slide.slide(f"x{i}", "way") for i, slide in enumerate(slides)),
        forces=tuple(pushes),
    )
    equations = kintrafo.compile(mechanism)
    kintrafo.System(equations)
    refused(kintrafo.ParameterError, lambda: kintrafo.System(equations, {"inner_mass": 0.0}))


class TestMistakes:
    @pytest.mark.parametrize(
        ("text", "words"),
        [
            ("x = (\n", "Line 1: '(' was never closed"),
            ("\nimport math\nx = math.sqrt(-1.0)\n", "Line 3: ValueError: math domain error"),
            ("def f():\n    return 1 / 0\n\nf()\n", "Line 2: ZeroDivisionError"),
            ("x = 1\n", "no Formulation and no Mechanism"),
            (f"{IMPORTS}second = replace(first, name='other')\n", "four_bar, other"),
        ],
    )
    def test_in_a_file(self, tmp_path, text, words):
        with pytest.raises(kintrafo.InputError, match=re.escape(words)):
            kintrafo.compile(write(tmp_path, text))

    def test_a_name_that_there_is_not(self, tmp_path, refused):
        path = write(tmp_path, f"{IMPORTS}second = replace(first, name='other')\n")
        refused(kintrafo.InputError, lambda: kintrafo.compile(path, name="fuor_bar"))

    def test_binary_files_and_other_things(self, tmp_path):
        path = tmp_path / "mine.py"
        path.write_bytes(b"\xff\xfe\x00")
        with pytest.raises(kintrafo.InputError, match="UTF-8"):
            kintrafo.compile(path)
        path.write_bytes(b"import math\n\0\n")
        with pytest.raises(kintrafo.InputError, match="null bytes") as raised:
            kintrafo.compile(path)
        assert "None" not in str(raised.value)
        with pytest.raises(kintrafo.InputError, match="not 3"):
            kintrafo.compile(3)
        with pytest.raises(kintrafo.InputError, match="numpy"):
            kintrafo.compile(FOUR_BAR, backend="nunpy")

    def test_a_loop_that_does_not_close(self, cache, refused):
        free = replace(FOUR_BAR, forces=())
        model = replace(FOUR_BAR_MODELS[0], mechanism=free, independent=())
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model))
        assert not list(cache.iterdir())

    def test_a_joint_to_nowhere(self, tmp_path, refused):
        text = EXAMPLE.read_text(encoding="utf-8").replace("CHASSIS, ROCKER,", "CHASSIS, ROKCER,")
        refused(kintrafo.InputError, lambda: kintrafo.compile(write(tmp_path, text)))

    def test_the_command_line_has_no_traceback(self, tmp_path):
        path = write(tmp_path, "x = (\n")
        done = subprocess.run(
            [sys.executable, "-m", "kintrafo", "mechanism", "generate", str(path)],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 2
        assert "never closed" in done.stderr
        assert "Traceback" not in done.stderr


def test_which_of_several_models(tmp_path):
    path = write(tmp_path, f"{IMPORTS}second = replace(first, name='other')\n")
    other = kintrafo.compile(path, name="other", backend="numpy")
    assert other.NAME == "other"


def test_the_hint_for_one_of_several_models_works_as_printed(tmp_path):
    path = write(tmp_path, f"{IMPORTS}second = replace(first, name='other')\n")
    command = ["mechanism", "generate", str(path), "--model", "other", "--numpy"]
    done = CliRunner().invoke(app, command)
    assert done.exit_code == 0, done.output
    (call,) = re.findall(r"kintrafo\.compile\(.*?\)", done.output.replace("\n", ""))
    assert eval(call.replace(")", ", backend='numpy')")).NAME == "other"


def test_a_page_of_what_ships_can_be_generated_from():
    """Its imports are relative to the package in which it is."""
    page = Path(generator.__file__).parent / "mechanisms/four_bar.py"
    assert declaration.model_of(page) == FOUR_BAR_MODELS[0]


def test_declarations_can_be_imported_from_one_place():
    assert Mechanism.__module__ == "kintrafo.generator.declare.mechanism"
    assert Formulation.__module__ == "kintrafo.generator.declare.formulation"
