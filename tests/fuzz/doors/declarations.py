"""Declarations of mechanisms with common mistakes: names, types, bodies, numbers.

One or two places of a good declaration are changed. What is accepted and small is derived, and held
against the same mechanism in maximal coordinates: loops that close, and accelerations. Now and then
one of the mechanisms of the tests is tried beside copies of itself.
"""

import tempfile
import warnings
from dataclasses import fields, is_dataclass, replace
from decimal import Decimal
from functools import cache
from pathlib import Path

import numpy as np
from kintrafo.core.errors import KintrafoError
from kintrafo.generator import DeclarationError
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.mechanisms import double_wishbone, four_bar, slider_crank
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.declaration import given_by, translated_errors
from kintrafo.systems.compile.loader import load
from mechanisms import beside_mirror_image
from mechanisms.every_closed_form import spatial_four_bar
from support.models import Built

from ..attempts import RawError, UnjudgedError, WrongError

SECONDS = 120.0
SHORT = 40

_EXAMPLE = Path(__file__).parents[3] / "examples" / "pushrod_suspension.py"
_DERIVED = 0.2  # share of the small accepted ones that are derived as a whole: a second each
_IN_COMPANY = 0.002
_SMALL = ("four_bar", "slider_crank")
_EXTREME = 1e6  # how much larger or smaller than it was a number is, of which nothing is compared


@cache
def _models():
    """Return good declarations."""
    example = given_by(_EXAMPLE, None)
    (small, slider) = (m.MODELS[0] for m in (four_bar, slider_crank))
    return (small, slider, small, double_wishbone.MODELS[0], spatial_four_bar("spatial"), example)


def attempt(random):
    """Try a declaration with a mistake."""
    if random.random() < _IN_COMPANY:
        names = list(beside_mirror_image.EVERY)
        model = beside_mirror_image.EVERY[names[random.integers(len(names))]]
        beside_mirror_image.check_in_company(model, random)
        return
    model = _models()[random.integers(len(_models()))]
    words = sorted({w for w in _texts(model) if w.isidentifier()})
    for _ in range(random.integers(1, 3)):
        model = _mistaken(model, random, words)
    try:
        with translated_errors():
            plan = CataloguePlan.of(model)
    except KintrafoError as error:
        _judge(error)
        raise
    if model.name in _SMALL and random.random() < _DERIVED and not plan.formulation.prescribed:
        _compare(model, random)


# -- mistakes -------------------------------------------------------------------------------------


def _mistaken(whole, random, words):
    """Return a declaration with a mistake at some place."""
    paths = list(_paths(whole))
    path = paths[random.integers(len(paths))]
    try:
        return _changed(whole, path, random, words)
    except DeclarationError as error:
        _judge(error)
        raise


def _paths(value, path=()):
    """Yield the ways to all parts of a declaration."""
    if path:
        yield path
    if is_dataclass(value) and type(value).__name__ != "Vector":
        for name in _written(value):
            yield from _paths(getattr(value, name), (*path, name))
    elif isinstance(value, tuple):
        for i, item in enumerate(value):
            yield from _paths(item, (*path, i))
    elif isinstance(value, dict):
        for key, item in value.items():
            yield from _paths(item, (*path, key))


def _written(value):
    """Return the names of the fields that a person gives."""
    return [e.name for e in fields(value) if e.init and e.name not in ("order", "image", "axial")]


def _changed(value, path, random, words):
    """Return a value with a mistake at the end of a path."""
    if not path:
        return _mistake(value, random, words)
    first, *rest = path
    if isinstance(value, tuple):
        new = _changed(value[first], rest, random, words)
        return (*value[:first], new, *value[first + 1 :])
    if isinstance(value, dict):
        return value | {first: _changed(value[first], rest, random, words)}
    return replace(value, **{first: _changed(getattr(value, first), rest, random, words)})


