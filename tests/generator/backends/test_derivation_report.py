"""Formulas of motion in the derivation reports, evaluated: equal to the compiled code.

The formulas are read from the committed reports as they are printed, and evaluated by this file's
own reader of them with the poses of the compiled functions at random states.
"""

import re
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import sympy as sp
from kintrafo import generated
from kintrafo.generator import Point, Revolute
from kintrafo.generator.declare.declared import parts
from kintrafo.generator.mechanisms import MODELS

FOLDER = Path(generated.__file__).parent
NAMES = [model.name for model in MODELS]
BY_NAME = {model.name: model for model in MODELS}


class V:
    """A scalar, vector or matrix in a printed formula: * multiplies, ^ is the cross product."""

    def __init__(self, value):
        self.value = np.asarray(value, float)

    def __mul__(self, other):
        a, b = self.value, as_v(other).value
        return V(a * b if a.ndim == 0 or b.ndim == 0 else a @ b)

    def __xor__(self, other):
        return V(np.cross(self.value, other.value))

    def __matmul__(self, other):
        return V(self.value @ other.value)

    def __truediv__(self, other):
        return V(self.value / other.value)

    def __add__(self, other):
        return V(self.value + other.value)

    def __sub__(self, other):
        return V(self.value - other.value)

    def __neg__(self):
        return V(-self.value)


def as_v(value):
    return value if isinstance(value, V) else V(value)


def turn(axis, angle):
    """Rodrigues' formula."""
    x, y, z = as_v(axis).value
    w = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    a = as_v(angle).value
    return V(np.eye(3) + np.sin(a) * w + (1 - np.cos(a)) * w @ w)


READ = (
    (r"\\tag\{.*\}$", ""),
    (r"\\frac\{(.*?\})\}\{(\(.*?\)\\cdot .*?\}\})\}", r"((\1)/(\2))"),
    (r"\\mathbf\{1\}", "one"),
    (r"\\mathbf\{0\}", "zero"),
    (r"\\mathbf\{R\}_([xyz])\(", r"R_\1("),
    (r"\\mathbf\{R\}\(", "turn("),
    (r"\\mathbf\{e\}_([xyz])", r"e_\1"),
    (r"\(\\mathbf\{F\}\^0_\{(\d+)\}\)\^T", r"F0T[\1]"),
    (r"\\mathbf\{h\}_\{\\mathrm\{(.*?)\}\}", r"h['\1']"),
    (r"\\mathbf\{u\}_\{\\mathrm\{(.*?)\}\}", r"u['\1']"),
    (r"L_\{\\mathrm\{(.*?)\}\}", r"L['\1']"),
    (r"\\(?:mathbf|boldsymbol)\{\\?(\w+)\}\^0_\{(\d+)\}", r"\g<1>0[\2]"),
    (r"\\(?:mathbf|boldsymbol)\{\\?(\w+)\}_\{(\d+)\}", r"\1[\2]"),
    (r"\\dot\{\\beta\}_\{(\d+)\}", r"rate[\1]"),
    (r"\\beta\^0_\{(\d+)\}", r"beta0[\1]"),
    (r"\\beta_\{(\d+)\}", r"beta[\1]"),
    (r",\\ ", ", "),
    (r"\\times", "^"),
    (r"\\cdot", "@"),
    (r"\\,", "*"),
    (r"\\ ", " "),
)


def python(formula):
    """Return a printed formula as Python reads it."""
    for pattern, by in READ:
        formula = re.sub(pattern, by, formula)
    assert "\\" not in formula, formula
    return formula


