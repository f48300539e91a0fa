"""Steps of one length: their order, cubics and events, and that none is too long in silence."""

import ctypes
import re
import shutil
from importlib import import_module
from itertools import pairwise

import kintrafo
import kintrafo.generator as g
import numpy as np
import pytest
from kintrafo import (
    InputError,
    Model,
    SignalEvent,
    SimulationError,
    Stepper,
    System,
    equilibrium,
    simulate,
    state_at_height,
)
from kintrafo.simulation.solvers import native_available
from support import lanes

pytestmark = pytest.mark.skipif(not native_available(), reason="nothing is integrated in C")

MODEL = Model("reference_car")
START = state_at_height(MODEL, 0.325, spin_rate=93.0)
SPAN = (0.0, 1.0)
TIMES = np.linspace(*SPAN, 101)
TRUTH = simulate(
    MODEL, SPAN, START, method="DOP853", t_eval=TIMES, rtol=1e-13, atol=1e-15, dense_output=True
)


def run(step=1e-3, span=SPAN, start=START, model=MODEL, **options):
    return simulate(model, span, start, method="RK4", step=step, **options)


def test_it_is_of_fourth_order():
    """Half the step makes an error 16 times smaller, at the ends of steps as between them."""
    within = np.linspace(*SPAN, 334)[1:]
    for times in (TIMES, within):
        truth = TRUTH.sol(times)[0]
        errors = [np.abs(run(step, t_eval=times).y[0] - truth).max() for step in (2e-3, 1e-3, 5e-4)]
        gains = [a / b for a, b in pairwise(errors)]
        # the next term of the error is a step times as large, some per cent here
        assert gains == pytest.approx([16.0, 16.0], rel=0.1), errors


def test_a_step_is_four_evaluations_and_one_length():
    found = run(1e-3, t_eval=None)
    assert (found.steps, found.nfev, found.order) == (1000, 4001, 4)
    # each time is rounded once
    np.testing.assert_allclose(np.diff(found.t), 1e-3, rtol=0.0, atol=3e-16)
    assert found.solver == "kintrafo"
    many = run(1e-3, t_eval=np.linspace(*SPAN, 10_001))
    assert many.nfev == 4001
    assert many.y[:, -1].tolist() == found.y[:, -1].tolist()


def loops_of_the_page(language):
    """Return the code of the page that is in a language."""
    page = (lanes.ROOT / "docs/simulation/real-time.md").read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", page, flags=re.DOTALL)


def test_the_loops_of_the_page_do_the_same(tmp_path):
    found = run(1e-3, span=(0.0, 0.1))
    inputs, names = np.zeros(len(MODEL.input_names)), {}
    for code in loops_of_the_page("python"):
        exec(code, names)
    assert (names["found"].steps, names["found"].nfev) == (1000, 4001)
    assert names["stepper"].time == 1.0
    assert np.isfinite(names["stepper"].state).all()
    if shutil.which("gcc") is None:
        pytest.skip("no gcc")
    folder, source = lanes.ROOT / "generated/c", tmp_path / "loop.c"
    source.write_text(loops_of_the_page("c")[0], encoding="utf-8")
    built = lanes.compiled(
        tmp_path, source, str(folder / "macpherson.c"), f"-I{folder}", name="loop"
    )
    state, (constants, given) = np.array(START), (np.array(MODEL.constants), inputs)
    for _ in range(100):
        pointers = (ctypes.c_void_p(a.ctypes.data) for a in (constants, state, given))
        assert built.step(*pointers, ctypes.c_double(1e-3)) == 0
    # sums in another order, over a hundred steps
    np.testing.assert_allclose(found.y[:, -1], state, rtol=1e-12, atol=1e-13)


def test_inputs_that_jump_and_turn_keep_the_order():
    road = (np.array([0.0, 0.1234, 0.1234, 0.5]), np.array([0.0, 0.01, 0.02, 0.0]))
    options = {"inputs": {"road_height": road}, "t_eval": [0.5]}
    truth = simulate(
        MODEL, (0.0, 0.5), START, method="DOP853", rtol=1e-12, atol=1e-14, **options
    ).y[0, -1]
    errors = [abs(run(step, span=(0.0, 0.5), **options).y[0, -1] - truth) for step in (2e-3, 1e-3)]
    assert errors[0] / errors[1] > 12.0, errors


def test_zeros_of_events_are_found_by_the_cubic():
    def event(time, _):
        return np.sin(np.pi * (16.7 * time - 0.3))

    found = run(5e-3, span=(0.0, 0.2), events=event)
    known = (0.3 + np.arange(4)) / 16.7
    np.testing.assert_allclose(found.t_events[0], known[known < 0.2], rtol=0.0, atol=1e-11)
    level = SignalEvent("wheel_center_z", 0.3)
    found = run(1e-3, events=level, dense_output=True)
    heights = MODEL.signals(found.sol(found.t_events[0]).T)["wheel_center_z"]
    np.testing.assert_allclose(heights, 0.3, rtol=0.0, atol=1e-13)