def _mistake(value, random, words):
    """Return what somebody may write in the place of a value."""
    if isinstance(value, str):
        options = _wrong_text(value, random, words)
    elif isinstance(value, bool):
        options = ["yes", None, 2, not value]
    elif isinstance(value, int):
        options = [value + 1, 1, 2, -1, str(value), 1.5, None]
    elif isinstance(value, float):
        options = [
            float("nan"), -value, 1e3 * value, 1e-3 * value, 0.0, str(value), np.inf, 1e300, 1e-300,
            Decimal(value), np.float32(value), None, complex(value, 1.0), int(value), -1e-9, 1e9,
            value * np.pi / 180.0, [value], True,
        ]  # fmt: skip
    elif isinstance(value, tuple):
        options = _wrong_tuple(value, random)
    elif isinstance(value, dict):
        options = [{}, None, tuple(value), tuple(value.items()), {w: w for w in words[:2]}]
        options += [{key: value[key] for key in list(value)[1:]}]
    else:
        options = [None, getattr(value, "name", "x"), type(value), (value,), [value], 0.0]
    return options[random.integers(len(options))]


def _wrong_text(text, random, words):
    at = int(random.integers(max(len(text), 1)))
    other = words[random.integers(len(words))]
    return [
        other, other, other,
        text[:at] + text[at + 1 :], text[:at] + text[at : at + 1] * 2 + text[at + 1 :],
        text[:at] + text[at + 1 : at + 2] + text[at : at + 1] + text[at + 2 :],
        text.capitalize(), text.upper(), f"{text} ", f"{text}-1", f"1{text}", "", None, 3,
        "double", "NAN", "lambda", "count", "given_x", "a */ b", "ü", "a\nb", [text], (text,),
    ]  # fmt: skip


def _wrong_tuple(value, random):
    if not value:
        return [None, "x", (None,), ("x",), 0]
    at, other = (int(i) for i in random.integers(len(value), size=2))
    swapped = list(value)
    swapped[at], swapped[other] = swapped[other], swapped[at]
    return [
        (*value[:at], *value[at + 1 :]), (*value, value[at]), tuple(swapped), tuple(swapped),
        list(value), (), value[at], None, (*value, None), (*value, "x"), (value,), str(value),
        (*value[:at], [value[at]], *value[at + 1 :]), iter(value), value[::-1],
    ]  # fmt: skip


def _texts(value):
    """Yield all texts of a declaration."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, tuple):
        for item in value:
            yield from _texts(item)
    elif isinstance(value, dict):
        yield from _texts(tuple(value.items()))
    elif is_dataclass(value):
        for name in _written(value):
            yield from _texts(getattr(value, name))


# -- outcomes -------------------------------------------------------------------------------------


def _judge(error):
    """Check that an error is a sentence and names its part."""
    text = str(error)
    if len(text) < 30 or "Traceback" in text or "object at 0x" in text:
        raise RawError(text) from error


def _compare(model, random):
    """Hold a derived model against the same mechanism in maximal coordinates."""
    with translated_errors(model):
        derived = generate(model)
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        target = Path(folder) / f"{model.name}-{random.integers(2**62):x}"
        target.mkdir()
        build(derived, target, None)
        built = Built.of(model, load(target))
        rates = random.standard_normal(built.size)
        state = np.concatenate((built.design + 0.01 * random.standard_normal(built.size), rates))
        inputs = random.standard_normal(len(built.module.INPUTS))
        motion, found = built.motion(state, inputs), built("rhs", state, inputs)[built.size :]
    sizes = [abs(p.default) for p in model.mechanism.parameters if p.default]
    if max(sizes) > _EXTREME or min(sizes) < 1.0 / _EXTREME:
        raise UnjudgedError("sizes so far apart that roundings of one are more than the other")
    # closed to rounding, which grows from 1e-16 with the angle at which circles cut
    if np.abs(built.oracle.closure(motion).value).max() > 1e-9 * max(sizes):
        raise WrongError(f"a loop is open: {built.oracle.closure(motion).value}")
    expected = built.oracle.reduced(motion, built.named(inputs), {}).accelerations
    if np.abs(found - expected).max() > 1e-6 * np.abs(expected).max() + 1e-9:
        raise WrongError(f"accelerations {found}, in maximal coordinates {expected}")
