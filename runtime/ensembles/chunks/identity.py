"""Digests that identify an ensemble: of everything on which its numbers depend."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np
from scipy.interpolate import PPoly

from ...systems.compile.shipped import words_of
from ..collected import Collected
from .versions import versions

Identity = dict[str, str]


def identity_of(collected: Collected) -> Identity:
    """Return a digest for each of the arguments.

    Threads, lanes and workers are left out: the bits of the results do not depend on them.
    """
    problem, asked = collected.problem, collected.asked
    systems = problem.systems
    parts: dict[str, Any] = {
        "the version of kintrafo or its packages": versions(),
        "equations": (problem.model.equations.NAME, words_of(problem.model.equations)),
        "parameters of the model": systems.parameters,
        "variants": (systems.varied, systems.variants, systems.drive_of, systems.count),
        "y0": systems.states,
        "t_span and inputs": (systems.inputs, systems.drives),
        "t_eval": asked.times,
        "signals and reductions": (asked.signals, asked.reduced, asked.bounds),
        "tolerances and steps": problem.accuracy,
        "stiff": (problem.stiff_after, collected.again is not None),
    }
    return {name: _digest(value) for name, value in parts.items()}


def _digest(value: Any) -> str:
    digest = hashlib.sha256()
    for word in _words(value):
        # with its length, so that no two sequences of words agree
        digest.update(len(word).to_bytes(8, "little") + word)
    return digest.hexdigest()


def _words(value: Any) -> Iterator[bytes]:
    """Yield the contents of a value in their order."""
    yield type(value).__name__.encode()
    if isinstance(value, np.ndarray):
        yield from (value.dtype.str.encode(), repr(value.shape).encode(), value.tobytes())
    elif isinstance(value, PPoly):
        yield from (*_words(value.x), *_words(value.c))
    elif isinstance(value, bytes):
        yield value
    elif isinstance(value, Mapping):
        yield from _all_words(value.items())
    elif isinstance(value, tuple | list):
        yield from _all_words(value)
    elif is_dataclass(value):
        yield from _all_words(getattr(value, field.name) for field in fields(value))
    else:  # numbers and texts
        yield repr(value).encode()


def _all_words(values: Any) -> Iterator[bytes]:
    listed = [*values]
    yield str(len(listed)).encode()
    for value in listed:
        yield from _words(value)
