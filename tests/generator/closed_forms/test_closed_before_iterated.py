"""A closed form before a loop that iterates, and much faster than the coordinate of both.

A long lever, or a slide, turns a short crank by a rod; the crank drives a six-bar linkage that has
no closed form. When the pin of the lever is too near to the crank or too far, the rod cannot close:
the law of cosines says where. The lever passes such a gap within a small angle, and behind it the
crank is where it was before.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from mechanisms import iterated_loops
from mechanisms.every_closed_form import NORMAL, askew, declare, guide, heading, hinge
from mechanisms.random_loops import REGULAR, Follower
from support.models import Built, needs_gcc, own
from support.placements import Placements

PINS = {name: (one, two, at) for name, one, two, at in iterated_loops.STEPHENSON_PINS}
CRANK, END = (np.array(PINS[name][2]) for name in ("arm_hinge", "arm_pin"))
RADIUS = float(np.linalg.norm(END - CRANK))


@cache
def model(drive):
    """Return the linkage, driven by a "lever" or a "slide"; its dimensions are parameters."""
    pins = PINS | {
        "lever_hinge": ("ground", "lever", (1.5, 0.4)),
        "lever_pin": ("lever", "rod", (1.4, 0.7)),
        "rod_pin": ("rod", "arm", tuple(END)),
    }
    directions = {"normal": NORMAL}
    first = hinge("lever_hinge", "ground", "lever", "lever_hinge_at", "normal")
    if drive == "slide":
        directions["along"] = heading(0.5)
        first = guide("lever_hinge", "ground", "lever", "along")
    places = {}
    for one, two, at in pins.values():
        places.setdefault(one, []).append(at)
        places.setdefault(two, []).append(at)
    others = [
        hinge(name, one, two, f"{name}_at", "normal")
        for name, (one, two, _) in pins.items()
        if name != "lever_hinge"
    ]
    return declare(
        f"fast_{drive}",
        {b: askew(*np.mean(at, axis=0), 0.01) for b, at in places.items() if b != "ground"},
        (first, *others),
        {
            **{f"{name}_at": askew(*at) for name, (_, _, at) in pins.items()},
            "ground_top": askew(0.2, 0.7, 0.05),
            "coupler_seat": askew(0.15, 0.3),
        },
        directions,
        ("lever_hinge",),
        spring=("ground_top", "coupler_seat"),
        massive=("coupler",),
        allow_iteration=True,
    )


def turned(vector, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector


@dataclass(frozen=True)
class Drive:
    """Position of the drive of the crank.

    Attributes
    ----------
    places
        Of its pins.
    along
        The direction of a slide.
    middle
        The coordinate at which the lever is in line with the crank, or the slide is nearest to it.
    lengths
        Of lever, ground and rod.
    """

    kind: str
    places: dict[str, np.ndarray]
    along: np.ndarray
    middle: float
    lengths: tuple[float, float, float]

    @classmethod
    def of(cls, kind, ratio, gap, start):
        """Return the drive with a lever that is `ratio` times as long as the crank.

        Parameters
        ----------
        gap
            How far the rod is from closing in line, in radii of the crank.
        start
            How far the pin of the lever is at design from where it closes first, in the same.
        """
        lever = ratio * RADIUS
        ground = 1.5 * lever
        nearest = ground - lever if kind == "lever" else lever
        rod = nearest + (1.0 + gap) * RADIUS
        far = rod - RADIUS + start * RADIUS
        bend = np.arccos((RADIUS**2 + far**2 - rod**2) / (2.0 * RADIUS * far))
        to_pin = turned((END - CRANK) / RADIUS, bend)
        pin = CRANK + far * to_pin
        if kind == "lever":
            aside = np.arccos((ground**2 + far**2 - lever**2) / (2.0 * ground * far))
            center = CRANK + ground * turned(to_pin, aside)
            one, two = CRANK - center, pin - center
            angle = np.arctan2(one[0] * two[1] - one[1] * two[0], one @ two)
            along, middle = np.array([1.0, 0.0]), -angle
        else:
            center, aside = pin + 0.1, np.arccos(nearest / far)
            along, middle = turned(to_pin, aside + np.pi / 2), far * np.sin(aside)
        places = {"lever_hinge": center, "lever_pin": pin, "rod_pin": END}
        return cls(kind, places, along, float(middle), (lever, ground, rod))

    def far(self, inputs):
        """Return how far the pin of the lever is from the hinge of the crank."""
        lever, ground, _ = self.lengths
        off = inputs - self.middle
        if self.kind == "slide":
            return np.hypot(lever, off)
        return np.sqrt(lever**2 + ground**2 - 2.0 * lever * ground * np.cos(off))

    def closes(self, inputs):
        """Return where the rod closes all the way from the design position."""
        rod, whole = self.lengths[2], []
        for value in inputs:
            far = self.far(np.linspace(0.0, value, 2001))
            whole.append(((rod - RADIUS < far) & (far < rod + RADIUS)).all())
        return np.array(whole)

    def parameters(self):
        """Return all parameters of the linkage."""
        points = {f"{name}_at": askew(*at) for name, at in self.places.items()}
        found = {p.name: p.default for p in model(self.kind).mechanism.parameters}
        if self.kind == "slide":
            points["along"] = heading(float(np.arctan2(self.along[1], self.along[0])))
        return found | {
            f"{name}_{axis}": x
            for name, at in points.items()
            for axis, x in zip("xyz", at, strict=True)
            if f"{name}_{axis}" in found
        }


@pytest.mark.parametrize("kind", ["lever", "slide"])
@pytest.mark.parametrize("ratio", [3.0, 100.0])
@pytest.mark.parametrize(
    ("gap", "start"), [(0.03, 1.0), (0.3, 1.0), (1.0, 1.0), (0.03, 0.4), (1.0, 0.4), (0.3, 1.6)]
)
def test_no_answer_is_behind_a_gap(kind, ratio, gap, start):
    drive = Drive.of(kind, ratio, gap, start)
    inputs = np.linspace(-0.5, 3.0, 71) * drive.middle
    parameters = drive.parameters()
    answered, _, _ = Placements.of(model(kind)).at(parameters, inputs[:, None])
    assert not answered[~drive.closes(inputs)].any()
    if start != 1.0:
        return
    for sense in (-1.0, 1.0):
        follower = Follower(model(kind), parameters)
        for value in np.linspace(0.0, 0.5, 11)[1:] * sense * drive.middle:
            if not (follower.go(np.array([value])) and follower.least > REGULAR):
                break
            at = np.argmin(np.abs(inputs - value))
            assert answered[at]


@needs_gcc
def test_c_answers_what_numpy_answers():
    drive = Drive.of("lever", 27.0, 0.3, 1.0)
    inputs = np.linspace(-0.5, 3.0, 71) * drive.middle
    parameters = drive.parameters()
    expected, _, _ = Placements.of(model("lever")).at(parameters, inputs[:, None])
    module = own(model("lever"), derivatives=False)
    compiled = replace(Built.of(model("lever"), module), parameters=parameters)
    margins = compiled("margins", np.stack([inputs, np.zeros_like(inputs)], axis=1))
    np.testing.assert_array_equal((margins > 0.0).all(axis=1), expected)
