"""A boom and its cylinder over their whole range, against the law of cosines in many digits.

Boom and cylinder stand on two hinges of the ground, and the guide of the cylinder passes beside
its pins. Either the boom is driven and the stroke follows, or the stroke is driven and the boom
follows.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import permutations, product

import mpmath
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator.backends.counting import operations_of
from kintrafo.generator.closed_forms.prismatic import PrismaticByLength
from kintrafo.generator.closed_forms.revolute import RevoluteByLength
from kintrafo.generator.closed_forms.rpr import RPR, PlaceTelescope
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.mechanisms.slider_crank import MODELS as SLIDER_CRANKS
from kintrafo.generator.planning.plan import CataloguePlan
from mpmath import mpf
from support.changes import changed, named
from support.models import Built, needs_gcc, own
from support.symbolic import constants_of, python

EPSILON = 2.0**-52
BOOM, BASE = (
    1.3,
    1.0,
)  # from the boom's hinge to the cylinder's pin on it, and to that on the ground


def crane(driven):
    """Return the crane with the boom's hinge or the bore of the cylinder driven."""
    ground = g.Ground("ground")
    foot, low, high = (
        g.flat(name, place)
        for name, place in (
            ("foot", (0.0, 0.0)),
            ("barrel_pin", (BASE, 0.0)),
            ("piston_pin", (0.0, BOOM)),
        )
    )
    boom, barrel, piston = (
        g.Body(name, 2.0, g.flat(f"{name}_com", place), 0.3)
        for name, place in (("boom", (0.1, 0.9)), ("barrel", (0.8, 0.3)), ("piston", (0.3, 0.9)))
    )
    joints = (
        g.hinge("pivot", ground, boom, foot),
        g.hinge("low", ground, barrel, low),
        g.Prismatic("bore", barrel, piston, g.Direction("way", tuple(WAY.values()))),
        g.hinge("high", piston, boom, high),
    )
    pivot, leaning, bore, _ = joints
    mechanism = g.Mechanism(
        name=f"crane_{driven}",
        title="Crane",
        joints=joints,
        coordinates=(
            pivot.angle("boom_angle", "angle of the boom"),
            leaning.angle("barrel_angle", "angle of the barrel"),
            bore.slide("stroke", "stroke"),
        ),
    )
    return g.Formulation(mechanism.name, "Crane", mechanism, independent=(mechanism.joint(driven),))


WAY = {"x": -0.5, "y": 0.7, "z": 0.0}


@pytest.fixture(scope="module", params=["pivot", "bore"])
def built(request):
    model = crane(request.param)
    return Built.of(model, own(model))


# -- the law of cosines ---------------------------------------------------------------------------


@dataclass(frozen=True)
class Exact:
    """The crane in many digits, from the numbers that the model is given.

    Attributes
    ----------
    boom, base
        Sides of the triangle at the boom's hinge.
    along, beside
        The way from pin to pin at the start, along the guide and across it.
    side
        1 where the boom is left of the line to the barrel's hinge, -1 right.
    """

    boom: mpf
    base: mpf
    along: mpf
    beside: mpf
    side: int
    start: mpf

    @classmethod
    def of(cls, built):
        given = {name: mpf(value) for name, value in built.parameters.items()}

        def place(name):
            return given[f"{name}_x"] - given["foot_x"], given[f"{name}_y"] - given["foot_y"]

        barrel, piston = place("barrel_pin"), place("piston_pin")
        size = mpmath.hypot(given["way_x"], given["way_y"])
        way = given["way_x"] / size, given["way_y"] / size
        span = piston[0] - barrel[0], piston[1] - barrel[1]
        turned = barrel[0] * piston[1] - barrel[1] * piston[0]
        return cls(
            mpmath.hypot(*piston),
            mpmath.hypot(*barrel),
            span[0] * way[0] + span[1] * way[1],
            way[0] * span[1] - way[1] * span[0],
            1 if turned > 0 else -1,
            mpmath.atan2(turned, barrel[0] * piston[0] + barrel[1] * piston[1]),
        )

    def boom_angle(self, stroke):
        """Return the turn of the boom from the start at a stroke."""
        squared = (self.along + mpf(stroke)) ** 2 + self.beside**2
        cosine = (self.boom**2 + self.base**2 - squared) / (2 * self.boom * self.base)
        return self.side * mpmath.acos(cosine) - self.start

    def stroke(self, turn):
        """Return the stroke at a turn of the boom from the start."""
        cosine = mpmath.cos(self.start + mpf(turn))
        squared = self.boom**2 + self.base**2 - 2 * self.boom * self.base * cosine
        return mpmath.sign(self.along) * mpmath.sqrt(squared - self.beside**2) - self.along

    def barrel_angle(self, turn, stroke):
        """Return the turn of the barrel: that of the line from pin to pin, less that in it."""
        now = self.start + turn
        line = mpmath.atan2(self.boom * mpmath.sin(now), self.boom * mpmath.cos(now) - self.base)
        first = mpmath.atan2(
            self.boom * mpmath.sin(self.start), self.boom * mpmath.cos(self.start) - self.base
        )
        inside = mpmath.atan2(self.beside, self.along + stroke)
        return line - first - inside + mpmath.atan2(self.beside, self.along)

    def all_at(self, built, driven):
        """Return boom angle, barrel angle and stroke."""
        if built.model.independent[0].name == "pivot":
            turn, stroke = mpf(driven), self.stroke(driven)
        else:
            turn, stroke = self.boom_angle(driven), mpf(driven)
        return turn, self.barrel_angle(turn, stroke), stroke