def fastest(model, state, by=1e-6):
    """Return the magnitude of the fastest eigenvalue, by LAPACK on differences of the rates."""
    inputs, size = np.zeros(len(model.input_names)), len(state)
    columns = []
    for place in range(size):
        moved = by * np.eye(size)[place]
        rates = [model.evaluate("rhs", state + sign * moved, inputs) for sign in (1.0, -1.0)]
        columns.append((rates[0] - rates[1]) / (2.0 * by))
    return np.abs(np.linalg.eigvals(np.array(columns).T)).max()


def damped(rate):
    return System(MODEL.equations, MODEL.parameters | {"damper_rate": rate})


def with_friction(force, velocity):
    """Return a strut with dry friction (N, m/s), and a state in which it slides."""
    changes = {"strut.friction_N": force, "strut.friction_velocity_m_per_s": velocity}
    model = Model(MODEL.suspension.with_changes(changes))
    start = np.array(state_at_height(model, 0.305))
    start[2] = 0.3
    return model, start


def allowed_step(error):
    """Return the longest stable step that an error names, s."""
    return float(error.reason.split("steps of ")[2].split(" s")[0])


@pytest.mark.parametrize("rate", [0.0, 1500.0, 1e5])
def test_the_longest_stable_step_is_named(rate):
    """Eigenvalues across, slanting and along the axis: that step is stable, much more is not."""
    model, start = damped(rate), np.array(START)
    longest = 2.61 / fastest(model, start)
    with pytest.raises(SimulationError, match="not stable") as caught:
        run(1.02 * 2.83 / 2.61 * longest, model=model, start=start)
    allowed = allowed_step(caught.value)
    # the bound of the power 256 is some per cent above the eigenvalue, and 1 % is left
    assert 0.9 * longest < allowed < longest
    assert caught.value.time == 0.0
    found = run(allowed, model=model, start=start, span=(0.0, 2e-3))
    assert found.success


def test_what_is_beyond_the_limit_would_be_nonsense():
    """The same steps by hand, from beside rest, grow; those that are allowed do not."""
    rest, inputs = np.array(equilibrium(MODEL)), np.zeros(len(MODEL.input_names))
    model = damped(1e5)  # which does not change what is at rest
    longest = 2.61 / fastest(model, rest)
    moved = {}
    for part in (0.95, 1.2):
        state = rest + np.array([0.0, 0.0, 1e-9, 0.0])
        for _ in range(12):
            rates = [model.evaluate("rhs", state, inputs)]
            for share in (0.5, 0.5, 1.0):
                there = state + share * part * longest * rates[-1]
                rates.append(model.evaluate("rhs", there, inputs))
            state = state + part * longest / 6.0 * (
                rates[0] + 2.0 * rates[1] + 2.0 * rates[2] + rates[3]
            )
        moved[part] = abs(state[2])
    assert moved[0.95] < 1e-9 < moved[1.2]
    with pytest.raises(SimulationError, match="not stable"):
        run(1.2 * longest, model=model, start=rest)


def test_a_motion_that_becomes_stiff_ends_there():
    """A strut that comes to stick: slow while it slides, and fast when it does no more."""
    model, start = with_friction(600.0, 1e-5)
    with pytest.raises(SimulationError, match=r"needs steps of .* s or less") as caught:
        run(1e-4, model=model, start=start)
    assert caught.value.time > 1e-3
    assert caught.value.partial.t.size > 10
    allowed = allowed_step(caught.value)
    held = np.array(equilibrium(model))
    # where the strut sticks the Jacobian is that of the friction at rest, wherever that is
    assert allowed == pytest.approx(0.99 * 2.61 / fastest(model, held, 1e-9), rel=0.1)
    assert run(allowed, model=model, start=start, span=(0.0, 0.02)).success


def stiffest_of(model, found):
    """Return the greatest magnitude of an eigenvalue at each state of a result, by LAPACK."""
    size = len(model.state_names)
    matrices = model.evaluate("rhs_jacobian", found.y.T, found.inputs)
    return np.abs(np.linalg.eigvals(matrices.reshape(-1, size, size))).max(axis=1)


@pytest.mark.parametrize("step", [3e-4, 1e-3, 3e-3, 1e-2])
@pytest.mark.parametrize("friction", [(50.0, 1e-3), (200.0, 1e-2), (600.0, 1e-2), (600.0, 1e-5)])
def test_no_step_of_a_result_is_unstable(friction, step):
    """Eigenvalues by LAPACK at each step, of a strut that slides or sticks."""
    model, start = with_friction(*friction)
    try:
        found = run(step, model=model, start=start, span=(0.0, 0.4), t_eval=None)
    except SimulationError as error:
        found = error.partial
    stiffest = step * stiffest_of(model, found)
    # no step begins at the last state, or the one that is refused
    assert stiffest[:-1].max() < 2.61
    if found.success:
        truth = simulate(model, (0.0, 0.4), start, method="BDF", rtol=1e-9, atol=1e-12)
        moved = np.abs(START[0] - truth.y[0, -1])
        assert abs(found.y[0, -1] - truth.y[0, -1]) < 1e-3 * moved


