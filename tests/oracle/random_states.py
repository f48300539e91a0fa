"""Compare a model with the oracle in maximal coordinates, over random states."""

from itertools import count as counted

import numpy as np
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.equations.outputs import generate
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.loader import load
from support.models import Built

_numbers = counted()


def check_with_the_oracle(model, folder, reach, count=10, *, operations=None):
    """See that loops close, that rates keep them closed, and that accelerations are the oracle's.

    Parameters
    ----------
    reach
        How far from the design position the independent coordinates are taken.
    operations
        At most that many has a call of the right-hand side.
    """
    derived = generate(model, derivatives=False)
    if operations is not None:
        assert operations_of(derived.functions["rhs"]).total() <= operations
    # a module is known by the name of its folder: another model of that name would be taken for it
    target = folder / f"{model.name}-{next(_numbers)}"
    target.mkdir()
    build(derived, target, None)
    built = Built.of(model, load(target))
    names = list(built.module.INPUTS)
    random = np.random.default_rng(0)
    for _ in range(count):
        away = random.uniform(-reach, reach, built.size)
        state = np.concatenate((built.design + away, random.uniform(-3.0, 3.0, built.size)))
        inputs = random.uniform(-1.0, 1.0, len(names))
        inputs[[name.endswith("_position") for name in names]] *= reach
        motion = built.motion(state, inputs)
        closure = built.oracle.closure(motion)
        np.testing.assert_allclose(closure.value, 0.0, atol=1e-14)
        np.testing.assert_allclose(closure.rate, 0.0, atol=1e-12)
        named = built.named(inputs)
        given = {joint: named[moved.rates[1]] for joint, moved in model.motions.items()}
        expected = built.oracle.reduced(motion, named, given).accelerations
        found = built("rhs", state, inputs)[built.size :]
        scale = np.abs(expected).max()
        np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-10 * scale)
    return built
