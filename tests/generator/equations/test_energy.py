"""Energy over a simulated second of a car with everything: what it loses is what dissipates.

The equations are those of the compiled model; the energies and powers are those of the oracle's
laws at the compiled poses and velocities. The forces enter the motion through Q and M alone, so an
error of either shows, as does one of B, which does no work of its own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache, partial
from typing import Any

import numpy as np
import pytest
from cases import Instant, car_parameters, counted_by, of_model
from kintrafo.generated import macpherson_general
from oracle import laws
from oracle.constraints import BODIES, KNUCKLE, WHEEL, Array, Pose, unit
from oracle.newton import Z_AXIS, Mechanism, observe
from oracle.reference import SPRING_SEGMENTS, Parameters
from scipy.integrate import solve_ivp

MODEL = macpherson_general
pytestmark = pytest.mark.slow

END = 0.5  # s: two periods of the road, in which both stops act and the tyre lifts off
TIMES = np.linspace(0.0, END, 51)
TOLERANCE = 1e-11
BEYOND = 1e-12
"""Time behind a kink at which the integration continues, so as not to find it again [s]."""


@dataclass(frozen=True)
class Instantaneous:
    """Energies and powers at one instant.

    Attributes
    ----------
    kinetic, potential : float
        The latter of gravity, spring and stops, J.
    dissipated : float
        What damper and friction take, W.
    tyre : float
        What the road does on the wheel through the tyre, W.
    """

    kinetic: float
    potential: float
    dissipated: float
    tyre: float


class Bench:
    """A car that hops on a road which moves up and down, its rack held."""

    def __init__(self, parameters: Parameters) -> None:
        self.given = of_model(MODEL, parameters)
        self.car = Mechanism(counted_by(MODEL, self.given))
        self.constants = MODEL.prepare(self.given)
        self.names = list(MODEL.INPUTS)

    def inputs(self, time: float) -> Array:
        """Return a road that a tyre leaves: 4 Hz and 40 mm up and down."""
        phase = 8.0 * np.pi * time
        road = {
            "road_height": 0.04 * np.sin(phase),
            "road_velocity": 0.04 * 8.0 * np.pi * np.cos(phase),
        }
        return np.array([road.get(name, 0.0) for name in self.names])

    def at(self, time: float, state: Array) -> Instantaneous:
        """Return what the state's motion holds and exchanges, by the oracle's laws."""
        given, car, inputs = self.given, self.car, self.inputs(time)
        arguments = state[:4], inputs, self.constants
        twist = MODEL.velocities(*arguments)
        pose = Pose(MODEL.positions(*arguments), MODEL.orientations(*arguments))
        seen = observe(car, pose)
        deflection = given["tyre_free_height"] + inputs[self.names.index("road_height")]
        deflection -= pose.position[WHEEL - 1, 2]
        rise = twist[WHEEL - 1, 5]
        closing = inputs[self.names.index("road_velocity")] - rise
        load = laws.tyre_load(given, float(deflection), float(closing))
        axis = seen.spin_axis
        upright = (Z_AXIS - axis[2] * axis) / (1.0 - axis[2] ** 2)
        slide_rate = self.slide_rate(pose, twist)
        return Instantaneous(
            kinetic=self.kinetic(pose, twist),
            potential=float(given["gravity"] * car.masses @ pose.position[:, 2])
            + laws.spring_energy(given, seen.spring_length)
            + sum(laws.stop_energy(given, side, seen.strut_length) for side in ("bump", "rebound")),
            dissipated=slide_rate
            * (laws.damper_force(given, slide_rate) + laws.friction_force(given, slide_rate)),
            tyre=float(load * upright @ twist[WHEEL - 1, 3:]),
        )

    def kinetic(self, pose: Pose, twist: Array) -> float:
        """Sum up the kinetic energies of the bodies."""
        total = 0.0
        for body in range(len(BODIES)):
            local = pose.rotation[body].T @ twist[body, :3]
            total += 0.5 * self.car.masses[body] * twist[body, 3:] @ twist[body, 3:]
            total += 0.5 * local @ self.car.inertias[body] @ local
        return float(total)

    def slide_rate(self, pose: Pose, twist: Array) -> float:
        """Return how fast the strut is compressed, m/s."""
        lower = self.car.point(pose, "strut_lower", KNUCKLE)
        velocity = twist[KNUCKLE - 1, 3:] + np.cross(
            twist[KNUCKLE - 1, :3], lower - pose.position[KNUCKLE - 1]
        )
        return float(-unit(lower - self.car.points["strut_top"]) @ velocity)

    def run(self, *, lossless: bool = False) -> tuple[Array, list[Instantaneous]]:
        """Integrate the motion, with dissipation and the tyre's work as two states more.

        Parameters
        ----------
        lossless
            Leave those two out: nothing is dissipated, and no tyre does work.
        """

        def derivative(time: float, state: Array) -> Array:
            motion = MODEL.rhs_rack_held(state[:4], self.inputs(time), self.constants)
            if lossless:
                return np.array(motion)
            now = self.at(time, state)
            return np.array([*motion, now.dissipated, now.tyre])

        beta1 = self.car.beta1_design - 0.1
        state = Instant(beta1, spin_rate=60.0).state(MODEL)
        if not lossless:
            state = np.append(state, [0.0, 0.0])
        states, begin = [], 0.0
        while begin < END:
            pieces = self.up_to_a_kink(derivative, begin, state)
            for piece, stop in zip(pieces, [*(p.t[0] for p in pieces[1:]), np.inf], strict=True):
                inside = (piece.t[0] <= TIMES) & (piece.t[-1] > TIMES) & (stop > TIMES)
                states += [piece.sol(time) for time in TIMES[inside]]
            begin, state = pieces[-1].t[-1], pieces[-1].y[:, -1]
        states = np.array([*states, state])
        return states, [self.at(t, y) for t, y in zip(TIMES, states, strict=True)]

    def up_to_a_kink(self, derivative: Any, begin: float, state: Array) -> list[Any]:
        """Integrate until a law has a kink, or to the end."""
        smooth = solve(derivative, begin, END, state, self.switches())
        if smooth.status == 0:
            return [smooth]
        # some stages of the last step have seen what is behind the kink: that step is done again
        end = smooth.t[-1] + BEYOND
        return [smooth, solve(derivative, smooth.t[-2], end, smooth.y[:, -2])]

    def switches(self) -> list[Callable[[float, Array], float]]:
        """Return events for the stops, the spring's knots, the tyre's load and its clearance."""
        given = self.given

        @lru_cache(maxsize=2)
        def signals(time: float, state: bytes) -> dict[str, float]:
            found = MODEL.signals(np.frombuffer(state)[:4], self.inputs(time), self.constants)
            return dict(zip(MODEL.SIGNALS, found.tolist(), strict=True))

        def signal(name: str, time: float, state: Array) -> float:
            return signals(time, state.tobytes())[name]  # all events ask at one state

        def deflection(time: float, state: Array) -> float:
            road = self.inputs(time)[self.names.index("road_height")]
            return given["tyre_free_height"] + road - signal("wheel_center_z", time, state)

        def load(time: float, state: Array) -> float:
            road_rate = self.inputs(time)[self.names.index("road_velocity")]
            closing = road_rate - signal("wheel_velocity", time, state)
            stiff, damped = given["tyre_rate"], given["tyre_damper_rate"]
            return stiff * deflection(time, state) + damped * closing

        def bump(time: float, state: Array) -> float:
            return signal("strut_length", time, state) - given["bump_stop_length"]

        def rebound(time: float, state: Array) -> float:
            return signal("strut_length", time, state) - given["rebound_stop_length"]

        def knot(i: int, time: float, state: Array) -> float:
            return signal("spring_length", time, state) - given[f"spring_table_knot_{i}"]

        # partials, to which an attribute can be given as to functions
        knots = [partial(knot, i) for i in range(SPRING_SEGMENTS + 1)]
        events = [bump, rebound, *knots]
        if given["tyre_rate"]:
            events += [deflection, load]
        for event in events:
            event.terminal = True
        return events


def solve(derivative: Any, begin: float, end: float, state: Array, events: Any = None) -> Any:
    """Integrate, up to the first event."""
    options = {"rtol": TOLERANCE, "atol": TOLERANCE, "max_step": 5e-3, "dense_output": True}
    result = solve_ivp(derivative, (begin, end), state, "DOP853", events=events, **options)
    assert result.success
    return result


def test_all_that_is_lost_is_dissipated() -> None:
    """Kinetic and potential energy change by what the tyre does less what the strut dissipates."""
    bench = Bench(car_parameters(1, MODEL))
    states, instants = bench.run()
    energy = np.array([now.kinetic + now.potential for now in instants])
    dissipated, tyre = states[:, 4], states[:, 5]
    balance = energy - energy[0] + dissipated - tyre
    # Some hundred joules go in and out. What remains are the errors of the integration: some
    # thousand steps, each good to its tolerance of some numbers of which the largest is a hundred
    # times the others.
    assert min(np.ptp(energy), np.ptp(tyre), np.ptp(dissipated)) > 50.0
    assert np.abs(balance).max() < 1e-10 * np.ptp(tyre)
    shown = MODEL.signals(
        states[:, :4], np.array([bench.inputs(t) for t in TIMES]), bench.constants
    )
    for name in ("bump_stop_force", "rebound_stop_force", "tyre_force"):
        force = shown[:, list(MODEL.SIGNALS).index(name)]
        assert (force == 0.0).any()
        assert np.abs(force).max() > 100.0


def test_nothing_is_lost_without_dissipation() -> None:
    """Between its stops, in the air, the suspension swings for ever."""
    names = ("damper_rate", "strut_friction", "tyre_rate", "tyre_damper_rate")
    parameters = car_parameters(1, MODEL)
    parameters |= dict.fromkeys([n for n in parameters if n.startswith("damper_table_")], 0.0)
    parameters |= dict.fromkeys(names, 0.0)
    _, instants = Bench(parameters).run(lossless=True)
    energy = np.array([now.kinetic + now.potential for now in instants])
    assert len(instants) == len(TIMES)
    assert {(now.dissipated, now.tyre) for now in instants} == {(0.0, 0.0)}
    kinetic = np.array([now.kinetic for now in instants])
    assert np.ptp(kinetic) > 50.0
    # errors of the integration again, of stops that are hit hard: some thousand steps. A knot of
    # the spring that is passed and passed back within a step is not seen: an order or two more.
    assert np.ptp(energy) < 2e-8 * np.ptp(kinetic)
