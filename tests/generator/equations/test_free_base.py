"""Bodies that move freely: positions, unit quaternion, and speeds in their own axes."""

from dataclasses import dataclass, replace

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.equations.errors import ClosureError
from kintrafo.generator.declare.forces.force import Action, Force
from kintrafo.generator.declare.world import WORLD
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.skeleton import Skeleton
from mechanisms import every_closed_form
from mechanisms.free_bodies import (
    INERTIA,
    compared,
    freed,
    product,
    rig,
    rotation,
    state_near,
    tethered,
    thrown,
    unit_quaternion,
)
from oracle.constraints import skew
from scipy.integrate import solve_ivp
from scipy.optimize import minimize
from support.exported import needs_library
from support.models import Built, own

TENSOR = np.array(
    [
        [INERTIA[0], INERTIA[3], INERTIA[4]],
        [INERTIA[3], INERTIA[1], INERTIA[5]],
        [INERTIA[4], INERTIA[5], INERTIA[2]],
    ]
)
SPINNING = {
    "block_u": 2.0,
    "block_v": -1.0,
    "block_w": 3.0,
    "block_p": 4.0,
    "block_q": -7.0,
    "block_r": 5.0,
}
CLOSE = {"rtol": 1e-12, "atol": 1e-13}
FINE = {**CLOSE, "method": "DormandPrince"}


@pytest.fixture(scope="module")
def block():
    return kintrafo.System(own(thrown()))


@pytest.fixture(scope="module")
def box():
    return Built.of(rig(), own(rig()))


@pytest.fixture(scope="module")
def hanging(tmp_path_factory):
    """The body on a spring, with all that is compiled for ensembles and gradients."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("KINTRAFO_CACHE", str(tmp_path_factory.mktemp("cache")))
        return kintrafo.System(kintrafo.compile(tethered(), parameter_derivatives=True))


# -- one body -------------------------------------------------------------------------------------


def test_a_thrown_body_follows_eulers_equations(block):
    """Beside it: Euler's equations with a rotation matrix in place of the quaternion."""

    def rates(_, y):
        turned, omega = y[:9].reshape(3, 3), y[9:]
        return np.concatenate(
            [
                (turned @ skew(omega)).ravel(),
                np.linalg.solve(TENSOR, -np.cross(omega, TENSOR @ omega)),
            ]
        )

    start = block.state(**SPINNING)
    found = kintrafo.simulate(block, (0.0, 10.0), start, **FINE)
    expected = solve_ivp(
        rates,
        (0.0, 10.0),
        [*np.eye(3).ravel(), *start[10:]],
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
    ).y[:, -1]
    end = found.y[:, -1]
    turned = block.evaluate("orientations", end)[0]
    np.testing.assert_allclose(turned, expected[:9].reshape(3, 3), atol=1e-10)
    np.testing.assert_allclose(end[10:], expected[9:], atol=1e-10)
    fallen = start[7:10] * 10.0 - [0.0, 0.0, 0.5 * 9.81 * 100.0]
    np.testing.assert_allclose(end[:3], fallen, rtol=1e-10, atol=1e-8)
    np.testing.assert_allclose(rotation(end[3:7]), turned, atol=1e-12)


def test_its_coordinates_are_displacement_yaw_pitch_and_roll(block):
    yaw, pitch, roll = 0.7, -0.4, 1.9
    half = [
        np.array([np.cos(a / 2), *(np.sin(a / 2) * axis)])
        for a, axis in zip((yaw, pitch, roll), np.eye(3)[::-1], strict=True)
    ]
    e = product(product(half[0], half[1]), half[2])
    state = np.concatenate(([1.0, 2.0, 3.0], e, np.zeros(6)))
    np.testing.assert_allclose(
        block.evaluate("relative_coordinates", state), [1.0, 2.0, 3.0, yaw, pitch, roll], atol=1e-14
    )
    rates = np.array([0.3, -0.2, 0.5, 0.4, 0.6, -0.7])  # of the speeds; the slopes are along them
    moved = state + 1e-6 * block.evaluate("rhs", np.concatenate((state[:7], rates))) * (
        [1.0] * 7 + [0.0] * 6
    )
    change = (
        block.evaluate("relative_coordinates", moved)
        - block.evaluate("relative_coordinates", state)
    ) / 1e-6
    np.testing.assert_allclose(
        block.evaluate("relative_jacobian", state) @ rates, change, atol=1e-5
    )
    assert np.abs(block.equations.residuals([1.0, 2.0, 3.0, yaw, pitch, roll], state)).max() < 1e-14


