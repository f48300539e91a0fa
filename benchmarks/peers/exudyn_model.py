"""Exudyn: rigid bodies and joints in redundant coordinates, implicit integration.

Arm, knuckle and wheel are rigid bodies with Euler parameters. The massless tie rod is a distance,
the massless upper strut a generic joint that keeps the strut top on the knuckle's axis. The tyre's
force is a user function in Exudyn's symbolic form, so that no Python runs during integration.
"""

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from .case import ARM, KNUCKLE, SAMPLES, WHEEL, Array, Instant, Parameters, car, parameters
from .geometry import strut_frame

sys.exudynFast = True  # type: ignore[attr-defined]  # its module without range checks
import exudyn as exu
import exudyn.itemInterface as items
from exudyn.advancedUtilities import CreateSymbolicUserFunction
from exudyn.rigidBodyUtilities import RigidBodyInertia

esym = exu.symbolic
exu.config.printToConsole = False


@dataclass(frozen=True)
class Setting:
    """How Exudyn integrates.

    Attributes
    ----------
    steps : int
        Of the second.
    spectral_radius : float
        Of the generalised-alpha method at infinite frequency.
    modified_newton : bool
        Whether the Jacobian is kept from step to step.
    """

    steps: int
    spectral_radius: float = 0.9
    modified_newton: bool = False

    def __str__(self) -> str:
        return f"{self.steps} steps"


class Exudyn:
    """The suspension as an Exudyn system.

    Parameters
    ----------
    begin : Instant
        Where it starts.
    rates : mapping, optional
        Rates of springs and dampers that are others, by name [N/m, N s/m].
    """

    def __init__(self, begin: Instant, rates: Mapping[str, float] | None = None) -> None:
        self._container = exu.SystemContainer()
        self._system = self._container.AddSystem()
        self._bodies = {body: self._body(begin, body) for body in (ARM, KNUCKLE, WHEEL)}
        self._ground = self._system.AddObject(items.ObjectGround())
        self._joints()
        self._forces(parameters() | dict(rates or {}))
        arm = car().points["ball_joint"] - car().centres[ARM]
        self._sensor = self._system.AddSensor(
            items.SensorBody(
                bodyNumber=self._bodies[ARM],
                localPosition=arm,
                outputVariableType=exu.OutputVariableType.Position,
                storeInternal=True,
                writeToFile=False,
            )
        )
        self._system.Assemble()

    def run(self, setting: Setting) -> Array:
        """Simulate the second; return beta1 at `SAMPLES`, rad."""
        given = exu.SimulationSettings()
        given.timeIntegration.numberOfSteps = setting.steps
        given.timeIntegration.endTime = float(SAMPLES[-1])
        given.timeIntegration.adaptiveStep = False
        given.timeIntegration.verboseMode = 0
        given.timeIntegration.newton.useModifiedNewton = setting.modified_newton
        alpha = given.timeIntegration.generalizedAlpha
        alpha.spectralRadius = setting.spectral_radius
        alpha.computeInitialAccelerations = True
        given.linearSolverType = exu.LinearSolverType.EXUdense
        given.solutionSettings.writeSolutionToFile = False
        given.solutionSettings.sensorsWritePeriod = float(SAMPLES[1])
        self._system.SolveDynamic(given)
        stored = self._system.GetSensorStoredData(self._sensor)
        lever = stored[:, 1:] - car().hinge_foot
        return np.arctan2(lever @ car().hinge[1], lever @ car().hinge[2])

    def _body(self, begin: Instant, body: int) -> Any:
        mechanism = car()
        rotation = begin.pose.rotation[body - 1]
        inertia = RigidBodyInertia(
            mass=mechanism.masses[body - 1], inertiaTensor=mechanism.inertias[body - 1]
        )
        return self._system.CreateRigidBody(
            inertia=inertia,
            referencePosition=begin.pose.position[body - 1],
            referenceRotationMatrix=rotation,
            initialVelocity=begin.twist[body - 1, :3],
            initialAngularVelocity=begin.twist[body - 1, 3:],
            gravity=[0.0, 0.0, -mechanism.parameters["gravity"]],
            nodeType=exu.NodeType.RotationEulerParameters,
        )

    def _marker(self, body: int, point: Array) -> Any:
        """Return a marker of a body at a point given in the design position."""
        return self._system.AddMarker(
            items.MarkerBodyRigid(
                bodyNumber=self._bodies[body] if body else self._ground,
                localPosition=np.asarray(point) - car().centres[body],
            )
        )

    def _joint(self, bodies: tuple[int, int], points: tuple[Array, Array], axes: Any) -> None:
        first, second = bodies
        rotation = np.array(axes[1]).T
        self._system.AddObject(
            items.ObjectJointGeneric(
                markerNumbers=[self._marker(first, points[0]), self._marker(second, points[1])],
                constrainedAxes=axes[0],
                rotationMarker0=rotation,
                rotationMarker1=rotation,
            )
        )

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
        self._system.AddObject(
            items.ObjectConnectorDistance(
                markerNumbers=[self._marker(KNUCKLE, ends[0]), self._marker(0, ends[1])],
                distance=float(np.linalg.norm(ends[0] - ends[1])),
            )
        )

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
    half = Setting(setting.steps // 2, setting.spectral_radius, setting.modified_newton)
    fine, coarse = system.run(setting), system.run(half)
    return (4.0 * fine - coarse) / 3.0
