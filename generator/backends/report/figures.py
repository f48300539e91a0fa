"""Three figures of any mechanism, after the paper's Figures 1 to 3, from its declaration alone.

Its bodies and joints in space, its graph of physical and of elementary joints, and its kinematic
transformers with the relative coordinates as wires.
"""

from __future__ import annotations

from itertools import combinations, pairwise
from textwrap import fill
from typing import TYPE_CHECKING, Any

import matplotlib as mpl

mpl.use("Agg")
import networkx as nx
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from ....core.files import replacing
from ...declare.geometry import Point
from ...declare.joints import Cylindrical, Prismatic, Revolute
from .document import FIGURES

if TYPE_CHECKING:
    from pathlib import Path

    from matplotlib.axes import Axes

    from ...declare.joints import Joint
    from ...declare.mechanism import Mechanism
    from ...loops.planner import Plan, Transformer

INK, GREY, PALE = "#222222", "#8a8a8a", "#d9d9d9"
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#7b5ea7", "#56a0d3", "#a6761d")
HELD = "\N{NO-BREAK SPACE}"
ELEMENTS = {
    "revolute": "R", "prismatic": "P", "cylindrical": "PR", "universal": "RR", "spherical": "RRR",
    "free": "PPPRRR",
}  # fmt: skip
"""The elementary joints that a joint is equivalent to: guides (P) and hinges (R), in a row."""