@pytest.mark.parametrize(
    ("method", "more"),
    [("DormandPrince", {}), ("BDF", {}), ("RK4", {"step": 1e-2}), ("RODASP", {"step": 1e-2})],
)
def test_the_norm_stays_one_for_long(block, method, more):
    """Ten minutes and a thousand turns at ordinary accuracy; the term that keeps it has 1 s."""
    weightless = kintrafo.System(block.equations, {"gravity": 0.0})
    found = kintrafo.simulate(
        weightless,
        (0.0, 600.0),
        block.state(**SPINNING),
        method=method,
        t_eval=np.linspace(0.0, 600.0, 601),
        **more,
    )
    norm = np.linalg.norm(found.y[3:7], axis=0)
    assert np.abs(norm - 1.0).max() < 1e-4


def test_the_motion_does_not_depend_on_the_norm(block):
    """The quaternion of any length is the same rotation, and so are all rates but its own."""
    start = block.state(**SPINNING)
    start[3:7] = unit_quaternion(np.random.default_rng(0))
    longer = start.copy()
    longer[3:7] *= 1.5
    for function in ("orientations", "positions", "velocities", "forces"):
        np.testing.assert_allclose(
            block.evaluate(function, longer),
            block.evaluate(function, start),
            rtol=1e-14,
            atol=1e-14,
        )
    here, there = (block.evaluate("rhs", s) for s in (start, longer))
    np.testing.assert_allclose(
        np.delete(here, range(3, 7)), np.delete(there, range(3, 7)), rtol=1e-13, atol=1e-13
    )
    assert there[3:7] @ longer[3:7] < 0.0


def test_no_quaternion_is_no_rotation(block, refused):
    start = block.design_state.copy()
    start[3] = 0.0
    refused(ClosureError, lambda: block.evaluate("rhs", start))


def test_a_spinning_body_has_its_known_frequencies(block):
    """About a principal axis: what turns with it, and the nutation of Euler's equations."""
    moments, axes = np.linalg.eigh(TENSOR)
    omega = 6.0
    weightless = kintrafo.System(block.equations, {"gravity": 0.0})
    state = weightless.design_state.copy()
    state[10:] = omega * axes[:, 2]
    linear = kintrafo.linearise(weightless, state)
    nutation = omega * np.sqrt(
        (moments[2] - moments[0]) * (moments[2] - moments[1]) / (moments[0] * moments[1])
    )
    found = np.sort(np.abs(linear.eigenvalues.imag))
    # double zeros of free directions are the square root of rounding
    np.testing.assert_allclose(found[-8:], sorted([omega] * 6 + [nutation] * 2), rtol=1e-6)
    assert np.abs(linear.eigenvalues.real).max() < 1e-6 * omega
    assert len(linear.eigenvalues) == 12
    assert linear.steady
    np.testing.assert_allclose(weightless.eigenvalues(state), linear.eigenvalues)


# -- several bodies -------------------------------------------------------------------------------


def _close(found, expected, part=1e-11):
    np.testing.assert_allclose(
        found, expected, rtol=0.0, atol=part * np.abs(expected).max(initial=1.0)
    )


def test_equations_are_those_of_maximal_coordinates(box):
    for state, inputs, motion, expected, positions in compared(box, 4):
        assert np.abs(box.oracle.closure(motion).rate).max() < 1e-13
        _close(box("mass_matrix", state, inputs), expected.mass_matrix)
        _close(box("bias", state, inputs), expected.inertial)
        _close(box("forces", state, inputs), expected.applied)
        _close(box("rhs", state, inputs)[positions:], expected.accelerations)
        _close(
            box("global_jacobian", state, inputs).reshape(-1, 6, 12 + 2),
            np.roll(expected.jacobian, 3, axis=1),
        )