def off_by(found, expected):
    """Return how far the coordinates are off, angles without whole turns."""
    off = [mpf(float(f)) - e for f, e in zip(found, expected, strict=True)]
    turn = 2 * mpmath.pi
    off[:2] = [o - turn * mpmath.nint(o / turn) for o in off[:2]]
    return float(max(map(abs, off)))


# -- the whole range ------------------------------------------------------------------------------

GEOMETRIES = {
    "as declared": {},
    "boom on the right": {"piston_pin_y": -BOOM, "way_y": -0.7},
    "guide the other way": {"way_x": 0.5, "way_y": -0.7},
    "guide far beside": {"way_x": -0.9, "way_y": 0.5},
}


@needs_gcc
@pytest.mark.parametrize("geometry", GEOMETRIES)
def test_position_over_the_whole_range(built, geometry):
    built = Built.of(built.model, built.module, GEOMETRIES[geometry])
    exact = Exact.of(built)
    for driven in np.linspace(*reach(built, exact), 43)[1:-1]:
        found = built("relative_coordinates", np.array([driven, 0.0]))
        with mpmath.workdps(40):
            # some ten roundings; roots of a twentieth at the ends
            assert off_by(found, Exact.of(built).all_at(built, driven)) < 5e-15


def reach(built, exact):
    """Return the ends of the driven coordinate: of the boom half a turn, of the stroke its ends."""
    if built.model.independent[0].name == "pivot":
        return nearest_pins(exact), float(exact.side * mpmath.pi - exact.start)
    sign = mpmath.sign(exact.along)
    lengths = (abs(exact.boom - exact.base), exact.boom + exact.base)
    ways = [mpmath.sqrt(max(l**2 - exact.beside**2, 0)) for l in lengths]
    shortest, longest = (float(sign * way - exact.along) for way in ways)
    return shortest, longest


def nearest_pins(exact):
    """Return the boom's angle at which the pins are as near as boom or guide lets them be."""
    least = max(exact.beside**2, (exact.boom - exact.base) ** 2)
    cosine = (exact.boom**2 + exact.base**2 - least) / (2 * exact.boom * exact.base)
    return float(exact.side * mpmath.acos(min(cosine, mpf(1))) - exact.start)


# -- the ends -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class End:
    """An end of the range: the driven coordinate there, which way is inward, and the guard."""

    driven: float
    inward: float
    guard: str


def end_of(built, which):
    """Return an end of the range of a crane whose guide passes far beside its pins."""
    with mpmath.workdps(40):
        exact = Exact.of(built)
        if built.model.independent[0].name == "pivot":
            return End(nearest_pins(exact), float(exact.side), "barrel_extension_squared")
        shortest, longest = reach(built, exact)
        inward = float(mpmath.sign(exact.along))
        if which == "longest":
            return End(longest, -inward, "boom_closure")
        return End(shortest, inward, "boom_closure")


def with_end(built, which):
    """Return a crane that has such an end.

    Where the stroke follows, both stand for the pins coming together, on either side of the boom:
    the guide is so far beside them that they cannot meet.
    """
    if built.model.independent[0].name != "pivot":
        return Built.of(built.model, built.module)
    side = 1.0 if which == "shortest" else -1.0
    bent = {"way_x": -0.99, "way_y": 0.3 * side, "piston_pin_y": side * BOOM}
    return Built.of(built.model, built.module, bent)


ENDS = pytest.mark.parametrize("which", ["shortest", "longest"])


@needs_gcc
@ENDS
def test_beyond_the_end_the_loop_is_named(built, which):
    built = with_end(built, which)
    end = end_of(built, which)
    for beyond in (1e-9, 1e-3, 0.05):
        state = np.array([end.driven - end.inward * beyond, 1.0])
        for function in ("rhs", "rhs_jacobian", "positions", "relative_coordinates"):
            with pytest.raises(built.module.ClosureError) as error:
                built(function, state)
            assert error.value.margins[end.guard] < 0.0


@needs_gcc
@ENDS
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10])
def test_accuracy_before_the_end(built, which, before):
    built = with_end(built, which)
    end = end_of(built, which)
    driven = end.driven + end.inward * before
    found = built("relative_coordinates", np.array([driven, 0.0]))
    with mpmath.workdps(40):
        off = off_by(found, Exact.of(built).all_at(built, driven))
    # a root of the distance to the end: some ten roundings over that root
    assert off < 10.0 * EPSILON / np.sqrt(before)


