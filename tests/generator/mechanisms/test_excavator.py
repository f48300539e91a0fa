"""The excavator: its cylinders, its statics and its energy, by hand and by other formulations."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from changes import changed, named
from kintrafo.generated import excavator, excavator_lifting
from kintrafo.generator import Actuator, AlongLine, ForceElement, Point, Weight
from kintrafo.generator.closed_forms.rpr import RPR
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms.excavator import EXCAVATOR, MODELS
from kintrafo.generator.planning.plan import CataloguePlan
from own_models import Built
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from symbolic import constants_of, python

if TYPE_CHECKING:
    from oracle.constraints import Array

DIGGING, CARRYING = (
    Built.of(m, e) for m, e in zip(MODELS, (excavator, excavator_lifting), strict=True)
)
CYLINDERS = ("boom", "arm", "bucket")
PINS = {
    "boom": (("chassis", "boom_barrel_pin"), ("boom", "boom_rod_pin")),
    "arm": (("boom", "arm_barrel_pin"), ("arm", "arm_rod_pin")),
    "bucket": (("arm", "bucket_barrel_pin"), ("rocker", "knee")),
}
GRAVITY = DIGGING.parameters["gravity"]


def state_at(strokes: Array, rates: Any = (0.0, 0.0, 0.0)) -> Array:
    return np.array([*strokes, *rates])


def strokes_in_reach(count: int) -> Array:
    """Return strokes over most of the range of the cylinders, m."""
    rng = np.random.default_rng(7)
    return rng.uniform((-0.55, -0.45, -0.35), (0.55, 0.85, 0.55), (count, 3))


STROKES = strokes_in_reach(40)
EPSILON = 2.0**-52


def place(name: str) -> Array:
    """Return a hardpoint at the design position."""
    return np.array([DIGGING.parameters[f"{name}_x"], 0.0, DIGGING.parameters[f"{name}_z"]])


def carried(body: str, point: str, state: Array) -> Array:
    """Return where a body has taken a hardpoint."""
    if body == "chassis":
        return place(point)
    index = excavator.BODIES.index(body)
    center = excavator.positions(state)[index]
    found: Array = center + excavator.orientations(state)[index] @ (
        place(point) - place(f"{body}_com")
    )
    return found


# -- kinematics -----------------------------------------------------------------------------------


@pytest.mark.parametrize("cylinder", CYLINDERS)
def test_a_stroke_is_the_change_of_the_distance_of_the_pins(cylinder: str) -> None:
    for strokes in STROKES:
        state = state_at(strokes)
        low, high = (carried(*pin, state) for pin in PINS[cylinder])
        design = np.linalg.norm(place(PINS[cylinder][1][1]) - place(PINS[cylinder][0][1]))
        stroke = strokes[CYLINDERS.index(cylinder)]
        assert np.linalg.norm(high - low) - design == pytest.approx(stroke, abs=1e-14)


def test_signs_are_those_of_the_table() -> None:
    """Extended, the boom rises, the arm comes in, and the bucket curls in."""
    angles = ("boom_angle", "arm_angle", "bucket_angle")
    names = list(excavator.RELATIVE_COORDINATES)
    rows = [names.index(a) for a in angles]
    for strokes in STROKES:
        rates = excavator.relative_jacobian(state_at(strokes))[rows]
        assert rates[0, 0] < 0.0  # positive down
        assert rates[1, 1] > 0.0
        assert rates[2, 2] > 0.0
        # differences of sums of some sixty products, each as large as the rates themselves
        rounding = 64 * EPSILON * np.abs(rates).max()
        np.testing.assert_allclose(rates[~np.eye(3, dtype=bool)], 0.0, atol=rounding)


@pytest.mark.parametrize(
    ("cylinder", "beyond", "loop"),
    [
        ("boom", 1.0, "chassis - boom_barrel - boom_rod - boom"),
        ("arm", 1.4, "boom - arm - arm_rod - arm_barrel"),
        ("bucket", 1.5, "arm - rocker - bucket_rod - bucket_barrel"),
    ],
)
def test_a_stroke_out_of_reach_names_its_loop(cylinder: str, beyond: float, loop: str) -> None:
    strokes = np.zeros(3)
    strokes[CYLINDERS.index(cylinder)] = beyond
    with pytest.raises(excavator.ClosureError, match="cannot close") as error:
        excavator.rhs(state_at(strokes))
    assert set(loop.split(" - ")) <= set(error.value.reasons[0].replace(" cannot", "").split())


def test_prescribed_strokes_take_the_bodies_where_coordinates_do() -> None:
    shared = [excavator_lifting.BODIES.index(body) for body in excavator.BODIES]
    for strokes in STROKES:
        inputs = np.zeros(9)
        inputs[::3] = strokes
        lifted = excavator_lifting.positions([0.3, 0.0], inputs)[shared]
        np.testing.assert_allclose(lifted, excavator.positions(state_at(strokes)), atol=1e-15)


# -- statics --------------------------------------------------------------------------------------


def test_cylinders_carry_the_moments_of_what_hangs_on_them() -> None:
    """About the hinges of boom and arm, with the levers of massless cylinders."""
    light = {
        f"{c}_{part}_{what}": 0.0
        for c in CYLINDERS
        for part in ("barrel", "rod")
        for what in ("mass", "inertia_yy")
    }
    built = Built.of(MODELS[0], excavator, light)
    hanging = {"boom": ("boom", "arm", "rocker", "link", "bucket")}
    hanging["arm"] = hanging["boom"][1:]
    hinges = {"boom": ("boom", "boom_foot"), "arm": ("arm", "arm_pin")}
    for strokes in STROKES:
        state = state_at(strokes)
        forward = dict(zip(excavator.BODIES, excavator.positions(state)[:, 0], strict=True))
        holding = dict(zip(CYLINDERS, -built("forces", state, np.zeros(3)), strict=True))
        for cylinder, bodies in hanging.items():
            hinge = carried(*hinges[cylinder], state)
            moment = sum(weight_of(body) * (forward[body] - hinge[0]) for body in bodies)
            low, high = (carried(*pin, state) for pin in PINS[cylinder])
            lever = np.linalg.norm(np.cross(high - low, hinge - low)) / np.linalg.norm(high - low)
            sense = {"boom": 1.0, "arm": -1.0}[cylinder]  # extending lifts the boom, lowers the arm
            # 1e-9 N m of moments of 1e5 N m: a few roundings
            assert sense * holding[cylinder] * lever == pytest.approx(moment, abs=1e-9)


def weight_of(body: str) -> float:
    return GRAVITY * DIGGING.parameters[f"{body}_mass"]


def test_holding_forces_are_the_slope_of_the_potential_energy() -> None:
    step = 1e-3
    for strokes in STROKES[:10]:
        holding = -excavator.forces(state_at(strokes), np.zeros(3))
        slopes = []
        for direction in np.eye(3):
            near, far = (
                potential(strokes + k * step * direction)
                - potential(strokes - k * step * direction)
                for k in (1, 2)
            )
            slopes.append((8.0 * near - far) / (12.0 * step))
        # differences of fourth order: their error, and the roundings of 1e5 J over a step
        np.testing.assert_allclose(holding, slopes, atol=1e-9 * np.abs(holding).max())


def potential(strokes: Array) -> float:
    heights = excavator.positions(state_at(strokes))[:, 2]
    return float(sum(weight_of(b) * z for b, z in zip(excavator.BODIES, heights, strict=True)))


def test_held_excavator_stands_still() -> None:
    for strokes in STROKES:
        state = state_at(strokes)
        holding = -excavator.forces(state, np.zeros(3))
        # what rounding leaves of 1e5 N on 1e3 kg
        np.testing.assert_allclose(excavator.rhs(state, holding), 0.0, atol=1e-11)


def test_load_hangs_below_its_hook_and_swings_like_a_pendulum() -> None:
    """At rest under the hook; of small swings the period of a compound pendulum."""
    inputs = np.zeros(9)
    inputs[::3] = 0.2, -0.3, 0.1

    def pull(angle: float) -> float:
        return float(excavator_lifting.rhs([angle, 0.0], inputs)[1])

    rest = brentq(pull, -1.0, 1.0, xtol=1e-14)
    jacobian = excavator_lifting.rhs_jacobian([rest, 0.0], inputs)
    given = CARRYING.parameters
    length = given["hook_z"] - given["load_com_z"]
    mass, inertia = given["load_mass"], given["load_inertia_yy"]
    squared = mass * GRAVITY * length / (inertia + mass * length**2)
    np.testing.assert_allclose(jacobian, [[0.0, 1.0], [-squared, 0.0]], rtol=1e-12, atol=1e-12)
    below = excavator_lifting.positions([rest, 0.0], inputs)[-1]
    swung = excavator_lifting.positions([rest + np.pi, 0.0], inputs)[-1]
    np.testing.assert_allclose(swung - below, [0.0, 0.0, 2.0 * length], atol=1e-12)


# -- dynamics -------------------------------------------------------------------------------------


def test_work_of_the_cylinders_is_what_the_energy_changes_by() -> None:
    """Forces that swing about those that hold the machine at the start."""

    def forces(time: float) -> Array:
        swing = np.array([6e3 * np.sin(2.0 * time), 4e3 * np.sin(3.0 * time), 2e3 * np.cos(time)])
        return -excavator.forces(np.zeros(6), np.zeros(3)) + swing

    def slope(time: float, y: Array) -> Array:
        pushed = forces(time)
        return np.array([*excavator.rhs(y[:6], pushed), pushed @ y[3:6]])

    result = solve_ivp(slope, (0.0, 1.5), np.zeros(7), "DOP853", rtol=1e-12, atol=1e-12)
    assert result.success
    energies = np.array(
        [
            DIGGING.oracle.energy(DIGGING.motion(y[:6], forces(t)))
            for t, y in zip(result.t, result.y.T, strict=True)
        ]
    )
    work = result.y[6]
    assert np.ptp(work) > 1e3
    # the integrator's tolerance, over a hundred steps
    np.testing.assert_allclose(energies - energies[0], work, rtol=0.0, atol=1e-7)


def test_angles_as_coordinates_give_the_same_motion() -> None:
    """Cylinders that follow their hinges, with the force along the line of their pins."""
    points = {
        name: (EXCAVATOR.body(body), named(EXCAVATOR, Point, pin))
        for name, (body, pin) in _ends().items()
    }
    inputs = {c: EXCAVATOR.input(f"{c}_force") for c in CYLINDERS}
    mechanism = replace(
        EXCAVATOR,
        name="by_angles",
        forces=(
            Weight(),
            *(
                ForceElement(
                    name=f"{c}_cylinder",
                    path=AlongLine(points[f"{c}_low"], points[f"{c}_high"]),
                    laws=(Actuator(inputs[c]),),
                )
                for c in CYLINDERS
            ),
        ),
    )
    hinges = tuple(map(EXCAVATOR.joint, ("boom_hinge", "arm_hinge", "bucket_hinge")))
    model = replace(MODELS[0], name="by_angles", mechanism=mechanism, independent=hinges)
    derived = generate(model, derivatives=False)
    strokes = [a for a in derived.plan.steps if isinstance(a, RPR)]
    assert [a.telescope.joint.name for a in strokes] == [f"{c}_bore" for c in CYLINDERS]
    names = list(excavator.RELATIVE_COORDINATES)
    rows = [names.index(f"{c}_angle") for c in CYLINDERS]
    constants = constants_of(derived, DIGGING.parameters)
    for start in STROKES[:4]:
        state, pushed = state_at(start, (0.4, -0.3, 0.5)), np.array([9e4, -4e4, 3e4])
        rates = excavator.relative_jacobian(state)[rows]
        angles = excavator.relative_coordinates(state)[rows]
        values = constants | dict(zip((f"{c}_force" for c in CYLINDERS), pushed, strict=True))
        coordinates = [e.name for e in derived.state]
        values |= dict(zip(coordinates, [*angles, *rates @ state[3:]], strict=True))
        found = [float(x) for x in python(derived.functions["rhs"])(values)][3:]
        accelerations = excavator.rhs(state, pushed)[3:]
        expected = rates @ accelerations + drift_of(state, rows)
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-10)


def _ends() -> dict[str, tuple[str, str]]:
    ends = {}
    for cylinder, (low, high) in PINS.items():
        ends |= {f"{cylinder}_low": low, f"{cylinder}_high": high}
    return ends


def drift_of(state: Array, rows: list[int]) -> Array:
    """Return the rate of the angles' Jacobian times the rates, by differences of fourth order."""

    def rates(ahead: float) -> Array:
        moved = state_at(state[:3] + ahead * state[3:])
        found: Array = excavator.relative_jacobian(moved)[rows] @ state[3:]
        return found

    h = 1e-3
    return (8.0 * (rates(h) - rates(-h)) - (rates(2 * h) - rates(-2 * h))) / (12.0 * h)


# -- declarations ---------------------------------------------------------------------------------


@pytest.mark.parametrize("model", MODELS, ids=lambda model: model.name)
def test_loops_wait_for_those_that_they_hang_on(model: Any) -> None:
    """The bucket's loops declared first and its bodies numbered first: the same loops."""
    mechanism = model.mechanism
    backward = ((body, replace(body, order=-body.order)) for body in mechanism.bodies)
    turned = changed(mechanism, *backward)
    turned = replace(turned, joints=turned.joints[::-1])
    assert turned.bodies[1:] == mechanism.bodies[:0:-1]
    plan, expected = CataloguePlan.of(replace(model, mechanism=turned)), CataloguePlan.of(model)
    assert {t.cycle.key for t in plan.transformers} == {t.cycle.key for t in expected.transformers}
    assert plan.transformers[0].cycle.key == expected.transformers[0].cycle.key


def test_mobility() -> None:
    assert excavator.MOBILITY == 3
    assert len(MODELS[1].inputs) == 3 * (excavator_lifting.MOBILITY - 1)
    assert len(excavator.LOOPS) == 4
