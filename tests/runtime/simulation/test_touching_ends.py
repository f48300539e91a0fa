"""A motion ends where the ends of a spring meet, by every method, and goes on where they pass.

A spring pulls at an arm on a hinge from a point that lies on the circle of its end, or beside it.
The oracle of the times is the energy of the arm: ``t = integral dq / q'(q)``.
"""

from functools import cache

import numpy as np
import pytest
from kintrafo import SimulationError, System, compile, ensemble, simulate  # noqa: A004 (its name)
from kintrafo import generator as g
from kintrafo.simulation.dead_points import meanings
from kintrafo.simulation.solvers import native_available, native_methods
from kintrafo.simulation.trust import SINGULAR
from scipy.integrate import quad, solve_ivp

RADIUS, RATE, FREE, INERTIA = 0.3, 2000.0, 0.3, 0.01 + 1.0 * 0.2**2
START, SPEED, END = 0.5, -90.0, 0.05
METHODS = tuple(dict.fromkeys([*native_methods(), "BDF", "Radau", "LSODA", "RK45", "DOP853"]))
STEP = 1e-5


def flat(name, x, z):
    return g.flat(name, (x, z), name, "y")


@cache
def built():
    ground = g.Ground("ground")
    arm = g.Body("arm", 1.0, flat("arm_center", 0.2, 0.0), 0.01)
    hinge = g.hinge("hinge", ground, arm, flat("pin", 0.0, 0.0))
    spring = g.ForceElement(
        "spring",
        g.AlongLine((ground, flat("top", 0.6, 0.0)), (arm, flat("seat", RADIUS, 0.0))),
        (
            g.LinearSpring(
                rate=g.SpringRate("rate", RATE, "rate"),
                free_length=g.Length("free", FREE, "free length"),
            ),
        ),
    )
    return compile(
        g.Mechanism(
            name="touching_ends",
            title="Arm whose spring may have no length",
            joints=(hinge,),
            forces=(spring,),
            coordinates=(hinge.angle("angle", "angle"),),
        )
    )


def system(beside=0.0):
    """Return the arm with the top of its spring outside of the circle by a distance [m]."""
    return System(built(), {"top_x": RADIUS + beside})


def options(method):
    return {"step": STEP} if method == "RK4" else {"rtol": 1e-8, "atol": 1e-11}


def time_of_meeting():
    def energy(angle):
        return 0.5 * RATE * (2.0 * RADIUS * np.sin(0.5 * angle) - FREE) ** 2

    def slowness(angle):
        return 1.0 / np.sqrt(SPEED**2 + 2.0 * (energy(START) - energy(angle)) / INERTIA)

    return float(quad(slowness, 0.0, START, epsabs=1e-13)[0])


@pytest.mark.parametrize("method", METHODS)
def test_a_motion_ends_where_the_ends_meet(method):
    with pytest.raises(SimulationError, match="spring") as caught:
        simulate(system(), (0.0, END), [START, SPEED], method=method, **options(method))
    # ends have met where they are a 100,000th of their extent, 0.4 m, apart: at 22 m/s, 2e-7 s
    assert caught.value.time == pytest.approx(time_of_meeting(), abs=5e-7)


@cache
def followed_closely():
    """Return where the motion that passes beside ends, by SciPy in tiny steps."""
    arm, tiny = system(0.003), {"rtol": 1e-12, "atol": 1e-13, "max_step": 1e-5}
    return solve_ivp(
        lambda _, y: arm.evaluate("rhs", y), (0.0, END), [START, SPEED], "DOP853", **tiny
    ).y[:, -1]


@pytest.mark.parametrize("method", METHODS)
def test_a_motion_that_passes_beside_goes_on(method):
    """The force turns round over some 0.02 rad, within a fifth of a millisecond."""
    arm = system(0.003)
    found = simulate(arm, (0.0, END), [START, SPEED], method=method, **options(method))
    assert found.success
    # some hundred tolerances, at 90 rad/s
    assert found.y[:, -1] == pytest.approx(followed_closely(), abs=1e-4)


def test_an_ensemble_ends_like_each_of_its_systems():
    masses = np.linspace(0.9, 1.1, 9)
    found = ensemble(system(), {"arm_mass": masses}, (0.0, END), [START, SPEED])
    assert not found.success.values.any()
    assert all("the ends of spring coincide" in str(reason) for reason in found.reason.values)
    beside = ensemble(system(0.003), {"arm_mass": masses}, (0.0, END), [START, SPEED])
    assert beside.success.values.all()
    if native_available():
        one = System(built(), {"top_x": RADIUS + 0.003, "arm_mass": float(masses[2])})
        alone = simulate(one, (0.0, END), [START, SPEED], method="DormandPrince")
        np.testing.assert_array_equal(beside.final_state.values[2], alone.y[:, -1])


def test_all_but_pivots_is_watched():
    """Divisors of positions and forces are checked, for example of a wheel that lies flat."""
    from kintrafo.generated import macpherson_free_rack

    watched = meanings(macpherson_free_rack) & SINGULAR
    named = {
        name for (name, _), one in zip(macpherson_free_rack.GUARDS, watched, strict=True) if not one
    }
    assert named == {"pivot_beta1", "pivot_beta9", "shaft_level_squared_C", "shaft_level_squared_E"}
