"""Dynamics of any declared mechanism in maximal coordinates with Lagrange multipliers.

Only the declaration is read: bodies, joints, forces and numbers for the parameters. Every quantity
that a joint or a force is about (a gap, an angle, a length) is a `Jet`: its value, its rate as rows
over the twists of all bodies, and the part of its second derivative that no acceleration makes. A
joint holds jets at a constant value; a force does work on the rate of a jet.

With G the rows of all joints and S those of the given coordinates, the equations are

    [M  G^T] [acceleration]   [applied - gyroscopic]
    [G   0 ] [multipliers ] = [   - convective     ].

Planar loops close with more rows than are independent, so the multipliers are not unique, and they
are not asked for: accelerations that fulfil the lower rows are ``drift + J z``, with J the twists
for unit rates of the independent coordinates, and J^T applied to the upper rows gives z.

Units are SI, axes are those of the chassis. A twist is (velocity of the centre of mass, angular
velocity), and body 0 is the ground, which does not move.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from kintrafo import generator as g

from oracle.constraints import Array, perpendiculars, skew, unit
from oracle.rolling import wrench_of_driving

UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True)
class Jet:
    """Some numbers that depend on the poses, and how they change.

    Attributes
    ----------
    value : ndarray, shape (m,)
        At this instant.
    rows : ndarray, shape (m, 6 n)
        Times the twists of the n bodies: the rate.
    rate : ndarray, shape (m,)
        At this instant.
    convective : ndarray, shape (m,)
        Second derivative where all bodies have no acceleration.
    """

    value: Array
    rows: Array
    rate: Array
    convective: Array

    def __add__(self, other):
        if not isinstance(other, Jet):
            return Jet(self.value + other, self.rows, self.rate, self.convective)
        return Jet(*(a + b for a, b in zip(self.parts, other.parts, strict=True)))

    def __mul__(self, factor):
        return Jet(*(part * factor for part in self.parts))

    def __neg__(self):
        return self * -1.0

    def __sub__(self, other):
        return self + -other

    @property
    def parts(self):
        return self.value, self.rows, self.rate, self.convective

    def dot(self, other):
        """Return the scalar product of two vectors."""
        return Jet(
            np.array([self.value @ other.value]),
            (self.value @ other.rows + other.value @ self.rows)[None],
            np.array([self.value @ other.rate + other.value @ self.rate]),
            np.array(
                [
                    self.value @ other.convective
                    + 2.0 * self.rate @ other.rate
                    + other.value @ self.convective
                ]
            ),
        )

    def norm(self):
        """Return the length of a vector."""
        square, length = self.dot(self), np.linalg.norm(self.value)
        rate = square.rate / (2.0 * length)
        convective = square.convective / (2.0 * length) - rate**2 / length
        return Jet(np.array([length]), square.rows / (2.0 * length), rate, convective)


def angle_of(sine, cosine):
    """Return the angle of a vector in a plane, whatever its length."""
    s, c = sine.value, cosine.value
    square = s * s + c * c
    rate = (c * sine.rate - s * cosine.rate) / square
    growth = (c * cosine.rate + s * sine.rate) / square  # rate of the logarithm of the length
    return Jet(
        np.arctan2(s, c),
        (c * sine.rows - s * cosine.rows) / square,
        rate,
        (c * sine.convective - s * cosine.convective) / square - 2.0 * rate * growth,
    )


def stacked(jets, size):
    """Return several jets as one; of none, a jet of no numbers over some bodies."""
    none = Jet(np.zeros(0), np.zeros((0, 6 * size)), np.zeros(0), np.zeros(0))
    parts = zip(*(jet.parts for jet in [none, *jets]), strict=True)
    return Jet(*(np.concatenate(part) for part in parts))


@dataclass(frozen=True)
class Motion:
    """Positions and velocities of the bodies.

    Attributes
    ----------
    position : ndarray, shape (n + 1, 3)
        Centres of mass, m; the ground first.
    rotation : ndarray, shape (n + 1, 3, 3)
        From the design orientation.
    twist : ndarray, shape (n + 1, 6)
        Velocity of the centre of mass, m/s, and angular velocity, rad/s.
    """

    position: Array
    rotation: Array
    twist: Array


@dataclass(frozen=True)
class Reduced:
    """The equations M q'' + B = Q of the independent coordinates, at one instant.

    Attributes
    ----------
    mass_matrix : ndarray, shape (k, k)
        M.
    inertial, applied : ndarray, shape (k,)
        B, with what given accelerations contribute, and Q.
    jacobian : ndarray, shape (n, 6, k)
        Twists of the moving bodies for unit rates of the coordinates.
    body_accelerations : ndarray, shape (n, 6)
        Of the centres of mass, and angular.
    accelerations : ndarray, shape (k,)
        q''.
    """

    mass_matrix: Array
    inertial: Array
    applied: Array
    jacobian: Array
    body_accelerations: Array
    accelerations: Array


class Oracle:
    """A declared model with numbers.

    Parameters
    ----------
    model
        Declaration.
    parameters
        Value of every parameter by name, SI units.
    """

    def __init__(self, model, parameters):
        self.model = model
        self.mechanism = model.mechanism
        self.parameters = dict(parameters) | {
            name: float(value.xreplace({s: parameters[s.name] for s in value.free_symbols}))
            for name, value in self.mechanism.derived.items()
        }
        self.bodies = self.mechanism.bodies
        self.index = {body.name: i for i, body in enumerate(self.bodies)}
        self.size = len(self.bodies) - 1
        self.centers = np.array(
            [np.zeros(3), *(self.place(body.center) for body in self.bodies[1:])]
        )
        self.mass = np.array([self._mass(body) for body in self.bodies])
        self.inertia = np.array([self._inertia(body) for body in self.bodies])

    # -- declaration ------------------------------------------------------------------------------

    def place(self, point):
        """Return the design position of a point."""
        return np.array(
            [
                0.0 if axis in point.flat else self.parameters[f"{point.name}_{axis}"]
                for axis in "xyz"
            ]
        )

    def along(self, direction):
        """Return the unit vector of a direction at design."""
        if direction.fixed is not None:
            return unit(np.array([float(c) for c in direction.fixed]))
        if direction.between is not None:
            start, end = map(self.place, direction.between)
            return unit(end - start)
        return unit(np.array([self.parameters[f"{direction.name}_{axis}"] for axis in "xyz"]))

    def axis(self, line):
        """Return the unit vector along a line at design."""
        if hasattr(line.towards, "flat"):  # a point
            return unit(self.place(line.towards) - self.place(line.through))
        return self.along(line.towards)

    def _mass(self, body):
        return self.parameters[f"{body.name}_mass"] if self.model.has_mass(body.name) else 0.0

    def _inertia(self, body):
        """Return the tensor about the centre of mass at design; planar bodies declare a part."""
        if not self.model.has_mass(body.name):
            return np.zeros((3, 3))
        if body.rotor_axis is not None:
            axis = self.along(body.rotor_axis)
            spin, across = (
                self.parameters[f"{body.name}_inertia_{kind}"] for kind in ("spin", "diametral")
            )
            return across * np.eye(3) + (spin - across) * np.outer(axis, axis)
        tensor = np.zeros((3, 3))
        for i, one in enumerate("xyz"):
            for j, other in enumerate("xyz"):
                name = f"{body.name}_inertia_{''.join(sorted(one + other))}"
                tensor[i, j] = self.parameters.get(name, 0.0)
        return tensor

    # -- jets of points and directions ------------------------------------------------------------

    def _carried(self, motion, body, arm, *, free):
        """Return a vector fixed in a body, from its centre of mass if it is not free."""
        i = self.index[body]
        spin, turned = skew(motion.twist[i, 3:]), motion.rotation[i] @ arm
        rows = np.zeros((3, self.size + 1, 6))
        rows[:, i, 3:] = -skew(turned)
        if not free:
            rows[:, i, :3] = np.eye(3)
        return Jet(
            turned if free else motion.position[i] + turned,
            rows[:, 1:].reshape(3, -1),
            rows.reshape(3, -1) @ motion.twist.ravel(),
            spin @ (spin @ turned),  # a tenth of the time of numpy.cross
        )

    def point(self, motion, body, place):
        """Return the motion of a point that a body carries, by its design position."""
        arm = place - self.centers[self.index[body]]
        return self._carried(motion, body, arm, free=False)

    def vector(self, motion, body, design):
        """Return the motion of a direction that a body carries."""
        return self._carried(motion, body, design, free=True)

    # -- joints -----------------------------------------------------------------------------------

    def closure(self, motion):
        """Return what all joints hold at zero, in m and rad; shape (equations,)."""
        joints = [joint for joint in self.mechanism.joints if not isinstance(joint, g.Free)]
        held = [jet for joint in joints for jet in self.equations(motion, joint)]
        geared = [self._slip(motion, joint) for joint in joints if joint.gear]
        return stacked([*held, *geared], self.size)

    def _slip(self, motion, joint):
        """Return by how much a joint is ahead of what it follows through a gear."""
        followed = self.driven(motion, joint.gear.joint.name)
        ratio = self.parameters[joint.gear.ratio.name]
        return self.driven(motion, joint.name) - followed * ratio

    def equations(self, motion, joint):
        """Return what one joint holds at zero."""
        if isinstance(joint, g.Spherical):
            return [self._gap(motion, joint, joint.at)]
        if isinstance(joint, g.Revolute):
            return [
                self._gap(motion, joint, joint.axis.through),
                *self._parallel(motion, joint, self.axis(joint.axis)),
            ]
        if isinstance(joint, g.Universal):
            first = self.along(joint.first_axis)
            second = unit(np.cross(first, self.axis(joint.shaft)))
            return [
                self._gap(motion, joint, joint.at),
                self._perpendicular(motion, joint, first, second),
            ]
        if isinstance(joint, g.Prismatic):
            x, y, z = np.eye(3)
            place = self.centers[self.index[joint.second.name]]
            along = self.along(joint.direction)
            return [
                *(self._perpendicular(motion, joint, *pair) for pair in ((x, y), (y, z), (z, x))),
                *self._level(motion, joint, along, place, place),
            ]
        if isinstance(joint, g.Weld):
            x, y, z = np.eye(3)
            turns = [self._perpendicular(motion, joint, *pair) for pair in ((x, y), (y, z), (z, x))]
            return [self._gap(motion, joint, joint.second.center), *turns]
        assert isinstance(joint, g.Cylindrical)
        along = self.axis(joint.axis)
        ends = self.place(joint.axis.towards), self.place(joint.axis.through)
        return [*self._parallel(motion, joint, along), *self._level(motion, joint, along, *ends)]

    def _gap(self, motion, joint, at):
        place = self.place(at)
        return self.point(motion, joint.second.name, place) - self.point(
            motion, joint.first.name, place
        )

    def _perpendicular(self, motion, joint, first, second):
        return self.vector(motion, joint.first.name, first).dot(
            self.vector(motion, joint.second.name, second)
        )

    def _parallel(self, motion, joint, axis):
        """Return the two equations of a common direction."""
        return [self._perpendicular(motion, joint, v, axis) for v in perpendiculars(axis)]

    def _level(self, motion, joint, axis, on_first, on_second):
        """Return the two equations of points that do not leave a line along the axis."""
        span = self.point(motion, joint.second.name, on_second)
        span -= self.point(motion, joint.first.name, on_first)
        return [self.vector(motion, joint.first.name, v).dot(span) for v in perpendiculars(axis)]

    # -- coordinates ------------------------------------------------------------------------------

    def coordinate(self, motion, joint, kind):
        """Return a relative coordinate as the joint declares it, m or rad (up to whole turns)."""
        if isinstance(joint, g.Revolute):
            return self._hinge_angle(motion, joint)
        if isinstance(joint, g.Prismatic):
            place = self.centers[self.index[joint.second.name]]
            span = self.point(motion, joint.second.name, place)
            span -= self.point(motion, joint.first.name, place)
            return self.vector(motion, joint.first.name, self.along(joint.direction)).dot(span)
        if isinstance(joint, g.Universal):
            return self._shaft_angles(motion, joint)[kind]
        assert isinstance(joint, g.Cylindrical)
        if kind == "slide":
            full = self.parameters[joint.length_at_zero_slide.name]
            return -self.telescope_length(motion, joint) + full
        return self._telescope_angle(motion, joint)

    def _hinge_angle(self, motion, joint):
        axis = self.axis(joint.axis)
        reference = self.along(joint.angle_from)
        if joint.angle_to is None:
            start, _ = perpendiculars(axis)
            mark = start
        else:
            start = unit(reference - axis * (axis @ reference))
            arm = self.place(joint.angle_to) - self.place(joint.axis.through)
            mark = unit(arm - axis * (axis @ arm))
            axis = axis * np.sign(np.cross(start, mark) @ axis)
        marker = self.vector(motion, joint.second.name, mark)
        cosine = self.vector(motion, joint.first.name, start).dot(marker)
        sine = self.vector(motion, joint.first.name, np.cross(axis, start)).dot(marker)
        return angle_of(sine, cosine)

    def _shaft_angles(self, motion, joint):
        """Return azimuth and elevation: Rz(azimuth) Rx(elevation) takes y to the shaft."""
        shaft = self.vector(motion, joint.second.name, self.axis(joint.shaft))
        x, y, z = (self.vector(motion, joint.first.name, axis).dot(shaft) for axis in np.eye(3))
        return {
            "azimuth": angle_of(-x, y),
            "elevation": angle_of(z, stacked([x, y], self.size).norm()),
        }

    def telescope_length(self, motion, joint):
        """Return the distance, along the axis, of the two points that define it."""
        return self.vector(motion, joint.first.name, self.axis(joint.axis)).dot(
            self.point(motion, joint.first.name, self.place(joint.axis.towards))
            - self.point(motion, joint.second.name, self.place(joint.axis.through))
        )

    def _telescope_angle(self, motion, joint):
        """Return the turn of the second body about the axis, from the z' axis of the shaft.

        Its rate is left out: the z' axis belongs to no body.
        """
        holder = next(
            j
            for j in self.mechanism.joints
            if isinstance(j, g.Universal) and j.second == joint.first and j.at == joint.axis.towards
        )
        shaft = -self.vector(motion, joint.first.name, self.axis(joint.axis)).value
        up = self.vector(motion, holder.first.name, UP).value
        x = unit(np.cross(shaft, up))
        place = self.place(joint.angle_to) - self.place(joint.axis.through)
        mark = self.vector(motion, joint.second.name, place).value
        angle = np.array([np.arctan2(-mark @ x, mark @ np.cross(x, shaft))])
        nothing = np.full(1, np.nan)
        return Jet(angle, np.full((1, 6 * self.size), np.nan), nothing, nothing)

    def driven(self, motion, joint):
        """Return the coordinate of an independent or prescribed joint.

        Of a free one it is six that nobody integrates: only their rates mean anything, which are
        velocity and angular velocity in the body's own axes.
        """
        declared = self.mechanism.joint(joint)
        if isinstance(declared, g.Free):
            return self._own_speeds(motion, declared)
        return self.coordinate(motion, declared, declared.coordinates[0])

    def _own_speeds(self, motion, joint):
        i = self.index[joint.second.name]
        to_body, (velocity, omega) = motion.rotation[i].T, motion.twist[i].reshape(2, 3)
        rows = np.zeros((6, self.size + 1, 6))
        rows[:3, i, :3] = rows[3:, i, 3:] = to_body
        turning = np.concatenate((to_body @ np.cross(velocity, omega), np.zeros(3)))
        rate = np.concatenate((to_body @ velocity, to_body @ omega))
        return Jet(np.full(6, np.nan), rows[:, 1:].reshape(6, -1), rate, turning)

    # -- forces -----------------------------------------------------------------------------------

    def wrench(self, motion, inputs):
        """Return the applied forces and moments, flattened like the twists of moving bodies."""
        total = np.zeros(6 * self.size)
        for force in self.mechanism.forces:
            total += self._wrench_of(force, motion, inputs)
        return total

    def _wrench_of(self, force, motion, inputs):
        if isinstance(force, g.Weight):
            pull = np.zeros((self.size, 6))
            weight = self.mass[1:] * self.parameters[force.gravity.name]
            pull[:, :3] = -np.outer(weight, self.along(force.upward))
            return pull.ravel()
        if isinstance(force, g.AppliedForce | g.AppliedMoment):
            return inputs[force.input.name] * self._of_outside(motion, force)
        if isinstance(force, g.ForceElement):
            length = self.length(motion, force)
            push = sum(self._push(force, law, length, inputs) for law in force.laws)
            return push * length.rows[0]
        if isinstance(force, g.JointForce):
            independent = force.joint in self.model.independent
            push = inputs[force.input.name] if independent else 0.0
            return push * self.driven(motion, force.joint.name).rows[0]
        if isinstance(force, g.RollingTyre | g.ShaftTorque | g.AirForces):
            return wrench_of_driving(self, force, motion, inputs)
        assert isinstance(force, g.LinearTyre)
        center = self.point(motion, force.wheel.carrier.name, self.place(force.wheel.center))
        return self._tyre(force, motion, center, inputs) @ center.rows

    def wrench_on(self, motion, body, at, force, moment):
        """Return a force on a body at a place in the world, with a moment about that place."""
        i = self.index[body]
        total = np.zeros((self.size + 1, 6))
        total[i] = [*force, *(moment + np.cross(at - motion.position[i], force))]
        return total[1:].ravel()

    def _of_outside(self, motion, force):
        """Return what acts from outside, for a unit input."""
        line, body = self.along(force.direction), force.body.name
        if force.follows:
            line = self.vector(motion, body, line).value
        if isinstance(force, g.AppliedForce):
            return line @ self.point(motion, body, self.place(force.point)).rows
        turned = np.zeros((self.size, 6))
        turned[self.index[body] - 1, 3:] = line
        return turned.ravel()

    def length(self, motion, element):
        """Return the length of an element's path, or its twist."""
        if isinstance(element.path, g.AlongLine):
            first, second = (
                self.point(motion, body, self.place(point)) for body, point in element.path.ends
            )
            return (second - first).norm()
        if isinstance(element.path, g.AlongTelescope):
            return self.telescope_length(motion, element.path.joint)
        if isinstance(element.path, g.AlongHinge):
            return self._hinge_angle(motion, element.path.hinge)
        if isinstance(element.path, g.AlongGuide):
            return self.coordinate(motion, element.path.guide, "slide")
        first, second = (
            self._hinge_angle(motion, hinge) for hinge in (element.path.first, element.path.second)
        )
        return second - first

    def _push(self, element, law, path, inputs):
        """Return the force that pushes the ends of an element apart."""
        given, length, velocity = self.parameters, float(path.value[0]), float(path.rate[0])
        if isinstance(law, g.LinearSpring):
            return given[law.rate.name] * (self.free_length(element, law) - length)
        if isinstance(law, g.LinearDamper):
            return -given[law.rate.name] * velocity
        if isinstance(law, g.Friction):
            return -given[law.level.name] * np.sin(np.arctan2(velocity, given[law.speed.name]))
        if isinstance(law, g.Stop):
            sense = {"bump": 1.0, "rebound": -1.0}[law.side]
            depth = max(sense * (given[law.length.name] - length), 0.0)
            return sense * np.polyval(
                [given[law.progression.name], 0.0, given[law.rate.name], 0.0], depth
            )
        if isinstance(law, g.DamperTable | g.SpringTable):
            of_spring = isinstance(law, g.SpringTable)
            return self._of_table(law, *((-length, -1.0) if of_spring else (-velocity, 1.0)))
        assert isinstance(law, g.Actuator)
        return inputs[law.input.name]

    def free_length(self, element, spring):
        """Return the length of a spring without force, m."""
        if spring.free_length is not None:
            return self.parameters[spring.free_length.name]
        full = self.parameters[element.path.joint.length_at_zero_slide.name]
        return full - self.parameters[spring.free_slide.name]

    def _of_table(self, table, compression, sense):
        """Return the force of a curve: segment by segment as far as it is passed."""

        def given(what):
            return self.parameters[f"{table.name}_{what}"]

        knots = sense * np.array([given(f"knot_{i}") for i in range(table.segments + 1)])
        force = given("first_force")
        if compression <= knots[0]:
            return force + given("first_slope") * (compression - knots[0])
        for i, width in enumerate(np.diff(knots)):
            if width > 0.0 and compression > knots[i]:
                part = min((compression - knots[i]) / width, 1.0)
                powers = [given(f"{p}_{i}") for p in ("cubic", "quadratic", "linear")]
                force += np.polyval([*powers, 0.0], part)
        return force + given("last_slope") * max(compression - knots[-1], 0.0)

    def _tyre(self, tyre, motion, center, inputs):
        """Return the force of the road on a wheel, at its centre."""
        given = self.parameters
        deflection = given[tyre.free_height.name] + inputs[tyre.road.name] - center.value[2]
        load = given[tyre.rate.name] * deflection
        if tyre.damper is not None:
            (rising,) = (i.name for i in self.mechanism.inputs if i.derivative_of == tyre.road)
            load += given[tyre.damper.name] * (inputs[rising] - center.rate[2])
        if self._lifts_off(tyre) and min(deflection, load) < 0.0:
            load = 0.0
        axis = self.vector(motion, tyre.wheel.carrier.name, self.along(tyre.wheel.spin)).value
        return load * (UP - axis * axis[2]) / (1.0 - axis[2] ** 2)

    def _lifts_off(self, tyre):
        return tyre.lifts_off is not None and bool(self.parameters[tyre.lifts_off.name])

    # -- equations of motion ----------------------------------------------------------------------

    def reduced(self, motion, inputs, given):
        """Solve the equations of motion.

        Parameters
        ----------
        motion
            Poses and twists that fulfil the joints.
        inputs
            Forces and roads by name, N, N m, m.
        given
            Acceleration of each prescribed joint by its name, m/s^2 or rad/s^2.
        """
        closure = self.closure(motion)
        names = [joint.name for joint in self.model.independent]
        driven = [self.driven(motion, j) for j in (*names, *given)]
        driving = stacked(driven, self.size)
        count = sum(len(jet.value) for jet in driven[: len(names)])
        rows = np.concatenate((closure.rows, driving.rows))
        target = np.zeros((len(rows), count + 1))
        target[len(closure.value) :, :count] = np.eye(len(driving.value), count)
        target[:, count] = -np.concatenate((closure.convective, driving.convective))
        target[len(rows) - len(given) :, count] += list(given.values())
        solution = _least_squares(rows, target)
        jacobian, drift = solution[:, :count], solution[:, count]

        mass, gyroscopic = self._momentum_balance(motion)
        matrix = jacobian.T @ mass @ jacobian
        inertial = jacobian.T @ (mass @ drift + gyroscopic)
        applied = jacobian.T @ self.wrench(motion, inputs)
        accelerations = np.linalg.solve(matrix, applied - inertial)
        return Reduced(
            matrix,
            inertial,
            applied,
            jacobian.reshape(self.size, 6, count),
            (drift + jacobian @ accelerations).reshape(self.size, 6),
            accelerations,
        )

    def _momentum_balance(self, motion):
        """Return the mass matrix of all moving bodies and their gyroscopic moments."""
        mass = np.zeros((self.size, 6, self.size, 6))
        gyroscopic = np.zeros((self.size, 6))
        for i in range(self.size):
            rotation, omega = motion.rotation[i + 1], motion.twist[i + 1, 3:]
            tensor = rotation @ self.inertia[i + 1] @ rotation.T
            mass[i, :3, i, :3] = self.mass[i + 1] * np.eye(3)
            mass[i, 3:, i, 3:] = tensor
            gyroscopic[i, 3:] = skew(omega) @ tensor @ omega
        return mass.reshape(6 * self.size, -1), gyroscopic.ravel()

    # -- energy -----------------------------------------------------------------------------------

    def energy(self, motion):
        """Return kinetic energy and that of weight, springs and stops, J."""
        mass, _ = self._momentum_balance(motion)
        twist = motion.twist[1:].ravel()
        energy = 0.5 * twist @ mass @ twist
        for force in self.mechanism.forces:
            if isinstance(force, g.Weight):
                heights = motion.position[:, 2] * self.mass
                energy += self.parameters[force.gravity.name] * np.sum(heights)
            elif isinstance(force, g.ForceElement):
                length = float(self.length(motion, force).value[0])
                energy += sum(self._stored(force, law, length) for law in force.laws)
        return float(energy)

    def _stored(self, element, law, length):
        given = self.parameters
        if isinstance(law, g.LinearSpring):
            return 0.5 * given[law.rate.name] * (self.free_length(element, law) - length) ** 2
        if isinstance(law, g.Stop):
            sense = {"bump": 1.0, "rebound": -1.0}[law.side]
            depth = max(sense * (given[law.length.name] - length), 0.0)
            return (
                0.5 * given[law.rate.name] * depth**2
                + 0.25 * given[law.progression.name] * depth**4
            )
        if isinstance(law, g.SpringTable):
            # from a length that is no spring's, by a rule exact for the cubics of its pieces
            knots = [self.parameters[f"{law.name}_knot_{i}"] for i in range(law.segments + 1)]
            ends = np.unique(np.clip([0.0, *knots, length], 0.0, length))
            at, weights = np.polynomial.legendre.leggauss(3)
            return -sum(
                0.5
                * (b - a)
                * weights
                @ [self._of_table(law, -0.5 * (a + b + (b - a) * x), -1.0) for x in at]
                for a, b in pairwise(ends)
            )
        return 0.0


def _least_squares(rows, target):
    """Solve equations of which some follow from others; those must agree with them."""
    solution, _, rank, _ = np.linalg.lstsq(rows, target, rcond=1e-9)
    assert rank == rows.shape[1], "the coordinates do not determine the motion"
    solution += np.linalg.lstsq(rows, target - rows @ solution, rcond=1e-9)[0]  # refined
    left = np.abs(target - rows @ solution).max(axis=0)
    assert (left <= 1e-9 * (1.0 + np.abs(target).max(axis=0))).all(), "the joints contradict"
    return solution
