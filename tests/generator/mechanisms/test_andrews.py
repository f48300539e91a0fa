"""Andrews' squeezer against its published equations and its published solution.

Source: the IVP test set (problem "andrews"), after Hairer & Wanner, *Solving Ordinary Differential
Equations II*, section VII.7. The equations are those of the book: seven angles, six constraints.
The solution at 0.03 s was computed with the code PSIDE at a tolerance of 1e-14.

**How good the published digits are.** The published angles differ from those of the model, which is
first seen to be the book's problem to 20 digits, by one and the same shift in time, 1.005e-12 s,
the phase error of an integration over two and a half turns: beta and theta have ten digits right,
and without the shift all seven angles agree as far as double precision writes them. The published
rates of beta and theta have nine to ten digits right as well; those of the slower angles have seven
to eight, and leave up to 1e-8 m/s in the derivatives of the constraints, where ours leave nothing.
"""

import mpmath
import numpy as np
import pytest
import sympy as sp
from kintrafo.generated import andrews as compiled
from kintrafo.generator.mechanisms import andrews
from mpmath import mpf
from scipy.integrate import solve_ivp
from support.symbolic import python

DIGITS = 25
END = "0.03"
TORQUE = "0.033"

PUBLISHED = {
    "beta": (0.1581077119629904e2, 0.1139920302151208e4),
    "theta": (-0.1575637105984298e2, -0.1424379294994111e4),
    "gamma": (0.4082224013073101e-1, 0.1103291221937134e2),
    "phi": (-0.5347301163226948e0, 0.1929337464421385e2),
    "delta": (0.5244099658805304e0, 0.5735699284790808e0),
    "omega": (0.5347301163226948e0, -0.1929337464421385e2),
    "epsilon": (0.1048080741042263e1, 0.3231791658026955e0),
}
"""Angle and its rate at 0.03 s; PSIDE at a tolerance of 1e-14."""

ANGLES = tuple(PUBLISHED)


# -- the book's equations --------------------------------------------------------------------------


LENGTHS = {"d": "0.028", "da": "0.0115", "e": "0.02", "ea": "0.01421", "rr": "0.007",
           "ra": "0.00092", "ss": "0.035", "sa": "0.01874", "sb": "0.01043", "sc": "0.018",
           "sd": "0.02", "ta": "0.02308", "tb": "0.00916", "u": "0.04", "ua": "0.01228",
           "ub": "0.00449", "zf": "0.02", "zt": "0.04", "fa": "0.01421", "xb": "-0.03635",
           "yb": "0.03273", "xc": "0.014", "yc": "0.072"}  # fmt: skip
MASSES = ("0.04325", "0.00365", "0.02373", "0.00706", "0.07050", "0.00706", "0.05498")
INERTIAS = ("2.194e-6", "4.410e-7", "5.255e-6", "5.667e-7", "1.169e-5", "5.667e-7", "1.912e-5")
SPRING_RATE, FREE_LENGTH = "4530", "0.07785"


def lengths():
    """Return the dimensions by the names of the book, m, in the present precision."""
    return {name: mpf(text) for name, text in LENGTHS.items()}


def book_accelerations(angles, rates):
    """Return the second derivatives of the seven angles by the equations of the book."""
    k = lengths()
    mass, forces = _book_inertia(k, angles, rates)
    gradient, convective = _book_constraints(k, angles, rates)
    system = mpmath.zeros(13, 13)
    system[:7, :7], system[7:, :7], system[:7, 7:] = mass, gradient, gradient.T
    right = mpmath.matrix([*forces, *(-c for c in convective)])
    return dict(zip(ANGLES, mpmath.lu_solve(system, right)[:7], strict=True))


