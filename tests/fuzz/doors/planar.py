"""Random planar linkages: closed loops and accelerations, in maximal coordinates.

A linkage grows from the ground: by a body on a hinge or a guide, which moves by itself, or by two
bodies between two others, with hinges and one guide at most. The independent coordinates are those
that are proposed.
"""

import tempfile
import warnings
from pathlib import Path

import numpy as np
from kintrafo import generator as g
from kintrafo.core.errors import KintrafoError
from kintrafo.generator.equations.outputs import generate
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.planning.proposal import CoordinateSearch
from kintrafo.systems.compile.build import build
from kintrafo.systems.compile.declaration import translated_errors
from kintrafo.systems.compile.loader import load
from support.models import Built

from ..attempts import UnjudgedError, WrongError

SECONDS = 180.0
SHORT = 3

_NEAR = 0.02  # how far from the design position the coordinates are taken
_REGULAR = 1e-3  # least singular value of what determines the accelerations, of the greatest


def attempt(random):
    """Draw a linkage, derive it, and compare."""
    mechanism = _Drawn(random).mechanism
    model = _model_of(mechanism)
    with translated_errors(model):
        derived = generate(model, derivatives=False)
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("error")
        target = Path(folder) / f"{model.name}-{random.integers(2**62):x}"
        target.mkdir()
        build(derived, target, None)
        built = Built.of(model, load(target))
        compared = sum(_compared(built, random) for _ in range(4))
    if not compared:
        raise UnjudgedError("next to a dead point")


def _model_of(mechanism):
    """Return the first proposed model, with iteration where there is no closed form."""
    every = tuple(c.joint for c in mechanism.coordinates)
    search = CoordinateSearch(g.Formulation("planar", "t", mechanism, every))
    with translated_errors():
        found = next(search.closed(10.0), None)
        if found is not None:
            return search.model(found.independent)
        found = next(search.iterated(10.0), None)
        if found is None:
            raise NoClosedFormError(search.refusal())
        return search.model(found.independent, allow_iteration=True)


def _compared(built, random):
    """Compare at a position near the design position; whether that was possible."""
    near = built.design + _NEAR * random.standard_normal(built.size)
    state = np.concatenate((near, random.standard_normal(built.size)))
    try:
        motion, found = built.motion(state, np.zeros(0)), built("rhs", state, np.zeros(0))
    except KintrafoError as error:
        if "cannot close" not in str(error):
            raise
        return False
    found = found[built.size :]
    closure = built.oracle.closure(motion)
    if np.abs(closure.value).max(initial=0.0) > 1e-10:
        raise WrongError(f"a loop is open: {closure.value}")
    if np.abs(closure.rate).max(initial=0.0) > 1e-7 * max(np.abs(motion.twist).max(), 1.0):
        raise WrongError(f"a loop is opening: {closure.rate}")
    expected = built.oracle.reduced(motion, {}, {}).accelerations
    sizes = np.abs(motion.twist).max()
    if sizes > 1.0 / _REGULAR:
        return False
    # both solve linear equations whose condition is that of the rates, squared
    if np.abs(found - expected).max() > 1e-9 * sizes**2 * max(np.abs(expected).max(), 1.0):
        raise WrongError(f"accelerations {found}, in maximal coordinates {expected}")
    return True


class _Drawn:
    """A linkage, drawn step by step."""

    def __init__(self, random):
        self._random = random
        self._normal = "yz"[random.integers(2)]
        self._bodies = [g.Ground("ground")]
        self._joints = []
        self._single()
        for _ in range(random.integers(1, 4)):
            grow = self._single if random.random() < 0.3 else self._double
            grow()

    @property
    def mechanism(self):
        upward = {} if self._normal == "y" else {"upward": g.Direction("upward", fixed=(1, 2, 0))}
        one, other = (self._bodies[i] for i in (0, -1))
        spring = g.LinearSpring(
            g.SpringRate("rate", 50.0, "rate"), free_length=g.Length("free", 0.2, "length")
        )
        ends = (one, self._point("seat")), (other, self._point("end"))
        forces = g.Weight(**upward), g.ForceElement("spring", g.AlongLine(*ends), (spring,))
        named = tuple(
            j.angle(f"q_{j.name}", "q")
            if isinstance(j, g.Revolute)
            else j.slide(f"q_{j.name}", "q")
            for j in self._joints
        )
        return g.Mechanism("planar", "t", tuple(self._joints), forces, named)

    def _single(self):
        parent = self._bodies[self._random.integers(len(self._bodies))]
        self._joint(parent, self._body(), slides=self._random.random() < 0.3)

    def _double(self):
        """Add two bodies in a row between two that are there."""
        first, second = self._random.choice(len(self._bodies), size=2, replace=False)
        one, other = self._body(), self._body()
        guide = int(self._random.integers(6))  # in half of the cases none
        pairs = (self._bodies[first], one), (one, other), (self._bodies[second], other)
        for place, (near, far) in enumerate(pairs):
            self._joint(near, far, slides=place == guide)

    def _body(self):
        name = f"body_{len(self._bodies)}"
        mass, inertia = self._random.uniform(0.5, 2.0), self._random.uniform(0.005, 0.02)
        body = g.Body(name, mass, self._point(f"{name}_com"), inertia)
        self._bodies.append(body)
        return body

    def _joint(self, first, second, *, slides):
        name = f"j{len(self._joints)}"
        if slides:
            ends = self._point(f"{name}_start"), self._point(f"{name}_end")
            way = g.Direction(f"{name}_way", between=ends)
            self._joints.append(g.Prismatic(name, first, second, way))
        else:
            self._joints.append(g.hinge(name, first, second, self._point(name)))

    def _point(self, name):
        x, y = self._random.uniform(-0.3, 0.3, size=2)
        return g.flat(name, (float(x), float(y)), normal=self._normal)