def draw_figures(plan: Plan, folder: Path, *, force: bool = False) -> list[Path]:
    """Write the three figures of a plan, two if it has no loop; return their paths.

    The folder is made if missing; `force` is whether files that kintrafo did not write are
    replaced, see `kintrafo.core.files`.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    drawers = {"bodies": bodies, "graph": graph, "transformers": transformers}
    for name, drawn in drawers.items():
        if name == "transformers" and not plan.transformers:
            continue
        path = folder / f"{plan.formulation.name}_{name}.svg"
        figure = drawn(plan)
        figure.suptitle(plan.formulation.mechanism.title, fontsize=14)
        with mpl.rc_context({"svg.hashsalt": "kintrafo", "svg.fonttype": "none"}):
            for target in (path, path.with_suffix(".png")):
                facts: dict[str, Any] = {"Date": None} if target.suffix == ".svg" else {}
                with replacing(target, force=force) as temporary:
                    figure.savefig(temporary, dpi=160, metadata=facts)
                written.append(target)
    return written


def print_figures(plan: Plan, text: Path, *, force: bool = False) -> dict[str, str]:
    """Write the figures of a plan for a printed text; return their files' names.

    They are PDF, without titles, since the text has captions, beside the file `text` and under its
    name. `force` is as in `draw_figures`.
    """
    drawn = [bodies(plan), graph(plan, (False,)), graph(plan, (True,))]
    if plan.transformers:
        drawn.append(transformers(plan, numbered=True))
    names = {name: f"{text.stem}_{name}.pdf" for name in FIGURES[: len(drawn)]}
    facts = {"CreationDate": None, "Producer": None, "Creator": None}
    for name, figure in zip(names.values(), drawn, strict=True):
        with replacing(text.with_name(name), force=force) as temporary:
            figure.savefig(temporary, metadata=facts)
    return names


def _axes(figure: Figure, *place: int) -> Axes:
    axes = figure.add_subplot(*place)
    axes.set_axis_off()
    return axes


# -- Figure 1 -------------------------------------------------------------------------------------


def bodies(plan: Plan) -> Figure:
    """Draw bodies with their numbers, and joints with their names, at the design position."""
    mechanism = plan.formulation.mechanism
    values = {p.symbol: p.default for p in mechanism.parameters}
    values |= {name: value.subs(values) for name, value in mechanism.derived.items()}
    named = {str(symbol): value for symbol, value in values.items()}

    def place(point: Point) -> np.ndarray[Any, Any]:
        return np.array([float(c.subs(named)) for c in point.position])

    ends = {j.name: [place(p) for p in _points(j)] for j in mechanism.joints}
    view = _view(np.array([p for points in ends.values() for p in points]))
    held = _held(mechanism, {n: [view @ p for p in ps] for n, ps in ends.items()})
    size = float(np.ptp(np.array([p for points in held.values() for p in points]), axis=0).max())
    for joint in mechanism.joints:
        if isinstance(joint, Prismatic) and mechanism.ground in joint.bodies:
            along = np.array([float(c.subs(named)) for c in joint.direction.components])
            body = joint.other(mechanism.ground)
            shift = 0.12 * size * (view @ along)
            held[body] += [p + sign * shift for p in held[body][:1] for sign in (1, -1)]
    span = np.ptp(np.array([p for points in held.values() for p in points]), axis=0)
    tall = float(np.clip(span[1] / span[0], 0.4, 1.0)) if span[0] > 0 else 1.0
    figure = Figure(figsize=(6.2, 5.4 * tall + 1.0), layout="constrained")
    axes = _axes(figure)
    axes.set_aspect("equal")
    marks, obstacles = [], []
    for (body, number), colour in zip(
        mechanism.numbers.items(), (INK, *COLOURS * len(held)), strict=False
    ):
        points = np.array(held[body])
        if not len(points):
            continue
        at_rest = body == mechanism.ground
        center = points.mean(axis=0)
        marks.append((str(number), colour, center))
        for point in np.unique(points.round(9), axis=0):
            style = ":" if at_rest else "-"
            axes.plot(*zip(center, point, strict=True), style, color=colour, lw=1 if at_rest else 3)
            obstacles += [center + share * (point - center) for share in np.linspace(0.1, 1.0, 10)]
    letters = [(text, view @ point) for text, point in _letters(mechanism.joints, ends)]
    spots = [at for _, at in letters]
    for text, colour, center in marks:
        crowded = min(float(np.hypot(*(center - spot))) for spot in spots) < 0.04 * size
        at = _free(center, [*spots, *obstacles], 0.07 * size) if crowded else center
        axes.plot(*zip(center, at, strict=True), color=colour, lw=1)
        box = {"boxstyle": "circle,pad=0.25", "facecolor": colour, "edgecolor": "white"}
        axes.text(
            at[0], at[1], text, ha="center", va="center", size=12, color="white", zorder=5, bbox=box
        )
        spots += [at, *_around(at, 0.035 * size)]
    short = all(len(text) <= 5 for text, _ in letters)
    legend = []
    for place_of, (text, seen) in zip("abcdefghijklmnopqrstuvwxyz", letters, strict=False):
        words = text if short else place_of
        at = _free(seen, [*spots, *obstacles], 0.05 * size, 0.015 * size * (len(words) - 1))
        spots += [at, *_around(at, 0.02 * size)]
        axes.plot(*seen, "o", ms=6, mfc="white", mec=INK, zorder=4)
        axes.text(at[0], at[1], words, ha="center", va="center", size=13, zorder=6)
        legend += [] if short else [f"{place_of}{HELD}{text.replace('_', HELD)}"]
    names = ", ".join(f"{n}{HELD}{b.replace('_', HELD)}" for b, n in mechanism.numbers.items())
    lines = [_filled(names), *([_filled("; ".join(legend))] if legend else [])]
    figure.supxlabel("\n".join(lines), fontsize=10)
    axes.margins(0.08)
    return figure


def _filled(text: str) -> str:
    return fill(text, 70).replace(HELD, " ")


def _held(mechanism: Mechanism, ends: dict[str, list[Any]]) -> dict[str, list[Any]]:
    """Return the points that each body is drawn between: joints, and middles of telescopes."""
    held: dict[str, list[Any]] = {body: [] for body in mechanism.numbers}
    for joint in mechanism.joints:
        if not isinstance(joint, Cylindrical):
            for body in joint.bodies:
                held[body] += ends[joint.name]
    for joint in mechanism.joints:
        pair = [held[body] for body in joint.bodies]
        if isinstance(joint, Cylindrical):
            middle = sum(ends[joint.name]) / 2
        elif isinstance(joint, Prismatic) and mechanism.ground not in joint.bodies and all(pair):
            middle = (pair[0][0] + pair[1][0]) / 2
        else:
            continue
        for points in pair:
            points.append(middle)
    return held


def _around(at: Any, radius: float) -> list[Any]:
    """Return positions around a point."""
    angles = np.arange(16) * np.pi / 8
    return [at + radius * np.array([np.cos(a), np.sin(a)]) for a in angles]


def _free(at: Any, others: list[Any], radius: float, half_width: float = 0.0) -> Any:
    """Return the position around a point where a text of a width is farthest from all others."""
    along = [np.array([half_width * share, 0.0]) for share in (-1.0, 0.0, 1.0)]

    def distance(place: Any) -> float:
        gaps = [np.hypot(*(place + part - other)) for part in along for other in others]
        return round(float(min(gaps)), 9)

    return max(_around(at, radius), key=distance)


def _points(joint: Joint) -> list[Point]:
    """Return the hardpoints of a joint, none for a guide."""
    if joint.center is not None:
        return [joint.center]
    if isinstance(joint, Revolute | Cylindrical):
        return [p for p in (joint.axis.through, joint.axis.towards) if isinstance(p, Point)]
    return []


def _letters(joints: tuple[Joint, ...], ends: dict[str, Any]) -> list[tuple[str, Any]]:
    """Return the labels with their positions; a name of two letters is one for each end."""
    taken: dict[tuple[float, ...], list[str]] = {}
    for joint in joints:
        points = ends[joint.name]
        names = list(joint.name) if len(joint.name) == len(points) == 2 else [joint.name]
        for name, point in zip(names, points, strict=False):
            words = taken.setdefault(tuple(point.round(9)), [])
            if name not in words:
                words.append(name)
    return [(", ".join(words), np.array(point)) for point, words in taken.items()]


def _view(points: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Return the projection: along the normal of a plane mechanism, else from the front above."""
    for axis in (1, 2, 0):
        if np.ptp(points[:, axis]) < 1e-9:
            return np.delete(np.eye(3), axis, axis=0)
    turn, tilt = np.radians(35.0), np.radians(18.0)
    c, s = np.cos(turn), np.sin(turn)
    up = np.array([-np.sin(tilt) * c, np.sin(tilt) * s, np.cos(tilt)])
    return np.array([[-s, -c, 0.0], up])


