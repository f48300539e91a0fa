"""Derivatives of a motion over time, against motions beside it and the gradient backwards."""

import kintrafo
import numpy as np
import pytest
from kintrafo import InputError, Samples
from kintrafo.generator.mechanisms import MODELS

CAR = kintrafo.Model("reference_car")
SHIPPED = {model.name: model for model in MODELS}
SPAN, TIMES = (0.0, 0.3), np.linspace(0.0, 0.3, 31)
START = np.array(kintrafo.state_at_height(CAR, 0.325, spin_rate=93.0))
ROAD = {"road_height": Samples([0.0, 0.1, 0.1, 0.3], [0.0, 0.01, 0.03, 0.0], "linear")}
NAMES = ["tie_rod_inner_z", "wheel_center_x", "damper_rate", "gravity", "beta1", "strut_force"]
SIGNALS = ["toe", "wheel_acceleration", "tyre_force"]
TIGHT = {"rtol": 1e-11, "atol": 1e-13}


@pytest.fixture(scope="module")
def system() -> kintrafo.System:
    module = kintrafo.compile(SHIPPED[CAR.equations.NAME], parameter_derivatives=True)
    return kintrafo.System(module, CAR.parameters)


def beside(system: kintrafo.System, name: str, by: float) -> dict[str, np.ndarray]:
    """Return a motion in which something is another, by a method that shares nothing."""
    parameters, start, inputs = dict(system.parameters), START.copy(), dict(ROAD)
    if name in parameters:
        parameters[name] += by
    elif name in system.state_names:
        start[system.state_names.index(name)] += by
    else:
        inputs[name] = by
    other = kintrafo.System(system.equations, parameters)
    found = kintrafo.simulate(
        other, SPAN, start, inputs=inputs, t_eval=TIMES, method="DOP853", rtol=1e-12, atol=1e-14
    )
    return {**found.signals, **dict(zip(system.state_names, found.y, strict=True))}


def test_against_motions_beside_it(system: kintrafo.System) -> None:
    """Over a jump of the road; four neighbours, so that differences are known to some 1e-8."""
    found = kintrafo.motion_sensitivity(
        system, SPAN, START, NAMES, signals=SIGNALS, inputs=ROAD, t_eval=TIMES, **TIGHT
    )
    steps = {"damper_rate": 10.0, "gravity": 0.1, "strut_force": 10.0, "beta1": 1e-3}
    for name in NAMES:
        step = steps.get(name, 1e-3)
        at = {by: beside(system, name, by * step) for by in (-2, -1, 1, 2)}
        for wanted in (*SIGNALS, *system.state_names):
            difference = (
                8.0 * (at[1][wanted] - at[-1][wanted]) - (at[2][wanted] - at[-2][wanted])
            ) / (12.0 * step)
            exact = found.by[name][wanted]
            # the spin turns by 30 rad, of which rounding is more
            most = 2e-6 * np.abs(exact).max() + 1e-11 * np.abs(at[1][wanted]).max() / step
            assert np.abs(exact - difference).max() <= most, (name, wanted)


def test_it_is_the_transpose_of_the_gradient(system: kintrafo.System) -> None:
    weights = np.cos(40.0 * TIMES)
    of = dict.fromkeys([*SIGNALS, "beta1"], weights)
    names = [*NAMES, "spring_rate", "beta1_rate"]
    asked = {"inputs": ROAD, "t_eval": TIMES}
    back = kintrafo.motion_gradient(system, SPAN, START, of, **asked)
    found = kintrafo.motion_sensitivity(system, SPAN, START, names, **asked)
    for name in names:
        forward = sum(weights @ found.by[name][signal] for signal in of)
        assert forward == pytest.approx(back.by[name], rel=1e-9)
    np.testing.assert_array_equal(found.motion.t, back.motion.t)


def test_directions_of_several(system: kintrafo.System) -> None:
    together = {"raised": {"tie_rod_inner_z": 2.0, "damper_rate": -1.0, "beta1": 0.5}}
    found = kintrafo.motion_sensitivity(system, SPAN, START, together, t_eval=TIMES)
    alone = kintrafo.motion_sensitivity(system, SPAN, START, [*together["raised"]], t_eval=TIMES)
    wanted = sum(part * alone.by[name]["toe"] for name, part in together["raised"].items())
    np.testing.assert_allclose(found.by["raised"]["toe"], wanted, rtol=1e-9, atol=1e-12)
    assert set(found.values) == {*system.state_names, *system.signal_names}


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"by": ["no_such"]}, "no_such"),
        ({"by": {}}, "by is empty"),
        ({"by": ["road_height"], "inputs": ROAD}, "varies with time"),
        ({"by": ["gravity"], "t_span": (1.0, 0.0)}, "the later one"),
        ({"by": ["gravity"], "signals": ["nothing"]}, "nothing"),
        ({"by": {"a": {"gravity": np.nan}}}, "finite"),
        ({"by": ["gravity"], "rtol": -1.0}, "rtol"),
    ],
)
def test_what_cannot_be_used_is_refused(
    system: kintrafo.System, changes: dict[str, object], words: str
) -> None:
    asked: dict[str, object] = {"t_span": SPAN, "y0": START, **changes}
    with pytest.raises(InputError, match=words):
        kintrafo.motion_sensitivity(system, **asked)  # type: ignore[arg-type]
