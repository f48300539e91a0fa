"""Poses of the suspension by Newton's method in redundant maximal coordinates.

Each of the six moving bodies has a position of its centre of mass and a rotation matrix (relative
to its design orientation); the joints are written one by one as constraint equations between these
36 coordinates, 33 in all (`oracle.constraints`), and three drivers fix arm angle, wheel spin and
rack displacement. Nothing is eliminated and no closed form is used.

Units are SI, rotations rad; world axes are the chassis axes.
"""

from dataclasses import dataclass

import numpy as np

from oracle.constraints import (
    ARM,
    BODIES,
    CHASSIS,
    KNUCKLE,
    RACK,
    TIE_ROD,
    UPPER_STRUT,
    WHEEL,
    Array,
    Assembler,
    Equations,
    Pose,
    perpendiculars,
    skew,
    unit,
)
from oracle.reference import HARDPOINTS, STAND_INS, completed, inertia, vector

X_AXIS = np.array([1.0, 0.0, 0.0])
Z_AXIS = np.array([0.0, 0.0, 1.0])

# A continuation step moves the arm and the rack by at most these (rad, m).
ARM_STEP = 0.1
RACK_STEP = 0.02
# Smallest part of the way from start to goal that a step may be halved to.
SMALLEST_STEP = 1e-4
# Residual at which a step of the continuation counts as converged, before the final polish.
CONVERGED = 1e-10
# A body that turns by more than this in one step (rad) has probably jumped to another branch.
LARGEST_TURN = 0.6


class AssemblyError(RuntimeError):
    """The mechanism cannot be assembled, or only on another branch than that of the design."""