# -- Figure 2 -------------------------------------------------------------------------------------


_SHOWN = {
    False: "physical joints\non each joint its number of degrees of freedom",
    True: "elementary joints\n"
    "R hinges, P guides; between those of one joint, white, its fictitious bodies",
}


def graph(plan: Plan, shown: tuple[bool, ...] = (False, True)) -> Figure:
    """Draw the joint graph (False), that of the elementary joints (True), or both."""
    alone = min(2.0 + 0.5 * len(plan.formulation.mechanism.numbers), 7.5)
    side = alone if len(shown) == 1 else 7.2
    figure = Figure(figsize=(1.04 * side * len(shown), side), layout="constrained")
    places = _layout(plan)
    for index, elementary in enumerate(shown, 1):
        axes = _axes(figure, 1, len(shown), index)
        for joint in plan.formulation.mechanism.joints:
            _edge(axes, joint, *(places[b] for b in joint.bodies), elementary=elementary)
        for body, number in plan.formulation.mechanism.numbers.items():
            words = body.replace("_", "\n")
            _node(axes, places[body], f"{number} {words}", PALE, "round,pad=0.4", 11)
        if len(shown) > 1:
            axes.set_title(_SHOWN[elementary], fontsize=12)
        axes.margins(0.1)
    return figure


def _layout(plan: Plan) -> dict[str, Any]:
    """Return positions without crossings where possible, evenly spread."""
    joints = plan.topology.graph
    layouts: list[dict[str, Any]] = [nx.kamada_kawai_layout(joints, weight=None)]
    for seed in range(6):  # other starts lead to other layouts, some of them without crossings
        start = nx.random_layout(joints, seed=seed)
        layouts.append(nx.kamada_kawai_layout(joints, pos=start, weight=None))
        layouts.append(nx.spring_layout(joints, seed=seed, iterations=100))
    if nx.check_planarity(joints)[0]:
        layouts.append(nx.planar_layout(joints))
    return min(layouts, key=lambda at: 0.1 * _crossings(joints, at) - _nearest(joints, at))


def _nearest(joints: nx.Graph, places: dict[str, Any]) -> float:
    """Return the least distance between labels: at bodies, and halfway between them."""
    at = [*places.values(), *((places[a] + places[b]) / 2 for a, b in joints.edges)]
    return round(min(float(np.hypot(*(p - q))) for p, q in combinations(at, 2)), 3)


def _crossings(joints: nx.Graph, places: dict[str, Any]) -> int:
    """Return the number of pairs of straight edges that cross each other."""

    def side(a: Any, b: Any, c: Any) -> bool:
        return bool((b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]))

    pairs = (pair for pair in combinations(joints.edges, 2) if not {*pair[0]} & {*pair[1]})
    ends = ([places[body] for edge in pair for body in edge] for pair in pairs)
    return sum(
        side(a, b, c) != side(a, b, d) and side(c, d, a) != side(c, d, b) for a, b, c, d in ends
    )


