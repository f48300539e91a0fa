"""The derivation report: loops, choices and solutions, with operation counts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ...declare.world import WORLD
from ...program.floors import ROUNDING
from ..counting import OPERATIONS, operations_of
from ..text import formula
from ..words import FORMULA, iteration_note
from .document import Heading, Paragraph, Picture, TextTable, Transformation
from .motion import EquationNumbers, inline, motion_sections

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...declare.mechanism import Mechanism
    from ...equations.outputs import Derivation
    from ...loops.graph import Cycle, JointGraph
    from ...loops.planner import Transformer
    from .document import Block


def bodies_of(topology: JointGraph, cycle: Cycle) -> str:
    """Return a cycle as the numbers and names of its bodies."""
    return " - ".join(_numbered(topology.mechanism, body) for body in cycle.bodies)


def _numbered(mechanism: Mechanism, body: str) -> str:
    """Return the number and the name of a body; the world has no number."""
    return body if body == WORLD.name else f"{mechanism.numbers[body]} {body}"


def joint_rows(topology: JointGraph) -> list[tuple[str, ...]]:
    """Return the rows of the joint table (Table 1)."""
    mechanism = topology.mechanism
    return [
        (
            j.name,
            j.kind,
            *(_numbered(mechanism, body) for body in j.bodies),
            str(j.freedoms),
            j.shared,
        )
        for j in mechanism.joints
    ]


def path_rows(topology: JointGraph) -> list[tuple[str, ...]]:
    """Return the rows of the table of shortest paths (Table 2), ties included."""
    numbers = topology.mechanism.numbers.values()
    return [
        (f"**{number}**", *(" or ".join(paths) for paths in row))
        for number, row in zip(numbers, topology.path_table(), strict=True)
    ]


def mobility_line(topology: JointGraph) -> str:
    """Return Eq. 1 with the numbers of the mechanism."""
    moving = len(topology.mechanism.moving)
    closed = [str(6 - j.freedoms) for j in topology.mechanism.joints]
    planar = topology.planar_loop_count
    extra = f" + 3 x {planar} planar loops" if planar else ""
    central = topology.central_loop_count
    extra += f" + 3 x {central} loops about a point" if central else ""
    redundant = topology.redundant
    extra += f" + {redundant} for parallel links" if redundant else ""
    gears = len(topology.mechanism.geared)
    extra += f" - {gears} gear{'s' if gears > 1 else ''}" if gears else ""
    return f"f = 6 x {moving} - ({' + '.join(closed)}){extra} = {topology.mobility}"


def cycles_line(topology: JointGraph) -> str:
    """Return a sentence on the candidates of Horton's construction, and the cycles among them."""
    bodies, joints = len(topology.mechanism.bodies), len(topology.mechanism.joints)
    return (
        "Horton's construction closes a path over each joint from each body that the joint does "
        f"not touch: {joints} x ({bodies} - 2) = {topology.pair_count} candidates. A candidate "
        "whose shortest paths to the two ends share a body is not a cycle; "
        f"{topology.closing_pairs} candidates are cycles. Where several paths are equally short, "
        "a candidate counts once for each of them, which makes "
        f"{len(topology.horton_candidates())} simple cycles with repetitions; "
        f"{len(topology.candidate_cycles)} of them are distinct:"
    )


def _cut(transformer: Transformer) -> str:
    """Return the pair at which a loop is cut, in words."""
    if transformer.pair is None:
        return "none: solved together with others, in the unknowns of all"
    a, b = transformer.pair.joints
    return (
        f"{a.name} ({a.kind}) and {b.name} ({b.kind}): "
        f"{transformer.pair.eliminated} of {transformer.unknowns} unknowns eliminated, "
        f"{transformer.pair.equations} equation left"
    )


def transformation(topology: JointGraph, transformer: Transformer) -> Transformation:
    """Return a transformer as a block with its inputs and outputs."""
    closure, solution = transformer.step.words(transformer.closing)
    cycle = transformer.cycle
    inside = {
        "loop": f"{bodies_of(topology, cycle)} (length {cycle.length})",
        "pair": _cut(transformer),
        "equation": closure,
        "solution": solution,
    }
    return Transformation(transformer.number, transformer.inputs, inside, transformer.outputs)


def mermaid(topology: JointGraph) -> str:
    """Return the joint graph as a Mermaid diagram, which forges draw as a picture."""
    numbers = topology.mechanism.numbers
    bodies = [f'    {body}(["{number} {body}"])' for body, number in numbers.items()]
    joints = [
        f'    {j.first.name} ---|"{j.name}: {j.kind}, {j.freedoms}"| {j.second.name}'
        for j in topology.mechanism.joints
    ]
    return "\n".join(["graph LR", *bodies, *joints])


