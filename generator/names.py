"""Names and texts of a declaration that the emitted C and Python could not have."""

from __future__ import annotations

import keyword
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .mechanism import Mechanism

# What the emitted C and Python call their own, and the words of both languages.
_C_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while
"""
_OWN_WORDS = """
sqrt sin cos asin atan2 copysign isfinite fabs at_least not_finite
parameters constants state inputs given out status i np design_state prepare
"""
_WORDS = frozenset([*_C_WORDS.split(), *_OWN_WORDS.split(), *keyword.kwlist])
_ENDS_OF_COMMENTS = ("*/", '"""', "\\", "\n", "\r")
_COUNTED = ("count",)  # an enumeration ends with the number of its elements


def name_problems(mechanism: Mechanism) -> list[str]:
    """Find names that code cannot have: no identifiers, reserved words, one name for two things."""
    coordinates = [c.name for c in mechanism.coordinates]
    kinds = {
        "body": [b.name for b in mechanism.bodies],
        "joint": [j.name for j in mechanism.joints],
        "parameter": [p.name for p in mechanism.parameters],
        "coordinate": coordinates,
        "input": list(mechanism.inputs),
        "force element": [element.name for element in mechanism.elements],
    }
    problems = misnamed("mechanism", mechanism.name)
    problems += [p for kind, names in kinds.items() for n in names for p in misnamed(kind, n)]
    for kind, names in kinds.items():
        if kind != "joint":  # of joints there is no enumeration
            problems += _differ_in_case_only(kind, names)
    owners: dict[str, str] = {}
    rates = [f"{name}_rate" for name in coordinates]
    read = {k: kinds[k] for k in ("parameter", "coordinate", "input")} | {"rate": rates}
    read["derived"] = list(mechanism.derived)
    for kind, names in read.items():
        for name in dict.fromkeys(names):
            if name in owners:
                problems.append(
                    f"{name!r} is the name of a {owners[name]} and of {_article(kind)}; "
                    f"rename the {owners[name]}"
                )
            owners.setdefault(name, kind)
    return problems


def misnamed(kind: str, name: str) -> list[str]:
    """Find out whether code cannot have a name of some kind."""
    if not re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name):
        allowed = "use letters, digits and underscores, a letter first"
        return [f"{kind} {name!r} cannot be written in C; {allowed}"]
    reserved = name in _WORDS or name.lower() in _COUNTED or name.startswith("given_")
    if reserved and kind in ("parameter", "coordinate", "input"):
        return [f"{kind} {name!r} has a name that the generated code needs; choose another one"]
    return []


def text_problems(mechanism: Mechanism) -> list[str]:
    """Find units and meanings that comments and docstrings cannot have."""
    entries = [
        *((f"parameter {p.name!r}", (p.unit, p.meaning)) for p in mechanism.parameters),
        *((f"coordinate {c.name!r}", (c.unit, c.meaning)) for c in mechanism.coordinates),
        *((f"input {name!r}", texts) for name, texts in mechanism.inputs.items()),
    ]
    problems = unwritable("title of the mechanism", mechanism.title)
    return problems + [p for what, texts in entries for t in texts for p in unwritable(what, t)]


def unwritable(what: str, text: str) -> list[str]:
    """Find out whether a text would end the comment or the docstring that it stands in."""
    if any(end in text for end in _ENDS_OF_COMMENTS):
        allowed = 'write one line without */, """ and backslashes'
        return [f"{what}: the text {text!r} cannot stand in a comment of the code; {allowed}"]
    return []


def _differ_in_case_only(kind: str, names: list[str]) -> list[str]:
    alike: dict[str, str] = {}
    problems = []
    for name in names:
        other = alike.setdefault(name.lower(), name)
        if other != name:
            problems.append(
                f"{kind} {name!r} differs from {other!r} in capital letters only; rename one, "
                "since the enumerations in C have capital letters"
            )
    return problems


def _article(kind: str) -> str:
    return {
        "rate": "the rate of a coordinate",
        "input": "an input",
        "derived": "a parameter of a copy",
    }.get(kind, f"a {kind}")
