"""Times under watch, with pytest-benchmark: ``make benchmark-speed``. Nothing is asserted.

To compare with an earlier state: ``make benchmark-speed ARGS=--benchmark-autosave`` before a
change, ``ARGS=--benchmark-compare`` after it.
"""

import subprocess
import sys
from importlib import import_module

import kintrafo
import numpy as np
import pytest
from kintrafo import Model, characteristics, simulate, state_at_height
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import MODELS, chains, held_by_rods
from kintrafo.vehicle.analysis.paper import DURATION, SPIN_RATE, START_HEIGHT

NAMES = [model.name for model in MODELS]
BATCH = 1000  # states in one call, so that Python's share of a call is small


@pytest.fixture(scope="module")
def car():
    return Model("reference_car")


def at_rest(name):
    module = import_module(f"kintrafo.generated.{name}")
    return module, *states_at_design(module)


def states_at_design(module):
    values = {name: entry["default"] for name, entry in module.PARAMETERS.items()}
    return np.tile(module.design_state(values), (BATCH, 1)), np.zeros(len(module.INPUTS))


@pytest.mark.parametrize("function", ["rhs", "rhs_jacobian"])
@pytest.mark.parametrize("name", NAMES)
def test_right_hand_side(benchmark, name, function):
    module, state, inputs = at_rest(name)
    call = getattr(module, function)
    benchmark.extra_info["states"] = BATCH
    benchmark(call, state, inputs)


@pytest.mark.parametrize("name", ["macpherson", "macpherson_general", "double_wishbone"])
def test_right_hand_side_with_the_rack_held(benchmark, name):
    module, state, inputs = at_rest(name)
    benchmark.extra_info["states"] = BATCH
    benchmark(module.rhs_rack_held, state, inputs)


@pytest.mark.parametrize(
    "model", [*held_by_rods.MODELS, *chains.MODELS], ids=lambda model: model.name
)
def test_right_hand_side_with_an_iteration(benchmark, model):
    module = kintrafo.compile(model)
    benchmark.extra_info["states"] = BATCH
    benchmark(module.rhs, *states_at_design(module))


def test_constants(benchmark, car):
    benchmark(car.equations.prepare, car.suspension.parameters())


@pytest.mark.parametrize("method", ["BDF", "DormandPrince"])
def test_the_standard_second(benchmark, car, method):
    start = state_at_height(car, START_HEIGHT, spin_rate=SPIN_RATE)
    outputs = np.linspace(0.0, DURATION, 101)
    benchmark(simulate, car, (0.0, DURATION), start, method=method, t_eval=outputs)


def test_all_characteristics_at_ten_thousand_positions(benchmark, car):
    travel = np.linspace(-0.08, 0.08, 10_000)
    benchmark(characteristics.over, car, "travel", travel)


@pytest.mark.parametrize("model", MODELS, ids=NAMES)
def test_derivation(benchmark, model):
    benchmark.pedantic(generate, (model,), rounds=1)


def test_import(benchmark):
    command = [sys.executable, "-c", "import kintrafo; kintrafo.Model('reference_car')"]
    benchmark.pedantic(subprocess.run, (command,), {"check": True}, rounds=3)
