"""Closed forms in space against Newton's method in 30 digits: over all they reach, to the end.

Every case is a loop with one unknown, written as the length of its rod: nothing of a closed form is
in it. The root is followed from the design position on in small steps of what drives, so it is the
one that a motion leads to. At the end, where two roots meet, a position is worth half of the
digits; that is the geometry, and the model loses no more than that.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property

import mpmath
import numpy as np
import pytest
from kintrafo.equations.errors import ClosureError
from kintrafo.generated import double_wishbone, macpherson
from kintrafo.generator.mechanisms import MODELS as SHIPPED
from mechanisms.every_closed_form import moving_slider_crank, spatial_four_bar
from mpmath import mpf
from support.models import Built, own

BY_NAME = {model.name: model for model in SHIPPED}
DIGITS = 30
STEPS = 80

"""Three numbers of many digits."""


# -- geometry in many digits -----------------------------------------------------------------------


def exact(values, name):
    """Return a point or direction of a set of parameters."""
    return np.array([mpf(values[f"{name}_{a}"]) for a in "xyz"])


def unit(v):
    return v / mpmath.sqrt(v.dot(v))


def turned(axis, angle, v):
    """Return a vector turned about a unit axis."""
    c, s = mpmath.cos(angle), mpmath.sin(angle)
    return v * c + np.cross(axis, v) * s + axis * (axis.dot(v) * (1 - c))


def about(point, axis, angle, v):
    """Return a point turned about a line."""
    return point + turned(axis, angle, v - point)


# -- the loops -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Loop:
    """A loop with one unknown.

    Attributes
    ----------
    built
        The compiled model.
    state
        State and inputs of a value of what drives.
    body
        Name of the body that the loop places.
    ends
        The ends of the rod, for an unknown and a value of what drives.
    place
        Where the centre of mass of the body is.
    span
        How far to go from the design position, at most, to either side.
    guard
        What the model calls the end of its reach.
    """

    built: Built
    state: Callable[[float], tuple[np.ndarray, np.ndarray]]
    body: str
    ends: Callable[[mpf, mpf], tuple[np.ndarray, np.ndarray]]
    place: Callable[[mpf], np.ndarray]
    span: float
    guard: str
    _paths: dict[int, list[tuple[mpf, mpf]]] = field(default_factory=dict)

    @cached_property
    def _rod(self):
        """Length of the rod, squared."""
        with mpmath.workdps(DIGITS):
            start, end = self.ends(mpf(0), mpf(0))
            return (start - end).dot(start - end)

    def left(self, unknown, drive):
        """Return how much longer than the rod the way between its ends is, squared."""
        one, other = self.ends(unknown, drive)
        return (one - other).dot(one - other) - self._rod

    def solve(self, drive, guess):
        """Return the root next to a guess, by Newton's method; None if it leads away."""

        def slope(x):
            h = mpf(10) ** (-DIGITS // 2)
            return (self.left(x + h, drive) - self.left(x - h, drive)) / (2 * h)

        try:
            root = mpmath.findroot(lambda x: self.left(x, drive), guess, "newton", df=slope)
        except (ValueError, ZeroDivisionError):
            return None
        return root if abs(root - guess) < mpf(0.5) else None

    def followed(self, side):
        """Return drives and roots from the design position on, until there is none."""
        if side not in self._paths:
            self._paths[side] = list(self._followed(side))
        return self._paths[side]

    def _followed(self, side):
        """Yield drives and roots from the design position on, until there is none."""
        root = mpf(0)
        for i in range(1, STEPS + 1):
            drive = side * mpf(self.span) * i / STEPS
            found = self.solve(drive, root)
            if found is None:
                return
            root = found
            yield drive, root

    def end(self, side):
        """Return the drive at which two roots meet, or None if that is not in the span."""
        path = self.followed(side)
        if len(path) == STEPS:
            return None
        drive, root = path[-1]
        h = mpf(10) ** (-DIGITS // 3)

        def both(x, d):
            return [self.left(x, d), (self.left(x + h, d) - self.left(x - h, d)) / (2 * h)]

        _, where = mpmath.findroot(both, (root, drive))
        return where

    def off_by(self, drive, root):
        """Return how far the model's body is from where it should be, m."""
        state, inputs = self.state(float(drive))
        places = self.built("positions", state, inputs)
        found = places[list(self.built.module.BODIES).index(self.body)]
        expected = self.place(root)
        return float(max(abs(mpf(f) - e) for f, e in zip(found, expected, strict=True)))


def other_branch(loop):
    """Return the second root of the design position."""
    guesses = [mpmath.pi * i / 12 - 3 for i in range(24)]
    roots = [mpmath.findroot(lambda x: loop.left(x, mpf(0)), (g, g + mpf("0.01"))) for g in guesses]
    turn = 2 * mpmath.pi
    apart = [r for r in roots if abs(r - turn * mpmath.nint(r / turn)) > 1e-6]
    return apart[0]


def rocker(built):
    """Return hinge - rod - hinge in space: the angle of the rocker."""
    p = built.parameters
    crank, pivot, pin, eye = (
        exact(p, n) for n in ("crank_bearing", "rocker_bearing", "crank_end", "rocker_end")
    )
    drive, axis, com = (
        unit(exact(p, "crank_line")),
        unit(exact(p, "rocker_line")),
        exact(p, "rocker_com"),
    )
    return Loop(
        built,
        lambda d: (np.array([d, 0.0]), np.zeros(len(built.module.INPUTS))),
        "rocker",
        lambda x, d: (about(pivot, axis, x, eye), about(crank, drive, d, pin)),
        lambda x: about(pivot, axis, x, com),
        np.pi,
        "rocker_closure",
    )


def slider(built):
    """Return hinge - rod - guide in space, base and table at their design positions."""
    p = built.parameters
    crank, pin, eye = (exact(p, n) for n in ("crank_bearing", "crank_end", "slider_end"))
    drive, way, com = (
        unit(exact(p, "crank_line")),
        unit(exact(p, "way_axis")),
        exact(p, "slider_com"),
    )
    return Loop(
        built,
        lambda d: (np.array([0.0, d, 0.0, 0.0, 0.0, 0.0]), np.zeros(len(built.module.INPUTS))),
        "slider",
        lambda x, d: (eye + way * x, about(crank, drive, d, pin)),
        lambda x: com + way * x,
        np.pi,
        "slider_closure",
    )


def knuckle(built, *, wishbone):
    """Return a knuckle about the line of its two points, held by the tie rod; the rack drives."""
    p = built.parameters
    low = exact(p, "lower_ball_joint" if wishbone else "ball_joint")
    high = exact(p, "upper_ball_joint" if wishbone else "strut_top")
    outer, inner, com = (exact(p, n) for n in ("tie_rod_outer", "tie_rod_inner", "knuckle_com"))
    line, rack = unit(high - low), unit(exact(p, "rack_axis"))

    def state(d):
        inputs = np.zeros(len(built.module.INPUTS))
        inputs[0] = d
        return np.array([built.design[0], 0.0, 0.0, 0.0]), inputs

    return Loop(
        built,
        state,
        "knuckle",
        lambda x, d: (about(low, line, x, outer), inner + rack * d),
        lambda x: about(low, line, x, com),
        0.3,
        "knuckle_closure",
    )


def upper_arm(built):
    """Return the upper arm of a double wishbone, held by the knuckle; the lower arm drives."""
    p = built.parameters
    low_rear, low_front = exact(p, "lower_arm_rear"), exact(p, "lower_arm_front")
    rear, front = exact(p, "upper_arm_rear"), exact(p, "upper_arm_front")
    low, high, com = (
        exact(p, n) for n in ("lower_ball_joint", "upper_ball_joint", "upper_arm_com")
    )
    drive, axis = unit(low_front - low_rear), unit(front - rear)
    return Loop(
        built,
        lambda d: (
            np.array([built.design[0] + d, 0.0, 0.0, 0.0]),
            np.zeros(len(built.module.INPUTS)),
        ),
        "upper_arm",
        lambda x, d: (about(rear, axis, x, high), about(low_rear, drive, d, low)),
        lambda x: about(rear, axis, x, com),
        np.pi,
        "upper_arm_closure",
    )


def compiled(model):
    """Return a model with its default parameters."""
    return Built.of(model, own(model, derivatives=False))


@pytest.fixture(scope="session")
def loop():
    """Return a loop by its name."""

    def find(name):
        if name == "upper arm":
            return upper_arm(Built.of(BY_NAME["double_wishbone"], double_wishbone))
        if name.startswith("knuckle"):
            wishbone = "wishbone" in name
            module = double_wishbone if wishbone else macpherson
            shipped = "double_wishbone" if wishbone else "macpherson"
            return knuckle(Built.of(BY_NAME[shipped], module), wishbone=wishbone)
        if name.startswith("slider"):
            built = compiled(moving_slider_crank("slider_in_space"))
            return _on_the_other_side(slider, built, "slider") if "other" in name else slider(built)
        built = compiled(spatial_four_bar("rocker_in_space"))
        return _on_the_other_side(rocker, built, "rocker") if "other" in name else rocker(built)

    return cache(find)


def _on_the_other_side(make, built, body):
    """Return a loop declared where the other branch has its design position."""
    with mpmath.workdps(DIGITS):
        first = make(built)
        unknown = other_branch(first)
        moved, _ = first.ends(unknown, mpf(0))
        com = first.place(unknown)
    changes = {f"{body}_end_{a}": float(c) for a, c in zip("xyz", moved, strict=True)}
    changes |= {f"{body}_com_{a}": float(c) for a, c in zip("xyz", com, strict=True)}
    return make(Built.of(built.model, built.module, changes))


NAMES = [
    "rocker",
    "rocker, other branch",
    "slider",
    "slider, other branch",
    "knuckle of a strut",
    "knuckle of a double wishbone",
    "upper arm",
]


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("name", NAMES)
def test_over_the_whole_range(name, side, loop):
    case = loop(name)
    with mpmath.workdps(DIGITS):
        path = case.followed(side)
        assert len(path) > 10
        end = case.end(side)
        for drive, root in path:
            near = mpf(1) if end is None else min(mpf(1), abs(end - drive) / abs(end))
            # lengths below 1 m, over the root of the distance from the end
            assert case.off_by(drive, root) < 4e-15 / float(mpmath.sqrt(near)), drive


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("name", NAMES)
def test_to_the_end_of_the_range(name, side, loop):
    case = loop(name)
    with mpmath.workdps(DIGITS):
        end = case.end(side)
        if end is None:
            pytest.skip("it goes all the way round")
        drive, root = case.followed(side)[-1]
        for before in (1e-2, 1e-4, 1e-6, 1e-8, 1e-10):
            where = end * (1 - mpf(before))
            if abs(where) < abs(drive):
                continue
            for part in range(1, 9):  # in steps, of which every one halves the way that is left
                there = end - (end - drive) * mpf(2) ** (-part)
                root = case.solve(there, root) if abs(there) < abs(where) else root
            root = case.solve(where, root)
            drive = where
            assert case.off_by(where, root) < 4e-15 / before**0.5
        state, inputs = case.state(float(end * (1 + mpf("1e-9"))))
        with pytest.raises(ClosureError) as caught:
            case.built("positions", state, inputs)
        assert case.guard in caught.value.margins


@pytest.mark.parametrize("off", [1e-1, 1e-3, 1e-5, 1e-7])
def test_a_shaft_next_to_the_first_axis_of_its_cross(off, loop, refused):
    """The cross is singular there; its rotation is as exact as the distance from that allows.

    Where that is worse than 1e-9 in the worst case, within some 1e-5 rad, it is refused.
    """
    case, drive = loop("rocker"), mpf("0.3")
    with mpmath.workdps(DIGITS):
        eye, pin = case.ends(case.solve(drive, mpf(0)), drive)
        shaft = unit(eye - pin)
        beside = unit(np.cross(shaft, np.array([mpf(1), mpf(0), mpf(0)])))
        line = unit(exact(case.built.parameters, "crank_line"))
        axis = turned(line, -drive, shaft + beside * mpf(off))  # as the crank has it at design
        changes = {f"cross_axis_{a}": float(c) for a, c in zip("xyz", axis, strict=True)}
        built = Built.of(case.built.model, case.built.module, case.built.parameters | changes)
        axis = exact(built.parameters, "cross_axis")  # as it has been rounded
        start_eye, start_pin = case.ends(mpf(0), mpf(0))
        start = crossed(unit(start_eye - start_pin), axis)
        now = crossed(shaft, turned(line, drive, axis))
        state, inputs = case.state(float(drive))
        if off <= 1e-5:
            refused(built.module.ClosureError, lambda: built("orientations", state, inputs))
            return
        found = built("orientations", state, inputs)[list(built.module.BODIES).index("rod")]
        left = [f - e for f, e in zip(found.ravel(), (now @ start.T).ravel(), strict=True)]
        assert max(map(abs, left)) < 4e-15 / off


def crossed(shaft, axis):
    """Return the axes of a shaft as columns: its line, and the second axis of its cross."""
    second = unit(np.cross(axis, shaft))
    return np.array([shaft, second, np.cross(shaft, second)]).T
