"""Names of hardpoints in other programs, by kind of suspension.

They are those of Adams/Car's templates, OptimumK and Lotus Suspension Analysis; capitals, blanks,
hyphens and underscores do not matter.
"""

from collections.abc import Collection, Iterable, Mapping
from typing import Any

from ...core.errors import InputError
from ...core.legible import legible, short
from ...core.suggestions import nearest, suggestion
from ...core.tables import key
from ...core.validator import Validator
from ..input.hardpoints import Hardpoints
from ..kinds import KINDS

# By our names: names of Adams/Car, several if templates differ; of OptimumK, which begin with CHAS,
# UPRI, NSMA or ROCK; of Lotus, in words.
_EVERY = {
    "wheel_center": ("wheel_center", "wheel centre", "wheel centre point"),
    "tie_rod_outer": ("tierod_outer", "UPRI_TiePnt", "outer track rod ball joint"),
    "tie_rod_inner": ("tierod_inner", "CHAS_TiePnt", "inner track rod ball joint"),
}
_STRUT: Mapping[str, tuple[str, ...]] = {
    "arm_front": ("lca_front", "lower wishbone front pivot"),
    "arm_rear": ("lca_rear", "lower wishbone rear pivot"),
    "ball_joint": ("lca_outer", "lower wishbone outer ball joint"),
    "strut_top": ("top_mount",),
    "strut_lower": ("strut_lwr_mount",),
    "spring_seat": ("spring_lwr_seat",),
}
_ARMS = {
    "lower_arm_front": ("lca_front", "CHAS_LowFor", "lower wishbone front pivot"),
    "lower_arm_rear": ("lca_rear", "CHAS_LowAft", "lower wishbone rear pivot"),
    "lower_ball_joint": ("lca_outer", "UPRI_LowPnt", "lower wishbone outer ball joint"),
    "upper_arm_front": ("uca_front", "CHAS_UppFor", "upper wishbone front pivot"),
    "upper_arm_rear": ("uca_rear", "CHAS_UppAft", "upper wishbone rear pivot"),
    "upper_ball_joint": ("uca_outer", "UPRI_UppPnt", "upper wishbone outer ball joint"),
}
_COIL = {"spring_top": ("top_mount",), "spring_seat": ("lwr_strut_mount",)}
# The second point of the bellcrank is any point on its axis, as a bearing is.
_ROCKER = {
    "rocker_front": ("bellcrank_pivot_orient", "CHAS_RocAxi"),
    "rocker_rear": ("bellcrank_pivot", "CHAS_RocPiv"),
    "spring_top": ("shock_to_chassis", "CHAS_AttPnt"),
    "spring_seat": ("shock_to_bellcrank", "ROCK_CoiPnt"),
}
_ROD_OUTER = "prod_outboard", "prod_outer", "NSMA_PPAttPnt"
_ROD_INNER = "prod_to_bellcrank", "prod_inboard", "ROCK_RodPnt"

NAMES: Mapping[str, Mapping[str, tuple[str, ...]]] = {
    "macpherson": _STRUT,
    "double_wishbone": {**_ARMS, **_COIL},
    "push_rod": {**_ARMS, **_ROCKER, "push_rod_outer": _ROD_OUTER, "push_rod_inner": _ROD_INNER},
    "pull_rod": {**_ARMS, **_ROCKER, "pull_rod_outer": _ROD_OUTER, "pull_rod_inner": _ROD_INNER},
}
"""By kind and hardpoint. Templates of multi-link suspensions have no names in common."""

_OF_ROCKERS = "rocker: its axis leads from bellcrank_pivot to bellcrank_pivot_orient"
_AXES = {
    "macpherson": ("strut: its axis leads from strut_lower, or else ball_joint, to strut_top",),
    "double_wishbone": ("spring and damper: on one axis, between lower arm and chassis",),
    "push_rod": ("push rod: held by the lower arm", _OF_ROCKERS),
    "pull_rod": ("pull rod: held by the upper arm", _OF_ROCKERS),
}


def assumed_of(kind: str) -> tuple[str, ...]:
    """Return the assumptions on the template of a kind."""
    return _AXES.get(kind, ())


def points_of(kind: str) -> type[Hardpoints]:
    """Return the class of the hardpoints of a kind of suspension."""
    found = KINDS[kind].model_fields["hardpoints"].annotation
    if not (isinstance(found, type) and issubclass(found, Hardpoints)):
        raise TypeError(kind)
    return found


def known(kind: str) -> list[str]:
    """Return the names of all hardpoints that a kind may have."""
    points = points_of(kind)
    return [*points.names(), *points.STAND_INS]


