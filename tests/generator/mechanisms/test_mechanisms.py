"""Every declared mechanism against maximal coordinates: poses, velocities, equations of motion.

Beside the mechanisms that ship there are those of `every_closed_form`, in which no axis and no
plane is a special one. The states are random, within all but the last part of the reach; closer to
a dead point the rounding of any method grows without bound (`test_mechanisms_branches`).
"""

from dataclasses import dataclass, replace
from functools import cache, cached_property

import mpmath
import numpy as np
import pytest
from kintrafo.generator import FORWARD, AlongLine
from kintrafo.generator.closed_forms.catalogue import STEPS
from kintrafo.generator.closed_forms.elbow import PlaceElbow
from kintrafo.generator.closed_forms.free_body import PlaceFree
from kintrafo.generator.closed_forms.parallel_links import ParallelLinks
from kintrafo.generator.closed_forms.passive_turn import PlacePassive
from kintrafo.generator.closed_forms.scotch_yoke import ScotchYoke
from kintrafo.generator.closed_forms.single_cross import SingleCross
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import MODELS as SHIPPED
from kintrafo.generator.mechanisms import chains, held_by_rods
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.generator.planning.plan import CataloguePlan
from mechanisms import every_closed_form
from oracle.constraints import Array
from oracle.maximal import Motion, Oracle
from oracle.reference import completed, further_parameters, general_parameters, spring_parameters
from scipy.integrate import solve_ivp
from support import models
from support.changes import changed
from support.models import Built, needs_gcc, own, shipped
from support.symbolic import constants_of, derivatives_of, python

COMPILED_HERE = (*every_closed_form.MODELS, n_four_bar(3))
MODELS = {m.name: m for m in (*SHIPPED, *COMPILED_HERE)}
OWN = {m.name for m in COMPILED_HERE}
# `test_jacobians` compares those of the others, and derivatives by inputs; the pull rod is the push
# rod the other way round, and the rigid axle a steered one without its linkage
DIFFERENTIATED = [
    *(m.name for m in SHIPPED if not m.name.startswith(("macpherson", "pull_rod", "rigid_axle"))),
    *every_closed_form.DIFFERENTIATED,
    "four_bars_3",
]
SEEDS = range(3)  # 0 is the declaration's own geometry
STATES = 4  # for each geometry


SCALES = {
    "m": 0.02,
    "m/s": 0.3,
    "m/s^2": 5.0,
    "rad": 0.2,
    "rad/s": 2.0,
    "rad/s^2": 10.0,
    "N": 100.0,
    "N m": 1.0,
}
"""Size of the inputs by unit."""


@dataclass(frozen=True)
class At:
    """A model at a state and inputs, with the motion that it computes for its bodies."""

    built: Built
    state: Array
    inputs: Array
    motion: Motion

    def __call__(self, function):
        return self.built(function, self.state, self.inputs)

    @property
    def given(self):
        """Accelerations of the prescribed joints."""
        named = self.built.named(self.inputs)
        motions = self.built.model.motions
        return {joint: named[motion.rates[1]] for joint, motion in motions.items()}

    def reduced(self, **given):
        """Solve the equations of motion with the oracle, some accelerations given otherwise."""
        named = self.built.named(self.inputs)
        return self.built.oracle.reduced(self.motion, named, self.given | given)

    @cached_property
    def solved(self):
        """The reference of several tests."""
        return self.reduced()


# -- models, geometries, states -------------------------------------------------------------------


@pytest.fixture(scope="session")
def derive():
    return lambda name: models.derive(MODELS[name], derivatives=False)


@pytest.fixture(scope="session")
def module():

    @cache
    def found(name):
        if name in OWN:
            return own(MODELS[name], derivatives=name in DIFFERENTIATED)
        return shipped(MODELS[name])

    return found


def each_model(names=MODELS):
    """Parametrise a test by model."""
    parameters = [pytest.param(n, marks=[needs_gcc] if n in OWN else []) for n in names]
    return pytest.mark.parametrize("name", parameters)


