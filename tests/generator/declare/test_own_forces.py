"""Forces of somebody's own: formulas are emitted exactly, and nothing of an action is lost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import kintrafo
import numpy as np
import pytest
import sympy as sp
from kintrafo import generator as g
from kintrafo.generator.declare.forces.force import Action, Force
from kintrafo.generator.declare.shown import Shown
from kintrafo.systems.compile.compiler import find_compiler
from mechanisms.own_force import ARM, FOLLOWER, A, B, Own, Showing, mechanism, model

RATE = g.Ratio("rate", 1.5, "a number")


def compiled(force, *joints, backend="numpy", folder=None):
    return kintrafo.compile(model(force, *joints), backend=backend, folder=folder)


# -- formulas -------------------------------------------------------------------------------------

q, v, k = sp.symbols("q_A q_A_rate rate")
FORMULAS = {
    "tan": sp.tan(q / 3),
    "cot": sp.cot(q / 9 + 1),
    "sec": sp.sec(q / 3),
    "csc": sp.csc(q / 9 + 1),
    "acos": sp.acos(q / 9),
    "atan": sp.atan(q * v),
    "atan2": sp.atan2(q, v),
    "exponential": sp.exp(-q / 3) * v + sp.exp(k * v),
    "logarithm": sp.log(q**2 + 2) * v,
    "magnitude": sp.Abs(q) * v,
    "of_a_difference": sp.Abs(q - k) ** sp.Rational(3, 2),
    "sign": sp.sign(v) * k,
    "greatest": sp.Max(q, v, 0.5),
    "least": sp.Min(q, v, k),
    "contact": k * sp.Max(q - 0.1, 0) ** 1.5,
    "heaviside": sp.Heaviside(q - 0.3) * v,
    "two_and_a_half": (q**2 + 1) ** 2.5,
    "powers": q**5 + v**7 - q**9 + q**16,
    "large_and_half": (q**2 + 1) ** sp.Rational(13, 2),
    "below": (q**2 + 1) ** -5 + (q**2 + 1) ** -6.5 + 1 / (q**2 + 2) ** 3 + (v**2 + 1) ** -1.5,
    "of_parameters": q * k**11 + sp.Abs(k - 3) + sp.Max(k, 2),
    "numbers": q * (sp.E + sp.GoldenRatio + sp.pi + sp.EulerGamma),
    "computed": q * sp.exp(2) + v * sp.log(3) ** 2 + sp.sqrt(sp.E) + sp.cbrt(5) + sp.tanh(1),
    "rationals": q * sp.Rational(10**30 + 1, 3 * 10**30),
    "decimals": q * sp.Float("0.1", 40) + v * 0.3,
    "pieces": sp.Piecewise((q**2, q < -0.5), (v, q <= 0.5), (k * q, True)),
    "conditions": sp.Piecewise(
        (v, sp.And(q > 0, v >= 0.25)), (q * v, sp.Or(q > 1, sp.Not(v > -0.5))), (3, True)
    ),
    "with_assumptions": sp.Symbol("q_A", real=True) ** 2 + sp.Symbol("rate", positive=True) * v,
}  # fmt: skip


def shows_formulas(at, action):
    del at, action
    for name, formula in FORMULAS.items():
        yield Shown(f"s_{name}", formula, "N m", name)


@pytest.fixture(scope="module", params=["numpy", "c"])
def formulas(request, tmp_path_factory):
    if request.param == "c" and find_compiler() is None:
        pytest.skip("no C compiler")
    force = Showing(
        lambda at: Action({at.coordinate("A"): FORMULAS["powers"]}), shows_formulas, (RATE,)
    )
    return kintrafo.System(
        compiled(force, backend=request.param, folder=tmp_path_factory.mktemp("cache"))
    )


STATES = np.random.default_rng(1).uniform(-1.4, 1.4, size=(60, 2))


def exact(formula, state):
    """Evaluate a formula, with 40 digits and SymPy's own functions."""
    symbols = {s.name: s for s in formula.free_symbols}
    values = dict(zip(("q_A", "q_A_rate", "rate"), (*state, 1.5), strict=True))
    put = {symbols[n]: sp.Float(float(x), 40) for n, x in values.items() if n in symbols}
    return float(formula.xreplace(put).evalf(40))


def magnitudes(formula, state):
    """The sum of the sizes of terms: what a rounding is relative to."""
    return sum(abs(exact(term, state)) for term in sp.Add.make_args(formula))


@pytest.mark.parametrize("name", FORMULAS)
def test_a_formula_is_what_it_says(formulas, name):
    """Twenty operations of half a unit each, and arguments of functions rounded before: 1e-14."""
    place = list(formulas.equations.SIGNALS).index(f"s_{name}")
    found = formulas.evaluate("signals", STATES)[:, place]
    for value, state in zip(found, STATES, strict=True):
        expected = exact(FORMULAS[name], state)
        assert abs(value - expected) <= 1e-14 * max(magnitudes(FORMULAS[name], state), 1.0)