@pytest.fixture(scope="module")
def thrown():
    """Return a block that slides freely on its guide until it meets a stop, where slide is zero."""
    block = g.Body("block", 2.0, (0.1, 0.0, 0.0))
    guide = g.Prismatic("way", g.Ground("base"), block, g.FORWARD)
    stop = g.Stop(
        side="bump",
        length=g.Displacement("meeting", 0.0, "slide where the stop is met"),
        rate=g.SpringRate("stop_rate", 1.0, "rate"),
        progression=g.Progression("stop_progression", 0.0, "progression"),
    )
    push = g.Input("push", "N", "force on the block")
    return kintrafo.compile(
        g.Mechanism(
            name="thrown",
            title="Block that meets a stop",
            joints=(guide,),
            forces=(g.ForceElement("end", g.AlongGuide(guide), (stop,)), g.JointForce(guide, push)),
            coordinates=(guide.slide("slide", "slide of the block"),),
        )
    )


@pytest.mark.parametrize("fast", [3.0, 8.0, 20.0])
@pytest.mark.parametrize("push", [0.0, -20.0])
def test_no_step_begins_on_something_stiff(thrown, push, fast):
    """In free motion all eigenvalues are zero; contact begins at a stage of a step."""
    step, refusals = 1e-3, 0
    model = System(thrown, {"stop_rate": 2.0 * (fast / step) ** 2})
    for part in np.linspace(0.0, 0.95, 12):
        options = {"start": (0.02 + step * part, -1.0), "inputs": {"push": push}, "t_eval": None}
        try:
            found = run(step, span=(0.0, 0.05), model=model, **options)
        except SimulationError as error:
            found = error.partial
            allowed = allowed_step(error)
            assert allowed == pytest.approx(2.61 / fast * step, rel=0.1)
            refusals += 1
        # it may be thrown back within one step, but no step begins where it meets the stop
        assert (found.y[0, :-1] >= 0.0).all()
        assert found.njev < 5
    assert refusals >= 5


def test_the_jacobian_is_evaluated_where_it_is_needed():
    """At one step in 128 of a slow motion, at nearly all steps near the limit."""
    assert run(1e-3).njev <= 10
    step = 0.9 * 2.61 / fastest(damped(1e5), np.array(START))
    assert run(step, model=damped(1e5), span=(0.0, 100 * step)).njev > 90


def test_a_stepper_that_is_elsewhere_is_checked_there():
    """A state that a caller changes between steps has a Jacobian of its own."""
    model, start = with_friction(600.0, 1e-3)
    stepper = Stepper(model, 1e-3, start)
    stepper.step()
    stepper.state[2] = 0.0  # where it sticks
    with pytest.raises(SimulationError, match="not stable"):
        stepper.step()


@pytest.mark.parametrize("method", ["RK4", "RODASP"])
def test_dead_points_are_those_of_other_methods(method):
    inputs = {"strut_force": -1e6}
    ended = []
    for options in ({"method": method, "step": 1e-4}, {"method": "DOP853", "rtol": 1e-10}):
        with pytest.raises(SimulationError, match="tie_rod") as caught:
            simulate(MODEL, SPAN, START, inputs=inputs, **options)
        ended.append(caught.value.time)
    # both within what the last steps before a dead point leave of the time
    assert ended[0] == pytest.approx(ended[1], rel=1e-3)


def test_the_way_back_leads_to_the_start():
    there = run(1e-3, span=(0.0, 0.2))
    back = run(1e-3, span=(0.2, 0.0), start=there.y[:, -1])
    np.testing.assert_allclose(back.y[:, -1], START, rtol=0.0, atol=1e-5)


def test_a_model_that_is_at_rest_goes_on():
    model = System(import_module("kintrafo.generated.slider_crank"))
    assert run(1e-3, model=model, start=model.design_state).success


WRONG = [
    {"step": None},
    {"step": 0.0},
    {"step": -1e-3},
    {"step": np.nan},
    {"step": np.inf},
    {"step": 1e-9},
    {"rtol": 1e-6, "max_step": 0.1},
    {"max_step": [[1.0, 2.0], [3.0]]},
    {"atol": 1e-6},
    {"first_step": 1e-6},
    {"method": "BDF"},
    {"backend": "scipy"},
]


@pytest.mark.parametrize("wrong", WRONG)
def test_what_cannot_be_used(wrong, refused):
    refused(
        InputError, lambda: simulate(MODEL, SPAN, START, **{"method": "RK4", "step": 1e-3} | wrong)
    )
