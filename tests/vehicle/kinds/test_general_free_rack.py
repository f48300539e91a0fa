"""The free rack with everything that a car has: equations that are compiled when first needed."""

import sys

import numpy as np
import pytest
from kintrafo import Model, Suspension, equilibrium, simulate
from kintrafo.core.optional import MissingPackageError
from kintrafo.generator.mechanisms.macpherson import GENERAL_FREE_RACK
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.cli import app
from kintrafo.vehicle.kinds import macpherson
from support.models import Built
from typer.testing import CliRunner

MASSES = {
    "bodies.tie_rod": {"mass_kg": 1.1},
    "bodies.rack": {"mass_kg": 3.0},
    "bodies.upper_strut": {
        "mass_kg": 2.0,
        "inertia_xx_kg_m2": 0.02,
        "inertia_yy_kg_m2": 0.02,
        "inertia_zz_kg_m2": 0.004,
    },
}
CAR = Suspension.load("offset_strut_car").with_changes(MASSES)


def test_missing_packages_are_named(monkeypatch):
    macpherson._general_free_rack.cache_clear()  # another test may have had these equations made
    monkeypatch.setitem(sys.modules, "sympy", None)
    with pytest.raises(MissingPackageError, match=r"kintrafo\[generator\]"):
        Model(CAR, free_rack=True)


@pytest.mark.slow
@pytest.mark.skipif(find_compiler() is None, reason="no C compiler")
def test_all_that_it_is(tmp_path_factory):
    """One test, because the equations take half a minute to derive."""
    accelerations_are_those_of_the_maximal_coordinates()
    without_anything_more_it_is_the_free_rack_of_the_paper()
    a_file_with_heavy_rack_simulates(tmp_path_factory.mktemp("cars"))


def accelerations_are_those_of_the_maximal_coordinates():
    model = Model(CAR, free_rack=True)
    assert GENERAL_FREE_RACK.name == model.equations.NAME
    built = Built.of(GENERAL_FREE_RACK, model.equations, model.parameters)
    random = np.random.default_rng(8)
    for _ in range(6):
        state = model.design_state + [0.15, 2.0, 0.02, 3.0, 60.0, 0.5] * random.uniform(-1, 1, 6)
        inputs = 0.01 * random.standard_normal(len(model.input_names))
        found = built.oracle.reduced(built.motion(state, inputs), built.named(inputs), {})
        # 1e-11: forces of the tyre of some 1e4 N cancel in what moves the wheel
        np.testing.assert_allclose(
            model.evaluate("rhs", state, inputs)[3:], found.accelerations, rtol=1e-11, atol=1e-8
        )


def without_anything_more_it_is_the_free_rack_of_the_paper():
    """A tyre that may lift off but stays on the road asks for these equations, and no more."""
    paper = Suspension.load("reference_car").with_changes(MASSES)
    models = [
        Model(c, free_rack=True) for c in (paper, paper.with_changes({"tyre.lifts_off": True}))
    ]
    assert models[0].equations is not models[1].equations
    random = np.random.default_rng(9)
    for _ in range(6):
        state = models[0].design_state + [0.02, 2.0, 0.01, 1.0, 60.0, 0.5] * random.uniform(
            -1, 1, 6
        )
        expected, found = (m.evaluate("rhs", state) for m in models)
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-8)


def a_file_with_heavy_rack_simulates(folder):
    model = Model(CAR, free_rack=True)
    start = equilibrium(model)
    road = {"road_height": ([0.0, 0.05, 0.05, 0.2], [0.0, 0.0, 0.01, 0.01])}
    end = simulate(model, (0.0, 0.2), start, inputs=road)
    assert end.success
    assert abs(end.signals["wheel_center_z"][-1] - end.signals["wheel_center_z"][0]) > 0.005
    from kintrafo.vehicle.input.toml_writer import write_toml

    path = write_toml(CAR, folder / "heavy.toml")
    result = CliRunner().invoke(app, ["mechanism", "topology", str(path)])
    assert result.exit_code == 0, result.output
    assert "Mobility 3" in result.output
