"""Names and texts of a declaration that are impossible in the emitted C and Python.

That a name is an identifier is checked at its declaration (`declared.Name`).
"""

from __future__ import annotations

import keyword
from dataclasses import fields
from typing import TYPE_CHECKING

from .joints import Free
from .states import free_states

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from .assembly import Parts
    from .inputs import Input
    from .outputs import Output

# Words of C, and names that the emitted C and Python use.
_C_WORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while bool true false asm typeof thread_local nullptr constexpr alignas alignof
static_assert
"""
# macros of <math.h>, also those of compilers that are not strict
_MACROS = """
NAN INFINITY HUGE_VAL HUGE_VALF HUGE_VALL MAXFLOAT FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL
FP_FAST_FMA FP_FAST_FMAF FP_FAST_FMAL FP_ILOGB0 FP_ILOGBNAN MATH_ERRNO MATH_ERREXCEPT
math_errhandling DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI
M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 linux unix
"""
_OWN_WORDS = """
sqrt sin cos asin atan2 exp log copysign isfinite fabs abs at_least is_positive number
guard_bit finite_bit either first_not_finite failed status_word
parameters constants state inputs given out status wanted compute i np design_state prepare found
results follow follow_turns square fmax GUARD_FLOOR ROUNDING ITERATIONS CONVERGED STALLED LONGEST
TURNED INLINED NOT_INLINED NO_EFFECT NULL CLOSE SHORTEST CLOSED FULL_TURN UNKNOWNS ELEMENTS DRIVEN
ADDRESSES MECHANISM kept INLINE GREATEST_ANGLE ROUNDER SPREAD BITS REAL MODEL WIDTH
kt_any_sine kt_any_cosine kt_sine kt_cosine kt_arc_sine kt_arc_tangent kt_root kt_magnitude
kt_with_sign_of kt_exponential kt_logarithm kt_real casadi jnp
"""
_WORDS = frozenset([*_C_WORDS.split(), *_MACROS.split(), *_OWN_WORDS.split(), *keyword.kwlist])
# arguments of the residuals, functions that iterate, and macros of headers
_BEGINNINGS = ("given_", "loops_through_", "pose_of_", "KINTRAFO_")
# files without a model's name that lie beside its own when they are compiled
_FILES = ("elementary", "follow", "vectors")
_ENDS_OF_COMMENTS = ("*/", '"""', "\\", "\n", "\r")
TIME = "time"
"""Name of the independent variable of datasets and FMUs."""
_COUNTED = ("count",)  # an enumeration ends with the number of its elements


def name_problems(mechanism: Parts) -> list[str]:
    """Return problems of names: reserved words, and one name for two things."""
    coordinates = [c.name for c in mechanism.coordinates]
    forces = [force.identity for force in mechanism.forces]
    kinds = {
        "body": [b.name for b in mechanism.bodies],
        "joint": [j.name for j in mechanism.joints],
        "parameter": [p.name for p in mechanism.parameters],
        "coordinate": coordinates,
        "input": mechanism.input_names,
        "internal state": [s.name for s in mechanism.internal_states],
        "force": [name for kind, name in forces if kind == "force"],
        "output": [o.name for o in mechanism.outputs],
    }
    # names of variables in the code; other names are a part of one
    read_alone = ("parameter", "coordinate", "input", "internal state")
    problems = [p for kind in read_alone for n in kinds[kind] for p in _reserved(kind, n)]
    for kind, names in kinds.items():
        if kind != "joint":  # joints have no enumeration
            problems += _differ_in_case_only(kind, names)
    owners: dict[str, str] = {}
    rates = [f"{name}_rate" for name in coordinates]
    read = {kind: kinds[kind] for kind in read_alone} | {"rate": rates}
    read["state of a free body"] = [
        entry.name
        for j in dict.fromkeys(mechanism.joints)
        if isinstance(j, Free)
        for entry in free_states(j).entries
    ]
    read["derived"] = list(mechanism.derived)
    for kind, names in read.items():
        for name in dict.fromkeys(names):
            if name in owners:
                problems.append(
                    f"{name!r} is the name of {_article(owners[name])} and of {_article(kind)}; "
                    f"rename the {owners[name]}"
                )
            owners.setdefault(name, kind)
    return problems


def input_name_problems(mechanism: Parts, inputs: Iterable[Input]) -> list[str]:
    """Return problems of names of inputs in a mechanism."""
    taken = {p.name: "parameter" for p in mechanism.parameters}
    taken |= {c.name: "coordinate" for c in mechanism.coordinates}
    problems = []
    for entry in inputs:
        problems += _reserved("input", entry.name)
        problems += unwritable(f"input {entry.name!r}", f"{entry.unit} {entry.meaning}")
        if entry.name in taken:
            kind = taken[entry.name]
            problems.append(f"{entry.name!r} is the name of a {kind} and of an input; rename one")
    return problems


def file_name_problems(name: str) -> list[str]:
    """Return a problem if the files of a model would have the names of other files."""
    if name.lower() in _FILES:
        return [f"a file that the generated code needs is called {name.lower()}; rename the model"]
    return []


def _reserved(kind: str, name: str) -> list[str]:
    """Return a problem if the code uses a name for something else."""
    if name in _WORDS or name.lower() in _COUNTED or name.startswith(_BEGINNINGS):
        return [f"{kind} {name!r} has a name that the generated code needs; choose another one"]
    if name == TIME and kind != "parameter":
        return [f"{kind} {name!r} has the name of the time in results and FMUs; choose another one"]
    return []


def text_problems(mechanism: Parts) -> list[str]:
    """Return problems of units and meanings in comments and docstrings."""
    entries = [
        *((f"parameter {p.name!r}", (p.unit, p.meaning)) for p in mechanism.parameters),
        *((f"coordinate {c.name!r}", (c.unit, c.meaning)) for c in mechanism.coordinates),
        *((f"input {i.name!r}", (i.unit, i.meaning)) for i in mechanism.inputs),
        *((f"internal state {s.name!r}", (s.unit, s.meaning)) for s in mechanism.internal_states),
        *((f"output {o.name!r}", [*_texts(o)]) for o in mechanism.outputs),
    ]
    problems = unwritable("title of the mechanism", mechanism.title)
    return problems + [p for what, texts in entries for t in texts for p in unwritable(what, t)]


def _texts(output: Output) -> Iterator[str]:
    """Yield the texts of an output."""
    for text in (getattr(output, field.name) for field in fields(output)):
        if isinstance(text, str):
            yield text


def unwritable(what: str, text: str) -> list[str]:
    """Return a problem if a text would end the comment or the docstring that contains it."""
    if any(end in text for end in _ENDS_OF_COMMENTS):
        allowed = 'write one line without */, """ and backslashes'
        return [f"{what}: the text {text!r} cannot be in a comment of the code; {allowed}"]
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
        "internal state": "an internal state",
        "derived": "a parameter of a copy",
    }.get(kind, f"a {kind}")