def _book_inertia(k, angles, rates):
    """Return mass matrix and forces of the book, constraints apart."""
    m, i = ([mpf(text) for text in texts] for texts in (MASSES, INERTIAS))
    sin = {name: mpmath.sin(angle) for name, angle in angles.items()}
    cos = {name: mpmath.cos(angle) for name, angle in angles.items()}
    v = rates
    short, lever = k["e"] - k["ea"], k["zf"] - k["fa"]
    mass = mpmath.zeros(7, 7)
    mass[0, 0] = m[0] * k["ra"] ** 2 + i[0] + i[1]
    mass[0, 0] += m[1] * (k["rr"] ** 2 - 2 * k["da"] * k["rr"] * cos["theta"] + k["da"] ** 2)
    mass[1, 0] = mass[0, 1] = m[1] * (k["da"] ** 2 - k["da"] * k["rr"] * cos["theta"]) + i[1]
    mass[1, 1] = m[1] * k["da"] ** 2 + i[1]
    mass[2, 2] = m[2] * (k["sa"] ** 2 + k["sb"] ** 2) + i[2]
    mass[3, 3] = m[3] * short**2 + i[3]
    mass[4, 3] = mass[3, 4] = m[3] * (short**2 + k["zt"] * short * sin["phi"]) + i[3]
    mass[4, 4] = m[3] * (k["zt"] ** 2 + 2 * k["zt"] * short * sin["phi"] + short**2)
    mass[4, 4] += m[4] * (k["ta"] ** 2 + k["tb"] ** 2) + i[3] + i[4]
    mass[5, 5] = m[5] * lever**2 + i[5]
    mass[6, 5] = mass[5, 6] = m[5] * (lever**2 - k["u"] * lever * sin["omega"]) + i[5]
    mass[6, 6] = m[5] * (lever**2 - 2 * k["u"] * lever * sin["omega"] + k["u"] ** 2)
    mass[6, 6] += m[6] * (k["ua"] ** 2 + k["ub"] ** 2) + i[5] + i[6]
    arm_x = k["sd"] * cos["gamma"] + k["sc"] * sin["gamma"]
    arm_y = k["sd"] * sin["gamma"] - k["sc"] * cos["gamma"]
    span_x, span_y = k["xb"] + arm_x - k["xc"], k["yb"] + arm_y - k["yc"]
    length = mpmath.hypot(span_x, span_y)
    pull = -mpf(SPRING_RATE) * (length - mpf(FREE_LENGTH)) / length
    swing, twist = m[1] * k["da"] * k["rr"], m[3] * k["zt"] * short
    turn = m[5] * k["u"] * lever
    forces = [
        mpf(TORQUE) - swing * v["theta"] * (v["theta"] + 2 * v["beta"]) * sin["theta"],
        swing * v["beta"] ** 2 * sin["theta"],
        pull * (span_y * arm_x - span_x * arm_y),
        twist * v["delta"] ** 2 * cos["phi"],
        -twist * v["phi"] * (v["phi"] + 2 * v["delta"]) * cos["phi"],
        -turn * v["epsilon"] ** 2 * cos["omega"],
        turn * v["omega"] * (v["omega"] + 2 * v["epsilon"]) * cos["omega"],
    ]
    return mass, forces


# Each constraint is a sum of vectors in the plane: factor, name of the length, angles whose sum is
# its direction, and quarter turns ahead of that. Constant ends are left out.
_TO_KNEE = ((1, "rr", ("beta",), 0), (-1, "d", ("beta", "theta"), 0))
_LOOPS = (
    (*_TO_KNEE, (1, "ss", ("gamma",), 1)),
    (*_TO_KNEE, (1, "e", ("phi", "delta"), 1), (-1, "zt", ("delta",), 0)),
    (*_TO_KNEE, (-1, "zf", ("omega", "epsilon"), 0), (1, "u", ("epsilon",), 1)),
)


def _book_constraints(k, angles, rates):
    """Return the gradient of the six constraints, and their second derivatives without p''."""
    gradient, convective = mpmath.zeros(6, 7), [mpf(0)] * 6
    for loop, terms in enumerate(_LOOPS):
        for factor, length, names, quarters in terms:
            angle = sum((angles[n] for n in names), quarters * mpmath.pi / 2)
            rate = sum(rates[n] for n in names)
            x, y = (factor * k[length] * f(angle) for f in (mpmath.cos, mpmath.sin))
            for name in names:
                gradient[2 * loop, ANGLES.index(name)] -= y
                gradient[2 * loop + 1, ANGLES.index(name)] += x
            convective[2 * loop] -= x * rate**2
            convective[2 * loop + 1] -= y * rate**2
    return gradient, convective


# -- the model in many digits ----------------------------------------------------------------------


class ExactModel:
    """The program of the model with the exact numbers of the test set, in mpmath's precision."""

    def __init__(self, derived):
        self.derived = derived
        exact = {
            f"{name}_{axis}": mpf(str(sp.N(value, 38)))
            for name, place in andrews._places().items()
            for axis, value in zip("xy", place, strict=True)
        }
        for i, (mass, inertia) in enumerate(zip(MASSES, INERTIAS, strict=True), 1):
            exact |= {f"k{i}_mass": mpf(mass), f"k{i}_inertia_zz": mpf(inertia)}
        exact |= {"spring_rate": mpf(SPRING_RATE), "spring_free_length": mpf(FREE_LENGTH)}
        labels = derived.prepare.labels
        self.fixed = dict(zip(labels, python(derived.prepare)(exact), strict=True))
        self.fixed["drive_torque"] = mpf(TORQUE)

    def __call__(self, function, beta, rate):
        """Evaluate a function of the model at an angle of the crank from the start."""
        values = self.fixed | {"beta": beta, "beta_rate": rate}
        return list(python(self.derived.functions[function])(values))

    def angles(self, beta, rate):
        """Return the angles of the test set, and their rates."""
        names = [entry.name for entry in self.derived.relative]
        turned = dict(zip(names, self("relative_coordinates", beta, rate), strict=True))
        slopes = dict(zip(names, self("relative_jacobian", beta, rate), strict=True))
        start = {name: mpf(str(angle)) for name, angle in andrews.START.items()}
        return (
            {n: start[n] + a for n, a in book_angles(turned).items()},
            {n: rate * s for n, s in book_angles(slopes).items()},
        )