def places(name, found, seeds=SEEDS):
    """Return geometries of a model, each at random states, searched for once."""
    for seed in seeds:
        if (name, seed) not in _PLACES:
            _PLACES[name, seed] = _places(name, seed, found)
    return [at for seed in seeds for at in _PLACES[name, seed]]


_PLACES = {}


def _places(name, seed, found):
    rng = np.random.default_rng([seed, *name.encode()])
    built = geometry(MODELS[name], found, rng) if seed else Built.of(MODELS[name], found)
    return [random_place(built, rng) for _ in range(STATES)]


def geometry(model, found, rng):
    """Return a model of other dimensions; its loops are about as far from dead points."""
    reference = margins(Built.of(model, found))
    for _ in range(100):
        built = Built.of(model, found, other_values(model, rng))
        if (margins(built) > 0.4 * reference).all():
            return built
    raise AssertionError(f"{model.name}: no other geometry found")


def other_values(model, rng):
    """Return other values of all parameters that may be chosen freely."""
    if model.name.startswith("macpherson"):
        car = completed(general_parameters(rng, offset=rng.uniform(0.0, 0.08)))
        return {p.name: car[p.name] for p in model.mechanism.parameters}
    points = {
        p.name[:-2] for p in model.mechanism.parameters if p.unit == "m" and p.name[-2] == "_"
    }
    places = [p.default for p in model.mechanism.parameters if p.name[:-2] in points]
    oblique = any(p.name.startswith("normal_") for p in model.mechanism.parameters)
    inertia = {b.name: rng.uniform(0.7, 1.4) for b in model.mechanism.bodies}
    if model.mechanism.derived:  # the bodies of a copy read the parameters of what is copied
        owners = {p.name.split("_inertia_")[0]: p for p in model.mechanism.parameters}
        inertia |= {owner: rng.uniform(0.7, 1.4) for owner in owners}
    new = {}
    for p in model.mechanism.parameters:
        if p.name[:-2] in points:
            new[p.name] = p.default + 0.02 * np.ptp(places) * rng.standard_normal()
        elif p.unit == "1" and p.name[-2] != "_":  # a switch
            new[p.name] = p.default
        elif p.unit == "1":
            # directions; those of a planar loop must stay in its plane (see test_assumptions)
            new[p.name] = p.default + (0.0 if oblique else 0.1 * rng.standard_normal())
        elif p.unit == "kg m^2":
            new[p.name] = p.default * inertia[p.name.split("_inertia_")[0]]
        else:
            new[p.name] = p.default * rng.uniform(0.8, 1.2)
    if model.name.startswith("double_wishbone_general"):
        ends = (np.array([new[f"spring_{end}_{a}"] for a in "xyz"]) for end in ("top", "seat"))
        new |= further_parameters(rng, "damper", float(np.linalg.norm(np.subtract(*ends))))
    for name in [name for name in new if name.endswith("spring_table_first_force")]:
        prefix = name.removesuffix("spring_table_first_force")
        ends = (
            np.array([new[f"{prefix}spring_{end}_{a}"] for a in "xyz"]) for end in ("top", "seat")
        )
        length = float(np.linalg.norm(np.subtract(*ends)))
        new |= spring_parameters(rng, length, prefix)
    return new


def margins(built):
    """Return what must be positive, at the design position."""
    state = np.concatenate((built.design, np.zeros(built.size)))
    return built("margins", state)


def random_place(built, rng):
    """Return a random state within the reach, at most where the design's margins are a tenth."""
    least = 0.1 * margins(built)
    states = list(built.module.STATE.values())[: built.size]
    spread = np.array([1.2 if entry["unit"] == "rad" else 0.1 for entry in states])
    units = [entry["unit"] for entry in built.module.INPUTS.values()]
    for _ in range(1000):
        q = built.design + spread * rng.uniform(-1.0, 1.0, built.size)
        inputs = np.array([SCALES[unit] * rng.standard_normal() for unit in units])
        state = np.concatenate((q, 4.0 * spread * rng.standard_normal(built.size)))
        if (built("margins", state, inputs) > least).all():
            return At(built, state, inputs, built.motion(state, inputs))
    raise AssertionError(f"{built.model.name}: no state in reach found")


