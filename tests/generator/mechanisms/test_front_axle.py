"""The front axle against two suspensions of their own, its mirror, and formulas by hand.

`test_mechanisms` compares it with maximal coordinates, like every mechanism. Here the oracle is
that a whole is worth its parts: with a bar that resists nothing, each side moves like the
`macpherson` of that side, whose left hardpoints this file mirrors.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from folders import ROOT
from kintrafo import System, simulate
from kintrafo.generated import front_axle, macpherson
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import front_axle as declaration
from oracle.maximal import Oracle
from oracle.reference import perturbed_parameters
from own_models import Built
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from symbolic import accelerations

from benchmarks.front_axle import COUNTED, WITH, WITHOUT, rates, wheel_rate

if TYPE_CHECKING:
    from oracle.constraints import Array

SIDES = ("right", "left")
PAGE = ROOT / "docs/mechanisms/composition.md"
BASELINE = ROOT / "tests/generator/backends/operation_counts"
SEEDS = range(4)  # 0 is the reference car
AGAINST = {  # of the right side's parameters, those that the left one has with the other sign
    "spin_axis": "xz",
    "control_arm_inertia": ("xy", "yz"),
    "knuckle_inertia": ("xy", "yz"),
}


def parameters_of(seed: int, **changes: float) -> dict[str, float]:
    """Return an axle: the reference car's, or a general one with a bar of its own."""
    given = {name: entry["default"] for name, entry in front_axle.PARAMETERS.items()}
    if seed:
        rng = np.random.default_rng(seed)
        car = perturbed_parameters(rng)
        given |= {name: value for name, value in car.items() if name in given}
        for name in ("bar_bush", "link_top", "link_foot"):
            for axis in "xyz":
                given[f"{name}_{axis}"] += 0.01 * rng.standard_normal()
        given |= {"bar_axis_x": 0.1, "bar_axis_z": -0.05, "bar_free_angle": 0.02}
    return given | changes


def left_of(given: dict[str, float]) -> dict[str, float]:
    """Return the parameters of a left suspension as `macpherson` takes them."""
    mirrored = {name: given[name] for name in macpherson.PARAMETERS}
    points = [
        n
        for n in mirrored
        if n.endswith("_y") and not n.startswith(("spin_axis", "rack_axis", "tie_rod_inertia"))
    ]
    turned = points + [f"{name}_{e}" for name, which in AGAINST.items() for e in which]
    return mirrored | {name: -mirrored[name] for name in turned}


@dataclass(frozen=True)
class Compared:
    """An axle at random states, and the two suspensions that it is made of.

    Attributes
    ----------
    state, inputs : ndarray, shape (n, ...)
        Of the axle.
    """

    axle: System
    parts: dict[str, System]
    state: Array
    inputs: Array

    @classmethod
    def of(cls, seed: int, count: int = 50, **changes: float) -> Compared:
        given = parameters_of(seed, **changes)
        axle = System(front_axle, given)
        right = {name: given[name] for name in macpherson.PARAMETERS}
        parts = dict(
            zip(SIDES, (System(macpherson, p) for p in (right, left_of(given))), strict=True)
        )
        rng = np.random.default_rng([seed, 1])
        scale = np.array([0.25 if "beta1" in n else 3.0 for n in axle.state_names[:4]])
        rates = np.array([4.0 if "beta1" in n else 60.0 for n in axle.state_names[:4]])
        spread = np.concatenate((scale, rates))
        state = axle.design_state + spread * rng.uniform(-1.0, 1.0, (count, 8))
        sizes = {"rack_position": 0.03, "rack_velocity": 0.3, "rack_acceleration": 8.0}
        size = np.array(
            [sizes.get(n, 0.02 if n.endswith("height") else 500.0) for n in axle.input_names]
        )
        return cls(axle, parts, state, size * rng.standard_normal((count, len(size))))

    def of_side(self, side: str) -> tuple[Array, Array]:
        """Return state and inputs of one suspension."""
        part, axle = self.parts[side], self.axle
        states = [axle.state_names.index(f"{side}_{name}") for name in part.state_names]
        inputs = [
            axle.input_names.index(n if n.startswith("rack") else f"{side}_{n}")
            for n in part.input_names
        ]
        return self.state[:, states], self.inputs[:, inputs]

    def rows(self, side: str) -> list[int]:
        return [i for i, n in enumerate(self.axle.state_names) if n.startswith(side)]


