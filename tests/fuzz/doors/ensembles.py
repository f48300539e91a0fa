"""Ensembles with values, starts and roads of each car, compared with SciPy's DOP853.

The reference integrates the bare right-hand side of each car alone, at tight tolerances and with
steps short enough for its road, whose height and slope are evaluated apart from kintrafo; it shares
no step with the lanes. The result of one car must not depend on the other cars.
"""

from functools import cache

import numpy as np
from kintrafo import Model, ensemble, equilibrium
from kintrafo.equations.errors import ModelError
from scipy.integrate import solve_ivp

from ..attempts import UnjudgedError, WrongError
from ..courses import Sine

SHORT = 6
SECONDS = 60.0
_CARS = (
    "reference_car", "offset_strut_car", "double_wishbone_car", "push_rod_car", "pull_rod_car",
    "multi_link_car", "trailing_arm_car",
)  # fmt: skip
_RATES = ("damper_rate", "spring_rate", "tyre_rate")
# Of coordinates [rad]: errors of steps at 1e-8 add up to a hundred tolerances over the oscillations
# of a second.
_TOLERANCE = 1e-6


@cache
def _car(name):
    """Return a car and where it rests."""
    model = Model(name)
    return model, np.asarray(equilibrium(model))


def attempt(random):
    """Simulate some cars at once, and some of them alone."""
    model, rest = _car(str(random.choice(_CARS)))
    count, end = int(random.integers(1, 12)), float(10.0 ** random.uniform(-1.3, 0.0))
    cars = {
        name: model.parameters[name] * 10.0 ** random.uniform(-0.3, 0.3, count)
        for name in _RATES
        if model.parameters.get(name) and random.random() < 0.7
    }
    starts = np.repeat(rest[None], count, axis=0)
    half = rest.size // 2
    starts[:, half:] += random.normal(size=(count, half)) * 0.2
    roads = {
        label: Sine(0.01 * random.normal(), 2.0 * np.pi * random.uniform(0.5, 8.0))
        for label in ("a", 2, 2.5)
    }
    labels = [list(roads)[i] for i in random.integers(0, len(roads), count)]
    found = ensemble(
        model, {**cars, "road_height": labels}, (0.0, end), starts,
        inputs={"road_height": roads}, rtol=1e-8, atol=1e-11,
        reductions={"wheel_center_z": ["max", "min"]},
    )  # fmt: skip
    judged = [
        _judge(model, {name: float(values[car]) for name, values in cars.items()},
               starts[car], end, roads[labels[car]], found.isel({found["success"].dims[0]: car}))
        for car in random.permutation(count)[:3]
    ]  # fmt: skip
    if not any(judged):
        raise UnjudgedError("every car that was looked at is refused")


def _judge(model, values, start, end, road, found):
    """Compare one car with the reference; return whether there is one."""
    success, name = bool(found["success"]), model.equations.NAME
    try:
        expected = _alone(model, values, start, end, road)
    except ModelError as error:
        if success:
            raise WrongError(f"{name} goes on where the reference is refused: {error}") from None
        return False
    if not success:
        raise WrongError(f"{name} ends: {found['reason'].item()}")
    half = start.size // 2
    off = np.abs(found["final_state"].values - expected)[:half]
    if not (off <= _TOLERANCE * (1.0 + np.abs(expected[:half]))).all():
        raise WrongError(f"{name} with {values} and {road}: {off} rad off after {end} s")
    return True


def _alone(model, values, start, end, road):
    """Return the last state of the reference."""
    constants = model.equations.prepare({**model.parameters, **values})
    names = model.input_names

    def rhs(time, state):
        given = {"road_height": road(time), "road_velocity": road.rate(time)}
        return model.equations.rhs(state, np.array([given.get(n, 0.0) for n in names]), constants)

    followed = solve_ivp(rhs, (0.0, end), start, "DOP853", rtol=1e-11, atol=1e-13, max_step=0.01)
    return np.array(followed.y[:, -1])
