"""The report from velocities on: screws of the joints, Jacobians, M, B and Q.

Formulas are LaTeX in the signs of the section *Signs*. Everything follows from the declaration; the
compiled functions are named beside the quantities that they compute.
"""

from __future__ import annotations

from dataclasses import astuple, dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from ...declare.bodies import Rotor
from ...declare.geometry import Point
from ...declare.joints import Cylindrical, Prismatic, Revolute, Universal, Weld
from ...kinematics.chain import before_telescope, chain_to, reported
from ...program.steps import ancestors
from ...program.symbols import symbols_of
from .document import Equation, Heading, Paragraph, TextTable

if TYPE_CHECKING:
    from collections.abc import Iterator

    from ...declare.joints import Joint, RelativeCoordinate
    from ...equations.outputs import Derivation
    from .document import Block


@dataclass(frozen=True)
class ScrewFormula:
    """Motion of the rest of a chain per unit rate of a relative coordinate."""

    axis: str  # unit vector along or about which it moves, as LaTeX
    point: tuple[Point, str] | None  # point on the axis, with its body; None of a slide


class EquationNumbers:
    """Numbers equations, with the paper's numbers beside them."""

    def __init__(self) -> None:
        self._count = 0

    def __call__(self, formula: str, paper: str = "") -> Equation:
        """Return a displayed equation under the next number."""
        self._count += 1
        return Equation(formula, self._count, paper)


