"""Signs taken out of steps: the same bits with fewer operations, and names with the sign."""

import random

import numpy as np
import pytest
import sympy as sp
from kintrafo.generator.backends.counting import counted
from kintrafo.generator.backends.numpy.dialect import NUMPY
from kintrafo.generator.backends.schedule import schedule
from kintrafo.generator.backends.text import text_of
from kintrafo.generator.program.functions import Guarded
from kintrafo.generator.program.sharing import drop_dead
from kintrafo.generator.program.signs import take_out_signs
from kintrafo.generator.program.steps import Step

A, B, C, S, T, U = sp.symbols("a b c s t shared_1")


def without_signs(steps, *results, has=()):
    made = [Step(symbol, expression, "") for symbol, expression in steps.items()]
    return alive(*take_out_signs(made, results, {*results}, {*has}.__contains__))


def alive(steps, results):
    return drop_dead(steps, results), results


def written(program):
    return {step.symbol.name: step.expression for step in program[0]}


def evaluated(steps, results, values):
    names = {"np": np} | values
    for step in steps:
        names[step.symbol.name] = eval(text_of(schedule(step.expression), NUMPY), names)
    return [float(eval(text_of(schedule(result), NUMPY), names)) for result in results]


def test_a_sum_takes_up_the_sign_of_a_sum():
    program = without_signs({T: -A - B}, C + T)
    assert written(program) == {"minus_t": A + B}
    assert program[1] == [C - sp.Symbol("minus_t")]


def test_a_product_hands_the_sign_on():
    program = without_signs({T: -A * B, S: T * C}, A + S)
    assert written(program) == {"minus_t": A * B, "minus_s": C * sp.Symbol("minus_t")}


def test_a_named_negative_gives_its_name_to_what_has_none():
    """A common part takes its name from the step of its negative; other steps keep theirs."""
    program = without_signs({U: A * B, T: -U}, C + T)
    assert written(program) == {"minus_t": A * B}
    program = without_signs({S: A * B, T: -S}, C + T)
    assert written(program) == {"s": A * B}


def test_what_needs_its_sign_has_a_step_for_it():
    minus = sp.Symbol("minus_t")
    program = without_signs({T: -A - B}, sp.sin(T), C + T)
    assert written(program) == {"minus_t": A + B, "t": -minus}
    assert program[1] == [sp.sin(T), C - minus]


def test_results_and_guarded_quantities_stay_as_they_are():
    steps = {T: -A * B, S: sp.sqrt(Guarded(T, sp.Float("1e-9")))}
    assert written(without_signs(steps, T + S, T)) == {"t": -A * B, "s": steps[S]}


def test_a_name_that_is_taken_is_not_taken_again():
    program = without_signs({T: -A - B}, C + T, has=["minus_t"])
    assert written(program) == {"minus_t_2": A + B}


@pytest.mark.parametrize("seed", range(20))
def test_same_bits_and_no_more_operations(seed):
    """On random programs of sums of products, where every sign comes up everywhere."""
    rng = random.Random(seed)
    symbols, steps = [A, B, C], []
    for k in range(30):
        one, two, three = (rng.choice([-1, 1]) * rng.choice(symbols) for _ in range(3))
        forms = [one + two * three, one * two, one * (two + three), -one, one**2 * two]
        value = rng.choice(forms)
        if value.is_Atom or (-value).is_Number:
            continue
        symbols.append(sp.Symbol(f"step_{k}" if rng.random() < 0.7 else f"shared_{k}"))
        steps.append(Step(symbols[-1], value, ""))
    before = alive(steps, [symbols[-1] + symbols[-2], symbols[-3] * symbols[-1]])
    after = alive(*take_out_signs(*before, (), ().__contains__))
    # small numbers, so that sums of thirty products neither overflow nor lose a term
    values = {name: rng.uniform(0.5, 1.5) for name in "abc"}
    assert evaluated(*after, values) == evaluated(*before, values)
    operations = [
        counted(schedule(e) for e in [*(s.expression for s in steps), *results]).total()
        for steps, results in (before, after)
    ]
    assert operations[1] <= operations[0]