def preference(topology: JointGraph, transformer: Transformer) -> str:
    """Return the reason why a loop was taken before others of the same length."""
    if not transformer.rivals:
        return "It is the only shortest cycle that extends the basis."
    others = "; ".join(
        f"{bodies_of(topology, cycle)} would leave {unknowns}"
        for cycle, unknowns in transformer.rivals
    )
    if transformer.unknowns == min(unknowns for _, unknowns in transformer.rivals):
        return (
            f"No cycle of the same length has fewer than {transformer.unknowns} unknown relative "
            f"coordinates at this point; of those with as many it is the first by the numbers of "
            f"its bodies: {others}."
        )
    return (
        f"Preferred over cycles of the same length because only {transformer.unknowns} of its "
        f"relative coordinates are unknown at this point: {others}."
    )


def derivation_report(derivation: Derivation) -> list[Block]:
    """Return the whole report."""
    topology = derivation.plan.topology
    note, number = iteration_note(derivation), EquationNumbers()
    return [
        Heading(1, derivation.formulation.title),
        Paragraph(_summary(derivation)),
        *([Paragraph(note)] if note else []),
        *_structure(topology),
        Heading(2, "Kinematic transformers"),
        *_transformers(derivation, number),
        *motion_sections(derivation, number),
        Heading(2, "Functions"),
        Paragraph("The compiled functions, and the arithmetic of one call of each:"),
        _counts(derivation),
        Paragraph("A leading sign counts as an addition; guards are comparisons and do not count."),
        *_validity(derivation),
    ]


def _summary(derivation: Derivation) -> str:
    """Return the summary of the chapter, in its order."""
    topology, mechanism = derivation.plan.topology, derivation.formulation.mechanism
    loops, freedoms = topology.loop_count, topology.mobility
    closed = "" if iteration_note(derivation) else " in closed form"
    way = (
        "Its loops are closed one after the other by kinematic transformers, each of which is "
        f"solved{closed}. The relative coordinates that result give"
        if loops
        else "Its relative coordinates, which are not constrained by a loop, give"
    )
    return (
        f"This chapter derives the equations of motion of a mechanism of {len(mechanism.moving)} "
        f"moving bodies with {_counted(loops, 'kinematic loop')} and "
        f"{_counted(freedoms, 'degree')} of freedom. {way} "
        "position and velocity of every body. The equations of motion are the projection of the "
        "Newton-Euler equations of all bodies onto the independent coordinates. The method is that "
        "of J. A. M. Góis and C. A. P. Sarzeto (Instituto Militar de Engenharia, Rio de Janeiro, "
        '2000); after the word "paper" are numbers of its equations, sections and figures.'
    )


