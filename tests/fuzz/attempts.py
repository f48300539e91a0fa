"""Outcomes of one attempt at a door, and their words.

A door is a module of `fuzz.doors` with a docstring whose first line describes the input,
and with a function ``attempt(random)`` that tries it once with what it draws from a
`numpy.random.Generator`. What it may do:

- return: something went in and every check of the result held (clean);
- raise `UnjudgedError`: something went in, and what it is checked against has no answer (unjudged);
- raise a `KintrafoError`, or another error that the door names in ``CLEAR``: a refusal, in words
  that name what is wrong (clear). A door that can judge the words does so, and raises `RawError`;
- raise `WrongError`: a result that contradicts what shares no code with it;
- raise anything else, or end the interpreter: raw;
- not return within ``SECONDS`` (20 by default): hung.

A door may set ``SHORT``, the number of attempts in a test run (40 if it does not), to a number that
stands there as it is.
"""

from __future__ import annotations

import ast
import importlib
import pkgutil
from dataclasses import dataclass
from importlib.util import find_spec

import numpy as np
from kintrafo.core.errors import KintrafoError

from . import doors

OUTCOMES = ("clean", "unjudged", "clear", "wrong", "raw", "hung")
"""Outcomes of an attempt; the last three are defects."""

DEFECTS = OUTCOMES[3:]


class WrongError(AssertionError):
    """A result that contradicts its oracle."""


class UnjudgedError(Exception):
    """An attempt whose correct outcome the oracle does not know."""


class RawError(AssertionError):
    """A refusal in words that help nobody."""


@dataclass(frozen=True)
class Tried:
    """One attempt.

    Attributes
    ----------
    seed : int
        Of the random numbers: the same seed tries the same.
    outcome : str
        One of `OUTCOMES`.
    text : str
        Of the error, if there is one.
    """

    seed: int
    outcome: str
    text: str = ""


def names():
    """Return the names of all doors; one that begins with an underscore is none."""
    found = (module.name for module in pkgutil.iter_modules(doors.__path__))
    return sorted(name for name in found if not name.startswith("_"))


def door(name):
    """Return a door by its name."""
    return importlib.import_module(f"{doors.__name__}.{name}")


def what_is_tried(name):
    """Return the first line of the docstring of a door."""
    return (ast.get_docstring(_text_of(name)) or "").partition("\n")[0].rstrip(".")


def short(name):
    """Return the number of attempts in a test run."""
    found = 40
    for line in _text_of(name).body:
        if isinstance(line, ast.Assign) and ast.unparse(line.targets[0]) == "SHORT":
            found = ast.literal_eval(line.value)
    return found


def _text_of(name):
    """Return a door as it is written: to import it is for the processes that try it."""
    found = find_spec(f"{doors.__name__}.{name}")
    if found is None or found.loader is None:
        raise ModuleNotFoundError(name)
    return ast.parse(found.loader.get_source(found.name))


def setting(module, name):
    """Return a setting of a door, or its default."""
    defaults = {"SECONDS": 20.0, "CLEAR": ()}
    return getattr(module, name, defaults[name])


def tried(module, seed):
    """Try a door once; an attempt that does not come back is for the caller to end."""
    clear = (KintrafoError, *setting(module, "CLEAR"))
    try:
        module.attempt(np.random.default_rng(seed))
    except WrongError as error:
        return Tried(seed, "wrong", str(error))
    except UnjudgedError as error:
        return Tried(seed, "unjudged", str(error))
    except clear as error:
        return Tried(seed, "clear", str(error))
    except Exception as error:  # noqa: BLE001 (every other error is what is looked for)
        return Tried(seed, "raw", f"{type(error).__name__}: {error}")
    return Tried(seed, "clean")