class MotionFormulas:
    """Screws and chains of a model, as formulas.

    Attributes
    ----------
    numbers
        Place of each relative coordinate in the report, from 1 on: the index of its beta.
    """

    def __init__(self, derivation: Derivation) -> None:
        self.derivation = derivation
        self.formulation = derivation.formulation
        self.mechanism = derivation.formulation.mechanism
        self.numbers = {c.name: i for i, c in enumerate(self.mechanism.coordinates, 1)}

    # -- coordinates ----------------------------------------------------------------------------

    def first(self, coordinate: RelativeCoordinate) -> str:
        """Return the first name of a coordinate, of which this one may be a copy."""
        return reported(self.mechanism, coordinate.joint.name, coordinate.kind) or ""

    def coordinate_rows(self) -> list[tuple[str, ...]]:
        """Return the table of the relative coordinates."""
        return [
            (
                inline(beta(number)),
                f"`{c.name}`",
                f"`{c.joint.name}.{c.kind}`",
                self._origin(c),
                c.meaning,
            )
            for number, c in enumerate(self.mechanism.coordinates, 1)
        ]

    def _origin(self, coordinate: RelativeCoordinate) -> str:
        """Return the source of the value of a coordinate, in words."""
        first, joint = self.first(coordinate), coordinate.joint
        if first != coordinate.name:
            return f"copy of {inline(beta(self.numbers[first]))}"
        if joint in self.formulation.independent:
            return f"independent, {self._place_of(joint)}"
        if joint in self.formulation.prescribed:
            return f"prescribed by `{self.formulation.prescribed[joint].inputs[0].name}`"
        if joint.gear is not None:
            return f"gear, {joint.gear_words}"
        name = f"{joint.name}.{coordinate.kind}"
        for transformer in self.derivation.plan.transformers:
            if name in transformer.outputs:
                return f"transformer {transformer.number}"
        return "follows from the poses"

    def _place_of(self, joint: Joint) -> str:
        """Return the elements of q that belong to an independent joint."""
        positions = self.derivation.states.positions
        first, *others = self.derivation.states.part_of(joint).positions
        place = positions.index(first) + 1
        if not others:
            return inline(f"q_{{{place}}}")
        return f"{inline(f'q_{{{place}}}')} to {inline(f'q_{{{place + len(others)}}}')}"

    # -- screws ---------------------------------------------------------------------------------

    @cached_property
    def screws(self) -> dict[str, ScrewFormula]:
        """The screw of each coordinate that is not a copy and is in a chain, by its name."""
        names = {c.name for body in self.bodies for c in self.in_chain(body)}
        return {c.name: self._screw(c) for c in self.mechanism.coordinates if c.name in names}

    @cached_property
    def bodies(self) -> tuple[str, ...]:
        """The bodies with mass that a chain of reported coordinates leads to."""
        massive = self.derivation.massive_bodies
        return tuple(b for b in massive if chain_to(self.mechanism, b) is not None)

    def in_chain(self, body: str) -> list[RelativeCoordinate]:
        """Return the coordinates that move a body, from the ground on."""
        by_name = {c.name: c for c in self.mechanism.coordinates}
        return [
            by_name[reported(self.mechanism, joint.name, kind) or ""]
            for joint in chain_to(self.mechanism, body) or ()
            for kind in joint.coordinates
        ]

    def _screw(self, coordinate: RelativeCoordinate) -> ScrewFormula:
        joint = coordinate.joint
        frame = self._frame(joint.first.name)
        if isinstance(joint, Revolute):
            return ScrewFormula(f"{frame}{along(joint)}", (joint.axis.through, joint.first.name))
        if isinstance(joint, Prismatic):
            return ScrewFormula(f"{frame}{along(joint)}", None)
        if isinstance(joint, Universal):
            turned = "" if coordinate.kind == "azimuth" else f"{self._turn(joint, 'azimuth')}\\,"
            axis = r"\mathbf{e}_z" if coordinate.kind == "azimuth" else r"\mathbf{e}_x"
            return ScrewFormula(f"{frame}{turned}{axis}", (joint.at, joint.first.name))
        assert isinstance(joint, Cylindrical)
        assert isinstance(joint.axis.towards, Point)
        holder = self._holder(joint)
        point = None if coordinate.kind == "slide" else (joint.axis.towards, joint.first.name)
        return ScrewFormula(f"-{self.shaft(holder)}", point)

    def shaft(self, joint: Universal) -> str:
        """Return the unit vector along the shaft of a universal joint, from its centre on."""
        turns = (self._turn(joint, kind) for kind in ("azimuth", "elevation"))
        return self._frame(joint.first.name) + r"\,".join((*turns, r"\mathbf{e}_y"))

    def _turn(self, joint: Universal, kind: str) -> str:
        number = self.numbers[reported(self.mechanism, joint.name, kind) or ""]
        axis = "z" if kind == "azimuth" else "x"
        return rf"\mathbf{{R}}_{axis}({beta(number)})"

    def _holder(self, joint: Cylindrical) -> Universal:
        center = joint.axis.towards
        assert isinstance(center, Point)
        holder = self.mechanism.universal_at(joint.first.name, center)
        assert holder is not None, joint
        return holder

    def _frame(self, body: str) -> str:
        """Return the rotation of a body as a factor of its directions; empty at rest."""
        if body == self.mechanism.ground:
            return ""
        return rf"{rotation(self.mechanism.numbers[body])}\,"

    def screw_rows(self) -> list[tuple[str, ...]]:
        """Return the table of the screws."""
        rows: list[tuple[str, ...]] = []
        for name, screw in self.screws.items():
            number, place = self.numbers[name], "slides along it"
            if screw.point is not None:
                point, body = screw.point
                place = f"`{point.name}` of {self.mechanism.numbers[body]} {body}"
            rows.append((inline(beta(number)), inline(screw.axis), place))
        return rows

    # -- bodies ---------------------------------------------------------------------------------

    def twist_of(self, body: str) -> tuple[str, str]:
        """Return angular velocity and velocity of the centre of mass of a body."""
        place = self.mechanism.numbers[body]
        turns, moves = [], []
        crosses = self._crosses(body)
        for coordinate in self.in_chain(body):
            number, screw = self.numbers[coordinate.name], self.screws[coordinate.name]
            rate = rf"\dot{{\beta}}_{{{number}}}"
            sign = "c" if coordinate.joint in crosses else "a"
            axis = rf"\mathbf{{{sign}}}_{{{number}}}"
            if screw.point is None:
                moves.append(rf"{axis}\,{rate}")
                continue
            arm = rf"(\mathbf{{s}}_{{{place}}}-\mathbf{{p}}_{{{number}}})"
            turns.append(rf"{axis}\,{rate}")
            moves.append(rf"({axis}\times {arm})\,{rate}")
        angular = " + ".join(turns) or r"\mathbf{0}"
        return (
            rf"\boldsymbol{{\omega}}_{{{place}}} = {angular}",
            rf"\mathbf{{v}}_{{{place}}} = {' + '.join(moves)}",
        )

    def pose_of(self, body: str) -> list[str]:
        """Return orientation and position of a body from its last joint; a cross has no angle."""
        joint = (chain_to(self.mechanism, body) or [])[-1]
        b, f = (self.mechanism.numbers[name] for name in (body, joint.first.name))
        frame = self._frame(joint.first.name)
        if isinstance(joint, Prismatic | Weld):
            start = rf"\mathbf{{s}}^0_{{{b}}}"
            if frame:
                offset = rf"(\mathbf{{s}}^0_{{{b}}}-\mathbf{{s}}^0_{{{f}}})"
                start = rf"\mathbf{{s}}_{{{f}}} + {frame}{offset}"
            turn = rotation(f) if frame else r"\mathbf{1}"
            return [
                rf"{rotation(b)} = {turn}",
                rf"\mathbf{{s}}_{{{b}}} = {start}{self._slid(joint)}",
            ]
        k = self.numbers[reported(self.mechanism, joint.name, joint.coordinates[-1]) or ""]
        at, mark, turned = rf"\mathbf{{p}}_{{{k}}}", rf"\mathbf{{p}}^0_{{{k}}}", []
        if isinstance(joint, Revolute):
            angle = rf"{beta(k)}-\beta^0_{{{k}}}"
            turned = [rf"{rotation(b)} = {frame}\mathbf{{R}}({along(joint)},\ {angle})"]
        elif isinstance(joint, Cylindrical):
            slide = self.numbers[reported(self.mechanism, joint.name, "slide") or ""]
            length = rf"(L_{{\mathrm{{{plain(joint.name)}}}}}-{beta(slide)})"
            at, mark = rf"{at} - {length}\,\mathbf{{a}}_{{{k}}}", rf"\mathbf{{t}}^0_{{{k}}}"
            holder = self._holder(joint)
            turns = "\\,".join(self._turn(holder, kind) for kind in ("azimuth", "elevation"))
            product = rf"\mathbf{{F}}_{{{b}}}\,(\mathbf{{F}}^0_{{{b}}})^T"
            turned = [
                rf"\mathbf{{F}}_{{{b}}} = {turns}\,\mathbf{{R}}_y(-{beta(k)})",
                rf"{rotation(b)} = {self._frame(holder.first.name)}{product}",
            ]
        arm = rf"{rotation(b)}\,(\mathbf{{s}}^0_{{{b}}}-{mark})"
        return [*turned, rf"\mathbf{{s}}_{{{b}}} = {at} + {arm}"]

    def _slid(self, joint: Prismatic | Weld) -> str:
        """Return the displacement of a body by its guide."""
        if isinstance(joint, Weld):
            return ""
        k = self.numbers[reported(self.mechanism, joint.name, "slide") or ""]
        return rf" + {beta(k)}\,\mathbf{{a}}_{{{k}}}"

    def _crosses(self, body: str) -> list[Universal]:
        """Return the crosses in a chain that determine the turn of their shafts."""
        chain = chain_to(self.mechanism, body) or []
        crosses = (joint for joint in chain if isinstance(joint, Universal))
        return [joint for joint in crosses if not before_telescope(chain, joint)]

    def shaft_equations(self) -> Iterator[str]:
        """Yield the equations of the turns of shafts by their crosses."""
        for joint in dict.fromkeys(joint for body in self.bodies for joint in self._crosses(body)):
            for kind in joint.coordinates:
                k = self.numbers[reported(self.mechanism, joint.name, kind) or ""]
                n, h = rf"({self.shaft(joint)})", rf"\mathbf{{h}}_{{\mathrm{{{joint.name}}}}}"
                share = rf"\frac{{\mathbf{{a}}_{{{k}}}\cdot {h}}}{{{n}\cdot {h}}}"
                yield rf"\mathbf{{c}}_{{{k}}} = \mathbf{{a}}_{{{k}}} - {share}\,{n}"

    def rotors(self) -> list[Rotor]:
        """Return the bodies of revolution among those with mass."""
        bodies = (self.mechanism.body(name) for name in self.derivation.massive_bodies)
        return [body for body in bodies if isinstance(body, Rotor)]