# -- kinematics ------------------------------------------------------------------------------------


@each_model()
def test_the_design_position_is_the_declared_one(name, module):
    for built in (at.built for at in places(name, module(name))[::STATES]):
        motion = built.motion(np.concatenate((built.design, np.zeros(built.size))), None)
        # up to ninety operations on numbers of order one, each off by half of 2.2e-16 at most
        np.testing.assert_allclose(motion.position[1:], built.oracle.centers[1:], atol=1e-14)
        np.testing.assert_allclose(motion.rotation, built.at_design.rotation, atol=1e-14)
        assert not motion.twist.any()


@each_model()
def test_bodies_fulfil_all_joints(name, module):
    # 1e-13: a hundred roundings of lengths below 1 m, times up to five near the end of the reach
    for at in places(name, module(name)):
        closure = at.built.oracle.closure(at.motion)
        np.testing.assert_allclose(closure.value, 0.0, atol=1e-13)
        fastest = np.abs(at.motion.twist).max()
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-13 * fastest)


@each_model()
def test_rotations_are_rotations(name, module):
    for at in places(name, module(name)):
        for rotation in at.motion.rotation:
            np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-13)
            assert np.linalg.det(rotation) > 0.0


@each_model()
def test_bodies_stand_and_move_as_the_state_says(name, module):
    for at in places(name, module(name)):
        driven = [at.built.oracle.driven(at.motion, j.name) for j in at.built.model.independent]
        q, rates = np.split(at.state, 2)
        for jet, coordinate, rate in zip(driven, q, rates, strict=True):
            assert whole_turns_off(jet, coordinate) < 1e-13
            assert jet.rate[0] == pytest.approx(rate, rel=1e-12, abs=1e-12)


def whole_turns_off(jet, value):
    """Return how far a coordinate is from a value; angles count up to whole turns."""
    return abs(np.remainder(jet.value[0] - value + np.pi, 2.0 * np.pi) - np.pi)


def reported(at):
    """Return all relative coordinates by the oracle."""
    return [
        at.built.oracle.coordinate(at.motion, c.joint, c.kind)
        for c in at.built.model.mechanism.coordinates
    ]


@each_model()
def test_relative_coordinates_are_those_of_the_joints(name, module):
    for at in places(name, module(name)):
        for value, jet in zip(at("relative_coordinates"), reported(at), strict=True):
            assert whole_turns_off(jet, value) < 1e-13


@each_model()
def test_residuals_vanish_at_the_relative_coordinates_only(name, module):
    for at in places(name, module(name)):
        beta = at("relative_coordinates")
        left = at.built.residuals(beta, at.state, at.inputs)
        np.testing.assert_allclose(left, 0.0, atol=1e-13)
        # each sees its own coordinate: a step of 1e-3 leaves much more than rounding
        for i in range(len(beta)):
            moved = beta + 1e-3 * np.eye(len(beta))[i]
            assert abs(at.built.residuals(moved, at.state, at.inputs)[i]) > 1e-6


# -- Jacobians -------------------------------------------------------------------------------------


@each_model()
def test_global_jacobian_is_the_twists_for_unit_rates(name, module):
    for at in places(name, module(name)):
        jacobian = oracle_jacobian(at)
        found = at("global_jacobian").reshape(-1, 6, at.built.size)
        found = np.concatenate((found[:, 3:], found[:, :3]), axis=1)
        np.testing.assert_allclose(found, jacobian, atol=1e-12 * np.abs(jacobian).max())


def oracle_jacobian(at):
    """Return the twists of the massive bodies for unit rates of the independent coordinates."""
    bodies = [b.name for b in at.built.model.mechanism.bodies[1:]]
    massive = [bodies.index(b) for b in at.built.module.MASSIVE_BODIES]
    return reduced(at).jacobian[massive]


