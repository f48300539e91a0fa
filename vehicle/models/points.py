"""Positions and velocities of hardpoints in states of a suspension."""

from collections.abc import Mapping

import numpy as np

from ...core.columns import spread
from ...core.named_types import Array, ArrayLike
from ...core.validator import Validator
from ...core.vectors import cross, turned
from .model import Model


def hardpoints(
    model: Model,
    state: ArrayLike,
    inputs: ArrayLike | None = None,
    *,
    poses: tuple[Array, Array] | None = None,
) -> dict[str, Array]:
    """Return the positions of the hardpoints in chassis axes by name, (..., 3) [m].

    State and inputs, one or many, are as in the compiled module; `poses` are positions and
    orientations there, if they have been evaluated. A point that the file leaves out has the
    position of the point that replaces it.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> hardpoints(model, model.design_state)["tie_rod_inner"].round(12).tolist()
    [-0.14, -0.31, 0.28]
    """
    with Validator("hardpoints") as given:
        given.instance("model", model, Model, Model.NEEDED)
    points = model.suspension.hardpoints
    carriers, suspension = model.suspension.carriers, model.suspension
    at_design = {p: points.metres(p) for p in (*points.names(), *points.STAND_INS)}
    if suspension.steered():
        at_design |= suspension.steering_gear.points()
    moved = carried(
        model,
        {p: (carriers[p], place) for p, place in at_design.items() if p in carriers},
        state,
        inputs,
        poses=poses,
    )
    shape = (*next(iter(moved.values())).shape[:-1], 3)
    fixed = {p: place for p, place in at_design.items() if p not in carriers}
    return moved | {p: np.broadcast_to(spread(place), shape) for p, place in fixed.items()}


def carried(
    model: Model,
    points: Mapping[str, tuple[str, Array]],
    state: ArrayLike,
    inputs: ArrayLike | None = None,
    *,
    poses: tuple[Array, Array] | None = None,
) -> dict[str, Array]:
    """Return the positions of points on moving bodies, (..., 3) [m].

    `points` have any names: the body, and the position at design, chassis axes [m]. Other arguments
    are as in `hardpoints`.
    """
    bodies, at_design = model.equations.BODIES, _centers_of_mass(model)
    if poses is None:
        poses = (
            model.evaluate("positions", state, inputs),
            model.evaluate("orientations", state, inputs),
        )
    centers, rotations = poses
    return {
        name: centers[..., index, :]
        + turned(rotations[..., index, :, :], spread(place - at_design[body]))
        for name, (body, place) in points.items()
        for index in [bodies.index(body)]
    }


def carried_velocity(
    model: Model, body: str, place: Array, states: Array, inputs: Array | None = None
) -> Array:
    """Return the velocity of the point of a body at a position `place`, (..., 3) [m/s].

    `states` and `inputs` are as in the compiled module. Velocities are linear in the rates: those
    at a unit rate are derivatives.
    """
    which = model.equations.BODIES.index(body)
    twist = model.evaluate("velocities", states, inputs)[..., which, :]
    arm = place - model.evaluate("positions", states, inputs)[..., which, :]
    return twist[..., 3:] + cross(twist[..., :3], arm)


def _centers_of_mass(model: Model) -> dict[str, Array]:
    """Return the centres of mass of the rigid bodies at design [m], by body."""
    suspension = model.suspension
    points, bodies = suspension.hardpoints, suspension.bodies.rigid()
    own = {name: body.centre_of_mass(points) for name, body in bodies.items()}
    return own | (suspension.steering_gear.centers_of_mass() if suspension.steered() else {})