class Mechanism:
    """The suspension as bodies and joints.

    The control arm's angle beta1 is measured about the hinge from the upward vertical: with h_x
    the unit vector along the hinge, h_z the unit vector perpendicular to it that points up (in the
    vertical plane through the hinge), h_y = h_z x h_x, and M the foot of the ball joint B on the
    hinge, B = M + |MB| (h_y sin beta1 + h_z cos beta1). Of the two senses of h_x that one is taken
    that makes h_y point from the hinge towards B (outboard), so 0 < beta1 < pi at design. The
    arm's angular velocity is -h_x beta1'.

    The strut's axis goes through `strut_lower`, fixed in the knuckle, and `strut_top`. It may miss
    the ball joint; without a `strut_lower` it goes through it.

    Parameters
    ----------
    parameters : dict of float
        Flat parameter dict, see `oracle.reference`.

    Attributes
    ----------
    parameters : dict of float
        The argument, completed.
    centres : ndarray, shape (7, 3)
        Centres of mass at design with the chassis's origin first, m.
    masses : ndarray, shape (6,)
        In kg.
    inertias : ndarray, shape (6, 3, 3)
        About the centres of mass, chassis axes at design, kg m².
    spin_axis, rack_axis : ndarray, shape (3,)
        Unit vectors at design.
    hinge : ndarray, shape (3, 3)
        Rows h_x, h_y, h_z.
    hinge_foot : ndarray, shape (3,)
        M, m.
    side : float
        +1 on the vehicle's left, -1 on its right.
    joints : Equations
        The 33 constraint equations of the joints.
    design : Pose
        The design position.
    beta1_design : float
        Its arm angle, rad.
    orientation : dict of float
        Sign of the driven equations' determinant at design, by the driving coordinate.
    """

    def __init__(self, parameters):
        self.parameters = parameters = completed(parameters)
        self.points = {name: vector(parameters, name) for name in (*HARDPOINTS, *STAND_INS)}
        point = self.points
        self.centres = np.array(
            [
                np.zeros(3),
                *(vector(parameters, f"{body}_com") for body in BODIES[:-1]),
                point["wheel_center"],
            ]
        )
        self.masses = np.array([parameters[f"{body}_mass"] for body in BODIES])
        self.inertias = np.array([inertia(parameters, body) for body in BODIES])
        self.spin_axis = unit(vector(parameters, "spin_axis"))
        self.rack_axis = unit(vector(parameters, "rack_axis"))
        self.side = float(np.sign(point["wheel_center"][1]))

        h_x = unit(point["arm_front"] - point["arm_rear"])
        h_z = unit(Z_AXIS - (Z_AXIS @ h_x) * h_x)
        lever = point["ball_joint"] - point["arm_rear"]
        self.hinge_foot = point["arm_rear"] + (lever @ h_x) * h_x
        if np.cross(h_z, h_x) @ lever < 0.0:
            h_x = -h_x
        self.hinge = np.array([h_x, np.cross(h_z, h_x), h_z])

        self.joints = self._joints()
        self.design = Pose(self.centres[1:].copy(), np.tile(np.eye(3), (6, 1, 1)))
        self.beta1_design = self.beta1(self.design)
        # The sign of the determinant tells which of two assemblies a pose belongs to.
        self.orientation = {}
        for coordinate, value in (
            ("beta1", self.beta1_design),
            ("wheel_height", float(point["wheel_center"][2])),
        ):
            equations = self.drive(coordinate, value, 0.0, 0.0)
            residual, jacobian = equations.evaluate(self.design)
            if np.abs(residual).max() > 1e-12:
                raise AssertionError("the design position does not satisfy the joints")
            self.orientation[coordinate] = float(np.linalg.slogdet(jacobian)[0])

    def _joints(self):
        point = self.points
        strut = point["strut_top"] - point["strut_lower"]
        rod = point["tie_rod_outer"] - point["tie_rod_inner"]
        joints = Assembler(self.centres)
        hinge = point["arm_front"] - point["arm_rear"]
        joints.revolute(CHASSIS, ARM, point["arm_rear"], hinge)
        joints.spherical(ARM, KNUCKLE, point["ball_joint"])
        joints.cylindrical(KNUCKLE, UPPER_STRUT, strut, (point["strut_lower"], point["strut_top"]))
        joints.universal(CHASSIS, UPPER_STRUT, point["strut_top"], X_AXIS, np.cross(X_AXIS, strut))
        joints.spherical(KNUCKLE, TIE_ROD, point["tie_rod_outer"])
        joints.universal(RACK, TIE_ROD, point["tie_rod_inner"], Z_AXIS, np.cross(Z_AXIS, rod))
        joints.prismatic(CHASSIS, RACK, self.rack_axis, point["tie_rod_inner"])
        joints.revolute(KNUCKLE, WHEEL, point["wheel_center"], self.spin_axis)
        return joints.equations()

    def drive(self, coordinate, value, rack, spin):
        """Return all equations: the joints' 33 and three that fix the independent coordinates.

        Parameters
        ----------
        coordinate : {"beta1", "wheel_height"}
            What fixes the vertical motion.
        value : float
            Arm angle, rad, or height of the wheel centre, m.
        rack : float
            Rack displacement along the unit rack axis from design, m.
        spin : float
            Rotation of the wheel relative to the knuckle about the spin axis from design, rad.

        Returns
        -------
        Equations
            With 36 scalar equations.
        """
        point = self.points
        drivers = Assembler(self.centres)
        if coordinate == "beta1":
            _, h_y, h_z = self.hinge
            # The lever MB must be perpendicular to the direction across its wanted one.
            drivers.perpendicular(
                CHASSIS,
                ARM,
                np.cos(value) * h_y - np.sin(value) * h_z,
                point["ball_joint"] - self.hinge_foot,
            )
        else:
            drivers.in_plane(CHASSIS, WHEEL, Z_AXIS, (np.zeros(3), point["wheel_center"]), value)
        drivers.in_plane(
            CHASSIS, RACK, self.rack_axis, (point["tie_rod_inner"], point["tie_rod_inner"]), rack
        )
        first, second = perpendiculars(self.spin_axis)
        drivers.perpendicular(KNUCKLE, WHEEL, np.cos(spin) * second - np.sin(spin) * first, first)
        extra = drivers.equations()
        joints = self.joints
        return Equations(
            *(
                np.concatenate((getattr(joints, field), getattr(extra, field)))
                for field in Equations.__dataclass_fields__
            )
        )

    def point(self, pose, name, body):
        """Return where the design point `name`, carried by a body such as `KNUCKLE`, is now [m]."""
        arm = self.points[name] - self.centres[body]
        return pose.position[body - 1] + pose.rotation[body - 1] @ arm

    def beta1(self, pose):
        """Return the arm angle, rad."""
        lever = self.point(pose, "ball_joint", ARM) - self.hinge_foot
        return float(np.arctan2(lever @ self.hinge[1], lever @ self.hinge[2]))

    def rack(self, pose):
        """Return the rack displacement, m."""
        return float(self.rack_axis @ (pose.position[RACK - 1] - self.centres[RACK]))

    def spin(self, pose):
        """Return the rotation of the wheel relative to the knuckle, rad in (-pi, pi]."""
        relative = pose.rotation[KNUCKLE - 1].T @ pose.rotation[WHEEL - 1]
        first, second = perpendiculars(self.spin_axis)
        turned = relative @ first
        return float(np.arctan2(turned @ second, turned @ first))


