"""Parts and settings of a system in Exudyn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import exudyn as exu
import exudyn.itemInterface as items
import numpy as np
from exudyn.rigidBodyUtilities import RigidBodyInertia

if TYPE_CHECKING:
    from collections.abc import Sequence

    from .case import Array

exu.config.printToConsole = False


@dataclass(frozen=True)
class Setting:
    """Settings of the integration by the generalised-alpha method."""

    steps: int  # number of steps of a simulation
    spectral_radius: float = 0.9  # of the generalised-alpha method at infinite frequency
    modified_newton: bool = False  # whether the Jacobian is kept from step to step

    def __str__(self) -> str:
        return f"{self.steps} steps"

    def simulation(self, times: Array) -> Any:
        """Return Exudyn's settings of a simulation with samples at equidistant times from zero."""
        given = exu.SimulationSettings()
        integration = given.timeIntegration
        integration.numberOfSteps = self.steps
        integration.endTime = float(times[-1])
        integration.adaptiveStep = False
        integration.verboseMode = 0
        integration.newton.useModifiedNewton = self.modified_newton
        integration.generalizedAlpha.spectralRadius = self.spectral_radius
        integration.generalizedAlpha.computeInitialAccelerations = True
        given.solutionSettings.writeSolutionToFile = False
        given.solutionSettings.sensorsWritePeriod = float(times[1])
        return given


class ExudynSystem:
    """An Exudyn system with a ground and one sensor."""

    def __init__(self) -> None:
        self._container = exu.SystemContainer()
        self._system = self._container.AddSystem()
        self._ground = self._system.AddObject(items.ObjectGround())

    def _rigid_body(
        self,
        mass: float,
        inertia: Array,
        pose: tuple[Array, Array],
        twist: Array,
        gravity: float,
    ) -> Any:
        """Return a rigid body with Euler parameters.

        Parameters
        ----------
        mass, inertia
            [kg]; about its centre of mass, in its axes [kg m^2].
        pose
            Position of the centre of mass [m], and rotation matrix.
        twist
            Velocity [m/s] and angular velocity [rad/s].
        gravity
            Acceleration downward [m/s^2].
        """
        return self._system.CreateRigidBody(
            inertia=RigidBodyInertia(mass=mass, inertiaTensor=inertia),
            referencePosition=pose[0],
            referenceRotationMatrix=pose[1],
            initialVelocity=twist[:3],
            initialAngularVelocity=twist[3:],
            gravity=[0.0, 0.0, -gravity],
            nodeType=exu.NodeType.RotationEulerParameters,
        )

    def _body_marker(self, body: Any, place: Array) -> Any:
        """Return a marker of a body at a point in its axes, from its centre of mass [m]."""
        return self._system.AddMarker(items.MarkerBodyRigid(bodyNumber=body, localPosition=place))

    def _constrain(
        self, markers: Sequence[Any], constrained: Sequence[int], axes: Array, **more: Any
    ) -> None:
        """Add a joint.

        Parameters
        ----------
        markers
            On the first body and on the second.
        constrained
            1 for each translation and rotation that the joint does not allow, else 0.
        axes
            Those of the joint at design, as columns.
        more
            Further arguments of Exudyn's joint.
        """
        self._system.AddObject(
            items.ObjectJointGeneric(
                markerNumbers=markers, constrainedAxes=constrained,
                rotationMarker0=axes, rotationMarker1=axes, **more,
            )
        )  # fmt: skip

    def _keep_distance(self, markers: Sequence[Any], distance: float) -> None:
        """Add a rod without mass between two markers [m]."""
        self._system.AddObject(
            items.ObjectConnectorDistance(markerNumbers=markers, distance=distance)
        )

    def _assemble(self, body: Any, place: Array, quantity: Any) -> None:
        """Add the sensor of a quantity at a point of a body, and assemble the system."""
        self._sensor = self._system.AddSensor(
            items.SensorBody(
                bodyNumber=body, localPosition=place, outputVariableType=quantity,
                storeInternal=True, writeToFile=False,
            )
        )  # fmt: skip
        self._system.Assemble()

    def _simulate(self, settings: Any) -> Array:
        """Return the samples of the sensor: time and three components, in rows."""
        self._system.SolveDynamic(settings)
        return np.asarray(self._system.GetSensorStoredData(self._sensor))
