"""Braking to standstill: how stiff a rolling wheel is, and what each method takes for it.

A quarter of a car brakes from 100 km/h: a body that moves ahead, a wheel on a spring, its spin, and
a tyre by Magic Formula. The slip of the tyre is steady, or follows along the relaxation lengths, or
the wheel is on a stiff longitudinal bush in addition. ``make benchmark-braking`` fills the page.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import kintrafo
import numpy as np
import typer
from kintrafo import SimulationError, System, simulate
from kintrafo import generator as g
from kintrafo.core.units import KM_PER_H
from numpy.typing import NDArray
from rich.console import Console
from rich.markdown import Markdown

from .report import count, fill_page, markdown_table, seconds_of

Array = NDArray[np.float64]

SPEED, DURATION, TORQUE = 100.0 / KM_PER_H, 5.0, 900.0  # m/s, s, N m
BODY, WHEEL, INERTIA, RADIUS = 340.0, 40.0, 1.1, 0.31  # kg, kg, kg m^2, m
STILL = 0.5  # spin below which the brake fades [rad/s]
TIMES = np.linspace(0.0, DURATION, 501)
REPEATS = 3
CASES = {
    "steady slip": {"relaxing": False, "bush": False},
    "relaxation": {"relaxing": True, "bush": False},
    "relaxation, on a bush": {"relaxing": True, "bush": True},
}

METHODS: dict[str, dict[str, Any]] = {
    "RK4, 1 ms": {"method": "RK4", "step": 1e-3},
    "RK4, 0.1 ms": {"method": "RK4", "step": 1e-4},
    "RODASP, 1 ms": {"method": "RODASP", "step": 1e-3},
    "RODASP, 4 ms": {"method": "RODASP", "step": 4e-3},
    "Dormand-Prince, 1e-6": {"method": "DormandPrince"},
    "Gear (BDF), 1e-6": {"method": "BDF", "rtol": 1e-6, "atol": 1e-9},
}


@dataclass(frozen=True)
class Point:
    """One method on one case: evaluations, Jacobians, seconds, error of the distance [m]."""

    steps: int
    evaluations: int
    jacobians: int
    seconds: float
    error: float


def formulation(*, relaxing: bool, bush: bool) -> g.Formulation:
    """Return a quarter of a car that brakes: a wheel, and a body that moves ahead.

    Parameters
    ----------
    relaxing
        Whether slips follow along the relaxation lengths.
    bush
        Whether the wheel carrier is on a longitudinal bush.
    """
    center = g.Point("wheel_center", (0.0, 0.0, RADIUS - 0.02), "wheel centre")
    axis = g.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, to the left")
    small = (0.1, 0.0, 0.3)
    body, fork = g.Body("body", BODY, small), g.Body("fork", 1.0, small)
    carrier = g.Body("carrier", WHEEL / 2, small)
    wheel = g.Rotor("wheel", WHEEL / 2, center, axis=axis, spin=INERTIA, diametral=0.6)
    ahead = g.Prismatic("ahead", g.Ground("road"), body, g.FORWARD)
    heave = g.Prismatic("heave", body, fork if bush else carrier, g.UP)
    fore = g.Prismatic("fore", fork, carrier, g.FORWARD)
    spin = g.Revolute("spin", carrier, wheel, g.Line(center, axis))
    joints = (ahead, heave, *((fore,) if bush else ()), spin)
    tyre = g.RollingTyre(
        name="tyre",
        wheel=g.Wheel(carrier, center, axis),
        bearing=spin,
        law=g.LinearContact(name="tyre"),
        road=g.Input("road_height", "m", "height of the road"),
        deflections=(
            g.InternalState("tyre_along", "m", "deflection of the contact, forward"),
            g.InternalState("tyre_across", "m", "deflection of the contact, to the left"),
        )
        if relaxing
        else None,
    )
    brake = g.Friction(
        g.MomentLevel("brake_torque", TORQUE, "torque of the brake"),
        g.AngularSpeed("brake_speed", STILL, "spin at which 71 % of it acts"),
    )
    forces: list[g.Force] = [
        g.Weight(), tyre, _strut("strut", heave, 20e3, 1500.0, free=-0.167),
        g.ForceElement("brake", g.AlongHinge(spin), (brake,)),
    ]  # fmt: skip
    if bush:
        forces.append(_strut("bush", fore, 5e6, 3e3, free=0.0))
    mechanism = g.Mechanism(
        name=f"braking{relaxing:d}{bush:d}",
        title="a quarter of a car that brakes",
        joints=joints,
        forces=tuple(forces),
        coordinates=(
            *(j.slide(f"{j.name}_slide", f"slide of {j.name}") for j in joints[:-1]),
            spin.angle("spin_angle", "angle of the wheel"),
        ),
    )
    return g.Formulation(mechanism.name, mechanism.title, mechanism, independent=joints)


def _strut(
    name: str, guide: g.Prismatic, rate: float, damping: float, *, free: float
) -> g.ForceElement:
    spring = g.LinearSpring(
        g.SpringRate(f"{name}_rate", rate, "rate"),
        free_length=g.Displacement(f"{name}_free", free, "slide without force"),
    )
    damper = g.LinearDamper(g.DamperRate(f"{name}_damping", damping, "rate"))
    return g.ForceElement(name, g.AlongGuide(guide), (spring, damper))


@cache
def system(case: str) -> System:
    """Return the compiled system of a case; its tyre slides without smoothing down to 0.1 m/s."""
    return System(kintrafo.compile(formulation(**CASES[case])), {"tyre_vxlow": 0.1})


def start(model: System) -> Array:
    """Return the state in which the wheel rolls freely."""
    # the deflection under load, and the radius at which it rolls, of the linear tyre
    spin = SPEED / model.parameters["tyre_effective_radius"]
    found: Array = model.state(ahead_slide_rate=SPEED, spin_angle_rate=spin)
    return found


def fastest(model: System, speeds: tuple[float, ...]) -> list[float]:
    """Return the largest magnitude of the eigenvalues on the way, at some speeds [1/s]."""
    found = simulate(model, (0.0, DURATION), start(model), t_eval=TIMES)
    speed = found.y[model.state_names.index("ahead_slide_rate")]
    rates = []
    for wanted in speeds:
        at = np.abs(speed - wanted).argmin()
        jacobian = model.evaluate("rhs_jacobian", found.y[:, at], model.inputs())
        rates.append(float(np.abs(np.linalg.eigvals(jacobian)).max()))
    return rates


def measure(case: str, options: dict[str, Any], truth: Array) -> Point | str:
    """Return the steps and time of a method, or the reason why it ends."""
    model = system(case)

    def run() -> kintrafo.Simulation:
        return simulate(model, (0.0, DURATION), start(model), t_eval=TIMES, **options)

    try:
        found = run()
    except SimulationError as error:
        longest = error.reason.partition("needs steps of ")[2].partition(" s")[0]
        return f"{float(longest) * 1e3:.2g}" if longest else error.reason
    place = model.state_names.index("ahead_slide")
    seconds = min(seconds_of(run) for _ in range(REPEATS))
    error = float(np.abs(found.y[place] - truth[place]).max())
    return Point(found.steps, found.nfev, found.njev, seconds, error)


def rows(case: str) -> Iterator[tuple[str, ...]]:
    """Yield the rows of a case."""
    model = system(case)
    truth = simulate(
        model, (0.0, DURATION), start(model), method="Radau", t_eval=TIMES, rtol=1e-10, atol=1e-12
    ).y
    for method, options in METHODS.items():
        found = measure(case, options, truth)
        if isinstance(found, str):
            yield case, method, "-", "-", "-", "-", "-", found
            continue
        yield (
            case, method, count(found.steps), count(found.evaluations), count(found.jacobians),
            f"{found.seconds * 1e3:.2g}", f"{found.error * 1e3:.1e}", "",
        )  # fmt: skip


def run(
    page: Annotated[Path | None, typer.Option(help="Page of docs/ with the tables.")] = None,
    *,
    quick: Annotated[bool, typer.Option("--quick", help="Steady slip alone.")] = False,
) -> None:
    """Measure all cases by all methods."""
    cases = list(CASES)[:1] if quick else list(CASES)
    speeds = (25.0, 5.0, 1.0, 0.0)
    header = ("case", *(f"at {speed:g} m/s [1/s]" for speed in speeds))
    rates = [(case, *(f"{r:,.0f}" for r in fastest(system(case), speeds))) for case in cases]
    columns = (
        "case", "method", "steps", "evaluations", "Jacobians", "time [ms]",
        "error of the distance [mm]", "not stable: longest stable step [ms]",
    )  # fmt: skip
    blocks = {
        "braking_rates": markdown_table(header, rates),
        "braking": markdown_table(columns, [row for case in cases for row in rows(case)]),
    }
    Console().print(Markdown("\n\n".join(blocks.values())))
    if page is not None:
        fill_page(page, blocks)


if __name__ == "__main__":
    typer.run(run)