def test_outputs_are_those_of_the_oracle(box):
    for state, inputs, motion, expected, _ in compared(box, 3):
        signals = kintrafo.System(box.module).signals(state, inputs)
        jet = box.oracle.point(motion, "limb", np.array([0.8, 0.5, 0.6]))
        acceleration = jet.rows @ expected.body_accelerations.ravel() + jet.convective
        for what, value in (
            ("place", jet.value),
            ("velocity", jet.rate),
            ("acceleration", acceleration),
        ):
            _close([float(signals[f"tip_{what}_{a}"]) for a in "xyz"], value)
        hook = box.oracle.point(motion, "box", np.array([-0.1, -0.2, 0.9]))
        eye = box.oracle.point(motion, "ball", np.array([0.45, 0.7, 0.55]))
        _close(signals["gap"], np.linalg.norm(eye.value - hook.value))
        _close(signals["gap_rate"], (eye - hook).norm().rate[0])


@pytest.mark.parametrize(
    "model",
    [every_closed_form.spatial_four_bar("spatial"), every_closed_form.given_telescope()],
    ids=lambda model: model.name,
)
def test_loops_hang_on_it(model):
    """Mechanisms that usually have a ground, on a free body; the oracle closes their loops, too."""
    model = freed(model)
    built = Built.of(model, own(model, arrays=True, derivatives=False))
    for state, inputs, motion, expected, positions in compared(built, 3, 0.1):
        assert np.abs(built.oracle.closure(motion).value).max() < 1e-13
        assert np.abs(built.oracle.closure(motion).rate).max() < 1e-11
        _close(built("rhs", state, inputs)[positions:], expected.accelerations, 1e-10)
        _close(built("mass_matrix", state, inputs), expected.mass_matrix)


def test_the_jacobian_is_the_derivative(box):
    random = np.random.default_rng(1)
    for _ in range(2):
        state, inputs = state_near(box, random), random.uniform(-5.0, 5.0, 1)
        found, step = box("rhs_jacobian", state, inputs), 1e-5
        ends = [
            [box("rhs", state + s * step * d, inputs) for s in (1, -1)] for d in np.eye(state.size)
        ]
        differences = np.array([(a - b) / (2.0 * step) for a, b in ends]).T
        _close(found, differences, 1e-8)


# -- functions of states --------------------------------------------------------------------------


def test_rest_and_modes_are_those_of_a_body_on_a_spring(hanging):
    """Against the least potential energy, and its curvature with the body's mass and inertia."""
    given = hanging.parameters
    center, hook, post = (
        np.array([given[f"{p}_{a}"] for a in "xyz"]) for p in ("block_com", "hook", "post")
    )

    def energy(at, e):
        length = np.linalg.norm(center + at + rotation(e) @ (hook - center) - post)
        return (
            0.5 * given["tether_stiffness"] * (length - given["tether_free_length"]) ** 2
            + given["block_mass"] * given["gravity"] * at[2]
        )

    found = kintrafo.rest(hanging)
    at, e = np.array(found[:3]), np.array(found[3:7])
    assert np.linalg.norm(e) == pytest.approx(1.0, abs=1e-14)
    lowest = minimize(
        lambda y: energy(y[:3], y[3:] / np.linalg.norm(y[3:])), np.array(found[:7]), method="BFGS"
    )
    assert energy(at, e) <= lowest.fun + 1e-9

    def near(moved):
        angle = np.linalg.norm(moved[3:])
        turn = np.array([np.cos(angle / 2), *(0.5 * np.sinc(angle / (2.0 * np.pi)) * moved[3:])])
        return energy(at + rotation(e) @ moved[:3], product(e, turn))

    step = 1e-3
    sides = [np.array(s) * step for s in ((1, 1), (1, -1), (-1, 1), (-1, -1))]
    axes = np.eye(6)
    curvature = np.array(
        [
            [
                sum(s[0] * s[1] / step**2 * near(s[0] * a + s[1] * b) for s in sides)
                / (4.0 * step**2)
                for b in axes
            ]
            for a in axes
        ]
    )
    inertia = np.zeros((6, 6))
    inertia[:3, :3], inertia[3:, 3:] = given["block_mass"] * np.eye(3), TENSOR
    squares = np.sort(np.abs(np.linalg.eigvals(np.linalg.solve(inertia, curvature))))
    linear = kintrafo.linearise(hanging, found)
    assert linear.steady
    frequencies = np.sort(np.abs(linear.eigenvalues.imag))[::2]
    np.testing.assert_allclose(frequencies[1:], np.sqrt(squares[1:]), rtol=1e-4)


