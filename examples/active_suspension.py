"""Optimal control: the force in the strut of a quarter car over one bump, by CasADi and IPOPT.

It needs ``pip install "kintrafo[generator,casadi]"``. The road is known in advance. Between its
bounds the force is chosen so that acceleration and travel of the body and the variation of the
tyre force are least.
"""

import importlib.util
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import casadi as ca
import kintrafo
import numpy as np
from numpy.typing import NDArray

STEP, STEPS = 0.01, 50  # s; the force is constant in each step
SUBSTEPS = 4  # of Runge and Kutta
BUMP, START, LASTS = 0.04, 0.1, 0.08  # m, s, s
FORCE = 1500.0  # N, the greatest
# What weighs the same in the sum of squares: m/s^2, m, N, N
ACCELERATION, TRAVEL, LOAD, EFFORT = 1.0, 0.01, 1000.0, 3000.0


def road(time: Any) -> Any:
    """Return the height of the road [m]: one wave of a cosine."""
    wave = 0.5 * BUMP * (1.0 - ca.cos(2.0 * ca.pi * (time - START) / LASTS))
    return ca.if_else(ca.logic_and(time > START, time < START + LASTS), wave, 0.0)


def exported(model: kintrafo.System, rest: NDArray[np.float64]) -> Any:
    """Return the module of the equations for CasADi."""
    with TemporaryDirectory() as folder:
        path = kintrafo.export_model(model, Path(folder) / "quarter_car.py", "casadi", state=rest)
        spec = importlib.util.spec_from_file_location(path.stem, path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return module


def step_of(car: Any) -> ca.Function:
    """Return one step: to the next state, and by how much the cost grows."""
    start, force, begin = ca.SX.sym("state", len(car.STATE)), ca.SX.sym("force"), ca.SX.sym("time")
    constants = car.prepare(car.parameters())
    heave, speed = [*car.STATE].index("heave"), [*car.STATE].index("heave_rate")
    tyre = car.LABELS["signals"].index("tyre_force")
    still = float(car.signals(car.state(), car.inputs(), constants)[tyre])

    def rates(state: Any, time: Any) -> Any:
        inputs = car.inputs(strut_force=force, road_height=road(time))
        slopes = car.rhs(state, inputs, constants)
        load = (car.signals(state, inputs, constants)[tyre] - still) / LOAD
        travel = (state[heave] - car.STATE["heave"]) / TRAVEL
        effort = (force / EFFORT) ** 2
        cost = (slopes[speed] / ACCELERATION) ** 2 + travel**2 + load**2 + effort
        return ca.vertcat(slopes, cost)

    h, state, cost = STEP / SUBSTEPS, start, 0.0
    for i in range(SUBSTEPS):
        time = begin + i * h
        a = rates(state, time)
        b = rates(state + h / 2 * a[:-1], time + h / 2)
        c = rates(state + h / 2 * b[:-1], time + h / 2)
        d = rates(state + h * c[:-1], time + h)
        mean = h / 6 * (a + 2 * b + 2 * c + d)
        state, cost = state + mean[:-1], cost + mean[-1]
    return ca.Function("step", [start, force, begin], [state, cost])


def best(car: Any, most: float) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Return force, states and cost that are least with a force of at most so much."""
    problem, times = ca.Opti(), STEP * np.arange(STEPS)
    scale = np.array([0.01, 0.1, 0.1, 0.1, 1.0, 1.0])  # of the states: heave and two angles, rates
    states, force = problem.variable(len(scale), STEPS + 1), problem.variable(1, STEPS)
    there = ca.repmat(car.state(), 1, STEPS + 1) + ca.diag(scale) @ states
    ends, costs = step_of(car).map(STEPS)(there[:, :-1], most * force, times.reshape(1, -1))
    problem.subject_to(ca.vec(ca.diag(1 / scale) @ (there[:, 1:] - ends)) == 0)
    problem.subject_to(states[:, 0] == 0)
    problem.subject_to(problem.bounded(-1.0, ca.vec(force), 1.0))
    problem.minimize(ca.sum2(costs))
    problem.solver("ipopt", {"print_time": False}, {"print_level": 0, "sb": "yes"})
    found = problem.solve()  # raises an error where it does not converge
    value = float(found.value(ca.sum2(costs)))
    return most * found.value(force), found.value(there), value


def simulated(
    model: kintrafo.System, rest: NDArray[np.float64], force: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the last state of a simulation with this force, by an integrator of its own."""
    ends = STEP * np.arange(STEPS + 1)
    held = np.repeat(ends, 2)[1:-1], np.repeat(force, 2)
    times = np.linspace(0.0, ends[-1], 20 * STEPS + 1)
    heights = np.array([float(road(time)) for time in times])
    motion = kintrafo.simulate(
        model,
        (0.0, ends[-1]),
        rest,
        inputs={"strut_force": kintrafo.Samples(*held, "linear"), "road_height": (times, heights)},
    )
    assert motion.success
    return np.asarray(motion.y[:, -1])


def main() -> None:
    """Compare the best force with hardly any, and with a simulation of the compiled equations."""
    model = kintrafo.model_of(kintrafo.load("quarter_car"))
    rest = kintrafo.equilibrium(model)
    car = exported(model, rest)
    for most in (1.0, FORCE):  # N
        force, states, cost = best(car, most)
        apart = np.abs(simulated(model, rest, force) - states[:, -1]).max()
        print(f"at most {most:6.0f} N: sum {cost:.3f}, {apart:.0e} apart from a simulation")


if __name__ == "__main__":
    main()