def beta(number: int) -> str:
    """Return the symbol of a relative coordinate."""
    return rf"\beta_{{{number}}}"


def rotation(number: int) -> str:
    """Return the symbol of the rotation of a body from its design orientation."""
    return rf"\mathbf{{A}}_{{{number}}}"


def along(joint: Joint) -> str:
    """Return the symbol of the unit vector along a joint's axis at the design position."""
    return rf"\mathbf{{u}}_{{\mathrm{{{plain(joint.name)}}}}}"


def plain(name: str) -> str:
    """Return a name for a formula."""
    return name.replace("_", r"\ ")


def inline(formula: str) -> str:
    """Return a formula within a line, in the marks of forges."""
    return f"$`{formula}`$"


_SIGNS = {
    r"\mathbf{e}": (
        r"$`\mathbf{e}_x, \mathbf{e}_y, \mathbf{e}_z`$",
        "unit vectors along the axes of the ground, in which all vectors are written",
    ),
    r"\mathbf{R}_": (
        r"$`\mathbf{R}_x(\beta), \mathbf{R}_y(\beta), \mathbf{R}_z(\beta)`$",
        "rotations about these",
    ),
    r"\mathbf{R}(": (
        r"$`\mathbf{R}(\mathbf{u}, \beta)`$",
        r"rotation about the unit vector $`\mathbf{u}`$",
    ),
    r"\mathbf{A}": (r"$`\mathbf{A}_b`$", "rotation of body b from its design orientation"),
    r"\mathbf{F}": (r"$`\mathbf{F}_b`$", "axes of body b, the second one along its telescope"),
    r"\mathbf{s}": (r"$`\mathbf{s}_b`$", "centre of mass of body b"),
    r"\mathbf{u}": (
        r"$`\mathbf{u}_{\mathrm{J}}`$",
        "unit vector along joint J at design, in the sense in which its coordinate grows",
    ),
    r"\mathbf{a}": (
        r"$`\mathbf{a}_k`$",
        r"axis along or about which $`\beta_k`$ moves the rest of the chain",
    ),
    r"\mathbf{p}": (r"$`\mathbf{p}_k`$", "a point on that axis"),
    r"\mathbf{t}": (
        r"$`L_{\mathrm{J}}, \mathbf{t}_k`$",
        "length of telescope J at zero slide, and the point of its second body to which it leads",
    ),
    "^0": (r"a raised $`0`$", "the value at the design position"),
}
"""Symbol and meaning of each sign, by a part of formulas that contain it."""

