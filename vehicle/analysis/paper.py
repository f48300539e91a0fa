"""The results of the paper: Figures 4, 5 and 6, and the state of rest.

J. A. M. Góis and C. A. P. Sarzeto, "Modelo de suspensão MacPherson utilizando transformadores
cinemáticos", Instituto Militar de Engenharia, Rio de Janeiro, 2000. The paper has no hardpoints,
masses or rates; those of the reference car are this project's, so only the shape of curves agrees.
"""

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...core.named_types import Array
from ...systems.linearisation import linearise
from ...systems.modes import Mode
from ..assembly.equilibrium import equilibrium
from ..models.model import Model
from ..models.positions import arm_angles, state_at_height
from ..models.reach import at_rest

if TYPE_CHECKING:
    from ...simulation.result import Simulation


REST_HEIGHT = 0.300  # height of the wheel centre at rest [m]
TRAVEL = 0.150  # to either side of it [m]
START_HEIGHT = 0.325  # [m]
SPIN_RATE = 2.0 * np.pi * 14.8  # 14.8 revolutions per second [rad/s]
DURATION = 1.0  # [s]
OUTPUT_INTERVAL = 1e-4  # of the paper's integration routines [s]

PAPER_RUNGE_KUTTA_S = 360.0  # "more than 6 min", IMSL DIVPRK, 233 MHz Pentium
PAPER_GEAR_S = 13.0  # IMSL DIVPAG, same machine


@dataclass(frozen=True)
class PaperKinematics:
    """Figures 4 and 5: motion of the wheel over its travel, rack held at zero."""

    # wheel centre in chassis axes [m]
    x: Array
    y: Array
    z: Array
    # [rad]; camber positive with the top outboard, steer positive to the left
    camber: Array
    steer: Array
    side: str  # 'left' or 'right'
    design: int  # index of the design position, which is one of the points


@dataclass(frozen=True)
class PaperDynamics:
    """Figure 6: one second from a wheel centre at 0.325 m, with the wheel spinning."""

    result: "Simulation"  # output every 1e-4 s, as in the paper
    seconds: float  # wall-clock time of the integration, output included [s]


def kinematics(model: Model, points: int = 121) -> PaperKinematics:
    """Return the curves of Figures 4 and 5, at equally spaced wheel heights and at design."""
    ends = (REST_HEIGHT - TRAVEL, REST_HEIGHT + TRAVEL)
    design_height = float(model.signal("wheel_center_z", model.design_state))
    heights = np.linspace(*ends, points)
    # the design position replaces an equally spaced one that differs by rounding only
    heights = np.union1d(heights[np.abs(heights - design_height) > 1e-9], design_height)
    signals = model.signals(*at_rest(model, arm_angles(model, heights)))
    return PaperKinematics(
        x=signals["wheel_center_x"],
        y=signals["wheel_center_y"],
        z=signals["wheel_center_z"],
        camber=signals["camber"],
        steer=signals["steer"],
        side=model.suspension.vehicle.side,
        design=int(np.searchsorted(heights, design_height)),
    )


def dynamics(model: Model) -> PaperDynamics:
    """Return the simulation of Figure 6 by Gear's method."""
    from ...simulation.simulate import simulate  # noqa: PLC0415 (slow to import)

    start = state_at_height(model, START_HEIGHT, spin_rate=SPIN_RATE)
    times = np.linspace(0.0, DURATION, round(DURATION / OUTPUT_INTERVAL) + 1)
    before = time.perf_counter()
    result = simulate(model, (0.0, DURATION), start, t_eval=times, rtol=1e-6, atol=1e-9)
    return PaperDynamics(result, time.perf_counter() - before)


@dataclass(frozen=True)
class PaperRest:
    """The state of rest and the wheel-hop mode about it."""

    state: Array  # equilibrium, the wheel spinning at 14.8 revolutions per second
    height: float  # of the wheel centre [m]
    hop: Mode


def rest(model: Model) -> PaperRest:
    """Return the equilibrium and the wheel-hop mode there."""
    state = equilibrium(model, spin_rate=SPIN_RATE)
    height = float(model.signal("wheel_center_z", state))
    return PaperRest(state, height, linearise(model, state).mode_of(model.names.arm))