@needs_gcc
@ENDS
@pytest.mark.parametrize("before", [1e-2, 1e-4, 1e-6])
def test_equations_of_motion_before_the_end(built, which, before):
    built = with_end(built, which)
    end = end_of(built, which)
    state = np.array([end.driven + end.inward * before, 0.3 * before])
    oracle = built.oracle.reduced(built.motion(state, np.zeros(0)), {}, {})
    found = built("rhs", state)[1]
    scale = np.abs(oracle.inertial[0])
    # both lose digits like the inverse of the distance
    assert abs(found - oracle.accelerations[0]) * oracle.mass_matrix[0, 0] < 2e-16 * scale / before


@needs_gcc
@pytest.mark.parametrize("built", ["bore"], indirect=True)
def test_a_cylinder_drawn_in_beyond_its_pins_is_named(built, refused):
    at_once = Built.of(built.model, built.module, {"piston_pin_x": BASE, "piston_pin_y": 0.2})
    with refused(built.module.ClosureError) as error:
        at_once("rhs", np.array([-0.2, 0.0]))
    assert error.value.margins["barrel_extension"] < 0.0


# -- declarations ---------------------------------------------------------------------------------


@pytest.mark.parametrize("driven", ["pivot", "bore", "A", "guide"])
def test_any_order_of_declaration(driven):
    """Joints in any order, and those that are not driven from either end: crane, slider-crank."""
    model = crane(driven) if driven in ("pivot", "bore") else sliding(driven)
    free = [j for j in model.mechanism.joints if j.name != driven]
    for flips in product([False, True], repeat=len(free)):
        turned = [(j, reversed_joint(j)) for j, flip in zip(free, flips, strict=True) if flip]
        flipped = changed(model, *turned)
        for order in permutations(flipped.mechanism.joints):
            mechanism = replace(flipped.mechanism, joints=order)
            plan = CataloguePlan.of(replace(flipped, mechanism=mechanism))
            kinds = [type(action) for action in plan.steps if type(action) in ANSWERS[driven]]
            assert kinds == ANSWERS[driven]


ANSWERS = {
    "pivot": [RPR],
    "bore": [RevoluteByLength, PlaceTelescope],
    "A": [PrismaticByLength],
    "guide": [RevoluteByLength],
}


def sliding(driven):
    """Return the slider-crank without forces, its crank or its piston driven."""
    model = SLIDER_CRANKS[0]
    still = replace(model.mechanism, forces=())
    return replace(model, mechanism=still, independent=(still.joint(driven),))


def reversed_joint(joint):
    return replace(joint, first=joint.second, second=joint.first)


@needs_gcc
def test_guide_along_the_pins_is_a_guide_that_does_not_miss_them(built):
    """Declared from pin to pin it costs less, and the numbers are those of a direction."""
    mechanism = built.model.mechanism
    pins = named(mechanism, g.Point, "barrel_pin"), named(mechanism, g.Point, "piston_pin")
    along = {"way_x": -BASE, "way_y": BOOM}
    state = np.array([0.2, 1.3])
    expected = Built.of(built.model, built.module, along)("rhs", state)
    for between in (pins, pins[::-1]):
        way = named(mechanism, g.Direction, "way")
        direct = changed(built.model, (way, g.Direction("bore", between=between)))
        derived = generate(direct, derivatives=False)
        driven = built.model.independent[0].name
        sign = -1.0 if between != pins and driven == "bore" else 1.0
        found = evaluated(derived, sign * state)
        np.testing.assert_allclose(sign * found, expected, rtol=1e-13)
        general = sum(built.module.rhs.operations[kind] for kind in ("add", "multiply"))
        assert operations_of(derived.functions["rhs"]).total() < general


def evaluated(derived, state):
    """Evaluate the right-hand side of a derived model in many digits."""
    defaults = {p.name: p.default for p in derived.formulation.mechanism.parameters}
    values = constants_of(derived, defaults)
    values |= dict(zip([e.name for e in derived.state], map(mpf, state), strict=True))
    return np.array([float(x) for x in python(derived.functions["rhs"])(values)])


def test_known_telescope_in_space_is_refused_by_name(refused):
    """A guide does not say where its line is: in space a telescope is a cylindrical joint."""
    model = crane("bore")
    pivot = model.mechanism.joint("pivot")
    assert isinstance(pivot, g.Revolute)
    low, high = (model.mechanism.joint(name) for name in ("low", "high"))
    at, to = (named(model, g.Point, name) for name in ("barrel_pin", "piston_pin"))
    shaft = replace(pivot.axis, through=at, towards=to)
    pins = (
        (low, g.Universal("low", low.first, low.second, at=at, shaft=shaft)),
        (high, g.Spherical("high", high.first, high.second, at=to)),
    )
    coordinates = tuple(c for c in model.mechanism.coordinates if c.joint.name == "bore")
    mechanism = replace(model.mechanism, coordinates=coordinates)
    refused(
        NoClosedFormError,
        lambda: CataloguePlan.of(changed(replace(model, mechanism=mechanism), *pins)),
    )
