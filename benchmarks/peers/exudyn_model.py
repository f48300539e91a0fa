"""Exudyn: rigid bodies and joints in redundant coordinates, implicit integration.

Arm, knuckle and wheel are rigid bodies with Euler parameters. The massless tie rod is a distance,
the massless upper strut a generic joint that keeps the strut top on the knuckle's axis. The tyre's
force is a user function in Exudyn's symbolic form, so that no Python runs during integration.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np
from exudyn.advancedUtilities import CreateSymbolicUserFunction

from .case import ARM, KNUCKLE, SAMPLES, WHEEL, Array, Instant, Parameters, car, parameters
from .exudyn_system import ExudynSystem, Setting
from .geometry import strut_frame

esym = exu.symbolic


class Exudyn(ExudynSystem):
    """The suspension as an Exudyn system.

    Parameters
    ----------
    begin : Instant
        Where it starts.
    rates : mapping, optional
        Rates of springs and dampers that are others, by name [N/m, N s/m].
    """

    def __init__(self, begin: Instant, rates: Mapping[str, float] | None = None) -> None:
        super().__init__()
        self._bodies = {body: self._body(begin, body) for body in (ARM, KNUCKLE, WHEEL)}
        self._joints()
        self._forces(parameters() | dict(rates or {}))
        arm = car().points["ball_joint"] - car().centres[ARM]
        self._assemble(self._bodies[ARM], arm, exu.OutputVariableType.Position)

    def run(self, setting: Setting) -> Array:
        """Simulate the second; return beta1 at `SAMPLES`, rad."""
        settings = setting.simulation(SAMPLES)
        settings.linearSolverType = exu.LinearSolverType.EXUdense
        stored = self._simulate(settings)
        lever = stored[:, 1:] - car().hinge_foot
        return np.arctan2(lever @ car().hinge[1], lever @ car().hinge[2])

    def _body(self, begin: Instant, body: int) -> Any:
        mechanism = car()
        place = body - 1
        return self._rigid_body(
            mechanism.masses[place],
            mechanism.inertias[place],
            (begin.pose.position[place], begin.pose.rotation[place]),
            begin.twist[place],
            mechanism.parameters["gravity"],
        )

    def _marker(self, body: int, point: Array) -> Any:
        """Return a marker of a body at a point given in the design position."""
        number = self._bodies[body] if body else self._ground
        return self._body_marker(number, np.asarray(point) - car().centres[body])

    def _joint(self, bodies: tuple[int, int], points: tuple[Array, Array], axes: Any) -> None:
        markers = [self._marker(*end) for end in zip(bodies, points, strict=True)]
        self._constrain(markers, axes[0], np.array(axes[1]).T)

    def _joints(self) -> None:
        point, mechanism = car().points, car()
        foot, ball, hub = mechanism.hinge_foot, point["ball_joint"], point["wheel_center"]
        spin = mechanism.spin_axis
        across = np.cross(spin, [1.0, 0.0, 0.0])
        hub_axes = [np.cross(across, spin), across, -spin]
        hinge = [mechanism.hinge[1], mechanism.hinge[2], mechanism.hinge[0]]
        revolute = [1, 1, 1, 1, 1, 0]
        self._joint((0, ARM), (foot, foot), (revolute, hinge))
        self._joint((ARM, KNUCKLE), (ball, ball), ([1, 1, 1, 0, 0, 0], np.eye(3)))
        self._joint((KNUCKLE, WHEEL), (hub, hub), (revolute, hub_axes))
        # The strut top may lie anywhere on the first axis of the strut frame.
        self._joint((KNUCKLE, 0), (ball, point["strut_top"]), ([0, 1, 1, 0, 0, 0], strut_frame()))
        ends = point["tie_rod_outer"], point["tie_rod_inner"]
        markers = [self._marker(KNUCKLE, ends[0]), self._marker(0, ends[1])]
        self._keep_distance(markers, float(np.linalg.norm(ends[0] - ends[1])))

    def _forces(self, given: Parameters) -> None:
        point = car().points
        strut = self._marker(KNUCKLE, point["ball_joint"]), self._marker(0, point["strut_top"])
        self._system.AddObject(
            items.ObjectConnectorSpringDamper(
                markerNumbers=list(strut),
                referenceLength=given["strut_length_max"] - given["spring_free_slide"],
                stiffness=given["spring_rate"],
                damping=given["damper_rate"],
            )
        )
        free = np.array([0.0, 0.0, given["tyre_free_height"]])
        hub = self._marker(KNUCKLE, point["wheel_center"])
        name = "springForceTorqueUserFunction"
        # The system does not keep it alive.
        self._tyre = CreateSymbolicUserFunction(
            self._system,
            _tyre_force(given["tyre_rate"]),
            name,
            itemTypeName="ObjectConnectorRigidBodySpringDamper",
        )
        self._system.AddObject(
            items.ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[self._marker(0, free), hub], **{name: self._tyre}
            )
        )


def _tyre_force(rate: float) -> Any:
    """Return the user function: what pulls the wheel centre back; the spin axis is y at design."""

    def force(
        _mbs: Any,
        _t: Any,
        _item: Any,
        displacement: Any,
        rotation: Any,
        _velocity: Any,
        _angular_velocity: Any,
        _stiffness: Any,
        _damping: Any,
        _rotation_0: Any,
        _rotation_1: Any,
        _offset: Any,
    ) -> Any:
        cos_x, sin_x = esym.cos(rotation[0]), esym.sin(rotation[0])
        cos_y, sin_y = esym.cos(rotation[1]), esym.sin(rotation[1])
        cos_z, sin_z = esym.cos(rotation[2]), esym.sin(rotation[2])
        axis_x = -cos_y * sin_z
        axis_y = cos_x * cos_z - sin_x * sin_y * sin_z
        axis_z = sin_x * cos_z + cos_x * sin_y * sin_z
        pull = rate * displacement[2]
        along = -pull * axis_z / (1.0 - axis_z * axis_z)
        return esym.Vector([along * axis_x, along * axis_y, pull, 0.0, 0.0, 0.0])

    return force


def extrapolated(system: Exudyn, setting: Setting) -> Array:
    """Return beta1 by Richardson's extrapolation of runs with half and all of the steps."""
    half = replace(setting, steps=setting.steps // 2)
    fine, coarse = system.run(setting), system.run(half)
    return (4.0 * fine - coarse) / 3.0
