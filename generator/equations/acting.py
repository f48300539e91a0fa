"""Checks of the actions of forces: complete, emittable, and without lost values.

The forces of the generator are right by their tests. A force of a user may use unknown names,
return something else, or have a formula without emitted operations; each is refused, with the line
of the code where that is known.
"""

from __future__ import annotations

import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...core.si_units import problem_of
from ...core.suggestions import suggestion
from ..declare.declared import DeclarationError, is_own, parts
from ..declare.forces.force import Action, Force
from ..declare.shown import Shown
from ..declare.surroundings import UnseenError
from ..program.spelling import SpellingError, spelled

if TYPE_CHECKING:
    import sympy as sp

    from .surroundings import Seen


def acted(force: Force, at: Seen) -> Action:
    """Return the action of a force.

    Raises `DeclarationError` if its `act` fails, or does not return an action on the coordinates.
    """
    if not _has_own_code(force):
        return force.act(at)
    with _reported(force, at, "act"):
        action = force.act(at)
        problem = _problem(force, at, action)
        if problem:
            raise UnseenError(problem)
        forces = _all_spelled(at, action.forces, "the force along")
        values = _all_spelled(at, action.values, "the value")
        rates = _all_spelled(at, action.rates, "the rate of")
        total = None if action.total is None else spelled(at.program.define, action.total)
        return replace(action, forces=forces, values=values, total=total, rates=rates)


def shown_by(force: Force, at: Seen, action: Action) -> Iterator[Shown]:
    """Yield the signals of a force with a given action.

    Raises `DeclarationError` if its `signals` fails, or yields anything but signals.
    """
    if not _has_own_code(force):
        yield from force.signals(at, action)
        return
    with _reported(force, at, "signals"):
        found: list[Any] = list(force.signals(at, action))
        for shown in found:
            if not isinstance(shown, Shown):
                problem = f"it yields {shown!r}; a Shown(name, value, unit, meaning) is needed"
                raise UnseenError(problem)
            if problem := problem_of(shown.unit):
                raise UnseenError(f"signal {shown.name!r}: {problem}")
        found = [replace(shown, value=spelled(at.program.define, shown.value)) for shown in found]
    yield from found


def _has_own_code(force: Force) -> bool:
    """Return whether a force, or a law or a path in it, is of a user's own class."""
    return any(is_own(type(part)) for part in (force, *parts(force)))


def _all_spelled(at: Seen, values: Mapping[str, Any], what: str) -> dict[str, sp.Expr]:
    found = {}
    for name, value in values.items():
        try:
            found[name] = spelled(at.program.define, value)
        except SpellingError as error:
            message = f"{what} {name!r}: {error}"
            raise SpellingError(message) from error
    return found


@contextmanager
def _reported(force: Force, at: Seen, method: str) -> Iterator[None]:
    """Accept formulas in any form, and name the force of an error."""
    try:
        with at.program.spelling():
            yield
    except DeclarationError:
        raise
    except Exception as error:
        known = isinstance(error, UnseenError | SpellingError)
        text = str(error) if known else f"{type(error).__name__}: {error}"
        problem = f"{method}{_line(force, method, error)}: {text}"
        raise DeclarationError(" ".join(map(str, force.identity)), [problem]) from error


def _line(force: Force, method: str, error: Exception) -> str:
    """Return the line of a force's own file at which an error occurred."""
    code = getattr(getattr(type(force), method), "__code__", None)
    file = code.co_filename if code else ""
    frames = traceback.extract_tb(error.__traceback__)
    lines = [frame.lineno for frame in frames if frame.filename == file]
    return f", line {lines[-1]}" if lines else ""


def _problem(force: Force, at: Seen, action: Any) -> str:
    """Return the reason why an action is incomplete; empty without one."""
    if not isinstance(action, Action):
        return f"it returns {action!r}; an Action(forces) is needed"
    for what in ("forces", "values", "rates"):
        if not isinstance(getattr(action, what), Mapping):
            return f"the {what} of its Action are {getattr(action, what)!r}, and no dictionary"
    for name in action.forces:
        if name not in at.driven:
            return f"a force along {_shown(name, at)}"
    silent = type(force).signals is Force.signals
    for name in action.values if silent else ():
        return (
            f"the value {name!r} is shown by nothing: give the force a method signals(at, action) "
            f"that yields Shown({name!r}, action.values[{name!r}], unit, meaning)"
        )
    nothing = silent and not action.forces and at.all_move
    return "it acts along no coordinate and shows nothing; leave it out" if nothing else ""


def _shown(name: Any, at: Seen) -> str:
    """Return a name that is not a coordinate, with its kind and the coordinates."""
    coordinates = ", ".join(at.driven)
    joints = [joint.name for joint in at.mechanism.joints]
    if name in joints:
        return (
            f"{name!r}, which is a joint, not a coordinate: at.coordinate({name!r}) is that of a "
            f"driven joint. There are {coordinates}"
        )
    if isinstance(name, str):
        return (
            f"{name!r}, which is not an independent or prescribed coordinate. "
            f"{suggestion(name, at.driven)} (There are {coordinates}.)"
        )
    return f"{name!r}, which is not a name: give one of {coordinates}"
