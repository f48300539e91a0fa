"""Functions that are computed together: the same bits as alone, the same refusals, less work."""

import operator

import numpy as np
import pytest
import sympy as sp
from kintrafo.equations.errors import ClosureError
from kintrafo.equations.status import LAST_GUARD_BIT, NOT_FINITE, bit_of, mask_of
from kintrafo.generated import four_bar
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.backends.schedule import ordered
from kintrafo.generator.backends.sharing import scheduled
from kintrafo.generator.backends.text import text_of
from kintrafo.generator.equations.outputs import TOGETHER
from kintrafo.generator.program.function import Function, Stage

# a plane, a plane with telescopes, and space with all laws of force
each_model = pytest.mark.parametrize("name", ["four_bar", "excavator_lifting", "double_wishbone"])


def stages(model):
    return (emitted for emitted in model.emitted.values() if isinstance(emitted, Stage))


ARITHMETIC = {
    "add": operator.add,
    "subtract": operator.sub,
    "negate": operator.neg,
    "multiply": operator.mul,
    "divide": operator.truediv,
    "root": np.sqrt,
}
CALLED = {
    kind: eval(f"lambda *x: {text.format('x[0]', 'x[1]')}", {"np": np})
    for kind, text in NUMPY.functions.items()
}


def carried_out(operation, values):
    """Return what comes of an operation in double precision."""
    if operation.kind == "symbol":
        return values[operation.of.name]
    if operation.kind == "number":
        return np.float64(operation.of)
    operands = [carried_out(operand, values) for operand in operation.operands]
    return np.float64((ARITHMETIC.get(operation.kind) or CALLED[operation.of])(*operands))


def evaluated(schedule, values):
    """Return the results of a schedule, step by step."""
    named = dict(values)
    for step in schedule.steps:
        named[step.name] = carried_out(step.value, named)
    return [carried_out(result, named) for result in schedule.results]


@each_model
def test_same_bits_as_alone(derived, name):
    model, random = derived(name), np.random.default_rng(3)
    for stage in stages(model):
        assert not stage.blocks
        values = {s.name: np.float64(random.uniform(0.5, 1.5)) for s in stage.free_symbols}
        with np.errstate(all="ignore"):  # what closes no loop has bits, too
            alone = [r for member in stage.members for r in evaluated(ordered(member), values)]
            np.testing.assert_array_equal(evaluated(scheduled(stage), values), alone)


@each_model
def test_less_work_than_alone(derived, name):
    model = derived(name)
    for stage in stages(model):
        alone = sum(operations_of(member).total() for member in stage.members)
        together = operations_of(stage).total()
        # what closes no loop may have nothing in common
        assert together < alone or (together == alone and not model.plan.transformers), stage.name
    together = {member for _, members in TOGETHER.values() for member in members}
    assert together <= model.functions.keys() | {"absolute_jacobian", "signals_jacobian"} | {
        "signals_input_jacobian"
    }


def function(name, steps, *results):
    from kintrafo.generator.program import Step

    made = tuple(Step(sp.Symbol(n), e, "") for n, e in steps.items())
    labels = tuple(map(str, range(len(results))))
    return Function(name, "", made, results, labels, (len(results),), ())


def test_a_name_of_two_values_is_distinguished():
    """A sum or product in another order has other bits, and so is another value."""
    x, y, z, a, b = sp.symbols("x y z a b")
    one = function("one", {"b": x + y, "a": b * z}, a)
    other = function("other", {"shared_1": y * z, "a": x * sp.Symbol("shared_1")}, a, -a)
    order = scheduled(Stage("both", "", (one, other)))
    assert [step.name for step in order.steps] == ["b", "a", "a_2"]
    assert [text_of(result, NUMPY) for result in order.results] == ["a", "a_2", "-a_2"]


def test_equal_values_of_other_names_are_one():
    x, y, p, q = sp.symbols("x y p q")
    one = function("one", {"p": x * y, "r": p + 1}, sp.Symbol("r"))
    other = function("other", {"q": y * x}, q, sp.sin(q))
    order = scheduled(Stage("both", "", (one, other)))
    assert [step.name for step in order.steps] == ["p", "r"]
    assert [text_of(result, NUMPY) for result in order.results] == ["r", "p", "np.sin(p)"]


def test_a_result_refuses_for_its_own_guards_only():
    """A derivative that is zero everywhere has no guard, also if the crank is too long to turn."""
    parameters = {n: entry["default"] for n, entry in four_bar.PARAMETERS.items()}
    constants = four_bar.prepare(parameters | {"crank_pin_y": 0.25})
    states = np.zeros((629, 2))
    states[:, 0] = 0.01 * np.arange(629)
    refused = []
    for state in states:
        try:
            four_bar.rhs_input_jacobian(state, None, constants)
        except ClosureError:
            refused.append(state)
    assert 0 < len(refused) < len(states)
    assert not four_bar.signals_input_jacobian(refused, None, constants).any()
    with pytest.raises(ClosureError, match=r"four_bar\.linearisation: "):
        four_bar.linearisation(refused[0], None, constants)


def test_parts_are_slices_of_the_stage():
    states, inputs = np.array([[0.1, 2.0], [-0.2, 1.0]]), np.array([0.5])
    whole = four_bar.dynamics(states, inputs)
    parts = [four_bar.mass_matrix, four_bar.bias, four_bar.forces]
    alone = [part(states, inputs).reshape(2, -1) for part in parts]
    np.testing.assert_array_equal(whole, np.concatenate(alone, axis=1))
    assert {part.stage for part in parts} == {"dynamics"}
    assert all(part.operations == four_bar.dynamics.operations for part in parts)


def test_status_bits():
    assert [bit_of(guard) for guard in (0, 28, 29, 30, 90)] == [0, 28, 29, 29, 29]
    assert mask_of([]) == NOT_FINITE
    assert mask_of([0, 3, 40]) == NOT_FINITE | 0b1001 | 1 << LAST_GUARD_BIT


def test_a_sum_of_which_each_term_waits_for_the_one_before_is_cut_into_steps():
    """A compiler takes some hundred brackets within each other, and a long chain makes more."""
    names = [sp.Symbol(f"term_{i}") for i in range(600)]
    start, factor = sp.symbols("start factor")
    pairs = zip(names, [start, *names[:-1]], strict=True)
    made = function("long", {name.name: before * factor for name, before in pairs}, sp.Add(*names))
    order = scheduled(made)
    texts = [text_of(value, NUMPY) for value in (*(s.value for s in order.steps), *order.results)]
    assert max(_brackets(text) for text in texts) < 100
    values = {"start": np.float64(0.3), "factor": np.float64(1.01)}
    # as long a sum one after the other, which rounds a little each time
    expected = 0.3 * sum(1.01 ** (i + 1) for i in range(600))
    np.testing.assert_allclose(evaluated(order, values), [expected], rtol=600 * 2.3e-16)
    assert operations_of(made).total() == 2 * 600 - 1


def _brackets(text):
    """Return how many brackets are open at a time."""
    depths = np.cumsum([{"(": 1, ")": -1}.get(letter, 0) for letter in text])
    return int(depths.max(initial=0))
