"""The second of simulation in each tool, with settings from loose to tight."""

import importlib.util
import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any
from unittest.mock import patch

import numpy as np
from kintrafo import Model, simulate
from kintrafo.simulation import solvers

from .case import SAMPLES, Array, instant, start
from .compiled import FLAGS, Library

Run = Callable[[], Array]
"""Simulates the second and returns beta1 at the samples."""

TOLERANCES: Array = 10.0 ** -np.arange(4.0, 11.1, 0.25)
"""From loose to tight."""


@dataclass(frozen=True)
class Simulator:
    """One way to simulate the second."""

    name: str  # tool and method
    settings: tuple[Any, ...]  # from loose to tight
    prepare: Callable[[Any], Run]  # from a setting to a `Run`; its time is build time


def kintrafo(method: str) -> Simulator:
    """Return this project's ``simulate`` as its users call it."""
    model = Model("reference_car")

    span = (float(SAMPLES[0]), float(SAMPLES[-1]))

    def solve(tolerance: float) -> Array:
        options = {"rtol": tolerance, "atol": tolerance}
        result = simulate(model, span, start(), method=method, t_eval=SAMPLES, **options)
        return np.asarray(result.y[0])

    name = "kintrafo.simulate by default" if method == "BDF" else "kintrafo.simulate"
    return Simulator(
        f"{name}, {method}",
        tuple(TOLERANCES.tolist()),
        lambda tolerance: lambda: solve(tolerance),
    )


def native(method: str) -> Simulator:
    """Return what ``simulate`` calls, a compiled function, as the other tools are called."""
    model, span = Model("reference_car"), (float(SAMPLES[0]), float(SAMPLES[-1]))
    solver = solvers.sundials

    def prepare(tolerance: float) -> Run:
        options = {"rtol": tolerance, "atol": tolerance, "t_eval": SAMPLES, "method": method}
        with patch.object(solver, "integrate", wraps=solver.integrate) as called:
            simulate(model, span, start(), **options)
        given, named = called.call_args
        return lambda: np.asarray(solver.integrate(*given, **named)["output"][:, 1])

    return Simulator(f"kintrafo's solver alone, {method}", tuple(TOLERANCES.tolist()), prepare)


def runge_kutta(name: str, library: Library, begin: Array) -> Simulator:
    """Return classical Runge-Kutta with fixed steps in C around a compiled right-hand side."""
    interval = float(SAMPLES[1])

    def prepare(steps: int) -> Run:
        return lambda: library.runge_kutta(begin, len(SAMPLES), steps, interval / steps)

    return Simulator(f"{name}, RK4 in C", tuple(range(1, 41)), prepare)


_JIT = {"jit": True, "compiler": "shell", "jit_options": {"flags": list(FLAGS["native"])}}


def casadi_plain() -> Iterator[Simulator]:
    """Yield CasADi's CVODES as one takes it from the manual: Lagrange, every option by default."""
    from . import casadi_tree  # noqa: PLC0415  # may not be installed

    model = casadi_tree.build("lagrange", literal=False)
    for ending, options in (("", {}), (", jit", _JIT)):
        name = f"CasADi CVODES by default, lagrange{ending}"
        yield Simulator(name, tuple(TOLERANCES.tolist()), _cvodes(model, options))


def casadi_tuned() -> Iterator[Simulator]:
    """Yield CasADi's CVODES: multistep method, iteration, interpreted or compiled functions."""
    from . import casadi_tree  # noqa: PLC0415  # may not be installed

    for formulation in ("lagrange", "routh", "implicit"):
        model = casadi_tree.build(formulation, literal=False)
        for multistep, iteration in (
            ("bdf", "newton"),
            ("adams", "newton"),
            ("adams", "functional"),
        ):
            for compiled in (False, True):
                options: dict[str, Any] = {
                    "linear_multistep_method": multistep,
                    "nonlinear_solver_iteration": iteration,
                    "max_num_steps": 100000,
                }
                yield Simulator(
                    f"CasADi CVODES tuned, {formulation}, {multistep}-{iteration}"
                    f"{', jit' if compiled else ''}",
                    tuple(TOLERANCES[4:].tolist()),
                    _cvodes(model, options | (_JIT if compiled else {})),
                )


def _cvodes(model: Any, options: dict[str, Any]) -> Callable[[float], Run]:
    import casadi as ca  # noqa: PLC0415  # may not be installed

    state, given = ca.SX.sym("x", 4), ca.SX.sym("p", model.constants.size)
    equations = {"x": state, "p": given, "ode": model.function(state, given)}
    begin = ca.DM(start())
    constants = ca.DM(model.constants)

    def prepare(tolerance: float) -> Run:
        chosen = {**options, "reltol": tolerance, "abstol": tolerance}
        times = SAMPLES[1:].tolist()
        solver = ca.integrator("second", "cvodes", equations, 0.0, times, chosen)

        def run() -> Array:
            result = solver(x0=begin, p=constants)["xf"]
            return np.append(start()[0], np.asarray(result)[0])

        return run

    return prepare


def exudyn() -> Iterator[Simulator]:
    """Yield Exudyn's generalised-alpha method, directly and with Richardson's extrapolation."""
    from . import exudyn_model as peer  # noqa: PLC0415  # may not be installed

    def direct(setting: Any) -> Run:
        system = peer.Exudyn(instant(start()))
        return lambda: system.run(setting)

    def extrapolated(setting: Any) -> Run:
        system = peer.Exudyn(instant(start()))
        return lambda: peer.extrapolated(system, setting)

    for radius, modified in ((0.9, True), (0.9, False), (0.6, True), (0.6, False)):
        newton = "modified Newton" if modified else "Newton"
        name = f"Exudyn generalised-alpha {radius}, {newton}"
        for steps, ending, prepare in (
            ((6000, 8000, 10000, 12000), "", direct),
            ((800, 1000, 1200, 1600), ", extrapolated", extrapolated),
        ):
            settings = tuple(peer.Setting(count, radius, modified) for count in steps)
            yield Simulator(name + ending, settings, prepare)


def installed(package: str) -> bool:
    """Return whether a package can be imported."""
    return importlib.util.find_spec(package) is not None


def seconds_of(run: Run, budget: float) -> list[float]:
    """Return the times of runs, s: as many as the budget has room for, and one at least."""
    times: list[float] = []
    while sum(times) < budget:
        begin = time.perf_counter()
        run()
        times.append(time.perf_counter() - begin)
    return times