@each_model()
def test_relative_jacobian_is_the_rates_for_unit_rates(name, module):
    for at in places(name, module(name)):
        columns = reduced(at).jacobian.reshape(-1, at.built.size)
        found = at("relative_jacobian")
        for row, jet in zip(found, reported(at), strict=True):
            if not np.isnan(jet.rows).any():  # of a telescope's angle the oracle has no rate
                expected = jet.rows[0] @ columns
                np.testing.assert_allclose(row, expected, atol=1e-12 * np.abs(found).max())


@each_model()
def test_absolute_times_relative_is_global_jacobian(name, module):
    found = module(name)
    if not hasattr(found, "absolute_jacobian"):
        pytest.skip("a body hangs on joints whose coordinates are not reported")
    for at in places(name, found):
        expected = at("global_jacobian")
        product = at("absolute_jacobian") @ at("relative_jacobian")
        np.testing.assert_allclose(product, expected, atol=1e-12 * np.abs(expected).max())


@each_model(DIFFERENTIATED)
def test_state_jacobian_of_the_right_hand_side_is_exact(name, module, derive):
    # differences of the program in 50 digits, with errors below 1e-20; in a geometry of which
    # nothing is parallel, upright or equal that need not be
    at, derived = places(name, module(name), [1])[0], derive(name)
    found = at("rhs_jacobian")
    with mpmath.workdps(50):
        values = constants_of(derived, at.built.parameters) | at.built.named(at.inputs)
        values |= dict(zip(at.built.module.STATE, map(mpmath.mpf, at.state), strict=True))
        expected = derivatives_of(derived.functions["rhs"], values, at.built.module.STATE)
    scale = np.abs(expected).max(axis=1, keepdims=True)
    np.testing.assert_allclose(found / scale, expected / scale, atol=1e-11)


def test_what_is_differentiated_has_every_step_of_the_catalogue():
    iterating = (*held_by_rods.MODELS, *chains.MODELS)  # looked at in tests of their own
    models = (*map(MODELS.get, DIFFERENTIATED), *iterating, MODELS["macpherson"])
    found = {type(action) for model in models for action in CataloguePlan.of(model).steps}
    # two that have no test of their derivatives, two with nothing of their own to differentiate,
    # one that is in no model here, and one that has no equations yet
    without = {PlaceElbow, ScotchYoke, SingleCross, ParallelLinks, PlacePassive, PlaceFree}
    assert found >= STEPS - without


# -- dynamics --------------------------------------------------------------------------------------


def reduced(at, **given):
    """Solve the equations of motion with the oracle."""
    return at.reduced(**given) if given else at.solved


@each_model()
def test_mass_matrix_and_forces_are_those_of_the_maximal_coordinates(name, module):
    for at in places(name, module(name)):
        oracle = reduced(at)
        for function, expected in (
            ("mass_matrix", oracle.mass_matrix),
            ("bias", oracle.inertial),
            ("forces", oracle.applied),
        ):
            # 1e-11: forces and bias are sums whose terms may be larger than what remains, which
            # is nothing at all for the bias of equal rockers: rounding of mass times rate squared
            terms = np.abs(oracle.mass_matrix).max() * np.square(at.state[at.built.size :]).max()
            allowed = 1e-11 * np.abs(expected).max() + 1e-15 * terms
            np.testing.assert_allclose(at(function), expected, atol=allowed, err_msg=function)


@each_model()
def test_accelerations_are_those_of_the_maximal_coordinates(name, module):
    for at in places(name, module(name)):
        oracle = reduced(at)
        allowed = 1e-11 * acceleration_scale(oracle)
        np.testing.assert_allclose(
            at("rhs"), [*at.state[at.built.size :], *oracle.accelerations], rtol=0.0, atol=allowed
        )