@dataclass(frozen=True)
class Observables:
    """Quantities that follow from a pose.

    Attributes
    ----------
    beta1, rack, spin : float
        The independent coordinates: rad, m, rad in (-pi, pi].
    wheel_center : ndarray, shape (3,)
        In m.
    spin_axis : ndarray, shape (3,)
        Unit vector, in the sense of the parameter `spin_axis`.
    camber, toe, steer : float
        In rad: positive with the top outboard, for toe-in, and for a left turn. With n the unit
        spin axis pointing outboard and s = +1 left, -1 right: camber = atan2(-n_z, s n_y), toe =
        atan2(n_x, s n_y), steer = atan2(-s n_x, s n_y).
    strut_length : float
        From the strut's lower end to its top, m.
    strut_slide : float
        beta2 = p - strut_length, m.
    strut_direction : ndarray, shape (3,)
        Unit vector from strut top to lower end.
    spring_length : float
        Between the spring's seats, m.
    """

    beta1: float
    rack: float
    spin: float
    wheel_center: Array
    spin_axis: Array
    camber: float
    toe: float
    steer: float
    strut_length: float
    strut_slide: float
    strut_direction: Array
    spring_length: float


def observe(mechanism, pose):
    """Measure a pose; signs and units are those of `Observables`."""
    strut = mechanism.point(pose, "strut_lower", KNUCKLE) - mechanism.points["strut_top"]
    spring = mechanism.point(pose, "spring_seat", KNUCKLE) - mechanism.points["spring_top"]
    length = float(np.linalg.norm(strut))
    axis = pose.rotation[WHEEL - 1] @ mechanism.spin_axis
    side = mechanism.side
    outboard = axis * side * np.sign(mechanism.spin_axis[1])
    return Observables(
        beta1=mechanism.beta1(pose),
        rack=mechanism.rack(pose),
        spin=mechanism.spin(pose),
        wheel_center=pose.position[WHEEL - 1].copy(),
        spin_axis=axis,
        camber=float(np.arctan2(-outboard[2], side * outboard[1])),
        toe=float(np.arctan2(outboard[0], side * outboard[1])),
        steer=float(np.arctan2(-side * outboard[0], side * outboard[1])),
        strut_length=length,
        strut_slide=mechanism.parameters["strut_length_max"] - length,
        strut_direction=strut / length,
        spring_length=float(np.linalg.norm(spring)),
    )


def solve_pose(mechanism, beta1, rack=0.0, spin=0.0, start=None):
    """Solve the joints, to round-off, on the branch of the design position.

    Parameters
    ----------
    mechanism : Mechanism
        The suspension.
    beta1 : float
        Arm angle, rad, see `Mechanism`.
    rack : float
        Rack displacement from design along the unit rack axis, m.
    spin : float
        Wheel rotation relative to the knuckle, rad; any number of turns.
    start : Pose, optional
        A pose to continue from instead of the design position, such as a neighbour's.

    Raises
    ------
    AssemblyError
        If the mechanism does not reach these coordinates.
    """
    return _continue(mechanism, start or mechanism.design, "beta1", beta1, rack=rack, spin=spin)


def solve_pose_at_height(mechanism, height, rack=0.0, spin=0.0, start=None):
    """Solve the joints as `solve_pose` for a given height of the wheel centre, m."""
    return _continue(
        mechanism, start or mechanism.design, "wheel_height", height, rack=rack, spin=spin
    )


def residual_norm(mechanism, pose):
    """Return the largest absolute residual of the joints' equations and of R^T R = 1."""
    residual, _ = mechanism.joints.evaluate(pose)
    gram = pose.rotation.swapaxes(1, 2) @ pose.rotation
    return float(max(np.abs(residual).max(), np.abs(gram - np.eye(3)).max()))


