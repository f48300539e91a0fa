"""The front axle: its signals are those of two suspensions; masses that a declaration may add.

`test_mechanisms` compares it with maximal coordinates, like every mechanism. Signals of a side are
those of the `macpherson` of that side, whose left hardpoints this file mirrors.
"""

import json
from dataclasses import dataclass

import numpy as np
import pytest
from kintrafo import System
from kintrafo.generated import front_axle, macpherson
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import front_axle as declaration
from oracle.maximal import Oracle
from oracle.reference import perturbed_parameters
from support.folders import ROOT
from support.models import Built
from support.symbolic import accelerations

from benchmarks.front_axle import COUNTED, WITH, WITHOUT, rates, wheel_rate

SIDES = ("right", "left")
PAGE = ROOT / "docs/mechanisms/composition.md"
BASELINE = ROOT / "tests/generator/backends/operation_counts"
SEEDS = range(4)  # 0 is the reference car
AGAINST = {  # of the right side's parameters, those that the left one has with the other sign
    "spin_axis": "xz",
    "control_arm_inertia": ("xy", "yz"),
    "knuckle_inertia": ("xy", "yz"),
}


def parameters_of(seed, **changes):
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


def left_of(given):
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
    state: np.ndarray
    inputs: np.ndarray

    @classmethod
    def of(cls, seed, count=50, **changes):
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

    def of_side(self, side):
        """Return state and inputs of one suspension."""
        part, axle = self.parts[side], self.axle
        states = [axle.state_names.index(f"{side}_{name}") for name in part.state_names]
        inputs = [
            axle.input_names.index(n if n.startswith("rack") else f"{side}_{n}")
            for n in part.input_names
        ]
        return self.state[:, states], self.inputs[:, inputs]


# -- composition -----------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", SEEDS)
def test_signals_of_each_side_are_those_of_its_suspension(seed):
    at = Compared.of(seed, bar_rate=0.0)
    found = at.axle.signals(at.state, at.inputs)
    for side, part in at.parts.items():
        for name, expected in part.signals(*at.of_side(side)).items():
            element = f"{side}_strut_" if name.endswith(("spring_force", "damper_force")) else ""
            full = element + name if element else f"{side}_{name}"
            full = full if full in found else f"{side}_front_{name}"
            scale = max(np.abs(expected).max(), 1e-3)
            np.testing.assert_allclose(found[full], expected, rtol=0.0, atol=2e-12 * scale)


# -- the bar ---------------------------------------------------------------------------------------


def test_halves_of_the_bar_may_have_mass():
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


# -- the page --------------------------------------------------------------------------------------


def cells(page, first):
    """Return the numbers of a table's row, by what it begins with."""
    row = next(line for line in page.splitlines() if line.startswith(f"| {first} "))
    return [cell.strip().replace(" ", "") for cell in row.split("|")[2:-1]]


def counts_of(model):
    """Return the operation counts of a model that are stored."""
    text = (BASELINE / f"{model}.json").read_text(encoding="utf-8")
    return json.loads(text)


@pytest.mark.parametrize("function", COUNTED)
def test_operations_on_the_page_are_the_present_ones(function):
    one, axle = (sum(counts_of(m)[function].values()) for m in ("macpherson", "front_axle"))
    row = cells(PAGE.read_text(encoding="utf-8"), COUNTED[function])
    assert [row[0], row[1], row[3]] == [str(one), str(2 * one), str(axle)]


def test_two_suspensions_in_one_cost_what_they_cost_alone_but_for_signs():
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


def test_wheel_rates_on_the_page_are_the_present_ones():
    assert rates() in PAGE.read_text(encoding="utf-8")
    # equal travel: the suspension's own rate; opposite travel: the bar adds to it
    assert wheel_rate(WITH, 1.0) == pytest.approx(wheel_rate(WITHOUT, -1.0), rel=1e-6)