_SHAFTS = (
    r"A shaft that universal joint J holds turns about itself as the cross demands: with "
    r"$`\mathbf{h}_{\mathrm{J}}`$ normal to both axes of the cross, its angular velocity relative "
    r"to the first body has no part along $`\mathbf{h}_{\mathrm{J}}`$. In the velocities of the "
    r"shaft itself $`\mathbf{c}`$ represents $`\mathbf{a}`$:"
)


def motion_sections(derivation: Derivation, number: EquationNumbers) -> list[Block]:
    """Return the sections from the relative coordinates to M, B and Q."""
    motion = MotionFormulas(derivation)
    return [
        *_coordinates(motion),
        *_relative(motion, number),
        *_absolute(motion, number),
        *_global(number),
        *_dynamics(motion, number),
    ]


def _coordinates(motion: MotionFormulas) -> list[Block]:
    return [
        Heading(2, "Relative coordinates"),
        Paragraph(
            "The equations below are written in these coordinates; each has its value from the "
            "transformer or input in its row."
        ),
        TextTable(("", "name", "joint", "value", "meaning"), motion.coordinate_rows()),
    ]


def _relative(motion: MotionFormulas, number: EquationNumbers) -> list[Block]:
    read = closure_reads(motion.derivation)
    rows = [
        (
            inline(rf"g_{{{motion.numbers[name]}}}"),
            ", ".join(inline(beta(motion.numbers[n])) for n in others),
            ", ".join(f"`{n}`" for n in given),
        )
        for name, (others, given) in read.items()
    ]
    return [
        Heading(2, "Relative Jacobian"),
        Paragraph(
            "For each coordinate there is one closure equation (`residuals`). It depends on "
            "these coordinates only:"
        ),
        TextTable(("equation", "relative coordinates", "independent and given"), rows),
        Paragraph(
            r"These equations, and their derivatives with respect to time, where $`\mathbf{u}`$ "
            "are the inputs that prescribe a motion:"
        ),
        number(
            r"\mathbf{g}(\boldsymbol{\beta}, \mathbf{q}, \mathbf{u}) = \mathbf{0}",
            "Eqs. 4 to 13" if motion.formulation.cites else "",
        ),
        number(
            r"\frac{\partial\mathbf{g}}{\partial\boldsymbol{\beta}}\,\dot{\boldsymbol{\beta}}"
            r" + \frac{\partial\mathbf{g}}{\partial\mathbf{q}}\,\dot{\mathbf{q}}"
            r" + \frac{\partial\mathbf{g}}{\partial\mathbf{u}}\,\dot{\mathbf{u}} = \mathbf{0}"
        ),
        number(
            r"\dot{\boldsymbol{\beta}} = \mathbf{J}_{\mathrm{rel}}\,\dot{\mathbf{q}}"
            r" + \mathbf{J}_{u}\,\dot{\mathbf{u}}, \qquad \mathbf{J}_{\mathrm{rel}} = "
            r"-\left(\frac{\partial\mathbf{g}}{\partial\boldsymbol{\beta}}\right)^{-1}"
            r"\frac{\partial\mathbf{g}}{\partial\mathbf{q}}",
            "section 4.2",
        ),
        Paragraph(
            r"No matrix is inverted for it: the transformers give $`\boldsymbol{\beta}`$, and "
            r"`relative_jacobian` is their exact derivative with respect to $`\mathbf{q}`$."
        ),
    ]


