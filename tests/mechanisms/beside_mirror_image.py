"""A mechanism in company: a copy of it beside its mirror image, in one mechanism."""

from __future__ import annotations

from dataclasses import dataclass

import mpmath
import numpy as np
import sympy as sp
from kintrafo.generator import Copy, Formulation, Revolute, combined
from kintrafo.generator.equations.design import _angle, design_coordinates
from kintrafo.generator.equations.dynamics import Dynamics
from kintrafo.generator.equations.in_motion import InMotion
from kintrafo.generator.mechanisms import MODELS, chains, held_by_rods
from kintrafo.generator.mechanisms.n_four_bar import n_four_bar
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.program import ConstantStage, Function, Program, Step, ancestors
from support.symbolic import python

from mechanisms import (
    coupled_wheels,
    every_closed_form,
    every_force,
    iterated_loops,
    scotch_yokes,
    steering_shafts,
)

DIGITS = 40
COPIES = "a_", "b_"
EVERY = {
    model.name: model
    for model in (
        *MODELS,
        *held_by_rods.MODELS,
        *chains.MODELS,
        n_four_bar(2),
        *every_closed_form.MODELS,
        iterated_loops.CROSSED_RING,
        iterated_loops.BALL_RING,
        iterated_loops.BENNETT,
        iterated_loops.PLATE_ON_A_SLOT,
        iterated_loops.PLATE_ON_A_PIN,
        iterated_loops.ROCKERS,
        iterated_loops.FIVE_BAR,
        iterated_loops.DRIVEN_GUIDE,
        iterated_loops.FOUR_BAR_AT_ITS_KNEE,
        scotch_yokes.SCOTCH_YOKE,
        steering_shafts.crosses_in_a_row(),
        coupled_wheels.locomotive(),
        every_force.loaded_crank(),
        every_force.loaded_bar(),
    )
}
NOT_MIRRORED = ("rockers",)
"""It has a direction that is an axis of rotation and one of motion, which a mirror turns apart."""


@dataclass(frozen=True)
class Moving:
    """The accelerations of a model; to derive its other functions takes most of the time."""

    model: Formulation
    coordinates: tuple[str, ...]
    constants: tuple[Step, ...]
    accelerations: Function

    @classmethod
    def of(cls, model):
        """Derive them."""
        mechanism, plan = model.mechanism, CataloguePlan.of(model)
        driven = [c.name for c in mechanism.coordinates if c.joint in model.independent]
        stage = ConstantStage(
            tuple(sp.Symbol(p.name) for p in mechanism.parameters),
            frozenset([*driven, *(f"{n}_rate" for n in driven), *model.inputs]),
            derived={sp.Symbol(n): value for n, value in mechanism.derived.items()},
        )
        program = Program(stage)
        kin = InMotion.of(program, plan)
        found = Dynamics(kin).accelerations
        results = [stage.insert_derived(found[k]) for k in kin.coordinates.independent]
        steps = stage.steps | program.steps
        needed = ancestors(steps, results)
        return cls(
            model,
            tuple(kin.coordinates.independent),
            _derived(mechanism),
            _function([steps[s] for s in steps if s in needed], results, stage.blocks.values()),
        )

    def design(self):
        """Return the coordinates at the design position."""
        steps = design_coordinates(self.model)
        every = [Step(*step, "") for own in steps.values() for step in own]
        values = [sp.Symbol(k) if k in steps else sp.Integer(0) for k in self.coordinates]
        return list(map(mpmath.mpf, python(_function(every, values))(self._given())))

    def given_angles(self):
        """Return the positions at design of prescribed hinges that measure their angle."""
        found = {}
        for joint, motion in self.model.prescribed.items():
            given = motion.name
            if isinstance(joint, Revolute) and joint.angle_to is not None:
                steps = [Step(*step, "") for step in _angle(given, joint)]
                (angle,) = python(_function(steps, [sp.Symbol(given)]))(self._given())
                found[f"{given}_position"] = mpmath.mpf(angle)
        return found

    def __call__(self, values):
        """Return the accelerations at some state and inputs, with the default parameters."""
        return python(self.accelerations)(self._given() | dict(values))

    def _given(self):
        given = {p.name: mpmath.mpf(p.default) for p in self.model.mechanism.parameters}
        names = [step.symbol for step in self.constants]
        found = python(_function(self.constants, names))(given)
        return given | dict(zip(map(str, names), found, strict=True))


def _function(steps, results, blocks=()):
    results = tuple(results)
    labels = tuple(map(str, range(len(results))))
    return Function(
        "", "", tuple(steps), results, labels, (len(results),), (), blocks=tuple(blocks)
    )


def _derived(mechanism):
    """Return what the names of a copy stand for."""
    return tuple(Step(sp.Symbol(n), e, "") for n, e in mechanism.derived.items())


def in_company(model):
    """Return a copy of a model beside its mirror image."""
    one, two = (
        Copy(model.mechanism, prefix, mirrored=mirrored and model.name not in NOT_MIRRORED)
        for prefix, mirrored in zip(COPIES, (False, True), strict=True)
    )
    return Formulation(
        name="pair",
        title="Two of them",
        mechanism=combined("pair", "Two of them", (one, two)),
        independent=one.of(model.independent) + two.of(model.independent),
        prescribed=one.of(model.prescribed) | two.of(model.prescribed),
        massive=one.of(model.massive) + two.of(model.massive),
        allow_iteration=model.allow_iteration,
    )


def check_in_company(model, random):
    """See that a copy of a model and its image have the accelerations of the original."""
    one, two = Moving.of(model), Moving.of(in_company(model))
    with mpmath.workdps(DIGITS):
        off = 1e-3 * random.standard_normal(len(one.coordinates))
        rates = random.standard_normal(len(one.coordinates))
        state = dict(zip(one.coordinates, np.array(one.design()) + off, strict=True))
        state |= {f"{k}_rate": r for k, r in zip(one.coordinates, rates, strict=True)}
        inputs = model.inputs
        state |= dict(zip(inputs, 1e-3 * random.standard_normal(len(inputs)), strict=True))
        state |= one.given_angles()
        alone = one(state)
        together = two({f"{prefix}{k}": v for prefix in COPIES for k, v in state.items()})
    # Computed with 40 digits, of places that lie in planes to the rounding of doubles: where the
    # copies hang on another base than the original, so much is between them.
    size = max(map(abs, alone))
    for found, expected in zip(together, alone * 2, strict=True):
        assert abs(found - expected) <= 1e-15 * size
