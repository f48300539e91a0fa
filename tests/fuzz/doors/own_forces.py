"""Forces of a user, edited between compilations: formulas, imported modules, constants.

The same file is written again with another formula, another helper or another constant, and is
compiled with the cache of before. What it computes is held against the text itself, evaluated by
Python.
"""

import math
import os
import tempfile
from pathlib import Path

import kintrafo
import numpy as np
from kintrafo.systems.compile.declaration import MechanismError

from ..attempts import RawError, WrongError

SECONDS = 120.0
SHORT = 3

_FILE = """
from dataclasses import dataclass
from sympy import *
from kintrafo import generator as g
from helper import helped
CONSTANT = {constant}
@dataclass(frozen=True)
class Mine(g.Force):
    joint: g.Revolute
    k: g.Ratio
    @property
    def identity(self):
        return "Mine", "force"
    def act(self, at):
        name = at.coordinate(self.joint.name)
        q, v, k = Symbol(name), at.rate(name), self.k.symbol
        return g.Action({{name: CONSTANT * ({formula}) + helped(q, v, k)}})
ARM = g.Body("arm", 1.0, g.flat("com", (0.0, 0.0)), 1.0)
A = g.hinge("A", g.Ground("ground"), ARM, g.flat("a", (0.0, 0.0)))
FORCE = Mine(A, g.Ratio("k", 1.5, "number"))
M = g.Mechanism("mine", "t", (A,), (FORCE,), (A.angle("q", "q"),))
"""
_HELPER = "from sympy import *\n\ndef helped(q, v, k):\n    return {helper}\n"

# each with what it has inside
_ONE = (
    "sin({})", "cos({})", "tan({})", "atan({})", "Abs({})", "sign({})", "asin(({})/9)",
    "acos(({})/9)", "sqrt({}**2+1)", "({})**5", "(({})**2+1)**2.5", "(({})**2+1)**-3",
    "Heaviside({})", "Max({}, 0)**1.5", "sqrt({})", "1/({})", "-({})",
)  # fmt: skip
_TWO = (
    "({}) + ({})", "({}) - ({})", "({}) * ({})", "({}) * ({})", "Max({}, {})", "Min({}, {})",
    "atan2({}, ({})**2 + 1)", "Piecewise(({}, q > v), ({}, True))",
    "Piecewise(({}, (q < 0.3) & (v <= k)), ({}, True))",
)  # fmt: skip
_REFUSED = ("exp({})", "log({})", "({})**0.3", "tanh({})", "floor({})")
_LEAVES = ("q", "v", "k", "0.7", "2", "E", "pi", "q", "v")


def _first(*pieces):
    return next(value for value, holds in pieces if holds)


_NAMES = {
    "sin": math.sin, "cos": math.cos, "tan": math.tan, "atan": math.atan, "Abs": abs,
    "sign": lambda x: float(np.sign(x)), "asin": math.asin, "acos": math.acos, "sqrt": math.sqrt,
    "Heaviside": lambda x: float(np.heaviside(x, 0.5)), "Max": max, "Min": min,
    "atan2": math.atan2, "Piecewise": _first, "E": math.e, "pi": math.pi,
    # of numbers alone
    "exp": math.exp, "log": math.log, "tanh": math.tanh, "floor": math.floor,
}  # fmt: skip


def attempt(random):
    """Write a declaration, and edit it twice."""
    parts = {"constant": "1.0", "formula": "q", "helper": "v"}
    refused = ""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for _ in range(3):
            edited = list(parts)[random.integers(len(parts))]
            parts[edited] = (
                f"{random.uniform(1, 9):.1f}" if edited == "constant" else _formula(random, 3)
            )
            try:
                _compare(folder, parts, random)
            except MechanismError as error:
                _judge(str(error), parts)
                refused = str(error)
                parts = {"constant": "1.0", "formula": "q", "helper": "v"}
    if refused:
        raise MechanismError(refused)


def _formula(random, depth):
    if depth == 0 or random.random() < 0.1:
        return _LEAVES[random.integers(len(_LEAVES))]
    kinds = _REFUSED if random.random() < 0.02 else (_ONE if random.random() < 0.5 else _TWO)
    form = kinds[random.integers(len(kinds))]
    return form.format(*(_formula(random, depth - 1) for _ in range(form.count("{}"))))


def _judge(text, parts):
    """See that a refusal names what cannot be emitted, and that there is such a thing."""
    named = [w for w in ("exp", "log", "**0.3", "tanh", "floor") if w in "".join(parts.values())]
    if not named and "is not a finite real number" not in text:
        raise RawError(f"{parts}: {text}")
    if "Mine force" not in text or "act" not in text:
        raise RawError(text)


def _compare(folder, parts, random):
    file = folder / "mine.py"
    file.write_text(_FILE.format(**parts))
    (folder / "helper.py").write_text(_HELPER.format(**parts))
    for path in (file, folder / "helper.py"):
        os.utime(path, (1e9, 1e9))  # nobody can tell by the date
    equations = kintrafo.compile(file, folder=folder / "cache", backend="numpy")
    for state in random.uniform(-1.5, 1.5, size=(8, 2)):
        expected, found = _evaluated(parts, *state), _answered(equations.rhs, state)
        if not _agree(found, expected):
            raise WrongError(f"{parts} at {state}: {found}, by Python {expected}")


def _answered(function, state):
    """Return the acceleration; None where it is refused."""
    try:
        return float(function([state])[0, 1])
    except kintrafo.KintrafoError:
        return None


def _evaluated(parts, q, v):
    """Return the value in the text, and its change by a rounding of q; None without a value."""
    found = []
    for nudge in (0.0, 1e-13, -1e-13):
        names = _NAMES | {"q": q + nudge, "v": v * (1.0 + nudge), "k": 1.5}
        try:
            value = float(parts["constant"]) * eval(parts["formula"], names)
            value += eval(parts["helper"], names)
        except (ValueError, ZeroDivisionError, OverflowError, TypeError):
            return None
        if isinstance(value, complex) or not math.isfinite(value):
            return None
        found.append(value)
    return found[0], max(found) - min(found)


def _agree(value, expected):
    """Compare; what Python does not evaluate, such as a root of -1, may be refused."""
    if expected is None:
        return True
    wanted, spread = expected
    if value is None:
        return abs(wanted) > 1e300
    # roundings add up to some thousand units of the largest intermediate value
    return abs(value - wanted) <= 1e3 * spread + 1e-9 * max(abs(wanted), 1.0)