@pytest.mark.parametrize("name", FORMULAS)
def test_its_derivatives_are_exact(formulas, name):
    """By SymPy, of the formula as it was written; no state is at a kink."""
    place = list(formulas.equations.SIGNALS).index(f"s_{name}")
    found = formulas.evaluate("signals_jacobian", STATES)[:, place]
    formula = FORMULAS[name].xreplace(
        {s: sp.Symbol(s.name, real=True) for s in FORMULAS[name].free_symbols}
    )
    for i, by in enumerate(("q_A", "q_A_rate")):
        slope = formula.diff(sp.Symbol(by, real=True)).replace(sp.DiracDelta, lambda *_: sp.S.Zero)
        for row, state in zip(found, STATES, strict=True):
            expected = exact(slope, state)
            assert abs(row[i] - expected) <= 1e-12 * max(abs(expected), 1.0)


def test_kinks_of_a_formula_are_found(tmp_path):
    """A stick at rest on both sides of the corner of |q|: a gradient would step over it."""
    force = Own(lambda _: Action({"q_A": -sp.Abs(q - 0.3) - sp.Max(v, 0.25)}))
    module = kintrafo.compile(
        model(force), backend="numpy", folder=tmp_path, parameter_derivatives=True
    )
    kinks = module.kinks([[0.3, 0.25], [0.5, 0.5]])
    assert np.sort(np.abs(np.atleast_2d(kinks)[0]))[:2] == pytest.approx(0.0, abs=1e-15)
    assert np.all(np.abs(np.atleast_2d(kinks)[1]) > 0.1)


@pytest.mark.parametrize(("formula", "angle"), [(sp.sqrt(q), -0.7), (1 / q, 0.0), (q**2.5, -0.1)])
def test_where_a_formula_has_no_value_it_is_said_so(tmp_path, formula, angle, refused):
    """It is no overflow: no smaller force would help."""
    system = kintrafo.System(compiled(Own(lambda _: Action({"q_A": formula})), folder=tmp_path))
    refused(kintrafo.ModelError, lambda: system.evaluate("rhs", [angle, 0.0]))


def test_steps_of_its_own_may_have_formulas(tmp_path):
    def act(at):
        step = at.program.define("stretch", sp.tan(q) * sp.Abs(v))
        return Action({"q_A": step**6 + at.program.define("stretch", q**2)})

    module = compiled(Own(act), folder=tmp_path)
    expected = (np.tan(0.3) * 0.7) ** 6 + 0.09
    assert module.rhs([[0.3, -0.7]])[0, 1] == pytest.approx(expected, rel=1e-14)


# -- errors ---------------------------------------------------------------------------------------


def test_what_cannot_be_emitted_is_refused_by_name(refused):
    for formula in (
        sp.erf(q),
        sp.gamma(q),
        sp.tanh(q),
        sp.floor(q),
        q**0.3,
        q**k,
        2**q,
        sp.Function("f")(q),
        sp.I * q,
        sp.oo,
        sp.nan,
        float("nan"),
        sp.Integer(10) ** 400,
        sp.Piecewise((q, q > 0)),
        sp.Piecewise((q, sp.Eq(q, 1)), (0, True)),
        None,
        "-5*q_A",
        True,
        (q, q),
        sp.Matrix([q]),
        sp.Symbol("given_q_A"),
    ):
        for force in (
            Own(lambda _, f=formula: Action({"q_A": f})),
            Showing(lambda _: Action({}), lambda *_, f=formula: [Shown("s", f, "N", "x")]),
        ):
            with refused(kintrafo.MechanismError):
                compiled(force)


def test_a_symbol_that_is_not_declared_is_refused(refused):
    force = Own(lambda _: Action({"q_A": sp.Symbol("other")}))
    refused(kintrafo.MechanismError, lambda: compiled(force))


def test_what_would_be_lost_of_an_action_is_refused(refused):
    for action in (
        None,
        {"q_A": q},
        Action({"nope": q}),
        Action({"A": q}),
        Action({"q_A_rate": q}),
        Action({0: q}),
        Action({q: q}),
        Action({A: q}),
        Action([("q_A", q)]),
        Action({"q_A": q}, {"power": q * v}),
        Action({"q_A": q}, [q]),
        Action({"q_A": q}, {}, "x"),
        Action({}),
    ):
        with refused(kintrafo.MechanismError):
            compiled(Own(lambda _, action=action: action))


def test_what_is_not_there_is_refused(refused):
    for asks in (
        lambda at: at.acceleration("q_A"),
        lambda at: at.coordinate("nope"),
        lambda at: at.coordinate(A),
        lambda at: at.coordinate("follower"),
        lambda at: at.rate("A"),
        lambda at: at.local("nope", B.axis.through),
        lambda at: at.local(ARM, B.axis.through),
        lambda at: at.direction("nope", g.UP),
        lambda at: at.line("nope", g.UP, follows=False),
        lambda at: at.up("nope"),
        lambda at: at.twists("amr"),
        lambda at: at.height("nope", None),
        lambda at: at.place("nope", None),
        lambda at: at.in_world("nope", None),
        lambda at: at.rising("nope", None),
        lambda at: at.extent("nope", None),
        lambda at: at.between(("nope", None), ("arm", None)),
        lambda at: at.hinge("nope"),
        lambda at: at.guide("A"),
        lambda at: at.telescope("A"),
        lambda at: at.local("arm", None),
        lambda at: at.program.define("my step", q),
        lambda _: 1 / 0,
    ):
        force = Own(lambda at, asks=asks: Action({"q_A": q + 0 * bool(asks(at))}))
        with refused(kintrafo.MechanismError):
            compiled(force, A, FOLLOWER)


