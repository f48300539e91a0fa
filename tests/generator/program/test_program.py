"""The straight-line program: steps are shared, differentiated, pruned and staged without loss."""

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from kintrafo.generator.backends.counting import counted, operations_of
from kintrafo.generator.backends.schedule import schedule
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.program import ConstantStage, Program, Step
from kintrafo.generator.program.derivatives import chain_rule
from kintrafo.generator.program.functions import Guarded, Positive
from kintrafo.generator.program.sharing import share

A, B = sp.symbols("a b")  # parameters
X, Y = sp.symbols("x y")  # variables

calm = settings(deadline=None, max_examples=60)


def new_program(*parameters):
    return Program(ConstantStage(parameters))


def expanded(program, expression):
    """Return an expression in parameters and variables only."""
    for stage in (program, program.constants):
        for step in reversed(stage.steps.values()):
            expression = expression.xreplace({step.symbol: step.expression})
    return expression.replace(Guarded, lambda q, _: q)


def run(function, values):
    """Carry out a function's steps in order, reading only what was given or computed before."""
    known = dict(values)
    for step in function.steps:
        assert step.expression.free_symbols <= known.keys()
        assert step.symbol not in known
        known[step.symbol] = step.expression.replace(Guarded, lambda q, _: q).xreplace(known)
    return [result.replace(Guarded, lambda q, _: q).xreplace(known) for result in function.results]


# -- defining -------------------------------------------------------------------------------------


def test_a_step_is_defined_once():
    program = new_program(A, B)
    first = program.define("product", A * X)
    assert first == sp.Symbol("product")
    assert program.define("same", X * A) == first
    assert program.define("opposite", -A * X) == -first
    assert list(program.steps) == [first]


def test_trivial_expressions_are_no_steps():
    program = new_program(A, B)
    for expression in (sp.Integer(0), sp.Rational(1, 2), X, -X, A):
        assert program.define("trivial", expression) == expression
    assert program.define("number", 2.0) == 2.0
    assert not program.steps


def test_names_are_unique():
    program = new_program(A, B)
    program.define("step", X + A)
    program.define("constant", A + B)
    for name in ("step", "constant"):
        assert str(program.define(name, X + Y + len(name))) == f"{name}_2"
    for name in ("constant", "a"):
        assert str(program.define(name, A * B + len(name))).startswith(f"{name}_")


def test_parameters_states_and_inputs_keep_their_names():
    program = Program(ConstantStage((A, B), frozenset({"x", "shared_1"})))
    assert program.define("a", X * Y) == sp.Symbol("a_2")
    assert program.define("x", X * A) == sp.Symbol("x_2")
    assert program.define("x", A * B) == sp.Symbol("x_3")
    both = {"sum": (X + Y) * (X * Y + 1), "other": (X + Y) * sp.sin(X * Y + 1)}
    shared = [step.symbol for step in program.function("two", "", both).steps]
    assert shared == [sp.Symbol("shared_2"), sp.Symbol("shared_3")]


def test_a_constant_does_not_take_the_name_of_a_step_that_came_before():
    program = new_program(A, B)
    assert program.define("length", X + A) == sp.Symbol("length")
    assert program.define("length", A + B) == sp.Symbol("length_2")


def test_constants_are_what_depends_on_parameters_only():
    program = new_program(A, B)
    constant = program.define("constant", A + B)
    further = program.define("further", sp.sqrt(constant))
    variable = program.define("variable", constant * X)
    assert list(program.constants.steps) == [constant, further]
    assert list(program.steps) == [variable]
    assert program.constants.contains(further * A + 1)
    assert not program.constants.contains(variable)


def test_variants_share_their_constants():
    """Two variants of a model may name different steps alike, but have one parameter stage."""
    stage = ConstantStage((A, B))
    one, other = Program(stage), Program(stage)
    assert one.define("sum", A + B) == other.define("sum", A + B)
    one.define("step", X + A)
    other.define("step", X + B)
    functions = [
        program.function("f", "Any.", {"r": sp.Symbol("step")}) for program in (one, other)
    ]
    assert [function.free_symbols for function in functions] == [{X, A}, {X, B}]
    assert stage.function(functions).labels == ("a", "b")


# -- random programs ------------------------------------------------------------------------------


