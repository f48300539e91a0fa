"""An input file with the hardpoints, angles and spring of a subsystem of Adams/Car."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import tomlkit

from ....core.errors import InputError
from ....core.legible import legible
from ....core.validator import Validator
from ...input.teim_values import shown
from ...kinds import KINDS, Suspension
from ...models.sides import SIDES
from ..fitting import Point, Side, differences, fresh, ground, move_along, put, to_side
from ..point_names import assumed_of, known, listed, matched, points_of
from ..point_table import Merged, put_points
from .rest import TemplateFile, rest_of
from .springs import AdamsSpring, force_at_design, put_spring, spring_of
from .subsystem import ANGLES, Subsystem

SMOOTH = "spring: a monotone cubic through the points of its curve, and straight beyond them"
_SCHEMA = "#:schema"  # a first line for editors


@dataclass(frozen=True)
class ImportedSubsystem(Merged):
    """An input file made from a subsystem; see `kintrafo.point_table.write_merged`.

    Attributes
    ----------
    kind : str
        The kind of suspension.
    side : {'left', 'right'}
        Side of the suspension.
    angles : dict of str to float
        Camber and toe of the subsystem [deg], by the keys of ``[wheel]``.
    spring : AdamsSpring or None
        The spring of the subsystem.
    assumed : tuple of str
        Assumptions, one sentence each.
    """

    kind: str
    side: Side
    angles: dict[str, float]
    spring: AdamsSpring | None
    assumed: tuple[str, ...]

    def words(self) -> list[tuple[str, str]]:
        """Return descriptions of values that were read, assumed and left out."""
        pairs = (
            ours if ours == theirs else f"{ours} ({theirs})" for ours, theirs in self.read.items()
        )
        return [
            ("read", f"{KINDS[self.kind].TITLE}, {self.side} side"),
            ("read", ", ".join(pairs)),
            *(("read", f"{key.removesuffix('_deg')} {v:g} deg") for key, v in self.angles.items()),
            *([("read", self.spring.words())] if self.spring else []),
            *(("assumed", text) for text in self.assumed),
            *(("left out", text) for text in self.left_out),
        ]


def imported(
    subsystem: Subsystem,
    *,
    side: Side | None = None,
    kind: str | None = None,
    base: str | Path | None = None,
    names: Mapping[str, str] | None = None,
) -> ImportedSubsystem:
    """Return the text of an input file made from an Adams/Car subsystem.

    Parameters
    ----------
    subsystem : Subsystem
    side : {'left', 'right'}, optional
        By default the side of `base`, or left.
    kind : str, optional
        The kind of suspension, such as ``"double_wishbone"``; by default that of `base`, or the one
        with the hardpoints of the subsystem.
    base : str or pathlib.Path, optional
        A file with all other values, including missing hardpoints. By default the packaged file of
        the kind, moved to the position of the wheel.
    names : mapping of str to str, optional
        Names of hardpoints in a subsystem whose template is not known, by those of kintrafo.

    Returns
    -------
    ImportedSubsystem

    Raises
    ------
    InputError
        If a hardpoint is missing, or the data are not valid; with all problems.
    """
    with Validator("imported") as arguments:
        arguments.instance("subsystem", subsystem, Subsystem, "a result of read is needed")
        if side is not None:
            arguments.among("side", side, SIDES)
        given = arguments.mapping("names", names or {}, "hardpoints and their names there")
    rest = rest_of(subsystem, kind, base, given)
    wanted: Side = side or ("left" if rest.packaged else rest.suspension.vehicle.side)
    read = matched(subsystem.points, rest.kind, given, subsystem.source)
    points = _points(subsystem, read, wanted, rest.kind, whole=rest.packaged)
    angles = _angles(subsystem, wanted)
    document: Any = tomlkit.parse(rest.text)
    old = to_side(document, rest.suspension, wanted)
    spring, unread = _spring(subsystem, rest, wanted)
    moved = move_along(document, old, points) if rest.packaged else []
    put_points(document, points, "mm")
    for key, angle in angles.items():
        put(document, ("wheel", key), angle)
    if spring:
        put_spring(document, spring)
    new = Suspension.from_dict(document.unwrap(), source=subsystem.source)
    changed = None if rest.packaged else differences(rest.suspension, new)
    text = fresh(tomlkit.dumps(document), new, changed)
    kept = tuple(name for name in new.hardpoints.given() if name not in read)
    assumed = (
        *_assumed(new, kept, angles, spring, rest.title),
        *assumed_of(rest.kind),
        *moved,
    )
    return ImportedSubsystem(
        text=_with_head(text, _head(subsystem, rest.title, assumed)),
        read=read,
        kept=kept,
        left_out=(*_left_out(subsystem, read), *unread, *subsystem.others),
        kind=rest.kind,
        side=wanted,
        angles=angles,
        spring=spring,
        assumed=assumed,
    )


def _spring(
    subsystem: Subsystem, rest: TemplateFile, side: Side
) -> tuple[AdamsSpring | None, list[str]]:
    """Return the spring, and descriptions of springs that are left out.

    A file of the user has a spring of its own.
    """
    found, unread = spring_of(subsystem, side)
    if found is None:
        return None, unread
    if not rest.packaged:
        return None, [f"{found.words()}: the {rest.title} has its own", *unread]
    force = force_at_design(tomlkit.parse(rest.text)) if found.force is None else found.force
    if not found.reaches(force):
        problem = f"its curve does not reach the force at design, {force:g} N"
        return None, [f"{found.words()}: {problem}", *unread]
    return found, unread


def _angles(subsystem: Subsystem, side: Side) -> dict[str, float]:
    """Return camber and toe of a side [deg]; refuse angles of another side alone."""
    found = {key: subsystem.angle(name, side) for name, key in ANGLES.items()}
    problems = [
        _other_side(name, subsystem.angles[name], side)
        for name, key in ANGLES.items()
        if found[key] is None and name in subsystem.angles
    ]
    if problems:
        raise InputError(problems, subsystem.source)
    return {key: angle for key, angle in found.items() if angle is not None}


def _other_side(name: str, rows: Iterable[str], side: Side) -> str:
    return (
        f"{shown(name)} is given as {' and '.join(rows)}; a row for the {side} side is needed, or "
        "one for left/right."
    )


def _points(
    subsystem: Subsystem, read: Mapping[str, str], side: Side, kind: str, *, whole: bool
) -> dict[str, Point]:
    """Return the hardpoints of a side [mm]; refuse missing ones, and a wheel on the other side."""
    found = {ours: subsystem.side(theirs, side) for ours, theirs in read.items()}
    problems = [
        _other_side(read[ours], subsystem.points[read[ours]], side)
        for ours, point in found.items()
        if point is None
    ]
    missing = [name for name in points_of(kind).names() if name not in found]
    if missing and whole:
        problems.append(
            f"hardpoints of a {KINDS[kind].TITLE} are missing: {', '.join(missing)}. Give "
            f"their names (--name {missing[0]}=NAME), or a file with them (--from FILE). "
            f"The subsystem has: {listed(subsystem.points)}."
        )
    if not found:
        problems.append(f"no hardpoint of it is one of {', '.join(known(kind))}.")
    points = {ours: point for ours, point in found.items() if point is not None}
    center = points.get("wheel_center")
    if center is not None and center[1] * (1.0 if side == "left" else -1.0) <= 0.0:
        problems.append(
            f"wheel_center of the {side} side is {abs(center[1]):g} mm on the other side of the "
            "car. In Adams/Car y points to the right, and rows for left/right are of the left "
            "side, with negative y. Correct the signs of the file."
        )
    if problems:
        raise InputError(problems, subsystem.source)
    return points


def _assumed(
    new: Suspension,
    kept: Iterable[str],
    angles: Mapping[str, float],
    spring: AdamsSpring | None,
    rest: str,
) -> list[str]:
    """Return the assumptions about data that the subsystem does not have."""
    lines = [
        "axes: x rearward, y to the right, z up, as is usual in Adams/Car",
        f"{'' if spring else 'spring, '}damper, masses, tyre, rack and vehicle: as in the {rest}",
        *([f"force of the spring: as in the {rest}"] if spring and spring.force is None else []),
        *([SMOOTH] if spring and spring.curve else []),
        *(f"{name}: as in the {rest}" for name in kept),
    ]
    lines += [
        f"{key.removesuffix('_deg')}: {getattr(new.wheel, key):g} deg, as in the {rest}"
        for key in ANGLES.values()
        if key not in angles
    ]
    return lines + ground(new)


def _left_out(subsystem: Subsystem, read: Mapping[str, str]) -> list[str]:
    return [
        f"hardpoint {shown(name)} ({side}): {', '.join(f'{value:.10g}' for value in point)} mm"
        for name, rows in subsystem.points.items()
        if name not in read.values()
        for side, point in rows.items()
    ]


def _head(subsystem: Subsystem, rest: str, assumed: Iterable[str]) -> list[str]:
    """Return the first comment of the new file."""
    template = f" (template {subsystem.template})" if subsystem.template else ""
    return [
        f"Hardpoints from {Path(subsystem.source).name}, a subsystem of Adams/Car{template}.",
        f"What follows is the {rest} with these hardpoints. Assumed:",
        *(f"  {text}" for text in assumed),
    ]


def _with_head(text: str, head: list[str]) -> str:
    """Return a file with a comment at its begin, after a line for editors."""
    first, end, rest = text.partition("\n")
    comment = "".join(f"# {legible(line)}\n" for line in head)
    comment += "#\n" if text.startswith("#") else "\n"
    return f"{first}{end}{comment}{rest}" if first.startswith(_SCHEMA) else comment + text