def test_modes_do_not_depend_on_the_norm(hanging, refused):
    """Twice the quaternion is the same attitude."""
    random = np.random.default_rng(4)
    state = hanging.design_state.copy()
    state[3:7], state[7:] = unit_quaternion(random), random.normal(size=6)
    longer, none = state.copy(), state.copy()
    longer[3:7] *= 2.0
    none[3:7] = 0.0
    for eigenvalues in (hanging.eigenvalues, lambda s: kintrafo.linearise(hanging, s).eigenvalues):
        # rounding of the length, in simple eigenvalues
        np.testing.assert_allclose(eigenvalues(longer), eigenvalues(state), rtol=1e-9)
        with refused(ClosureError):
            eigenvalues(none)


def test_an_ensemble_is_made_of_single_motions(hanging):
    times, masses = np.linspace(0.0, 2.0, 5), [2.0, 3.0, 4.5]
    start = hanging.state(block_q=1.5, block_u=0.3)
    several = kintrafo.ensemble(
        hanging,
        {"block_mass": masses},
        (0.0, 2.0),
        start,
        signals=("hook_place_z", "block_e2"),
        t_eval=times,
        **CLOSE,
    )
    for k, mass in enumerate(masses):
        alone = kintrafo.simulate(
            kintrafo.System(hanging.equations, {"block_mass": mass}),
            (0.0, 2.0),
            start,
            t_eval=times,
            **FINE,
        )
        np.testing.assert_allclose(several["block_e2"][k], alone.y[5], atol=1e-9)
        np.testing.assert_allclose(
            several["hook_place_z"][k], alone.signals["hook_place_z"], atol=1e-9
        )


def test_gradients_of_a_motion_are_differences(hanging):
    span, start = (0.0, 1.0), hanging.state(block_q=1.5, block_u=0.3)
    times = np.linspace(*span, 4)

    def mean(**changes):
        changed = kintrafo.System(hanging.equations, {**hanging.parameters, **changes})
        run = kintrafo.simulate(changed, span, start, t_eval=times, **FINE)
        return run.signals["hook_place_z"][-1]

    by = {
        name: (mean(**{name: value + 1e-5}) - mean(**{name: value - 1e-5})) / 2e-5
        for name, value in hanging.parameters.items()
        if name in ("block_mass", "block_inertia_xy", "tether_stiffness")
    }
    weights = np.array([0.0, 0.0, 0.0, 1.0])
    back = kintrafo.motion_gradient(
        hanging, span, start, {"hook_place_z": weights}, t_eval=times, **CLOSE
    )
    forth = kintrafo.motion_sensitivity(
        hanging, span, start, [*by], signals=["hook_place_z"], t_eval=times, **CLOSE
    )
    for name, expected in by.items():
        assert back.by[name] == pytest.approx(expected, rel=1e-6, abs=1e-9)
        assert forth.by[name]["hook_place_z"][-1] == pytest.approx(expected, rel=1e-6, abs=1e-9)


