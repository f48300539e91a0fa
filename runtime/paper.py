"""The results of the paper: Figures 4, 5 and 6, and what there is to say about them.

J. A. M. Góis and C. A. P. Sarzeto, "Modelo de suspensão MacPherson utilizando transformadores
cinemáticos", Instituto Militar de Engenharia, Rio de Janeiro, 2000. The paper gives no hardpoints,
masses or rates; the reference car is this project's own, so the curves compare in kind.
"""

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .model import Model
from .positions import equilibrium, state_at_height
from .simulation import Simulation, simulate

Array = NDArray[np.float64]

REST_HEIGHT = 0.300  # height of the wheel centre at rest [m]
TRAVEL = 0.150  # to either side of it [m]
START_HEIGHT = 0.325  # [m]
SPIN_RATE = 2.0 * np.pi * 14.8  # 14.8 revolutions per second [rad/s]
DURATION = 1.0  # [s]
OUTPUT_INTERVAL = 1e-4  # of the paper's integration routines [s]

PAPER_RUNGE_KUTTA_S = 360.0  # "more than 6 min", IMSL DIVPRK, 233 MHz Pentium
PAPER_GEAR_S = 13.0  # IMSL DIVPAG, same machine


@dataclass(frozen=True)
class Kinematics:
    """Figures 4 and 5: the wheel over its travel, rack held at zero.

    Attributes
    ----------
    x, y, z : ndarray
        Wheel centre in chassis axes [m].
    camber, steer : ndarray
        [rad]; camber positive with the top outboard, steer positive to the left.
    side : str
        'left' or 'right'.
    design : int
        Index of the design position, which is one of the points.
    """

    x: Array
    y: Array
    z: Array
    camber: Array
    steer: Array
    side: str
    design: int


@dataclass(frozen=True)
class Dynamics:
    """Figure 6: one second from 0.325 m with the wheel spinning.

    Attributes
    ----------
    result : Simulation
        Output every 1e-4 s, as in the paper.
    seconds : float
        Time that the integration took, output included [s].
    """

    result: Simulation
    seconds: float


def kinematics(model: Model, points: int = 121) -> Kinematics:
    """Compute Figures 4 and 5.

    Parameters
    ----------
    model : Model
    points : int, optional
        Number of equally spaced wheel heights; the design position comes besides.

    Returns
    -------
    Kinematics
    """
    ends = (REST_HEIGHT - TRAVEL, REST_HEIGHT + TRAVEL)
    design_height = float(model.signal("wheel_center_z", model.design_state))
    heights = np.linspace(*ends, points)
    # the design position is one of them: an equally spaced one where that is the same
    heights = np.union1d(heights[np.abs(heights - design_height) > 1e-9], design_height)
    states = np.array([state_at_height(model, z) for z in heights])
    signals = model.signals(states)
    return Kinematics(
        x=signals["wheel_center_x"],
        y=signals["wheel_center_y"],
        z=signals["wheel_center_z"],
        camber=signals["camber"],
        steer=signals["steer"],
        side=model.suspension.vehicle.side,
        design=int(np.searchsorted(heights, design_height)),
    )


def dynamics(model: Model) -> Dynamics:
    """Compute Figure 6 by Gear's method.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Dynamics
    """
    start = state_at_height(model, START_HEIGHT, spin_rate=SPIN_RATE)
    times = np.linspace(0.0, DURATION, round(DURATION / OUTPUT_INTERVAL) + 1)
    before = time.perf_counter()
    result = simulate(model, (0.0, DURATION), start, t_eval=times, rtol=1e-6, atol=1e-9)
    return Dynamics(result, time.perf_counter() - before)


@dataclass(frozen=True)
class Rest:
    """The state of rest and how the suspension moves about it.

    Attributes
    ----------
    state : ndarray
        Equilibrium, the wheel spinning at 14.8 revolutions per second.
    height : float
        Of the wheel centre [m].
    eigenvalues : tuple of complex
        The two of the wheel-hop mode [1/s].
    """

    state: Array
    height: float
    eigenvalues: tuple[complex, complex]

    @property
    def oscillates(self) -> bool:
        """Whether the wheel-hop mode is underdamped."""
        return self.eigenvalues[0].imag != 0.0

    @property
    def natural_frequency(self) -> float:
        """Undamped natural frequency of the wheel-hop mode [Hz]."""
        return float(np.sqrt(abs(self.eigenvalues[0] * self.eigenvalues[1]))) / (2.0 * np.pi)

    @property
    def damping_ratio(self) -> float:
        """Damping ratio of the wheel-hop mode; above one where it does not oscillate."""
        total = self.eigenvalues[0] + self.eigenvalues[1]
        return -total.real / (2.0 * 2.0 * np.pi * self.natural_frequency)

    @property
    def eigenvalues_text(self) -> str:
        """The eigenvalues for a person to read."""
        first, second = self.eigenvalues
        if self.oscillates:
            return f"{first.real:.4f} +- {abs(first.imag):.4f} i"
        return f"{first.real:.4f} and {second.real:.4f}"

    @property
    def mode_text(self) -> str:
        """The wheel-hop mode for a person to read."""
        text = f"{self.natural_frequency:.2f} Hz, damping ratio {self.damping_ratio:.3f}"
        if self.oscillates:
            return text
        times = " and ".join(f"{-1e3 / value.real:.3g} ms" for value in self.eigenvalues)
        return f"{text}: overdamped, time constants {times}"


def rest(model: Model) -> Rest:
    """Find the equilibrium and the eigenvalues of the exact Jacobian there.

    Parameters
    ----------
    model : Model

    Returns
    -------
    Rest
    """
    state = equilibrium(model, spin_rate=SPIN_RATE)
    height = float(model.signal("wheel_center_z", state))
    values = model.eigenvalues(state)
    hop = sorted(values, key=abs)[-2:]  # the other two are the zeros of the spin
    first, second = sorted(map(complex, hop), key=lambda v: (-v.imag, v.real))
    return Rest(state, height, (first, second))