# -- composition -----------------------------------------------------------------------------------


@pytest.mark.parametrize("function", ["rhs", "rhs_rack_held"])
@pytest.mark.parametrize("seed", SEEDS)
def test_without_the_bar_each_side_is_a_suspension_of_its_own(seed: int, function: str) -> None:
    at = Compared.of(seed, bar_rate=0.0)
    found = at.axle.evaluate(function, at.state, at.inputs)
    for side, part in at.parts.items():
        expected = part.evaluate(function, *at.of_side(side))
        # the same formulas in other axes: some hundred roundings of terms that partly cancel
        np.testing.assert_allclose(
            found[:, at.rows(side)], expected, rtol=0.0, atol=2e-12 * np.abs(expected).max()
        )


@pytest.mark.parametrize("seed", SEEDS)
def test_signals_of_each_side_are_those_of_its_suspension(seed: int) -> None:
    at = Compared.of(seed, bar_rate=0.0)
    found = at.axle.signals(at.state, at.inputs)
    for side, part in at.parts.items():
        for name, expected in part.signals(*at.of_side(side)).items():
            element = f"{side}_strut_" if name.endswith(("spring_force", "damper_force")) else ""
            full = element + name if element else f"{side}_{name}"
            full = full if full in found else f"{side}_front_{name}"
            scale = max(np.abs(expected).max(), 1e-3)
            np.testing.assert_allclose(found[full], expected, rtol=0.0, atol=2e-12 * scale)


def test_without_the_bar_the_jacobian_is_that_of_two_suspensions() -> None:
    at = Compared.of(1, bar_rate=0.0)
    found = at.axle.evaluate("rhs_jacobian", at.state, at.inputs)
    right, left = (at.rows(side) for side in SIDES)
    assert not found[:, right][:, :, left].any()
    assert not found[:, left][:, :, right].any()
    for side, part in at.parts.items():
        expected = part.evaluate("rhs_jacobian", *at.of_side(side))
        own = found[:, at.rows(side)][:, :, at.rows(side)]
        np.testing.assert_allclose(own, expected, rtol=0.0, atol=1e-11 * np.abs(expected).max())


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(
    ("jacobian", "function", "by"),
    [
        ("rhs_jacobian", "rhs", "state"),
        ("rhs_jacobian_rack_held", "rhs_rack_held", "state"),
        ("rhs_input_jacobian", "rhs", "inputs"),
    ],
)
def test_the_bar_couples_the_jacobian_as_differences_say(
    seed: int, jacobian: str, function: str, by: str
) -> None:
    at = Compared.of(seed, count=10)
    given = {"state": at.state, "inputs": at.inputs}
    found = at.axle.evaluate(jacobian, **given)
    columns = []
    for k in range(given[by].shape[1]):
        # four points: the error of the step is of the fourth order, that of rounding 1e-16 / step
        step = 2e-4 * np.maximum(1.0, np.abs(given[by][:, k]))
        total: Any = 0.0
        for weight, side in ((8.0, 1.0), (-8.0, -1.0), (-1.0, 2.0), (1.0, -2.0)):
            moved = given[by].copy()
            moved[:, k] += side * step
            total = total + weight * at.axle.evaluate(function, **given | {by: moved})
        columns.append(total / (12.0 * step[:, None]))
    expected = np.stack(columns, axis=-1)
    # columns differ by units; 1e-8 of each: steps of 2e-4 rad or m against lengths of 0.1 m
    scale = np.abs(expected).max(axis=(0, 1), keepdims=True) + 1e-12
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0.0, atol=1e-8)
    if by == "state":
        left, right = at.rows("left"), at.rows("right")
        assert np.abs(found[:, right][:, :, left]).max() > 10.0  # there is a bar


@pytest.mark.parametrize("seed", SEEDS)
def test_the_sides_have_no_inertia_in_common(seed: int) -> None:
    at = Compared.of(seed)
    matrix = at.axle.evaluate("mass_matrix", at.state, at.inputs)
    right, left = [0, 1], [2, 3]
    assert not matrix[:, right][:, :, left].any()
    for side, rows in (("right", right), ("left", left)):
        expected = at.parts[side].evaluate("mass_matrix", *at.of_side(side))
        own = matrix[:, rows][:, :, rows]
        np.testing.assert_allclose(own, expected, rtol=0.0, atol=1e-13 * np.abs(expected).max())