def test_signals_may_ask_for_accelerations_of_coordinates_alone(tmp_path, refused):
    def shows(at, _):
        yield Shown("turning", at.acceleration("q_A"), "rad/s^2", "acceleration")

    module = compiled(Showing(lambda _: Action({"q_A": 3 * q}), shows), folder=tmp_path)
    assert module.signals([[0.5, 0.0]])[0, 0] == pytest.approx(1.5)
    for wrong in (lambda at, _: [at.acceleration("A")], lambda *_: [q]):
        with refused(kintrafo.MechanismError):
            compiled(Showing(lambda _: Action({"q_A": q}), wrong))


def test_an_own_law_is_looked_at_alike(refused):
    @dataclass(frozen=True)
    class Tanh(g.LinearDamper):
        def force(self, at):
            return -sp.tanh(at.velocity)

    law = Tanh(g.TorsionDamperRate("c", 1.0, "c"))
    element = g.ForceElement("damper", g.AlongHinge(A), (law,))
    refused(kintrafo.MechanismError, lambda: compiled(element))


def test_a_force_that_cannot_be_distinguished_is_refused(refused):
    @dataclass
    class Changing(Force):
        joint: Any
        identity = "Own", "force"

        def act(self, at):
            return Action({at.coordinate(self.joint.name): q})

    refused(g.DeclarationError, lambda: mechanism(Changing(A)))

    @dataclass(frozen=True)
    class Nameless(Own):
        identity = "x"

    refused(g.DeclarationError, lambda: mechanism(Nameless(lambda _: None)))

    @dataclass(frozen=True)
    class Astray(Own):
        along = "A"

    refused(g.DeclarationError, lambda: mechanism(Astray(lambda _: None)))


def test_the_line_of_an_own_file_is_named(tmp_path, refused):
    text = (
        "from dataclasses import dataclass\n"
        "from kintrafo import generator as g\n"
        "@dataclass(frozen=True)\n"
        "class Mine(g.Force):\n"
        "    joint: g.Revolute\n"
        "    @property\n"
        "    def identity(self): return 'Mine', 'spring'\n"
        "    def act(self, at):\n"
        "        return g.Action({'q': at.hinge('B')[0]})\n"
        "arm = g.Body('arm', 1.0, g.flat('c', (0.2, 0.0)), 0.01)\n"
        "A = g.hinge('A', g.Ground('ground'), arm, g.flat('a', (0.0, 0.0)))\n"
        "M = g.Mechanism('fo', 't', (A,), (Mine(A),), (A.angle('q', 'q'),))\n"
    )
    file = tmp_path / "mine.py"
    file.write_text(text)
    refused(kintrafo.MechanismError, lambda: kintrafo.compile(file))


def after_jumps(start, jumps, far, jump, time):
    """Return angle and rate of a rotor of 1 kg m^2 that a moment brakes, by parts in closed form.

    The moment grows by a jump at each half and one, two, ... times an angle.
    """
    angle, rate = 0.0, start
    for n in range(jumps + 1):
        way = (n + 0.5) * far - angle
        root = np.sqrt(max(rate**2 - 2.0 * n * jump * way, 0.0))
        needed = 2.0 * way / (rate + root)
        if n == jumps or needed > time:
            break
        angle, rate, time = angle + way, root, time - needed
    return angle + rate * time - n * jump * time**2 / 2.0, n


@pytest.mark.skipif(find_compiler() is None, reason="no compiler")
def test_many_jumps_are_passed_as_accurately_as_the_page_says(tmp_path):
    """The errors of docs/mechanisms/own-mechanism.md; a few times those on other machines."""
    far, jump = 0.04, 0.08
    moment = -jump * sum(sp.Heaviside(q - (i + 0.5) * far, 1) for i in range(50))
    module = compiled(Own(lambda _: Action({"q_A": moment})), backend="c", folder=tmp_path)
    system = kintrafo.System(module)
    angle, passed = after_jumps(4.0, 50, far, jump, 0.45)
    assert passed == 42
    usual = {"DormandPrince": 2e-4, "Adams": 2e-5, "Verner": 4e-6, "BDF": 4e-6}
    for method, off in usual.items():
        for rtol, most in ((1e-6, off), (1e-9, 1e-6)):
            found = kintrafo.simulate(system, (0.0, 0.45), [0.0, 4.0], method=method, rtol=rtol)
            assert found.success
            assert abs(found.y[0, -1] - angle) < 5.0 * most, (method, rtol)
