"""The common case: the reference car, the standard start and the reference trajectory."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import numpy.typing as npt
from kintrafo.generated import macpherson
from oracle.constraints import ARM, KNUCKLE, WHEEL, Pose
from oracle.multipliers import solve_prescribed, solve_twist
from oracle.newton import Mechanism, solve_pose
from oracle.reference import DYNAMICS, SPIN_RATE, Parameters, reference_parameters
from scipy.integrate import solve_ivp

REPOSITORY = Path(__file__).resolve().parents[2]
Array = npt.NDArray[np.float64]

ACCURACY = 1e-6
"""Largest error of the arm angle at which the simulations are compared, rad."""

SAMPLES: Array = np.linspace(0.0, 1.0, 101)
"""Times at which every tool gives the arm angle, s; the error is the largest over these."""

TABLE_LENGTH = 64
"""Number of states that a timing loop goes through."""

MASSIVE = (ARM, KNUCKLE, WHEEL)
"""The bodies of the reference car that have mass, as indices of the oracle."""


@dataclass(frozen=True)
class Instant:
    """A state and what the independent reference says about it."""

    state: Array  # beta1 (rad), wheel spin (rad), beta1 rate, spin rate (rad/s), (4,)
    pose: Pose  # of the bodies
    twist: Array  # velocities of centres of mass, angular velocities, chassis axes, (6, 6)
    acceleration: Array  # second derivatives of beta1 and spin, rad/s², (2,)


@cache
def car() -> Mechanism:
    """Return the reference car as the oracle knows it."""
    return Mechanism(reference_parameters())


def parameters() -> Parameters:
    """Return the reference car's flat parameter dict, SI units."""
    return dict(car().parameters)


def start() -> Array:
    """Return the standard start: wheel at 0.325 m at rest, spinning; shape (4,)."""
    return np.array([car().beta1_design - DYNAMICS[0, 1], 0.0, 0.0, SPIN_RATE])


def instant(state: Array) -> Instant:
    """Solve pose, twist and accelerations of a state with the oracle.

    Parameters
    ----------
    state : ndarray, shape (4,)
        See `Instant`.

    Returns
    -------
    Instant
        With the state.
    """
    beta1, spin, *rates = (float(value) for value in state)
    pose = solve_pose(car(), beta1, 0.0, spin)
    solution = solve_prescribed(car(), pose, *rates)
    return Instant(
        np.array(state, dtype=float),
        pose,
        solve_twist(car(), pose, *rates),
        solution.coordinate_accelerations[:2],
    )


@cache
def random_instants() -> tuple[Instant, ...]:
    """Return states within the travel, at the rates of a rough road."""
    rng = np.random.default_rng(2000)
    span = np.array([0.35, 4.0, 4.0, 90.0])
    centre = np.array([car().beta1_design, 0.0, 0.0, 0.0])
    return tuple(instant(centre + span * rng.uniform(-1.0, 1.0, 4)) for _ in range(TABLE_LENGTH))


@cache
def reference_angles() -> Array:
    """Return beta1 at `SAMPLES` from the standard start, to about 1e-12; shape (101,), rad.

    It is checked against the stored trajectory of the independent reference.
    """
    solution = solve_ivp(
        lambda _, state: macpherson.rhs_rack_held(state),
        (0.0, 1.0),
        start(),
        "DOP853",
        rtol=2.3e-14,
        atol=1e-15,
        max_step=2e-3,
        dense_output=True,
    )
    stored = car().beta1_design - DYNAMICS[:, 1]
    worst = np.abs(solution.sol(DYNAMICS[:, 0])[0] - stored).max()
    if worst > 1e-9:
        message = f"the reference trajectory is off by {worst:.1e} rad"
        raise RuntimeError(message)
    angles: Array = solution.sol(SAMPLES)[0]
    return angles


def angle_error(angles: Array) -> float:
    """Return the largest error of beta1 at `SAMPLES`, rad."""
    return float(np.abs(np.asarray(angles) - reference_angles()).max())