def _edge(axes: Axes, joint: Joint, start: Any, end: Any, *, elementary: bool) -> None:
    """Draw a joint between two bodies: as one, or as a row of elementary ones."""
    start, end = np.array(start), np.array(end)
    axes.plot(*zip(start, end, strict=True), color=GREY, lw=1.2, zorder=1)
    if not elementary:
        words = _wrapped(f"{joint.name}: {joint.freedoms}")
        _node(axes, (start + end) / 2, words, "white", "round", 10)
        return
    letters = ELEMENTS[joint.kind]
    shares = np.linspace(0.0, 1.0, 2 * len(letters) + 1)[1:-1]
    shares = 0.5 + (shares - 0.5) * (0.8 if len(letters) > 1 else 1.0)
    for place, share in enumerate(shares):
        at = start + share * (end - start)
        if place % 2:
            axes.plot(*at, marker="D", ms=6, mfc="white", mec=INK, zorder=3)
        else:
            _node(axes, at, letters[place // 2], "white", "circle,pad=0.15", 8)
    across = np.array([end[1] - start[1], start[0] - end[0]])
    across = across / max(float(np.hypot(*across)), 1e-9)
    axes.annotate(
        _wrapped(joint.name),
        (start + end) / 2,
        (13 * across[0], (13 + 6 * _wrapped(joint.name).count("\n")) * across[1]),
        textcoords="offset points",
        ha="left" if across[0] > 0.5 else "right" if across[0] < -0.5 else "center",
        va="center",
        fontsize=11,
        color=COLOURS[0],
    )


def _wrapped(name: str) -> str:
    """Return a long name in several lines; a joint's number stays behind it."""
    return fill(name.replace(": ", f":{HELD}").replace("_", " "), 12).replace(HELD, " ")


def _node(axes: Axes, at: Any, text: str, colour: str, shape: str, size: int) -> None:
    box = {"boxstyle": shape, "facecolor": colour, "edgecolor": INK}
    axes.annotate(
        text, at, ha="center", va="center", fontsize=size, bbox=box, zorder=4, linespacing=0.95
    )


# -- Figure 3 -------------------------------------------------------------------------------------

WIDE, PITCH = 3.4, 0.5


class _Wires:
    """Names of coordinates at the two ends of a wire, as the mechanism reports them."""

    def __init__(self, plan: Plan, *, numbered: bool = False) -> None:
        self.names: dict[str, list[str]] = {}
        for number, c in enumerate(plan.formulation.mechanism.coordinates, 1):
            name = f"beta{number}" if numbered else c.name
            self.names.setdefault(f"{c.joint.name}.{c.kind}", []).append(name)

    def leaving(self, wire: str) -> str | None:
        """Return the name of a coordinate at the block that solves it."""
        return _sign(self.names[wire][0]) if wire in self.names else None

    def entering(self, wire: str) -> str | None:
        """Return the names of its copies, at the blocks that read them."""
        found = self.names.get(wire, [])[1:]
        return ", ".join(map(_sign, found)) or None


def _sign(name: str) -> str:
    """Return a name as drawn in a figure: betaN with its Greek letter."""
    number = name.removeprefix("beta")
    return f"$\\beta_{{{number}}}$" if number != name and number.isdigit() else name


def _plain(name: str) -> str:
    """Return a name of the width of the drawn one: betaN is a letter with its number."""
    return name.removeprefix("beta") + "b" if name.removeprefix("beta").isdigit() else name


def _columns(plan: Plan) -> list[int]:
    """Return the number of blocks in a row before each transformer."""
    found: dict[str, int] = {}
    columns = []
    for t in plan.transformers:
        columns.append(max((found.get(wire, -1) + 1 for wire in t.inputs), default=0))
        found |= dict.fromkeys(t.outputs, columns[-1])
    return columns


def transformers(plan: Plan, *, numbered: bool = False) -> Figure:
    """Draw the transformers as blocks, and the relative coordinates as the wires between them.

    `numbered` is whether coordinates have the numbers of the report, instead of their names.
    """
    wires, blocks = _Wires(plan, numbered=numbered), plan.transformers
    heights = [max(len(t.inputs), len(_shown(t, wires)) + 1, 3) * PITCH for t in blocks]
    tops = np.concatenate([[0.0], -np.cumsum(np.array(heights) + PITCH)])
    columns = _columns(plan)
    many = max(sum(len(t.inputs) for t, c in zip(blocks, columns, strict=True) if c == column)
               for column in columns)  # fmt: skip
    longest = max(len(_plain(n[0])) for n in wires.names.values())
    gap = max(3.0, 1.6 + 0.34 * longest + 0.22 * many)
    lefts = [column * (WIDE + gap) for column in columns]
    wide = max(columns) + 1
    figure = Figure(
        figsize=(0.8 * (WIDE + gap) * wide, 1.2 + 0.8 * -tops[-1]), layout="constrained"
    )
    axes = _axes(figure)
    sources: dict[str, tuple[float, float]] = {}
    used: set[str] = set()
    channels = dict.fromkeys(columns, 0)
    for t, column, left, top, height in zip(blocks, columns, lefts, tops, heights, strict=False):
        axes.add_patch(Rectangle((left, top - height), WIDE, height, fc=PALE, ec=INK, lw=1.5))
        numbers = "-".join(str(plan.formulation.mechanism.numbers[b]) for b in t.cycle.bodies)
        words = f"transformer {t.number}\nbodies {numbers}"
        axes.text(left + WIDE / 2, top - height / 2, words, ha="center", va="center", fontsize=12)
        for place, wire in enumerate(t.inputs):
            y = top - (place + 0.5) * height / max(len(t.inputs), 1)
            room = max(0.9, 0.17 * max(len(wires.entering(w) or "") for w in t.inputs))
            channel = left - room - 0.22 * channels[column]
            channels[column] += wire in sources
            _enter(axes, sources, wires, wire, (channel, left, y))
            used.add(wire)
        shown = _shown(t, wires)
        for place, wire in enumerate(shown):
            y = top - (place + 0.5) * height / (len(shown) + 1)
            sources[wire] = (left + WIDE, y)
            _arrow(axes, (left + WIDE, y), (left + WIDE + 0.5, y))
            axes.text(
                left + WIDE + 0.08, y + 0.05, wires.leaving(wire) or "", fontsize=13, va="bottom"
            )
        rest = [w for w in t.outputs if w not in shown]
        if rest:
            words = "also " + ",\n".join(rest)
            axes.text(
                left + WIDE / 2,
                top - height - 0.06,
                words,
                va="top",
                ha="center",
                fontsize=8,
                color=GREY,
            )
    _others(axes, wires, {*sources, *used}, tops[-1])
    axes.set_xlim(-gap / 2, max(lefts) + WIDE + gap / 2)
    axes.set_ylim(tops[-1] - 0.8, 0.2)
    return figure


def _shown(transformer: Transformer, wires: _Wires) -> list[str]:
    """Return the coordinates that a transformer solves and the mechanism reports."""
    return [wire for wire in transformer.outputs if wire in wires.names]


def _enter(
    axes: Axes,
    sources: dict[str, tuple[float, float]],
    wires: _Wires,
    wire: str,
    place: tuple[float, float, float],
) -> None:
    """Draw a wire into a block: from the block that solves it, or from outside."""
    channel, left, y = place
    name = wires.entering(wire)
    if wire in sources:
        x0, y0 = sources[wire]
        corners = [(x0 + 0.5, y0), (channel, y0), (channel, y), (left - 0.1, y)]
        for one, other in pairwise(corners):
            axes.plot(*zip(one, other, strict=True), color=INK, lw=1.1)
    elif wire in wires.names:
        name = wires.leaving(wire)
    if wire not in wires.names:
        name = wire
    _arrow(axes, (left - 0.8 if wire not in sources else left - 0.3, y), (left, y))
    if name:
        axes.text(left - 0.1, y + 0.05, name, fontsize=13, ha="right", va="bottom")


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float]) -> None:
    style = {"arrowstyle": "-|>", "color": INK, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", end, start, arrowprops=style)


def _others(axes: Axes, wires: _Wires, drawn: set[str], bottom: float) -> None:
    """Write the coordinates that no block solves or reads: they are inputs of the bodies alone."""
    rest = [_sign(names[0]) for wire, names in wires.names.items() if wire not in drawn]
    if rest:
        words = f"through no transformer: {', '.join(rest)}"
        axes.text(0.0, bottom - 0.1, words, va="top", fontsize=12)