# -- mirror ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_exchanged_sides_exchange_the_results(seed: int) -> None:
    # the rack's axis is its own mirror image only where it runs straight to the left
    at = Compared.of(seed, rack_axis_x=0.0, rack_axis_z=0.0, bar_free_angle=0.0)
    swap = [4 * (i // 4) + (i % 4 + 2) % 4 for i in range(8)]
    names = at.axle.input_names
    inputs = at.inputs.copy()
    for i, name in enumerate(names):
        if name.startswith("rack"):
            inputs[:, i] = -at.inputs[:, i]
        else:
            side, _, what = name.partition("_")
            other = {"right": "left", "left": "right"}[side]
            inputs[:, i] = at.inputs[:, names.index(f"{other}_{what}")]
    found = at.axle.evaluate("rhs", at.state, at.inputs)
    exchanged = at.axle.evaluate("rhs", at.state[:, swap], inputs)
    np.testing.assert_allclose(
        exchanged[:, swap], found, rtol=0.0, atol=2e-12 * np.abs(found).max()
    )
    (twist, mirrored) = (
        at.axle.signal("bar_angle", *pair)
        for pair in ((at.state, at.inputs), (at.state[:, swap], inputs))
    )
    np.testing.assert_allclose(mirrored, -twist, rtol=0.0, atol=1e-13)


# -- the bar ---------------------------------------------------------------------------------------


def in_plane(given: dict[str, float], name: str) -> Array:
    """Return a hardpoint of the right side."""
    return np.array([given[f"{name}_{axis}"] for axis in "xyz"])


def turned(axis: Array, angle: float, arm: Array) -> Array:
    """Return a vector turned about an axis (Rodrigues)."""
    n = axis / np.linalg.norm(axis)
    across = np.cross(n, arm)
    return arm + np.sin(angle) * across + (1.0 - np.cos(angle)) * np.cross(n, across)


@pytest.mark.parametrize("seed", SEEDS)
def test_angles_of_the_bar_are_those_at_which_the_link_fits(seed: int) -> None:
    given = parameters_of(seed)
    axle = System(front_axle, given)
    bush, top, foot, hinge = (
        in_plane(given, n) for n in ("bar_bush", "link_top", "link_foot", "arm_rear")
    )
    bar_axis, arm_axis = in_plane(given, "bar_axis"), in_plane(given, "arm_front") - hinge
    reach = np.linalg.norm(top - foot)
    names = list(front_axle.RELATIVE_COORDINATES)
    for step in np.linspace(-0.25, 0.25, 11):  # of the right arm only
        state = axle.state(right_beta1=axle.design_state[0] + step)
        found = axle.evaluate("relative_coordinates", state)
        # the right arm's angle counts right-handed about the hinge from rear to front
        now = hinge + turned(arm_axis, step, foot - hinge)

        def misfit(angle: float, now: Array = now) -> float:
            end = bush + turned(bar_axis, angle, top - bush)
            return float(np.linalg.norm(end - now) - reach)

        right = brentq(misfit, -0.7, 0.7, xtol=1e-15)
        assert found[names.index("right_bar_angle")] == pytest.approx(right, abs=1e-13)
        assert found[names.index("left_bar_angle")] == pytest.approx(0.0, abs=1e-14)


def test_roll_stiffness_is_that_of_a_formula_by_hand() -> None:
    """Small opposite angles d of the arms: moment -2 k r^2 d on each, r the ratio of the levers.

    The link moves along itself with the same speed at both ends, so r is the lever of its line
    about the arm's hinge over that about the bar's.
    """
    given = parameters_of(0)
    bush, top, foot, hinge = (
        in_plane(given, n) for n in ("bar_bush", "link_top", "link_foot", "arm_rear")
    )
    along = (top - foot) / np.linalg.norm(top - foot)
    bar_axis, arm_axis = in_plane(given, "bar_axis"), in_plane(given, "arm_front") - hinge
    levers = [
        np.dot(np.cross(axis / np.linalg.norm(axis), arm), along)
        for axis, arm in ((arm_axis, foot - hinge), (bar_axis, top - bush))
    ]
    ratio, rate, step = levers[0] / levers[1], given["bar_rate"], 1e-5
    stiff, soft = (System(front_axle, given | {"bar_rate": r}) for r in (rate, 0.0))
    turn = step * np.array([1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    moments = [s.evaluate("forces", s.design_state + turn) for s in (stiff, soft)]
    expected = -2.0 * rate * ratio**2 * turn[:4]
    # the ratio changes with the angles, by some 1e-5 of itself; the moments are of 1e3 N m
    np.testing.assert_allclose(moments[0] - moments[1], expected, rtol=1e-4, atol=1e-10)
    assert abs(ratio) > 0.9


@pytest.mark.parametrize("seed", SEEDS)
def test_equal_travel_leaves_the_bar_free(seed: int) -> None:
    axle = System(front_axle, parameters_of(seed, bar_free_angle=0.0))
    steps = np.linspace(-0.25, 0.25, 21)[:, None]
    state = axle.design_state + steps * np.array([1.0, 0.0, 1.0, 0.0, 2.0, 0.0, 2.0, 0.0])
    signals = axle.signals(state)
    np.testing.assert_allclose(signals["bar_angle"], 0.0, atol=1e-14)
    np.testing.assert_allclose(signals["bar_angular_velocity"], 0.0, atol=1e-14)
    np.testing.assert_allclose(signals["bar_spring_moment"], 0.0, atol=1e-11)


@pytest.mark.parametrize("seed", SEEDS)
def test_power_of_the_bar_is_what_it_stores(seed: int) -> None:
    at, given = Compared.of(seed), parameters_of(seed)
    soft = System(front_axle, given | {"bar_rate": 0.0})
    moments = at.axle.evaluate("forces", at.state, at.inputs)
    moments = moments - soft.evaluate("forces", at.state, at.inputs)
    power = np.einsum("ij,ij->i", moments, at.state[:, 4:])
    signals = at.axle.signals(at.state, at.inputs)
    twist, rate = signals["bar_angle"], signals["bar_angular_velocity"]
    expected = -given["bar_rate"] * (twist - given["bar_free_angle"]) * rate
    # the moments are differences to those of springs and tyres, of some 1e4 N m
    np.testing.assert_allclose(power, expected, rtol=0.0, atol=1e-9)
    assert np.abs(expected).max() > 100.0


def test_energy_of_opposite_motion_stays() -> None:
    """The arms swing against each other; a third of their energy and more goes through the bar."""
    lossless = {"damper_rate": 0.0, "tyre_rate": 0.0, "spring_free_slide": 0.18}
    given = parameters_of(0, **lossless)
    axle = System(front_axle, given)
    start = axle.state(right_beta1_rate=4.0, left_beta1_rate=-4.0)
    result = solve_ivp(
        lambda _, y: axle.evaluate("rhs", y), (0.0, 0.15), start, "DOP853", rtol=1e-12, atol=1e-12
    )
    built = Built(declaration.MODELS[0], front_axle, given)
    energies = np.array([built.oracle.energy(built.motion(y, None)) for y in result.y.T])
    twist = axle.signal("bar_angle", result.y.T)
    stored = 0.5 * given["bar_rate"] * twist**2
    swing = energies[0] - built.oracle.energy(built.motion(axle.design_state, None))
    # the integrator's tolerance, over some hundred steps
    assert np.ptp(energies) < 1e-9 * swing
    assert stored.max() > 0.33 * swing


def test_halves_of_the_bar_may_have_mass() -> None:
    """Declared so, the equations are those of the maximal coordinates with these masses."""
    heavy = {
        "bar_mass": 2.0,
        "bar_inertia_xx": 0.02,
        "bar_inertia_yy": 0.05,
        "bar_inertia_zz": 0.06,
        "bar_inertia_xy": 4e-3,
    }
    given = parameters_of(1, **heavy)
    model = declaration.model(declaration.mechanism(), with_mass=("bar",))
    at = Compared.of(1)
    state, inputs = at.state[0], at.inputs[0]
    named = dict(zip(at.axle.input_names, map(float, inputs), strict=True))
    motion = Built(declaration.MODELS[0], front_axle, given).motion(state, inputs)
    oracle = Oracle(model, given).reduced(motion, named, {"y": named["rack_acceleration"]})
    values = dict(zip(at.axle.state_names, map(float, state), strict=True)) | named
    found = accelerations(model, given, values)
    scale = np.abs(oracle.accelerations).max()
    # both in double precision, through some thousand operations
    np.testing.assert_allclose(found, oracle.accelerations, rtol=0.0, atol=1e-11 * scale)
    light = at.axle.evaluate("rhs", state, inputs)[4:]
    assert np.abs(found - light).max() > 1e-3 * scale  # the mass does make a difference


def test_a_free_rack_couples_the_sides() -> None:
    """The same declaration with the rack as a fifth freedom: then the axle is one part."""
    prescribed = declaration.MODELS[0]
    mechanism = prescribed.mechanism
    model = replace(
        prescribed,
        independent=(*prescribed.independent, mechanism.joint("y")),
        prescribed={},
        held={},
        massive=(*prescribed.massive, mechanism.body("rack")),
    )
    given = parameters_of(2, rack_mass=3.0)
    at = Compared.of(2)
    state, inputs = at.state[0], at.inputs[0]
    named = dict(zip(at.axle.input_names, map(float, inputs), strict=True)) | {"rack_force": 200.0}
    motion = Built(prescribed, front_axle, at.axle.parameters).motion(state, inputs)
    oracle = Oracle(model, given).reduced(motion, named, {})
    values = dict(zip(at.axle.state_names, map(float, state), strict=True)) | named
    values |= {"beta9": named["rack_position"], "beta9_rate": named["rack_velocity"]}
    found = accelerations(model, given, values)
    scale = np.abs(oracle.accelerations).max()
    np.testing.assert_allclose(found, oracle.accelerations, rtol=0.0, atol=1e-11 * scale)
    assert np.abs(oracle.mass_matrix[4, :4]).min() > 1e-3  # the rack moves both sides


# -- simulation ------------------------------------------------------------------------------------


def test_a_kerb_on_one_side_lifts_the_other_wheel_only_with_a_bar() -> None:
    def heights(bar_rate: float) -> dict[str, Any]:
        axle = System(front_axle, {"bar_rate": bar_rate})
        kerb = {"left_road_height": 0.03}
        result = simulate(axle, (0.0, 0.3), axle.design_state, inputs=kerb)
        return {s: result.signals[f"{s}_front_wheel_center_z"] - 0.3 for s in SIDES}

    without, stiff = heights(0.0), heights(1000.0)
    # at rest within the solver's tolerance of 1e-6 or so; the chassis is held, so nothing rolls
    assert np.abs(without["right"]).max() < 1e-6
    assert stiff["right"].max() > 1e-4
    assert stiff["left"].max() < without["left"].max()


# -- the page --------------------------------------------------------------------------------------


def cells(page: str, first: str) -> list[str]:
    """Return the numbers of a table's row, by what it begins with."""
    row = next(line for line in page.splitlines() if line.startswith(f"| {first} "))
    return [cell.strip().replace(" ", "") for cell in row.split("|")[2:-1]]


def counts_of(model: str) -> dict[str, dict[str, int]]:
    """Return the operation counts of a model that are stored."""
    text = (BASELINE / f"{model}.json").read_text(encoding="utf-8")
    return json.loads(text)


@pytest.mark.parametrize("function", COUNTED)
def test_operations_on_the_page_are_the_present_ones(function: str) -> None:
    one, axle = (sum(counts_of(m)[function].values()) for m in ("macpherson", "front_axle"))
    row = cells(PAGE.read_text(encoding="utf-8"), COUNTED[function])
    assert [row[0], row[1], row[3]] == [str(one), str(2 * one), str(axle)]


def test_two_suspensions_in_one_cost_what_they_cost_alone_but_for_signs() -> None:
    bare = generate(declaration.model(declaration.without_bar()))
    stored = counts_of("macpherson")
    page = PAGE.read_text(encoding="utf-8")
    functions = bare.emitted | {"prepare": bare.prepare}
    for name, what in COUNTED.items():
        assert cells(page, what)[2] == str(operations_of(functions[name]).total())
    held, one = operations_of(functions["rhs_rack_held"]), stored["rhs_rack_held"]
    for kind in ("multiply", "divide", "root", "trigonometric"):
        assert held[kind] == 2 * one[kind]
    # constants: those of one suspension, and the rack's direction in axes of the other side
    assert operations_of(functions["prepare"]).total() < 1.03 * sum(stored["prepare"].values())


def test_wheel_rates_on_the_page_are_the_present_ones() -> None:
    assert rates() in PAGE.read_text(encoding="utf-8")
    # equal travel: the suspension's own rate; opposite travel: the bar adds to it
    assert wheel_rate(WITH, 1.0) == pytest.approx(wheel_rate(WITHOUT, -1.0), rel=1e-6)
