"""A chain of many loops: its exact motion, what grows with its length, and which loop fails."""

import json

import numpy as np
import pytest
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.backends.numpy.printer import numpy_source
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.generator.planning.plan import CataloguePlan
from support.commands import ROOT, run_module
from support.models import Built, derive, needs_gcc, own

LONG = 16  # loops: more guards than a status word has bits


@pytest.fixture(scope="module")
def long_chain():
    return derive(n_four_bar(LONG), derivatives=False)


@pytest.fixture(scope="module")
def chain():
    model = n_four_bar(LONG)
    return Built.of(model, own(model, derivatives=False))


@needs_gcc
@pytest.mark.parametrize("angle", [-1.2, -0.3, 0.0, 0.7, 1.4])
def test_chain_is_a_pendulum(chain, angle):
    """All rockers stay parallel: (N + (N + 1) / 3) angle'' = (N + (N + 1) / 2) g sin(angle)."""
    found = chain("rhs", np.array([angle, 1.7]), np.zeros(1))[1]
    ratio = (LONG + (LONG + 1) / 2) / (LONG + (LONG + 1) / 3)
    # each loop hands its rounding on to the next, divided by the sine of the angle to level
    allowed = 1e-15 * LONG**2 / np.cos(angle) ** 3
    assert found == pytest.approx(9.81 * ratio * np.sin(angle), rel=0.0, abs=10.0 * allowed)


@needs_gcc
@pytest.mark.parametrize("loop", [1, LONG - 1, LONG])
def test_the_loop_that_cannot_close_is_named(chain, loop, refused):
    """Also where guards share a bit of the status word."""
    built = Built.of(chain.model, chain.module, {f"top_{loop}_z": 2.0})  # a rocker too long
    with refused(built.module.ClosureError) as error:
        built("rhs", np.array([1.4, 0.0]), np.zeros(1))
    first = next(iter(error.value.margins))
    assert first == f"rocker_{loop}_closure"
    assert error.value.margins[first] < 0.0


def test_arrays_share_the_last_bit_too(long_chain):
    source = numpy_source(long_chain)
    assert len(long_chain.guards) > 32
    assert f"{len(long_chain.guards) - 1}: " in source


def test_operations_grow_by_the_same_for_every_loop():
    """No loop costs more than another one."""
    lengths = (1, 2, 3)
    chains = (generate(n_four_bar(n), derivatives=False) for n in lengths)
    counts = [operations_of(chain.functions["rhs"]).total() for chain in chains]
    assert counts[2] - counts[1] == counts[1] - counts[0]


def test_long_chain_is_planned_loop_by_loop():
    plan = CataloguePlan.of(n_four_bar(40))
    assert plan.topology.mobility == 1
    names = [{f"rocker_{i - 1}", f"coupler_{i}", f"rocker_{i}"} for i in range(1, 41)]
    assert [set(t.cycle.bodies) - {"ground"} for t in plan.transformers] == names


@needs_gcc
def test_benchmark_writes_everything(tmp_path):
    page = tmp_path / "docs/theory/page.md"
    page.parent.mkdir(parents=True)
    (page.parents[1] / "images").mkdir()
    page.write_text((ROOT / "docs/theory/growth.md").read_text(encoding="utf-8"), encoding="utf-8")
    run_module("benchmarks.growth", "--quick", "--out", tmp_path, "--page", page)
    points = json.loads((tmp_path / "growth.json").read_text(encoding="utf-8"))["points"]
    assert [p["loops"] for p in points] == [1, 2, 3]
    for point in points:
        assert point["error"] < 1e-6  # a hundred times the tolerance of the integrator
    assert (page.parents[1] / "images/growth.png").stat().st_size > 10_000
    assert "proportion" in page.read_text(encoding="utf-8")