def read_names(texts: Iterable[str]) -> dict[str, str]:
    """Return the names of hardpoints that a user assigns by ``ours=theirs``.

    Parameters
    ----------
    texts : iterable of str
        Texts such as ``lower_ball_joint=my_lca_outer``: the name in kintrafo, ``=``, and the name
        in the other file.

    Returns
    -------
    dict
        The names in the other file, by those of kintrafo.

    Raises
    ------
    InputError
        If a text has another form, or a hardpoint occurs twice.
    """
    with Validator("read_names") as given:
        several = isinstance(texts, Iterable) and not isinstance(texts, str | bytes)
        listed: list[Any] = list(texts) if several else [texts]
        for text in listed:
            given.instance("texts", text, str, "texts are needed, such as ball_joint=my_lca_outer")
    found: dict[str, str] = {}
    problems = []
    for text in listed:
        ours, equals, theirs = (part.strip() for part in text.partition("="))
        if not (ours and equals and theirs):
            problems.append(f"{text!r} is not a pair. Write lower_ball_joint=my_lca_outer.")
        elif ours in found:
            problems.append(f"{ours} is named twice: {found[ours]} and {theirs}. Keep one.")
        else:
            found[ours] = theirs
    if problems:
        raise InputError(problems, "names of hardpoints")
    return found


def matched(
    there: Collection[str], kind: str, given: Mapping[str, str], source: str
) -> dict[str, str]:
    """Return the names of hardpoints in a file, by our names; missing ones are left out.

    `given` are names from the user, see `read_names`, which precede those of templates. Raises
    `InputError` if one of them does not exist, or the file has two names for one hardpoint.
    """
    by_key = {key(name): name for name in there}
    problems = [
        f"{name} and {by_key[key(name)]} are two spellings of one name. Keep one of them."
        for name in there
        if name != by_key[key(name)]
    ]
    problems += [
        f"{ours} is not a hardpoint of a {KINDS[kind].TITLE}. {suggestion(ours, known(kind))}"
        for ours in given
        if ours not in known(kind)
    ]
    problems += [
        f"{ours}={theirs}: there is no hardpoint {theirs}. {_hint(theirs, there)}"
        for ours, theirs in given.items()
        if key(theirs) not in by_key
    ]
    found: dict[str, str] = {}
    for ours in known(kind):
        names = [given[ours]] if ours in given else _usual(ours, kind)
        usual = [by_key[key(name)] for name in names if key(name) in by_key]
        if len(usual) > 1:
            problems.append(
                f"{' and '.join(usual)} may both be {ours}. Choose one: --name {ours}={usual[0]}."
            )
        if usual:
            found[ours] = usual[0]
    if problems:
        raise InputError(problems, source)
    return found


def kind_of(there: Collection[str], given: Mapping[str, str], source: str) -> str:
    """Return the kind of suspension of which a subsystem has the most hardpoints.

    A missing hardpoint, or two equal kinds, raise an `InputError`; a kind with fewer hardpoints is
    not a substitute: a double wishbone with another name of a point is not a strut.
    """
    near = nearest_kinds(there, given)
    missing = _missing(there, near[0], given)
    if len(near) == 1 and not missing:
        return near[0]
    if missing:
        problem = (
            f"its hardpoints match no kind of suspension. The nearest is {near[0]}; missing are: "
            f"{', '.join(missing)}. Give the kind, and the names of these points: "
            f"--kind {near[0]} --name {missing[0]}=NAME. It has: {listed(there)}."
        )
    else:
        problem = f"it may be {' or '.join(near)}. Choose one: --kind {near[0]}."
    raise InputError([problem], source)


def nearest_kinds(there: Collection[str], given: Mapping[str, str]) -> list[str]:
    """Return the kinds of suspension of which a subsystem has the most hardpoints.

    Of several kinds it returns those with the fewest missing hardpoints.
    """
    counts = {kind: len(_present(there, kind, given, known(kind))) for kind in KINDS}
    near = [kind for kind in KINDS if counts[kind] == max(counts.values())]
    lacks = {kind: len(_missing(there, kind, given)) for kind in near}
    least = min(lacks.values())
    return [kind for kind in near if lacks[kind] == least]


def _missing(there: Collection[str], kind: str, given: Mapping[str, str]) -> list[str]:
    """Return the required hardpoints of a kind that the subsystem does not have."""
    names = points_of(kind).names()
    present = _present(there, kind, given, names)
    return [name for name in names if name not in present]


def listed(there: Iterable[str]) -> str:
    """Return the names of a subsystem in printable form."""
    return short(legible(", ".join(there)), most=1000)


def _hint(word: str, there: Collection[str]) -> str:
    """Return a sentence with the most similar name of a subsystem, or with all of them."""
    near = nearest(word, there)
    return f"Did you mean {listed([near])}?" if near else f"It has: {listed(there)}."


def _present(
    there: Collection[str], kind: str, given: Mapping[str, str], names: Iterable[str]
) -> list[str]:
    """Return the hardpoints, by our names, that the subsystem has."""
    keys = {key(name) for name in there}
    return [
        name
        for name in names
        if any(key(n) in keys for n in (given.get(name, ""), *_usual(name, kind)))
    ]


def _usual(ours: str, kind: str) -> tuple[str, ...]:
    """Return the names of a hardpoint in templates, and its own."""
    theirs = {**_EVERY, **NAMES.get(kind, {})}.get(ours, ())
    return tuple({key(name): name for name in (*theirs, ours)}.values())