@st.composite
def programs(draw):
    """Programs of up to eight steps, each of which reads parameters, variables or other steps."""
    program = new_program(A, B)
    known = [A, B, X, Y]
    for index in range(draw(st.integers(1, 8))):
        one, other = draw(st.sampled_from(known)), draw(st.sampled_from(known))
        expression = draw(
            st.sampled_from(
                [
                    one + other,
                    one * other - A,
                    2 * one - 3 * other,
                    one / (1 + other**2),
                    sp.sqrt(1 + one**2),
                    sp.sin(one) * other,
                    sp.cos(one + other),
                    sp.atan2(one, 2 + other**2),
                    1 / (3 + one**2),
                    A * B * one + A * other,
                ]
            )
        )
        known.append(program.define(f"step_{index}", expression))
    return program, [s for s in known[4:] if s in program.steps]


VALUES = {A: sp.Float("0.7", 40), B: sp.Float("-1.3", 40), X: sp.Float("0.4", 40)}
VALUES |= {Y: sp.Float("1.9", 40)}


def assert_equal(one, other):
    """Compare two numbers of forty digits; thirty must agree."""
    assert abs(one - other) <= sp.Float("1e-30", 40) * (1 + abs(other)), f"{one} is not {other}"


@given(programs())
@calm
def test_functions_compute_the_results(case):
    """Pruning, sharing and the constant stage together leave the values as they are."""
    program, steps = case
    results = {str(s): s for s in steps}
    results["sum"] = sum(steps, A * B * X)
    expected = [expanded(program, r).xreplace(VALUES).evalf(40) for r in results.values()]
    function = program.function("f", "Any.", results)
    prepare = program.constants.function([function])
    assert function.labels == tuple(results)
    assert function.free_symbols <= {X, Y, *(sp.Symbol(label) for label in prepare.labels)}
    constants = run(prepare, {A: VALUES[A], B: VALUES[B]})
    given_values = {X: VALUES[X], Y: VALUES[Y]}
    given_values |= {sp.Symbol(k): v for k, v in zip(prepare.labels, constants, strict=True)}
    for found, value in zip(run(function, given_values), expected, strict=True):
        assert_equal(sp.sympify(found).evalf(40), value)


@given(programs())
@calm
def test_functions_are_pruned(case):
    """Every step is read later on, and none depends on parameters only (but for a shared sign)."""
    program, steps = case
    if not steps:
        return
    function = program.function("f", "Any.", {"last": steps[-1]})
    read = set().union(*(s.expression.free_symbols for s in function.steps), set())
    read |= set().union(*(r.free_symbols for r in function.results))
    assert {s.symbol for s in function.steps} <= read
    for step in function.steps:
        sign = (-step.expression).is_Symbol
        assert sign or not program.constants.contains(step.expression)


@given(programs(), st.sampled_from([X, Y]))
@calm
def test_tangents_are_derivatives(case, along):
    program, steps = case
    targets = [*steps, sum(steps, X * Y)]
    expected = [expanded(program, target).diff(along) for target in targets]
    found = program.tangents(along, targets, "tangent")
    for tangent, derivative in zip(found, expected, strict=True):
        value = expanded(program, sp.sympify(tangent)).xreplace(VALUES).evalf(40)
        assert_equal(value, derivative.xreplace(VALUES).evalf(40))


@given(programs())
@calm
def test_substitution_repeats_the_steps(case):
    program, steps = case
    stand_in = sp.Symbol("given_x")
    expected = [expanded(program, step).xreplace({X: stand_in}) for step in steps]
    found = program.substitute({X: stand_in}, steps, "given")
    values = VALUES | {stand_in: VALUES[X] + 1}
    for new, old in zip(found, expected, strict=True):
        assert X not in expanded(program, new).free_symbols
        value = expanded(program, new).xreplace(values).evalf(40)
        assert_equal(value, old.xreplace(values).evalf(40))


# -- particulars ----------------------------------------------------------------------------------


def test_common_subexpressions_are_computed_once():
    program = new_program()
    results = {"one": (X + Y) * sp.sin(X + Y), "two": (X + Y) ** 2}
    counts = operations_of(program.function("f", "Any.", results))
    assert counts == {"add": 1, "multiply": 2, "trigonometric": 1}


def test_constant_parts_of_sums_and_products_are_computed_once():
    """Of a*b*x + a + b only one product and one sum are left for every call."""
    program = new_program(A, B)
    function = program.function("f", "Any.", {"value": A * B * X + A + B})
    assert operations_of(function) == {"multiply": 1, "add": 1}
    prepare = program.constants.function([function])
    assert prepare.free_symbols == {A, B}
    assert operations_of(prepare) == {"multiply": 1, "add": 1}


def test_roots_are_not_taken_again_for_their_derivative():
    program = new_program()
    root = program.define("root", sp.sqrt(1 + X**2))
    (tangent,) = program.tangents(X, [root], "tangent")
    function = program.function("f", "Any.", {"root": root, "tangent": tangent})
    assert operations_of(function)["root"] == 1


