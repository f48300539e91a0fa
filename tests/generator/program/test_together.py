"""Functions with one program: equal quantities are equal, and variants keep their own."""

import sympy as sp
from kintrafo.generator.program import ConstantStage, Program
from kintrafo.generator.program.together import share_together

P, X, Y, Z = sp.symbols("p x y z")
TAKEN = frozenset({"x", "y", "z", "shared_1", "speed_held"})


def program(speed, *, guarded=False):
    """Return a program in which a distance is as in others, and the speed is not."""
    made = Program(ConstantStage((P,), TAKEN))
    made.define("distance", X * Y + P)
    made.define("speed", speed)
    if guarded:
        made.guarded("scale", sp.Symbol("speed") ** 2 + X, "too slow", "m")
    return made


def shared(variants, main):
    functions, _ = share_together(variants, main.steps, main.constants.has)
    return {function.name: function for function in functions}


def steps(function):
    return {step.symbol.name: step.expression for step in function.steps}


def test_a_sum_is_put_together_in_one_way():
    """Alone, the first function would have no part of its sum in common with anything."""
    main = program(X + Y)
    sums = {"one": X + Y + Z, "other": sp.sin(X + Y) * Z}
    pruned = [main.pruned(name, "", {"r": value}) for name, value in sums.items()]
    found = shared({"": pruned}, main)
    common = sp.Symbol("shared_2")  # shared_1 is the name of an input
    assert steps(found["one"]) == {"shared_2": X + Y}
    assert found["one"].results == (common + Z,)
    assert found["other"].results == (sp.sin(common) * Z,)


def test_a_variant_has_its_own_steps_beside_those_of_all():
    main, held = program(X * Z, guarded=True), program(Y * Z, guarded=True)
    results = {"r": sp.Symbol("distance") * sp.Symbol("speed") / sp.Symbol("scale")}
    groups = {"": [main.pruned("f", "", results)], "held": [held.pruned("f_held", "", results)]}
    found = shared(groups, main)
    assert steps(found["f"]).keys() == {"distance", "speed", "scale"}
    # a name that something else has gets a number
    own = {"distance", "speed_held_2", "scale_held"}
    assert own <= steps(found["f_held"]).keys()
    assert not {"speed", "scale"} & steps(found["f_held"]).keys()


def test_a_guard_of_a_variant_watches_its_own_quantity():
    main, held = program(X * Z, guarded=True), program(Y * Z, guarded=True)
    results = [
        {"r": made.guarded("scale", sp.Symbol("speed") ** 2 + X, "too slow", "m")}
        for made in (main, held)
    ]
    groups = {
        "": [main.pruned("f", "", results[0])],
        "held": [held.pruned("f_held", "", results[1])],
    }
    found = shared(groups, main)
    quantities = {n: [(g.name, str(g.quantity)) for g in f.guards] for n, f in found.items()}
    assert quantities == {"f": [("scale", "scale")], "f_held": [("scale", "scale_held")]}


def test_steps_come_in_the_order_of_the_program():
    main = program(X + Z)
    groups = [main.pruned("late", "", {"r": sp.Symbol("speed")})]
    groups += [main.pruned("early", "", {"r": sp.Symbol("distance") * sp.Symbol("speed")})]
    _, order = share_together({"": groups}, main.steps, main.constants.has)
    assert order == ["distance", "speed"]