def _counted(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"


def _structure(topology: JointGraph) -> list[Block]:
    """Return bodies and joints, mobility, paths and cycles."""
    mechanism = topology.mechanism
    return [
        Heading(2, "Bodies and joints"),
        Picture("bodies", "Bodies with their numbers, and joints, at the design position."),
        TextTable(
            ("joint", "type", "first body", "second body", "degrees of freedom", "in common"),
            joint_rows(topology),
        ),
        Paragraph(f"Mobility (Grübler; paper: Eq. 1): {mobility_line(topology)}."),
        Paragraph(
            f"Independent loops: {len(mechanism.joints)} - "
            f"({len(mechanism.bodies)} - 1) = {topology.loop_count}."
        ),
        Picture(
            "graph",
            "Joint graph: bodies, joints, and on each joint its number of degrees of freedom.",
            mermaid(topology),
        ),
        Picture(
            "elementary",
            "The same with elementary joints: hinges (R) and guides (P), and between those of one "
            "joint, white, its fictitious bodies.",
        ),
        Heading(2, "Shortest paths in the joint graph"),
        Paragraph(
            "The length of an edge is the number of degrees of freedom of its joint. Where "
            "several paths are equally short, all are listed."
        ),
        TextTable(("", *map(str, mechanism.numbers.values())), path_rows(topology)),
        Heading(2, "Cycles"),
        *_cycles(topology),
    ]


def _cycles(topology: JointGraph) -> list[Block]:
    if not topology.candidate_cycles:
        return [Paragraph("The joint graph is a tree, without a cycle.")]
    return [
        Paragraph(cycles_line(topology)),
        TextTable(
            ("bodies", "length"),
            [(bodies_of(topology, c), str(c.length)) for c in topology.candidate_cycles],
        ),
    ]


def _transformers(derivation: Derivation, number: EquationNumbers) -> Iterator[Block]:
    topology = derivation.plan.topology
    if not derivation.plan.transformers:
        yield Paragraph("The mechanism has no loop to close.")
        return
    together = (
        " Of loops that are solved by iteration, the remaining equations are solved together."
        if iteration_note(derivation)
        else ""
    )
    yield Paragraph(
        "A loop is cut at a pair of joints whose points keep a known distance. This leaves one "
        "equation with one unknown, of the six equations of a loop in space or the three of a loop "
        f"in a plane.{together} A table lists the pairs of each loop. The inputs of a transformer "
        "are known from the transformers before it."
    )
    yield Picture("transformers", "Kinematic transformers, and the coordinates between them.")
    yield from _turns(derivation, number)
    for transformer in derivation.plan.transformers:
        pairs = [
            (
                f"{p.joints[0].name}, {p.joints[1].name}",
                str(p.eliminated),
                str(p.equations),
                "chosen" if p == transformer.pair else "",
            )
            for p in transformer.candidates
        ]
        yield Heading(3, f"Transformer {transformer.number}")
        yield transformation(topology, transformer)
        yield Paragraph(preference(topology, transformer))
        yield TextTable(
            ("pair with a common distance", "unknowns eliminated", "equations left", ""), pairs
        )


def _turns(derivation: Derivation, number: EquationNumbers) -> Iterator[Block]:
    """Yield the solution of the equation of an unknown angle, where a loop has it."""
    steps = ((t.step, t.closing) for t in derivation.plan.transformers)
    if not any(step.words(closing)[1].startswith("a cos x") for step, closing in steps):
        return
    yield Paragraph(
        "Where the unknown is an angle x, the distance gives an equation whose coefficients follow "
        "from known quantities:"
    )
    yield number(r"a\cos x + b\sin x = c")
    yield number(
        r"\cos x = \frac{a\,c - s\,b\,w}{a^2+b^2}, \qquad "
        r"\sin x = \frac{b\,c + s\,a\,w}{a^2+b^2}, \qquad w = \sqrt{a^2+b^2-c^2}"
    )
    yield Paragraph(
        f"Its two solutions, {inline('s = 1')} and {inline('s = -1')}, are the two assembly modes "
        "of the loop. The sign is constant, that of the design position: the motion ends at the "
        f"dead point {inline('w = 0')}, where both solutions meet. Poses need only the cosine and "
        "the sine; an angle is computed only if it is reported."
    )


def _validity(derivation: Derivation) -> Iterator[Block]:
    """Yield the limits of the formulas, and the conditions on parameters."""
    yield Heading(2, "Validity")
    yield Paragraph(
        "A status bit of each function reports a quantity that is at or below its floor:"
    )
    yield TextTable(
        ("quantity", "floor", "unit", "meaning at or below the floor"),
        [
            (f"`{g.name}`", f"`{formula(g.floor, FORMULA)}`", g.unit, g.meaning)
            for g in derivation.guards
        ],
    )
    if derivation.assumptions:
        yield Paragraph(
            "Parameters are refused if one of these is not zero (the sine of an angle, or a "
            f"distance relative to a length, to {ROUNDING}):"
        )
        yield TextTable(
            ("quantity", "unit", "meaning when it is not zero"),
            [(f"`{a.quantity}`", a.unit, a.meaning) for a in derivation.assumptions],
        )
    if derivation.conditions:
        yield Paragraph(
            "Parameters are refused if one of these quantities is not above its lower limit:"
        )
        yield TextTable(
            ("quantity", "lower limit", "unit", "meaning below the limit"),
            [
                (f"`{c.quantity}`", f"`{formula(c.least, FORMULA)}`", c.unit, c.meaning)
                for c in derivation.conditions
            ],
        )


def _counts(derivation: Derivation) -> TextTable:
    rows = []
    for function in (derivation.prepare, derivation.design, *derivation.emitted.values()):
        counts = operations_of(function)
        rows.append(
            (
                f"`{function.name}`",
                ", ".join(" x ".join(map(str, member.shape)) for member in function.members),
                str(counts.total()),
                *(str(counts[name]) for name in OPERATIONS),
            )
        )
    return TextTable(("function", "results", "operations", *OPERATIONS), rows)