def test_guards_follow_what_they_guard():
    program = new_program(A)
    used = program.guarded("used", X - A, "x is not above a", "m")
    unused = program.guarded("unused", Y - A, "y is not above a", "m")
    inverse = program.define("inverse", 1 / used)
    root = program.define("root", sp.sqrt(unused))
    assert [g.name for g in program.function("f", "Any.", {"r": inverse}).guards] == ["used"]
    assert [g.name for g in program.function("g", "Any.", {"r": root}).guards] == ["unused"]
    # what is not read in its guarded form cannot fail
    assert program.function("h", "Any.", {"r": sp.Symbol("used")}).guards == ()
    constant = program.guarded("constant", A**2 + 1, "never", "m")
    assert constant == sp.Symbol("constant")


def test_operations_of_a_function_are_those_of_its_steps():
    program = new_program()
    step = program.define("step", X * Y + X)
    function = program.function("f", "Any.", {"one": step * X, "two": sp.cos(step)})
    values = [*(s.expression for s in function.steps), *function.results]
    total = counted(map(schedule, values))
    assert operations_of(function) == total == {"multiply": 2, "add": 1, "trigonometric": 1}


# -- against SymPy ---------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def four_bar():
    return generate(next(model for model in MODELS if model.name == "four_bar"))


def test_derivatives_are_those_of_sympy(four_bar):
    x, y = sp.symbols("x y")
    composed = [sp.sin(x * y) * sp.sqrt(x**2 + y), sp.atan2(y * x, x) / (1 + y) ** 3, Positive(x)]
    steps = [step.expression for f in four_bar.functions.values() for step in f.steps]
    for expression in {*composed, *steps}:
        for symbol in expression.free_symbols:
            found, expected = (
                chain_rule(expression, {symbol: sp.Integer(1)}),
                expression.diff(symbol),
            )
            assert found == expected or sp.simplify(found - expected) == 0, (expression, symbol)


def test_what_is_common_is_what_sympy_finds():
    """Common parts are the same; when they are inserted, every expression is the original one."""
    a, b, c, d = sp.symbols("a b c d")
    expressions = [
        (a + b + c) * sp.sqrt(a + b),
        (a + b) ** -2 + a * b * c,
        a * b * d - sp.cos(c - d),
        sp.sin(d - c) + b * a * (c - d),
    ]
    steps = [Step(sp.Symbol(f"step_{i}"), e, "") for i, e in enumerate(expressions)]
    shared, _ = share(steps, [], sp.numbered_symbols("x"))
    replacements, reduced = sp.cse(expressions, order="canonical")
    found = {step.symbol: step.expression for step in shared}
    expected = dict(replacements) | dict(zip((s.symbol for s in steps), reduced, strict=True))
    assert found == expected
    for step, expression in zip(steps, expressions, strict=True):
        written = found[step.symbol]
        while written.free_symbols & found.keys():
            written = written.xreplace(found)
        assert sp.expand(written - expression) == 0


def test_without_derivatives_the_other_functions_are_the_same(four_bar):
    bare = generate(four_bar.formulation, derivatives=False)
    left_out = {"rhs_jacobian", "rhs_input_jacobian", "signals_jacobian", "signals_input_jacobian"}
    assert four_bar.functions.keys() - bare.functions.keys() == left_out
    for name, function in bare.functions.items():
        assert operations_of(function) == operations_of(four_bar.functions[name]), name


def test_a_narrow_part_is_differentiated_once():
    program = Program(ConstantStage((sp.Symbol("p"),)))
    x, y = sp.symbols("x y")
    inner = program.define("inner", x * y)
    bent = program.define("bent", sp.sin(inner) + y * inner)
    out = program.define("out", bent**2 + sp.Symbol("p") * bent)
    direct = [program.tangents(s, [out], f"d{s}")[0] for s in (x, y)]
    program.narrow([inner], [out])
    narrowed = [program.tangents(s, [out], f"n{s}")[0] for s in (x, y)]
    names = [step.name for step in program.steps]
    assert "bent__by_inner" in names
    assert not any(name in names for name in ("bent__nx", "bent__ny"))
    written = {s: step.expression for s, step in program.steps.items()}
    values = {x: 0.3, y: 0.7, sp.Symbol("p"): 1.9}

    def number(expression):
        while expression.free_symbols & written.keys():
            expression = expression.xreplace(written)
        return float(expression.evalf(subs=values))

    found = [number(derivative) for derivative in narrowed]
    assert found == pytest.approx([number(derivative) for derivative in direct], rel=1e-14)
