"""The file with the data of an imported suspension that its subsystem does not have."""

from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

from ....core.errors import InputError
from ....core.legible import legible
from ....core.suggestions import suggestion
from ...data import find
from ...kinds import KINDS, Suspension
from ..fitting import packaged
from ..point_names import kind_of, nearest_kinds
from .subsystem import Subsystem


class TemplateFile(NamedTuple):
    """The file with all data besides those of the subsystem."""

    kind: str
    title: str  # name in messages
    text: str
    suspension: Suspension
    packaged: bool  # whether it is a packaged file, and not one of the user


def rest_of(
    subsystem: Subsystem, kind: str | None, base: str | Path | None, given: Mapping[str, str]
) -> TemplateFile:
    """Return the file that the user names, or the packaged one of a kind."""
    if kind is not None and kind not in KINDS:
        problem = f"{kind!r} is not a kind of suspension. {suggestion(kind, KINDS)}"
        raise InputError([problem], "kind")
    if base is not None:
        return _users(subsystem, kind, base, given)
    found = kind or kind_of(subsystem.points, given, subsystem.source)
    starter, text, suspension = packaged(found)
    return TemplateFile(found, f"packaged {starter}", text, suspension, packaged=True)


def _users(
    subsystem: Subsystem, kind: str | None, base: str | Path, given: Mapping[str, str]
) -> TemplateFile:
    """Return the file of a user; refuse it if the subsystem is of another kind."""
    suspension = Suspension.load(base)
    title = legible(f"file {Path(base).name}")
    own = next(name for name, known in KINDS.items() if type(suspension) is known)
    near = nearest_kinds(subsystem.points, given)
    if kind not in (None, own):
        problem = f"kind {kind} is given, and the {title} is of a {own}. Leave one of them out."
        raise InputError([problem], "kind")
    if kind is None and own not in near:
        problem = (
            f"its hardpoints are those of a {' or '.join(near)}, and the {title} is of a {own}. "
            f"Give another file, or this kind: --kind {own}."
        )
        raise InputError([problem], subsystem.source)
    text = find(base).read_text(encoding="utf-8-sig")
    return TemplateFile(own, title, text, suspension, packaged=False)