def closure_reads(derivation: Derivation) -> dict[str, tuple[list[str], list[str]]]:
    """Return for each closure equation its given coordinates, and its states and inputs."""
    function, names = derivation.functions["residuals"], [e.name for e in derivation.relative]
    given = {f"given_{name}": name for name in names}
    outer = [e.name for e in derivation.state] + [e.name for e in derivation.inputs]
    steps = {step.symbol: step for step in function.steps}
    found: dict[str, tuple[list[str], list[str]]] = {}
    for name, value in zip(names, function.results, strict=True):
        expressions = [value, *(steps[s].expression for s in ancestors(steps, [value]))]
        read = {str(symbol) for e in expressions for symbol in symbols_of(e)}
        others = [own for sign, own in given.items() if sign in read]
        found[name] = others, [o for o in outer if o in read]
    return found


def _absolute(motion: MotionFormulas, number: EquationNumbers) -> list[Block]:
    cites = motion.formulation.cites
    sections: list[Block] = []
    if motion.bodies:
        sections += [
            Paragraph("The axes of the coordinates, and a point through which each passes:"),
            TextTable(("coordinate", "axis a", "through p"), motion.screw_rows()),
            Paragraph(
                "Position and velocity of a body follow from those of the body before it in its "
                "chain. Each rate along the chain adds its share to the velocities."
            ),
        ]
    shafts = list(motion.shaft_equations())
    if shafts:
        sections.append(Paragraph(_SHAFTS))
        sections += [number(text) for text in shafts]
    for body in motion.bodies:
        angular, linear = motion.twist_of(body)
        *turned, place = motion.pose_of(body)
        sections += [
            Paragraph(f"Body {motion.mechanism.numbers[body]}, `{body}`:"),
            *map(number, turned),
            number(place, cites.get(f"position of {body}", "")),
            number(angular, cites.get(f"omega of {body}", "")),
            number(linear),
        ]
    signs = TextTable(("sign", "meaning"), [*_signs(sections)])
    sections = [Heading(2, "Absolute kinematics"), *([signs] if signs.rows else []), *sections]
    missing = [b for b in motion.derivation.massive_bodies if b not in motion.bodies]
    if missing:
        sections.append(
            Paragraph(
                "No chain of coordinates of this table leads to "
                f"{', '.join(f'`{b}`' for b in missing)}: not all coordinates of a joint on the "
                "way are reported. Their velocities follow from their pose as the closed form "
                "gives it, by exact differentiation (`global_jacobian`)."
            )
        )
    else:
        sections += [
            Paragraph(
                "The coefficients of the relative rates, body by body, are the rows of the "
                "absolute Jacobian (`absolute_jacobian`):"
            ),
            number(
                r"\begin{bmatrix}\boldsymbol{\omega}_b\\ \mathbf{v}_b\end{bmatrix}"
                r" = \mathbf{J}_{\mathrm{abs},b}\,\dot{\boldsymbol{\beta}}",
                "section 4.3",
            ),
        ]
    return sections