def rotation_matrix(turn):
    """Return the matrices (..., 3, 3) of rotation vectors (..., 3), by way of Euler parameters."""
    half = 0.5 * np.linalg.norm(turn, axis=-1, keepdims=True)
    scalar = np.cos(half)
    imaginary = 0.5 * np.sinc(half / np.pi) * turn
    cross = skew(imaginary)
    return np.eye(3) + 2.0 * (scalar[..., None] * cross + cross @ cross)


def _continue(mechanism, start, coordinate, goal, *, rack, spin):
    """Follow the straight path in the independent coordinates from `start` to the goal."""
    # The wheel turns freely, so the starting pose can be given the final spin exactly.
    pose = _spun(mechanism, start, spin)
    if coordinate == "beta1":
        first, step = mechanism.beta1(start), ARM_STEP
    else:
        first, step = float(start.position[WHEEL - 1, 2]), RACK_STEP
    rack_first = mechanism.rack(start)
    count = max(1.0, np.ceil(abs(goal - first) / step), np.ceil(abs(rack - rack_first) / RACK_STEP))
    done, stride = 0.0, 1.0 / count
    while done < 1.0:
        ahead = 1.0 if done + 1.001 * stride >= 1.0 else done + stride
        equations = mechanism.drive(
            coordinate,
            goal if ahead == 1.0 else first + ahead * (goal - first),
            rack if ahead == 1.0 else rack_first + ahead * (rack - rack_first),
            spin,
        )
        found = _newton(equations, pose, mechanism.orientation[coordinate])
        if found is None:
            stride *= 0.5
            if stride < SMALLEST_STEP:
                raise AssemblyError(
                    f"no pose on the design's branch with {coordinate} = {goal} and rack = {rack}"
                )
        else:
            pose, done = found, ahead
    return _polish(equations, pose)


def _newton(equations, start, orientation):
    """Take Newton steps to convergence; None if they fail or end on another branch."""
    pose = start
    for _ in range(10):
        residual, jacobian = equations.evaluate(pose)
        if not np.isfinite(residual).all():
            return None
        if np.abs(residual).max() < CONVERGED:
            # Two branches meet where the Jacobian is singular; its determinant tells them apart.
            sign = np.linalg.slogdet(jacobian)[0]
            cosine = 0.5 * (np.einsum("bij,bij->b", start.rotation, pose.rotation).min() - 1.0)
            near = cosine > np.cos(LARGEST_TURN)
            return pose if near and sign * orientation > 0.0 else None
        try:
            pose = _moved(pose, np.linalg.solve(jacobian, -residual).astype(float))
        except np.linalg.LinAlgError:
            return None
    return None


def _polish(equations, pose):
    """Take Newton steps until the residual stalls; the rotations are kept orthonormal."""
    best, smallest = pose, np.inf
    for _ in range(8):
        pose = Pose(pose.position, _orthonormal(pose.rotation))
        residual, jacobian = equations.evaluate(pose)
        size = float(np.abs(residual).max())
        if size >= smallest:
            break
        best, smallest = pose, size
        if size == 0.0:
            break
        pose = _moved(pose, np.linalg.solve(jacobian, -residual).astype(float))
    return best


def _spun(mechanism, pose, spin):
    """Return the pose with the wheel's rotation about its spin axis set to `spin`."""
    rotation = pose.rotation.copy()
    turn = np.remainder(spin + np.pi, 2.0 * np.pi) - np.pi
    rotation[WHEEL - 1] = rotation[KNUCKLE - 1] @ rotation_matrix(turn * mechanism.spin_axis)
    return Pose(pose.position, rotation)


def _moved(pose, change):
    """Apply displacements and world rotation vectors, shape (36,)."""
    each = change.reshape(6, 6)
    return Pose(pose.position + each[:, :3], rotation_matrix(each[:, 3:]) @ pose.rotation)


def _orthonormal(rotation):
    """Return the nearest rotation matrices to almost orthonormal ones, shape (6, 3, 3)."""
    gram = rotation.swapaxes(1, 2) @ rotation
    return rotation - 0.5 * rotation @ (gram - np.eye(3))
