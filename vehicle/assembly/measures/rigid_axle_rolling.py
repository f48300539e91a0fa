"""Formulas of roll centre and jacking of a rigid axle.

Each takes a `RigidAxleKinematics` and returns an array over its positions, SI units, chassis axes.

Source: J. C. Dixon, Suspension Geometry and Computation, Wiley, 2009 (rigid axles).
"""

import numpy as np

from ....core.named_types import Array
from ...models.rigid_axle.model import HEAVE, ROLL
from ...models.rigid_axle.structure import BEAM
from ...models.sides import LEFT, RIGHT, SIDES
from ..whole_axle_kinematics import RigidAxleKinematics
from .whole_axle import dot


def roll_center_height(beam: RigidAxleKinematics) -> Array:
    """Return the height of the roll centre above the line through the contacts [m].

    In front view it lies on the perpendicular bisector of the contacts: the point that does not
    move along the line through the contacts when the axle rolls and their middle does not move
    across this line. A force along the line at this point does no work in roll.
    """
    left, right = (beam.contact(side) for side in SIDES)
    middle, line = 0.5 * (left + right), (left - right)[:, 1:]
    line = line / np.linalg.norm(line, axis=-1, keepdims=True)
    across = np.stack([-line[:, 1], line[:, 0]], -1)
    roll, heave = (beam.velocity_of(BEAM, middle, by)[:, 1:] for by in (ROLL, HEAVE))
    times = -dot(across, roll) / dot(across, heave)
    velocity = roll + times[:, None] * heave
    turning = beam.turning_of(BEAM, ROLL)[:, 0] + times * beam.turning_of(BEAM, HEAVE)[:, 0]
    return dot(line, velocity) / turning


def jacking(beam: RigidAxleKinematics) -> Array:
    """Return the lift of the body by a force on the tyres to the left, over that force [1].

    By virtual work the force pushes the axle up, and the body down, if the axle moves to the left
    as it rises.
    """
    middle = 0.5 * (beam.contact(LEFT) + beam.contact(RIGHT))
    velocity = beam.velocity_of(BEAM, middle, HEAVE)
    return -velocity[:, 1] / velocity[:, 2]