class Place:
    """Values of all signs of a model's report at a random instant near its design position."""

    def __init__(self, name):
        self.model = import_module(f"kintrafo.generated.{name}")
        self.mechanism = BY_NAME[name].mechanism
        self.numbers = self.mechanism.numbers
        self.text = (FOLDER / f"{name}.md").read_text(encoding="utf-8")
        given = {p.name: p.default for p in self.mechanism.parameters}
        self.values = {n: e.subs(given) for n, e in self.mechanism.derived.items()} | given
        self.constants = self.model.prepare(given)
        design = np.array(self.model.design_state(given))
        design[len(design) // 2 :] = 0.0
        rng = np.random.default_rng(1)
        self.state = design + rng.uniform(-0.02, 0.02, len(design))
        # what prescribes a motion stands still, so that beta' is J_rel q'
        positions = [n.endswith("_position") for n in self.model.INPUTS]
        self.inputs = rng.uniform(-0.02, 0.02, len(positions)) * positions
        self.beta = self.call("relative_coordinates")
        rates = self.call("relative_jacobian") @ self.state[len(design) // 2 :]
        poses = self.poses()
        moved, self.state = self.state, design
        inputs, self.inputs = self.inputs, 0.0 * self.inputs
        self.resting, self.beta0 = self.poses(), self.call("relative_coordinates")
        self.state, self.inputs = moved, inputs
        self.signs = {
            "one": V(np.eye(3)),
            "zero": V(np.zeros(3)),
            "turn": turn,
            **{f"e_{axis}": V(np.eye(3)[i]) for i, axis in enumerate("xyz")},
            **{f"R_{axis}": self._about(i) for i, axis in enumerate("xyz")},
            "beta": numbered(self.beta),
            "beta0": numbered(self.beta0),
            "rate": numbered(rates),
            "A": {self.numbers[b]: V(pose[1]) for b, pose in poses.items()},
            "s": {self.numbers[b]: V(pose[0]) for b, pose in poses.items()},
            "s0": {self.numbers[b]: V(pose[0]) for b, pose in self.resting.items()},
            "u": self._axes(),
            "L": {
                j.name.replace("_", " "): V(self.values[j.length_at_zero_slide.name])
                for j in self.mechanism.joints
                if j.kind == "cylindrical"
            },
            **{sign: {} for sign in ("a", "c", "p", "p0", "t0", "F", "F0T", "h")},
        }
        self.poses_now = poses
        self._screws()

    @staticmethod
    def _about(axis):
        return lambda angle: turn(np.eye(3)[axis], angle)

    def call(self, function):
        return np.array(getattr(self.model, function)(self.state, self.inputs, self.constants))

    def poses(self):
        """Return position and rotation of each body."""
        pairs = zip(self.call("positions"), self.call("orientations"), strict=True)
        found = dict(zip(self.model.BODIES, pairs, strict=True))
        return found | {self.mechanism.ground: (np.zeros(3), np.eye(3))}

    def number(self, vector):
        return np.array([float(sp.sympify(c).subs(self.values)) for c in vector])

    def carried(self, body, point):
        """Return where a body has a hardpoint now, and where at the design position."""
        position = next(p for p in self._points() if p.name == point).position
        start = self.number(position)
        (now, turned), (rest, _) = self.poses_now[body], self.resting[body]
        return now + turned @ (start - rest), start

    def _points(self):
        return [p for joint in self.mechanism.joints for p in parts((joint,)) if is_point(p)]

    def _axes(self):
        found = {}
        for joint in self.mechanism.joints:
            if joint.kind not in ("revolute", "prismatic"):
                continue
            line = joint.axis.vector if isinstance(joint, Revolute) else joint.direction.components
            u = self.number(line)
            u /= np.linalg.norm(u)
            if isinstance(joint, Revolute) and joint.angle_to is not None:
                arm = self.number(joint.angle_to.position - joint.axis.through.position)
                if u @ np.cross(self.number(joint.angle_from.components), arm) < 0:
                    u = -u  # its angle lies between 0 and pi at the design position
            found[joint.name.replace("_", " ")] = V(u)
        return found

    def _screws(self):
        """Read the table of the screws, and what a formula needs of the joints beside it."""
        rows = re.findall(
            r"^\| \$`\\beta_\{(\d+)\}`\$ +\| \$`(.*?)`\$ +\| (.*?) *\|$", self.text, re.MULTILINE
        )
        for number, axis, place in rows:
            k = int(number)
            self.signs["a"][k] = eval(python(axis), self.signs)
            if place != "slides along it":
                point, body = re.fullmatch(r"`(\w+)` of \d+ (\w+)", place).groups()
                self.signs["p"][k], self.signs["p0"][k] = map(V, self.carried(body, point))
            joint = self.mechanism.coordinates[k - 1].joint
            if joint.kind == "cylindrical":
                self.signs["t0"][k] = V(self.number(joint.axis.through.position))
            if joint.kind == "universal":
                first = self.number(joint.first_axis.components)
                now = self.poses_now[joint.first.name][1] @ first
                second = np.cross(self.number(joint.shaft.vector), first)
                second = self.poses_now[joint.second.name][1] @ second
                self.signs["h"][joint.name] = V(np.cross(second, now))

    def equations(self):
        """Return the printed equations of bodies: sign, index, right-hand side."""
        shown = re.findall(r"```math\n(\S+) = (.*)\n```", self.text)
        found = ((re.fullmatch(r"(\w+)\[(\d+)\]", python_or(left)), right) for left, right in shown)
        return [(m[1], int(m[2]), python(right)) for m, right in found if m]


def python_or(formula):
    """Return the left-hand side of an equation as Python reads it; nothing of those in words."""
    try:
        return python(formula)
    except AssertionError:
        return ""


def numbered(values):
    return {k: V(value) for k, value in enumerate(values, 1)}


def is_point(part):
    return isinstance(part, Point)


@pytest.mark.parametrize("name", [n for n in NAMES if n != "rigid_axle"])  # as the steered one
def test_printed_motion_is_what_the_compiled_functions_give(name):
    """Poses and velocities of each body, from the printed formulas alone.

    Angles have been through sine and arc: lengths of metres keep 1e-12 m, rates of 0.02/s as much.
    """
    place = Place(name)
    velocities = dict(zip(place.model.BODIES, place.call("velocities"), strict=True))
    of_number = {number: body for body, number in place.numbers.items()}
    checked = []
    for sign, index, formula in place.equations():
        found = eval(formula, place.signs)
        if sign == "F":
            at_rest = place.signs | {"beta": place.signs["beta0"]}
            place.signs["F"][index] = found
            place.signs["F0T"][index] = V(eval(formula, at_rest).value.T)
            continue
        if sign == "c":
            place.signs["c"][index] = found
            continue
        twist = velocities[of_number[index]]
        expected = {
            "A": place.signs["A"].get(index),
            "s": place.signs["s"].get(index),
            "omega": V(twist[:3]),
            "v": V(twist[3:]),
        }[sign]
        np.testing.assert_allclose(
            found.value, expected.value, atol=1e-12, err_msg=f"{sign}{index}"
        )
        checked.append((sign, index))
    assert len(set(checked)) == len(checked)
    massive = {place.numbers[b] for b in place.model.MASSIVE_BODIES}
    assert {i for s, i in checked if s == "v"} <= massive
    if hasattr(place.model, "absolute_jacobian"):
        assert checked
        assert {i for s, i in checked if s == "omega"} == massive