def book_angles(ours):
    """Return the angles of the book (or slopes), counted from the start, from those of the model.

    The book counts bodies 4 and 6 from their outer neighbours, 5 and 7; the model from body 3.
    """
    own = {n: ours[n] for n in ("beta", "theta", "gamma", "delta", "epsilon")}
    own["phi"] = ours["gamma"] + ours["knee_34"] - ours["delta"]
    own["omega"] = ours["gamma"] + ours["knee_36"] - ours["epsilon"]
    return {n: own[n] for n in ANGLES}


@pytest.fixture(scope="module")
def exact(derived):
    with mpmath.workdps(DIGITS):
        return ExactModel(derived("andrews"))


# -- tests -----------------------------------------------------------------------------------------


def test_first_accelerations_are_the_published_ones():
    state, torque = np.zeros(2), [float(TORQUE)]
    acceleration = compiled.rhs(state, torque)[1]
    theta = list(compiled.RELATIVE_COORDINATES).index("theta")
    slope = compiled.relative_jacobian(state, torque)[theta, 0]
    # fifteen digits are published; a few roundings
    assert acceleration == pytest.approx(14222.4439199541, rel=1e-14)
    assert slope * acceleration == pytest.approx(-10666.8329399656, rel=1e-14)


PLACES = [(0, 0), (1, 300), (3, -900), (6, 1100), (11, 40), (16, 1140)]
"""Angles of the crank from the start, rad, and rates, rad/s."""


@pytest.mark.parametrize("place", PLACES, ids=str)
def test_the_program_is_the_problem_of_the_book(exact, place):
    # 1e-20: 25 digits, of which the cancellation of forces takes a few
    with mpmath.workdps(DIGITS):
        angles, rates = exact.angles(*map(mpf, place))
        expected = book_accelerations(angles, rates)["beta"]
        found = exact("rhs", *map(mpf, place))[1]
        assert abs(found / expected - 1) < mpf("1e-20")


@pytest.fixture(scope="module")
def end(exact):
    """Angles and rates at the end of the compiled model's motion."""
    torque = [float(TORQUE)]
    result = solve_ivp(
        lambda _, y: compiled.rhs(y, torque), (0.0, float(END)), np.zeros(2), "DOP853",
        rtol=1e-13, atol=1e-13,
    )  # fmt: skip
    with mpmath.workdps(DIGITS):
        return exact.angles(*map(mpf, result.y[:, -1]))


def test_ten_digits_of_the_published_angles(end):
    with mpmath.workdps(DIGITS):
        angles, rates = end
        off = {n: _nearest(angles[n] - mpf(PUBLISHED[n][0])) for n in ANGLES}
        for name in ("beta", "theta"):
            assert abs(off[name] / mpf(PUBLISHED[name][0])) < 1e-10
        shift = off["beta"] / rates["beta"]
        # that tolerance on each of some hundred steps: 2e-12 of 16 rad
        assert abs(shift + mpf("1.005e-12")) < 3e-14
        for name in ANGLES:
            assert abs(off[name] - shift * rates[name]) < 4e-15


def test_digits_of_the_published_rates(end):
    with mpmath.workdps(DIGITS):
        angles, rates = end
        published = {n: mpf(PUBLISHED[n][1]) for n in ANGLES}
        for name in ANGLES:
            allowed = 2e-10 if name in {"beta", "theta"} else 6e-8
            assert abs(published[name] / rates[name] - 1) < allowed
        gradient = _book_constraints(lengths(), angles, rates)[0]
        assert max(map(abs, gradient * _column(rates))) < mpf("1e-20")
        assert 5e-9 < max(map(abs, gradient * _column(published))) < 2e-8


def _column(rates):
    return mpmath.matrix([rates[n] for n in ANGLES])


def _nearest(difference):
    """Return a difference of angles without whole turns."""
    turn = 2 * mpmath.pi
    return difference - turn * mpmath.nint(difference / turn)
