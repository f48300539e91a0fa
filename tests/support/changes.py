"""The same declaration with something else in the place of one of its objects."""

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace

from kintrafo.generator.declare.parameters import Image


def changed(thing, *pairs):
    """Return a mechanism, a model or a part of one with new objects for old ones, everywhere."""
    return _changed(thing, pairs)


def with_default(thing, **values):
    """Return a mechanism or a model with other defaults of parameters, given by their names."""
    mechanism = getattr(thing, "mechanism", thing)
    unknown = {*values} - {p.name for p in mechanism.parameters}
    assert not unknown, unknown
    pairs = []
    for owner in mechanism.owners:
        defaults = [values.get(p.name, p.default) for p in owner.numbers]
        if any(p.name in values for p in owner.numbers):
            pairs.append((owner, _with_defaults(owner, defaults)))
    return changed(thing, *pairs)


def _with_defaults(owner, defaults):
    if hasattr(owner, "default"):
        return replace(owner, default=defaults[0])
    if hasattr(owner, "place"):
        return replace(owner, place=tuple(defaults))
    if hasattr(owner, "along"):
        return replace(owner, along=tuple(defaults))
    given = zip(owner.given, defaults, strict=True)
    return replace(owner, given=tuple((e, value, what) for (e, _, what), value in given))


def _changed(thing, pairs):
    for old, new in pairs:
        if type(thing) is type(old) and thing == old:
            return new
    if isinstance(thing, tuple) and not hasattr(thing, "_fields"):
        items = tuple(_changed(item, pairs) for item in thing)
        return items if any(a is not b for a, b in zip(items, thing, strict=True)) else thing
    if isinstance(thing, Mapping):
        return {_changed(k, pairs): _changed(v, pairs) for k, v in thing.items()}
    if not is_dataclass(thing) or isinstance(thing, type | Image):
        return thing
    given = {entry.name: getattr(thing, entry.name) for entry in fields(thing) if entry.init}
    found = {name: _changed(value, pairs) for name, value in given.items()}
    different = {name: value for name, value in found.items() if value is not given[name]}
    return replace(thing, **different) if different else thing


def named(thing, kind, name):
    """Return a point, a direction or another object of a mechanism or a model by its name."""
    mechanism = getattr(thing, "mechanism", thing)
    return next(part for part in mechanism.every(kind) if part.name == name)
