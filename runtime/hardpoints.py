"""Where the hardpoints are in a given position of the suspension."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .model import Model

Array = NDArray[np.float64]

# Which body carries a point; the others are fixed to the chassis.
_CARRIERS = {
    "ball_joint": "knuckle",
    "tie_rod_outer": "knuckle",
    "wheel_center": "knuckle",
    "tie_rod_inner": "rack",
    "strut_lower": "knuckle",
    "spring_seat": "knuckle",
}
_FIXED = ("arm_front", "arm_rear", "strut_top", "spring_top")


def hardpoints(model: Model, state: ArrayLike, inputs: ArrayLike | None = None) -> dict[str, Array]:
    """Return the hardpoints in chassis axes.

    Parameters
    ----------
    model : Model
    state, inputs : array_like
        One state or many, as in the compiled module.

    Returns
    -------
    dict
        Name to position [m], shape (..., 3). Points that the file leaves out are where those are
        that stand in for them.

    Examples
    --------
    >>> model = Model("reference_car")
    >>> hardpoints(model, model.design_state)["tie_rod_inner"].round(12).tolist()
    [-0.14, -0.31, 0.28]
    """
    points, bodies = model.suspension.hardpoints, model.equations.BODIES
    rigid = model.suspension.bodies.rigid()
    centers = model.evaluate("positions", state, inputs)
    rotations = model.evaluate("orientations", state, inputs)
    moved = {}
    for point, body in _CARRIERS.items():
        index = bodies.index(body)
        arm = points.metres(point) - rigid[body].centre_of_mass(points)
        moved[point] = centers[..., index, :] + rotations[..., index, :, :] @ arm
    shape = centers.shape[:-2]
    return moved | {point: np.broadcast_to(points.metres(point), (*shape, 3)) for point in _FIXED}