def acceleration_scale(oracle):
    """Return how large accelerations would be if forces and inertia did not cancel."""
    inverse = np.abs(np.linalg.inv(oracle.mass_matrix))
    return float((inverse @ (np.abs(oracle.applied) + np.abs(oracle.inertial))).max())


@each_model(n for n, m in MODELS.items() if m.held)
def test_held_joints_stand_still(name, module):
    for at in places(name, module(name)):
        (variant, joints), *_ = MODELS[name].held.items()
        moving = [MODELS[name].prescribed[j].name for j in joints]
        still = at.inputs.copy()
        for i, entry in enumerate(at.built.module.INPUTS):
            if entry in {f"{m}_{kind}" for m in moving for kind in ("velocity", "acceleration")}:
                still[i] = 0.0
        halted = At(at.built, at.state, still, at.built.motion(at.state, still))
        oracle = reduced(halted)
        np.testing.assert_allclose(
            at(f"rhs_{variant}")[at.built.size :],
            oracle.accelerations,
            rtol=0.0,
            atol=1e-11 * acceleration_scale(oracle),
        )


@each_model(n for n, m in MODELS.items() if m.mechanism.elements)
def test_lengths_of_force_elements(name, module):
    for at in places(name, module(name)):
        signals = dict(zip(at.built.module.SIGNALS, at("signals"), strict=True))
        for element in at.built.model.mechanism.elements:
            path = at.built.oracle.length(at.motion, element)
            shown = ("angle", "angular_velocity") if element.turns else ("length", "velocity")
            value, rate = (signals[f"{element.name}_{what}"] for what in shown)
            # 1e-14 rad: a twist is the small difference of two angles
            assert value == pytest.approx(path.value[0], rel=1e-13, abs=1e-14)
            assert rate == pytest.approx(path.rate[0], rel=1e-12, abs=1e-13)


CONSERVATIVE = [n for n in MODELS if not n.startswith("macpherson")]
START = {
    "andrews": 100.0,
    "oblique_piston": 0.3,
    "oblique_trammel": 0.3,
    "pushed_slider": 0.3,
    "excavator": 0.3,
}
"""Rates at the start where they are not 2 rad/s (or m/s)."""
AFLOAT = {
    "double_wishbone": {"tyre_rate": 0.0, "spring_free_length": 0.44},
    "double_wishbone_general": {"tyre_rate": 0.0, "spring_free_length": 0.44},
    "double_wishbone_general_pitman_arm": {"tyre_rate": 0.0, "spring_free_length": 0.44},
    "push_rod": {"tyre_rate": 0.0, "spring_free_length": 0.291},
    "pull_rod": {"tyre_rate": 0.0, "spring_free_length": 0.318},
    "multi_link": {"tyre_rate": 0.0, "spring_free_length": 0.291},
    "trailing_arm": {"tyre_rate": 0.0, "spring_free_length": 0.3},
    "front_axle": {"tyre_rate": 0.0, "spring_free_slide": 0.18},
    "rigid_axle": {
        name: value
        for prefix in ("", "left_")
        for name, value in ((f"{prefix}tyre_rate", 0.0), (f"{prefix}spring_free_length", 0.258))
    },
}
"""Suspensions without a road, on springs that carry the arms only; others have no tyres alone."""


@each_model(CONSERVATIVE)
def test_energy_stays_where_nothing_dissipates(name, module):
    built = Built.of(MODELS[name], module(name))
    lossless = {p: 0.0 for p in built.parameters if "damper" in p and not p.endswith("_speed")}
    lossless |= AFLOAT.get(name, {p: 0.0 for p in built.parameters if p.endswith("tyre_rate")})
    built = Built.of(MODELS[name], module(name), lossless)
    inputs = np.zeros(len(built.module.INPUTS))
    start = np.concatenate((built.design, np.full(built.size, START.get(name, 2.0))))
    result = solve_ivp(
        lambda _, y: built("rhs", y, inputs), (0.0, 0.1), start, "DOP853", rtol=1e-12, atol=1e-12
    )
    assert result.success
    energies = [built.oracle.energy(built.motion(y, inputs)) for y in result.y.T]
    kinetic = [kinetic_energy(built, y) for y in result.y.T]
    # the integrator's tolerance, over some hundred steps
    assert np.ptp(energies) < 1e-9 * max(kinetic)
    rates = result.y[built.size :]
    assert (np.ptp(rates, axis=1) > 1e-3 * np.abs(rates).max(axis=1)).all()  # it does move