def _signs(blocks: list[Block]) -> Iterator[tuple[str, str]]:
    """Yield the signs that blocks contain, with their meanings."""
    cells = (
        cell
        for block in blocks
        if isinstance(block, TextTable)
        for row in block.rows
        for cell in row
    )
    used = " ".join([*cells, *(b.formula for b in blocks if isinstance(b, Equation))])
    yield from (meaning for sign, meaning in _SIGNS.items() if sign in used)


def _global(number: EquationNumbers) -> list[Block]:
    return [
        Heading(2, "Global Jacobian"),
        Paragraph(
            "With the relative rates from the relative Jacobian, the velocities are those of the "
            "independent coordinates alone:"
        ),
        number(
            r"\mathbf{J}_b = \begin{bmatrix}\mathbf{W}_b\\ \mathbf{V}_b\end{bmatrix}"
            r" = \mathbf{J}_{\mathrm{abs},b}\,\mathbf{J}_{\mathrm{rel}}",
            "section 4.3",
        ),
        Paragraph(
            r"$`\mathbf{W}_b`$ has the angular velocity of a body, $`\mathbf{V}_b`$ the velocity "
            "of its centre of mass, per rate of each independent coordinate (`global_jacobian`)."
        ),
    ]


def _dynamics(motion: MotionFormulas, number: EquationNumbers) -> list[Block]:
    numbers = motion.mechanism.numbers
    bodies = ", ".join(f"{numbers[b]} `{b}`" for b in motion.derivation.massive_bodies)
    inertia = r"\boldsymbol{\Theta}_b"
    turned = r"\mathbf{A}_b\,\boldsymbol{\Theta}_b^0\,\mathbf{A}_b^T"
    sections: list[Block] = [
        Heading(2, "Equations of motion"),
        Paragraph(
            f"The sums are over the bodies with mass: {bodies}. By d'Alembert's principle, the "
            "power of inertia and applied forces vanishes along every admissible motion:"
        ),
        number(
            r"\sum_b \left[\mathbf{J}_b^T\left(\boldsymbol{\Xi}_b\,\ddot{\mathbf{s}}_b"
            r" + \mathbf{b}_b - \mathbf{w}_b\right)\right] = \mathbf{0}",
            "Eq. 2",
        ),
        Paragraph(
            r"Here $`\ddot{\mathbf{s}}_b`$ has the angular acceleration of a body and that of its "
            r"centre of mass, $`\boldsymbol{\Xi}_b`$ its inertia and mass, $`\mathbf{b}_b`$ the "
            r"torque $`\boldsymbol{\omega}_b\times\boldsymbol{\Theta}_b\boldsymbol{\omega}_b`$ of "
            r"its turning, and $`\mathbf{w}_b`$ applied torque and force. "
            f"{inline(rf'{inertia} = {turned}')} is the inertia of the body about its "
            "centre of mass, along the axes of the ground. Sorted by accelerations, rates and "
            "forces:"
        ),
        number(
            r"\mathbf{M}(\mathbf{q})\,\ddot{\mathbf{q}} + \mathbf{B}(\mathbf{q},\dot{\mathbf{q}})"
            r" = \mathbf{Q}(\mathbf{q},\dot{\mathbf{q}})",
            "Eq. 3",
        ),
        number(
            r"\mathbf{M} = \sum_b \left(m_b\,\mathbf{V}_b^T\mathbf{V}_b"
            rf" + \mathbf{{W}}_b^T{inertia}\mathbf{{W}}_b\right)",
            "Eq. 3",
        ),
        number(
            r"\mathbf{B} = \sum_b \left[m_b\,\mathbf{V}_b^T\bar{\mathbf{a}}_b + \mathbf{W}_b^T"
            rf"\left({inertia}\bar{{\boldsymbol{{\alpha}}}}_b + \boldsymbol{{\omega}}_b\times"
            rf"{inertia}\boldsymbol{{\omega}}_b\right)\right]",
            "Eq. 3",
        ),
        Paragraph(
            r"The accelerations $`\bar{\boldsymbol{\alpha}}_b`$ and $`\bar{\mathbf{a}}_b`$ are "
            r"those at $`\ddot{\mathbf{q}} = \mathbf{0}`$: the parts from the change of "
            "the Jacobian and from prescribed motions. The compiled `mass_matrix`, `bias` and "
            r"`forces` return $`\mathbf{M}`$, $`\mathbf{B}`$ and $`\mathbf{Q}`$; `rhs` solves this "
            r"system for $`\ddot{\mathbf{q}}`$."
        ),
    ]
    for part in motion.derivation.states.free:
        body = part.joint.second.name
        names = ", ".join(f"`{entry.name}`" for entry in part.speeds)
        sections.append(
            Paragraph(
                f"Body {numbers[body]}, `{body}`, moves freely. Its rates are no derivatives of "
                f"coordinates: {names} are velocity and angular velocity in its own axes, and "
                r"take the place of elements of $`\dot{\mathbf{q}}`$. Positions change by "
                r"$`\dot{\mathbf{q}} = \mathbf{N}(\mathbf{q})\,\mathbf{v}`$, in which the "
                r"quaternion e follows $`\dot{e} = \tfrac12\,e\circ(0, p, q, r)`$ and is kept at "
                "length one."
            )
        )
    constraints = motion.mechanism.constraints
    if constraints:
        names = ", ".join(f"`{constraint.name}`" for constraint in constraints)
        given = ", ".join(f"`{name}`" for name in motion.derivation.states.eliminated)
        sections.append(
            Paragraph(
                f"Constraints on speeds, {names}, give {given}. With "
                r"$`\mathbf{v} = \mathbf{T}\mathbf{v}_i + \mathbf{p}`$ for the other speeds "
                r"$`\mathbf{v}_i`$, the compiled functions return "
                r"$`\mathbf{T}^T\mathbf{M}\mathbf{T}`$, $`\mathbf{T}^T\mathbf{Q}`$ and "
                r"$`\mathbf{T}^T(\mathbf{B} + \mathbf{M}\mathbf{g})`$, where "
                r"$`\mathbf{g}`$ are the rates of the eliminated speeds at constant "
                r"$`\mathbf{v}_i`$."
            )
        )
    for rotor in motion.rotors():
        name = inline(rf"\boldsymbol{{\Theta}}_{{{numbers[rotor.name]}}}")
        sections.append(
            Paragraph(
                f"Body {numbers[rotor.name]}, `{rotor.name}`, is a body of revolution: {name} has "
                f"`{rotor.name}_inertia_spin` about its axis and `{rotor.name}_inertia_diametral` "
                "across it, at every angle of rotation."
            )
        )
    formulation = motion.formulation
    acting = [f for f in formulation.mechanism.forces if f.along not in formulation.prescribed]
    rows = [(*astuple(f.describe()), formulation.cites.get(f.identity[1], "")) for f in acting]
    sections += [
        Paragraph(
            r"The share of a force in $`\mathbf{Q}`$ is, for each independent coordinate, the "
            "coefficient of the rate of that coordinate in the power of the force:"
        ),
        TextTable(("force", "acts", "share of Q", "paper"), rows),
    ]
    return sections
