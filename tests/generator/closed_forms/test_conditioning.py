"""Towards every singular set, results keep all distances to 1e-9 or are refused.

Hardpoints and coordinates are moved until a guard's quantity vanishes, and from there back by
decreasing powers of ten. What a model returns on the way is given to the joints of the oracle,
which reads nothing but the declaration: gaps of joints, and axes that must be orthonormal.
"""

import numpy as np
import pytest
from kintrafo.equations.errors import ModelError, ParameterError
from kintrafo.generator.mechanisms import MODELS
from mechanisms.every_closed_form import MODELS as OWN
from mechanisms.iterated_loops import KNEE
from mechanisms.scotch_yokes import SCOTCH_YOKE
from oracle.maximal import Motion
from support.models import Built, needs_gcc, own, shipped

PROMISED = 1e-9
FREE = 4  # hardpoint coordinates that are moved, besides those of the joints
DESCENT = 12
# Each closed form of the shipped models once: the others are made of the same.
SHIPPED = (
    "macpherson",
    "macpherson_general",
    "double_wishbone",
    "four_bar",
    "slider_crank",
    "excavator",
    "excavator_lifting",
)
# Of masses, of a tyre and of angles that are only reported: no pose depends on them.
NO_POSE = ("pivot", "cos_camber", "shaft_level")
CASES = (*(model for model in MODELS if model.name in SHIPPED), *OWN, SCOTCH_YOKE, KNEE)


def module_of(model):
    """Return the compiled module of a model."""
    return shipped(model) if model in MODELS else own(model, derivatives=False)


class Place:
    """A model at hardpoints and coordinates, all of which are one vector."""

    def __init__(self, model, random):
        self.model, self.module = model, module_of(model)
        points = [
            name
            for name, entry in self.module.PARAMETERS.items()
            if entry["unit"] == "m" and name.endswith(("_x", "_y", "_z")) and "com_" not in name
        ]
        # not out of a plane in which the loops must stay
        points = [name for name in points if self._stays(name)]
        self.moved = [str(n) for n in random.choice(points, min(FREE, len(points)), replace=False)]
        design = Built.of(model, self.module)
        self.state = np.zeros(len(self.module.STATE))
        self.state[: design.size] = design.design
        self.start = np.concatenate([np.zeros(len(self.moved)), np.zeros(design.size)])

    def _stays(self, name):
        values = {n: e["default"] for n, e in self.module.PARAMETERS.items()}
        try:
            self.module.prepare(values | {name: values[name] + 1e-3})
        except ParameterError:
            return False
        return True

    def at(self, x):
        """Return the model with moved hardpoints, and the state."""
        defaults = {n: e["default"] for n, e in self.module.PARAMETERS.items()}
        changes = dict(zip(self.moved, x[: len(self.moved)], strict=True))
        built = Built(
            self.model, self.module, defaults | {n: defaults[n] + by for n, by in changes.items()}
        )
        state = self.state.copy()
        state[: x.size - len(self.moved)] += x[len(self.moved) :]
        return built, state

    def margin(self, x, guard):
        """Return how far a quantity is over its floor; NaN where there is no model."""
        built, state = self.at(x)
        try:
            return float(built("margins", state)[guard])
        except ModelError:
            return np.nan

    def error(self, x):
        """Return by how much the joints gape, as a part of the size; None if that is refused."""
        built, state = self.at(x)
        try:
            centers, axes = built("positions", state), built("orientations", state)
        except ModelError:
            return None
        motion = Motion(
            np.concatenate((np.zeros((1, 3)), centers)),
            np.concatenate((np.eye(3)[None], axes)),
            np.zeros((len(centers) + 1, 6)),
        )
        gram = axes @ axes.swapaxes(1, 2) - np.eye(3)
        size = max(1.0, float(np.abs(centers).max()))
        return max(
            float(np.abs(built.oracle.closure(motion).value).max()) / size,
            float(np.abs(gram).max()),
        )


def singular(place, guard, random):
    """Return a start, and a place where a quantity has vanished or is as small as it gets."""
    start = place.start + 0.02 * random.standard_normal(place.start.size)
    x = start
    for _ in range(DESCENT):
        here = place.margin(x, guard)
        if not here > 0.0:
            break
        steps = 1e-7 * np.eye(x.size)
        slope = np.array(
            [(place.margin(x + s, guard) - place.margin(x - s, guard)) / 2e-7 for s in steps]
        )
        slope = np.nan_to_num(slope)
        if not slope.any():
            break
        # Newton's step of the root, which is linear about a place where a square vanishes
        step = -2.0 * here * slope / (slope @ slope)
        x = x + step * min(1.0, 0.3 / np.abs(step).max())
    return start, x


@needs_gcc
@pytest.mark.parametrize("model", CASES, ids=lambda model: model.name)
def test_right_or_refused_beside_a_singular_set(model):
    for number, (guard, _) in enumerate(module_of(model).GUARDS):
        if guard.startswith(NO_POSE):
            continue
        random = np.random.default_rng(len(guard))
        place = Place(model, random)
        start, end = singular(place, number, random)
        assert place.error(start) is not None, guard
        for power in range(0, 15, 2):
            error = place.error(end + 10.0**-power * (start - end))
            assert error is None or error < PROMISED, (guard, power, error)