def kinetic_energy(built, state):
    """Return half of q' M q'."""
    rates = state[built.size :]
    return float(0.5 * rates @ built("mass_matrix", state) @ rates)


# -- declarations ----------------------------------------------------------------------------------


def four_bar(name, **changes):
    """Return the four-bar that ships, declared otherwise."""
    model = MODELS["four_bar"]
    return replace(model, name=name, mechanism=replace(model.mechanism, name=name, **changes))


@needs_gcc
def test_a_hardpoint_may_be_carried_by_two_bodies():
    # the seat of the second spring is where the centre of the coupler is, but on the rocker
    mechanism = MODELS["four_bar"].mechanism
    coupler, rocker = mechanism.body("coupler"), mechanism.body("rocker")
    ground = mechanism.body("ground")
    ends = (ground, ground.center), (rocker, coupler.center)
    spring = replace(mechanism.elements[0], name="second", path=AlongLine(*ends))
    model = four_bar("two_springs", forces=(*mechanism.forces, spring))
    built = Built.of(model, own(model, derivatives=False))
    state, inputs = np.array([0.4, 1.0]), np.zeros(1)
    length = built.oracle.length(built.motion(state, inputs), spring).value[0]
    signals = dict(zip(built.module.SIGNALS, built("signals", state, inputs), strict=True))
    assert signals["second_length"] == pytest.approx(length, rel=1e-13)


@pytest.mark.parametrize("joint", ["A", "B", "C", "D"])
@pytest.mark.parametrize("counted", [False, True], ids=["from design", "to a point"])
def test_every_angle_of_a_planar_loop_can_be_reported(joint, *, counted):
    """The pin at which the loop closes, too; also where the angle counts to a hardpoint."""
    mechanism = MODELS["four_bar"].mechanism
    plain = declared = mechanism.joint(joint)
    if counted:
        declared = replace(plain, angle_to=plain.second.center, angle_from=FORWARD)
    model = changed(MODELS["four_bar"], (plain, declared))
    kept = (c for c in model.mechanism.coordinates if c.joint.name in {"A"} - {joint})
    coordinates = (*kept, declared.angle("shown", "angle"))
    mechanism = replace(model.mechanism, name="reported", coordinates=coordinates)
    model = replace(model, name="reported", mechanism=mechanism)
    derived = generate(model, derivatives=False)
    given = {p.name: p.default for p in mechanism.parameters}
    constants = constants_of(derived, given)
    (crank, _), shown = derived.state, derived.functions["relative_coordinates"]
    oracle = Oracle(model, given)
    for turn in np.linspace(-3.0, 3.0, 7):
        start = oracle.driven(Built(model, None, given).at_design, "A").value[0]
        values = constants | {crank.name: start + turn, f"{crank.name}_rate": 0.0}
        pose = motion_of(derived, values | {"crank_torque": 0.0})
        angle = dict(zip(shown.labels, python(shown)(values), strict=True))["shown"]
        expected = oracle.coordinate(pose, declared, "angle")
        assert whole_turns_off(expected, float(angle)) < 1e-13


def motion_of(derived, values):
    """Return poses and twists of all bodies, from the symbolic program."""

    def found(name, *shape):
        numbers = python(derived.functions[name])(values)
        return np.array([float(n) for n in numbers]).reshape(-1, *shape)

    return Motion(
        np.concatenate((np.zeros((1, 3)), found("positions", 3))),
        np.concatenate((np.eye(3)[None], found("orientations", 3, 3))),
        np.concatenate((np.zeros((1, 6)), np.roll(found("velocities", 6), 3, axis=1))),
    )