def test_events_and_steps_of_one_length(block):
    def ground(_, state):
        return state[2] + 5.0

    ground.terminal = True
    start = block.state(**SPINNING)
    found = kintrafo.simulate(block, (0.0, 10.0), start, events=[ground], **FINE)
    fall = (3.0 + np.sqrt(9.0 + 2.0 * 9.81 * 5.0)) / 9.81
    assert found.t[-1] == pytest.approx(fall, rel=1e-10)
    stepper = kintrafo.Stepper(block, 1e-3, start)
    for _ in range(500):
        stepper.step()
    expected = kintrafo.simulate(block, (0.0, 0.5), start, **FINE).y[:, -1]
    np.testing.assert_allclose(stepper.state, expected, atol=1e-7)


@needs_library
@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_other_programs_simulate_it(hanging, tmp_path, kind):
    fmpy = pytest.importorskip("fmpy")
    path, start = tmp_path / "hanging.fmu", hanging.state(block_q=1.5, block_u=0.3)
    kintrafo.export_model(hanging, path, "fmu", state=start)
    found = fmpy.simulate_fmu(
        str(path),
        stop_time=1.0,
        output_interval=0.5,
        fmi_type=kind,
        relative_tolerance=1e-12,
        output=["hook_place_z"],
    )
    expected = kintrafo.simulate(hanging, (0.0, 1.0), start, t_eval=[0.0, 0.5, 1.0], **FINE)
    np.testing.assert_allclose(found["hook_place_z"], expected.signals["hook_place_z"], atol=1e-8)


def test_its_points_are_drawn_where_they_are(box):
    system, random = kintrafo.System(box.module), np.random.default_rng(2)
    state = state_near(box, random)
    skeleton = Skeleton(system)
    motion = box.motion(state, np.zeros(1))
    for body in ("box", "ball", "limb"):
        for name, place in zip(skeleton.bodies[body], skeleton.places(state)[body], strict=True):
            if f"{name}_x" in system.parameters:
                design = np.array([system.parameters[f"{name}_{a}"] for a in "xyz"])
                _close(place, box.oracle.point(motion, body, design).value)


# -- errors ---------------------------------------------------------------------------------------


def test_a_strut_from_the_world_is_refused(refused):
    """It would take no freedom, but what closes through the world is solved on no base."""
    model = thrown()
    (joint,) = model.independent
    barrel, piston = (
        g.Body(n, 0.2, at, (0.1, 0.1, 0.1))
        for n, at in (("barrel", (0.6, 0.1, 1.5)), ("piston", (0.5, 0.0, 1.2)))
    )
    post, hook = g.Point("post", (0.6, 0.1, 1.6)), g.Point("hook", (0.5, -0.1, 1.1))
    joints = (
        joint,
        g.Universal("post_joint", WORLD, barrel, post, shaft=g.Line(post, hook)),
        g.Cylindrical(
            "stroke",
            barrel,
            piston,
            g.Line(hook, post),
            g.Distance("strut_length", 0.54, "length of the strut"),
            angle_to=g.Point("mark", (0.7, 0.0, 1.2)),
        ),
        g.Spherical("hook_joint", piston, joint.second, hook),
    )
    mechanism = replace(model.mechanism, joints=joints)
    refused(
        g.DeclarationError,
        lambda: generate(
            replace(model, mechanism=mechanism, massive=(joint.second,)), derivatives=False
        ),
    )


def test_a_force_cannot_act_along_all_its_speeds_at_once(as_stored):
    @dataclass(frozen=True)
    class Push(Force):
        @property
        def identity(self):
            return "force", "push"

        def act(self, at):
            return Action({at.coordinate("flight"): 1.0})

    model = thrown()
    pushed = replace(model, mechanism=replace(model.mechanism, forces=(Push(),)))
    with pytest.raises(g.DeclarationError) as found:
        generate(pushed)
    line = Push.act.__code__.co_firstlineno + 1
    as_stored(str(found.value).replace(f"line {line}:", "line LINE:"))


def test_names_of_its_states_are_taken(refused):
    model = thrown()
    (joint,) = model.independent
    named = (joint.coordinate("x", "block_x", "x"),)
    refused(g.DeclarationError, lambda: replace(model.mechanism, coordinates=named))
