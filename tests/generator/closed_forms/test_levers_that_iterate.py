"""A long lever that drives the links of a loop without a closed form, and passes gaps.

A four-bar linkage carries a link to the pin of a lever, which drives it; together they have no
closed form. The oracle has one for the four-bar linkage alone (two circles), and follows its crank
in tiny steps of the lever, by the distance between both ends of the link, until that has no slope
along the crank: a dead point. The levers are mounted so that their pin passes just outside of where
the link reaches: there is a gap, within a small angle of a long lever.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest
from mechanisms import iterated_loops
from mechanisms.every_closed_form import askew
from numpy.typing import NDArray
from support.placements import Placements

MODEL = iterated_loops.STEPHENSON
PINS = {name: complex(*at) for name, _, _, at in iterated_loops.STEPHENSON_PINS}
RATIOS = [1.0, 3.0, 27.0, 300.0, 1000.0]
PASSED = {3.0: 280, 27.0: 374, 300.0: 121}
"""Of each ratio a lever that has been seen to get over its gap."""
COUNT = 40
"""Positions of each lever."""
STEP, STEPS = 2e-3, 12000
"""Of the oracle, along the way of crank (rad) and lever (parts of the whole)."""
Plane = NDArray[np.complex128]
Array = NDArray[np.float64]


def carried(crank):
    """Return where the pins of crank, rocker and link are, by the angle from the crank's design."""
    pin = PINS["crank_hinge"] + (PINS["crank_pin"] - PINS["crank_hinge"]) * np.exp(1j * crank)
    coupler, rocker = (abs(PINS["rocker_pin"] - PINS[end]) for end in ("crank_pin", "rocker_hinge"))
    to = PINS["rocker_hinge"] - pin
    along = (abs(to) ** 2 + coupler**2 - rocker**2) / (2.0 * abs(to))
    knee = pin + to / abs(to) * (along + 1j * np.sqrt(coupler**2 - along**2))
    ahead = (PINS["link_pin"] - PINS["crank_pin"]) / (PINS["rocker_pin"] - PINS["crank_pin"])
    return pin, knee, pin + (knee - pin) * ahead


@dataclass(frozen=True)
class Levers:
    """Many levers, each on a linkage of its own.

    Attributes
    ----------
    pin, hinge
        Of each lever, at design.
    crank
        Angle of the crank there.
    farthest
        How far the lever turns.
    """

    pin: Plane
    hinge: Plane
    crank: Array
    farthest: Array

    @classmethod
    def passing(cls, ratio, count):
        """Return levers that are `ratio` times as long as the link, and pass by a gap.

        The link stands across the way of its pin where the lever passes: there it is at a dead
        point, or just too short.
        """
        rng = np.random.default_rng(int(ratio))
        link, small = abs(PINS["arm_pin"] - PINS["link_pin"]), 1e-5
        dead = rng.uniform(-np.pi, np.pi, count)
        at = carried(dead)[2]
        ahead = carried(dead + small)[2] - carried(dead - small)[2]
        across = 1j * ahead / abs(ahead) * rng.choice([-1, 1], count)
        gap = link * 10.0 ** rng.uniform(-3.0, 0.0, count) * rng.choice([-1, 1], count)
        middle = at + across * (link + gap)
        hinge = middle + across * ratio * link * rng.choice([-1, 1], count)
        turned = (
            10.0 ** rng.uniform(-1.5, 0.5, count) / max(ratio, 3.0) * rng.choice([-1, 1], count)
        )
        pin = hinge + (middle - hinge) * np.exp(1j * turned)
        found = cls(pin, hinge, dead + rng.uniform(-0.7, 0.7, count), -4.0 * turned)
        for _ in range(20):
            step = found.apart(found.crank, 0.0 * turned) / found.slope(found.crank, 0.0 * turned)
            found = replace(found, crank=found.crank - np.clip(step, -0.1, 0.1))
        return found.chosen(
            (abs(found.apart(found.crank, 0.0 * turned)) < 1e-12)
            & (abs(found.slope(found.crank, 0.0 * turned)) > 0.03)
        )

    def chosen(self, which):
        return Levers(self.pin[which], self.hinge[which], self.crank[which], self.farthest[which])

    def apart(self, crank, lever):
        """Return by how much of itself the link is too short."""
        pin = self.hinge + (self.pin - self.hinge) * np.exp(1j * lever)
        return abs(pin - carried(crank)[2]) / abs(PINS["arm_pin"] - PINS["link_pin"]) - 1.0

    def slope(self, crank, lever):
        small = 1e-5
        return (self.apart(crank + small, lever) - self.apart(crank - small, lever)) / (2 * small)

    @property
    def inputs(self):
        """Return angles of the levers, in rows."""
        return self.farthest[:, None] * np.arange(1, COUNT + 1) / COUNT

    def reached(self):
        """Return how many positions a path leads to: it ends where the lever turns back."""
        crank, part = self.crank, 0.0 * self.crank
        before, end = np.stack([0.0 * part, 1.0 + part]), 0.0 * part
        going = np.ones(len(part), bool)
        for _ in range(STEPS):
            by_crank, by_part = self.gradient(crank, part)
            along = np.stack([-by_part, by_crank]) / np.hypot(by_crank, by_part)
            along *= np.sign((along * before).sum(axis=0))
            going &= along[1] > 0.0
            before, end = along, np.where(going, part, end)
            crank, part = crank + STEP * along[0], part + STEP * along[1]
            for _ in range(2):
                by_crank, by_part = self.gradient(crank, part)
                off = self.apart(crank, self.farthest * part) / np.hypot(by_crank, by_part) ** 2
                crank, part = crank - off * by_crank, part - off * by_part
            going &= end < 1.0
            if not going.any():
                return np.floor(np.minimum(end, 1.0) * COUNT).astype(int)
        message = "too few steps"
        raise AssertionError(message)

    def gradient(self, crank, part):
        small, lever = 1e-5, self.farthest * part
        more, less = (self.apart(crank, lever + s * small * self.farthest) for s in (1, -1))
        return self.slope(crank, lever), (more - less) / (2 * small)

    def parameters(self, which):
        """Return all parameters of a linkage."""
        names = "crank_pin", "rocker_pin", "link_pin", "arm_pin", "arm_hinge"
        places = *carried(self.crank[which]), self.pin[which], self.hinge[which]
        found = {p.name: p.default for p in MODEL.mechanism.parameters}
        for name, at in zip(names, places, strict=True):
            point = askew(float(at.real), float(at.imag))
            found |= {f"{name}_at_{axis}": x for axis, x in zip("xyz", point, strict=True)}
        return found


@cache
def some(ratio):
    """Return levers, and how many positions of each a path leads to."""
    every = Levers.passing(ratio, 1000)
    levers = every.chosen(np.array([*range(12), PASSED.get(ratio, 12)]))
    return levers, levers.reached()


@pytest.mark.parametrize("ratio", RATIOS)
def test_no_answer_is_behind_a_gap(ratio):
    levers, reached = some(ratio)
    for k, count in enumerate(reached):
        inputs = levers.inputs[k][:, None]
        answered, _, _ = Placements.of(MODEL).at(levers.parameters(k), inputs)
        np.testing.assert_array_equal(answered, np.arange(COUNT) < count)
