"""The constants that a peer's hand-written closed form needs, prepared once from the parameters.

Vectors of the chassis are in the hinge frame: origin at the foot of the ball joint on the arm's
hinge, axes along the hinge (x), outboard (y) and up (z) as the oracle defines them. Vectors of the
knuckle are from the ball joint in its strut frame: first axis from the strut top to the ball joint,
second towards the outer end of the tie rod, third completing it.
"""

from dataclasses import dataclass

import numpy as np

from .case import ARM, KNUCKLE, Array, car


@dataclass(frozen=True)
class Constants:
    """Prepared geometry and inertia of the reference car, SI units."""

    arm_radius: float  # distance of the ball joint from the hinge
    # fixed points, hinge frame, (3,)
    strut_top: Array
    tie_rod_inner: Array
    up: Array  # vertical, hinge frame, (3,)
    foot_height: float  # height of the frame's origin above the ground
    rod: Array  # outer end of the tie rod in the strut frame; its third component is zero, (2,)
    rod_length_squared: float  # of the tie rod
    branch: float  # sign of the closed form's root
    # strut frame, (3,)
    wheel: Array
    spin_axis: Array
    knuckle_com: Array
    knuckle_inertia: Array  # about its centre of mass, strut frame, (3, 3)
    arm_com: Array  # along the hinge, along the lever, across (hinge x lever), (3,)
    arm_inertia: Array  # about its centre of mass in these axes, (3, 3)


def strut_frame() -> Array:
    """Return the rows of the knuckle's strut frame at design, chassis axes; shape (3, 3)."""
    point = car().points
    along = point["ball_joint"] - point["strut_top"]
    along = along / np.linalg.norm(along)
    across = point["tie_rod_outer"] - point["ball_joint"]
    across = across - (across @ along) * along
    across = across / np.linalg.norm(across)
    return np.array([along, across, np.cross(along, across)])


def arm_frame() -> Array:
    """Return the rows hinge, lever, hinge x lever at design, chassis axes; shape (3, 3)."""
    mechanism = car()
    lever = mechanism.points["ball_joint"] - mechanism.hinge_foot
    lever = lever / np.linalg.norm(lever)
    return np.array([mechanism.hinge[0], lever, np.cross(mechanism.hinge[0], lever)])


def prepared() -> Constants:
    """Return the constants of the reference car."""
    mechanism = car()
    point, hinge = mechanism.points, mechanism.hinge
    frame, arm = strut_frame(), arm_frame()
    ball, foot = point["ball_joint"], mechanism.hinge_foot
    rod_vector = point["tie_rod_outer"] - point["tie_rod_inner"]
    rod = frame @ (point["tie_rod_outer"] - ball)
    reach = frame @ (point["tie_rod_inner"] - ball)
    return Constants(
        arm_radius=float(np.linalg.norm(ball - foot)),
        strut_top=hinge @ (point["strut_top"] - foot),
        tie_rod_inner=hinge @ (point["tie_rod_inner"] - foot),
        up=hinge @ np.array([0.0, 0.0, 1.0]),
        foot_height=float(foot[2]),
        rod=rod[:2],
        rod_length_squared=float(rod_vector @ rod_vector),
        branch=float(np.sign(-reach[2])),
        wheel=frame @ (point["wheel_center"] - ball),
        spin_axis=frame @ mechanism.spin_axis,
        knuckle_com=frame @ (mechanism.centres[KNUCKLE] - ball),
        knuckle_inertia=frame @ mechanism.inertias[KNUCKLE - 1] @ frame.T,
        arm_com=arm @ (mechanism.centres[ARM] - foot),
        arm_inertia=arm @ mechanism.inertias[ARM - 1] @ arm.T,
    )
