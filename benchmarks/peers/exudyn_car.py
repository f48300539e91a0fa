"""A step steer of a car here and in Exudyn, from one declaration of the car.

``make benchmark-car-peers`` fills docs/theory/other-tools.md. The car in Exudyn has a rigid body
for each part that has mass, with the joints of the declaration as constraints. Rods without mass
are distances, and the upper strut is a joint. Rack and anti-roll bar need bodies there: the body of
the car lends them a little mass, and together they have its mass and inertia at design. The tyre is
a function in Python: in Exudyn's symbolic form, which has no common subexpressions, it is a tree of
69,000 nodes and takes twenty times as long.
"""

from __future__ import annotations

import argparse
import math
from functools import partial
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import exudyn as exu
import exudyn.itemInterface as items
import kintrafo
import numpy as np
from kintrafo.core.units import KM_PER_H
from kintrafo.generator import (
    AlongLine,
    AlongTelescope,
    Cylindrical,
    ForceElement,
    Free,
    LinearDamper,
    LinearSpring,
    Prismatic,
    Revolute,
    RollingTyre,
    Spherical,
    TwistOfHinges,
    Universal,
)
from kintrafo.vehicle.assembly.controls import Controls
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.models.car.equations import CarModel, declared
from oracle.constraints import Array, perpendiculars
from oracle.maximal import Motion, Oracle

from ..report import fill_page, markdown_table, one_core, seconds_of
from .exudyn_system import ExudynSystem, Setting

if TYPE_CHECKING:
    from collections.abc import Callable

    from kintrafo.generator.declare.joints import Joint

PAGE = Path(__file__).parents[2] / "docs/theory/other-tools.md"
SPEED, DURATION = 80.0 / KM_PER_H, 4.0  # m/s, s
BEGIN, RISE, ANGLE = 0.5, 0.2, np.deg2rad(40.0)  # of the step of the steering wheel: s, s, rad
TIMES = np.linspace(0.0, DURATION, 401)
SAMPLED = np.linspace(0.0, DURATION, 4001)  # times at which the rack is sampled for its spline
STEPS = (1600, 2000, 4000)  # of Exudyn, from loose to tight
TOLERANCES = (1e-3, 1e-4, 1e-5, 1e-6)
LENT, LENT_INERTIA = 0.1, 0.01  # of a body without mass: kg, kg m^2
ENOUGH = 1e-4  # error, relative to the largest lateral acceleration
TYRE = {
    "radius_mm": 316.0,
    "effective_radius_mm": 307.0,
    "vertical_stiffness_N_per_mm": 200.0,
    "slip_stiffness_N": 90000.0,
    "cornering_stiffness_N_per_rad": 70000.0,
}
NO_AIR_FORCES = {
    f"air.{key}": 0.0 for key in ("drag_area_m2", "front_lift_area_m2", "rear_lift_area_m2")
}


def the_car() -> Any:
    """Return the driving car, which coasts on linear tyres without relaxation."""
    given = {f"tyres.{axle}": TYRE for axle in ("front", "rear")}
    return kintrafo.load("driving_car").with_changes(
        given | {"tyres.relaxation": False, **NO_AIR_FORCES}
    )


# Axes in which a wheel spins about the first one: its Cardan angles are regular in every turn.
ABOUT_UP = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def main() -> None:
    """Simulate the step steer with both, and print or fill the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--page", action="store_true", help="fill the page")
    chosen = parser.parse_args()
    with one_core():
        block = _compared()
    print(block)
    if chosen.page:
        fill_page(PAGE, {"car": block})


def _compared() -> str:
    """Return the table: each program at the loosest setting that is accurate enough."""
    model = CarModel(the_car())
    whole = Controls(model.car).rack(ANGLE)["rack_position"]

    def rack(t: float) -> float:
        part = min(max((t - BEGIN) / RISE, 0.0), 1.0)
        return float(whole * part**4 * (35.0 - part * (84.0 - part * (70.0 - 20.0 * part))))

    samples = kintrafo.Samples(SAMPLED, np.array([rack(t) for t in SAMPLED]), "spline")
    start = assembly_of(model).running(SPEED)

    def ours(rtol: float, method: str = "DormandPrince") -> Array:
        found = kintrafo.simulate(
            model, (0.0, DURATION), start, inputs={"rack_position": samples}, t_eval=TIMES,
            method=method, rtol=rtol, atol=1e-2 * rtol,
        )  # fmt: skip
        return np.asarray(found.signals["body_acceleration_y"])

    exact = ours(1e-11, "Verner")
    motion = _motion(model, start)
    theirs = ExudynCar(Oracle(declared(model.car), model.parameters), motion, rack)
    rows = [
        _loosest("kintrafo.simulate, DormandPrince", ours, TOLERANCES, "rtol {:g}", exact, 5),
        _loosest(
            "Exudyn, generalised-alpha 0.9, modified Newton",
            lambda steps: theirs.run(Setting(int(steps), modified_newton=True)),
            STEPS, "{:g} steps", exact, 3,
        ),
    ]  # fmt: skip
    least = rows[0][-1]
    header = ["program", "setting", "error", "time [s]", "times real time", "/ kintrafo"]
    cells = [
        [name, setting, f"{error:.1e}", f"{took:.3g}", f"{DURATION / took:.3g}",
         f"{took / least:,.0f}"]
        for name, setting, error, took in rows
    ]  # fmt: skip
    return f"{markdown_table(header, cells)}\n\nExudyn {version('exudyn')}."


def _loosest(
    name: str,
    run: Callable[[float], Array],
    settings: tuple[float, ...],
    words: str,
    exact: Array,
    repeated: int,
) -> tuple[str, str, float, float]:
    """Return name, setting, error and processor time [s] of the loosest setting that is enough."""
    for setting in settings:
        try:
            took, found = _timed(partial(run, setting))
        except exu.SolverError:
            continue
        error = float(np.abs(found - exact).max() / np.abs(exact).max())
        print(f"{name}, {words.format(setting)}: {error:.1e}, {took:.3g} s", flush=True)
        if error <= ENOUGH:
            again = [seconds_of(partial(run, setting)) for _ in range(repeated - 1)]
            return name, words.format(setting), error, min(took, *again)
    message = f"{name}: no setting is accurate to {ENOUGH:g}."
    raise RuntimeError(message)


def _timed(call: Callable[[], Array]) -> tuple[float, Array]:
    """Return the processor time of a call [s], and its result."""
    found: list[Array] = []
    took = seconds_of(lambda: found.append(call()))
    return took, found[0]


def _motion(model: CarModel, start: Any) -> Motion:
    """Return poses and twists of all bodies of a state, the ground first."""
    places, axes, rates = (
        np.asarray(model.evaluate(what, np.asarray(start), start.inputs))
        for what in ("positions", "orientations", "velocities")
    )
    return Motion(
        np.concatenate((np.zeros((1, 3)), places)),
        np.concatenate((np.eye(3)[None], axes)),
        np.concatenate((np.zeros((1, 6)), np.roll(rates, 3, axis=1))),
    )


class ExudynCar(ExudynSystem):
    """The declared car as an Exudyn system.

    Parameters
    ----------
    oracle : Oracle
        The declaration with numbers.
    start : Motion
        Poses and twists of all bodies.
    rack : callable
        Displacement of the rack over time [m].
    """

    def __init__(self, oracle: Oracle, start: Motion, rack: Callable[[float], float]) -> None:
        super().__init__()
        self._oracle, self._start = oracle, start
        self._centers = oracle.centers.copy()
        self._lent = [b.name for b in oracle.bodies if b.name.endswith(("rack", "_bar"))]
        joints = oracle.mechanism.joints
        self._struts = {j.first.name: j for j in joints if isinstance(j, Cylindrical)}
        self._bodies = {"world": self._ground}
        for body in oracle.bodies[1:]:
            if not self._is_rod(body.name):
                self._bodies[body.name] = self._body(body.name)
        self._rods: dict[str, list[tuple[str, Array]]] = {}
        for joint in joints:
            self._joint(joint, rack)
        for ends in self._rods.values():
            (first, one), (second, other) = ends
            markers = [self._marker(first, one), self._marker(second, other)]
            self._keep_distance(markers, float(np.linalg.norm(one - other)))
        for force in oracle.mechanism.forces:
            self._force(force)
        place = oracle.index["body"]
        from_center = oracle.centers[place] - self._centers[place]
        self._assemble(self._bodies["body"], from_center, exu.OutputVariableType.Acceleration)

    def run(self, setting: Setting) -> Array:
        """Simulate; return the lateral acceleration of the body at `TIMES`, m/s^2."""
        settings = setting.simulation(TIMES)
        newton = settings.timeIntegration.newton
        newton.relativeTolerance, newton.absoluteTolerance = 1e-8, 1e-10
        alpha = settings.timeIntegration.generalizedAlpha
        alpha.useIndex2Constraints = alpha.useNewmark = False
        settings.linearSolverType = exu.LinearSolverType.EigenSparse
        stored = self._simulate(settings)
        return np.interp(TIMES, stored[:, 0], stored[:, 2])

    # -- bodies -----------------------------------------------------------------------------------

    def _is_rod(self, name: str) -> bool:
        """Return whether a body is a distance in Exudyn, or a part of a joint."""
        rod = any(name.endswith(kind) for kind in ("tie_rod", "drop_link"))
        return rod or name in self._struts

    def _body(self, name: str) -> Any:
        oracle = self._oracle
        place = oracle.index[name]
        mass, inertia = oracle.mass[place], oracle.inertia[place]
        if not mass:
            mass, inertia = LENT, LENT_INERTIA * np.eye(3)
        if name == "body":
            mass, inertia = self._lending()
        motion = self._start
        moved = motion.rotation[place] @ (self._centers[place] - oracle.centers[place])
        return self._rigid_body(
            mass,
            inertia,
            (motion.position[place] + moved, motion.rotation[place]),
            motion.twist[place],
            oracle.parameters["gravity"],
        )

    def _lending(self) -> tuple[float, Array]:
        """Return mass and inertia of the body less those lent to rack and bar."""
        oracle, place = self._oracle, self._oracle.index["body"]
        mass, inertia = oracle.mass[place], oracle.inertia[place].copy()
        first, center = mass * oracle.centers[place], oracle.centers[place]
        for name in self._lent:
            at = oracle.centers[oracle.index[name]]
            mass, first = mass - LENT, first - LENT * at
            inertia -= LENT_INERTIA * np.eye(3) + _of_point(LENT, at - center)
        own = first / mass
        self._centers[place] = own
        return mass, inertia - _of_point(mass, own - center)

    def _marker(self, body: str, point: Array) -> Any:
        """Return a marker of a body at a point given in the design position."""
        center = self._centers[self._oracle.index[body]]
        return self._body_marker(self._bodies[body], np.asarray(point) - center)

    # -- joints -----------------------------------------------------------------------------------

    def _joint(self, joint: Joint, rack: Callable[[float], float]) -> None:
        oracle, names = self._oracle, (joint.first.name, joint.second.name)
        if isinstance(joint, Free) or names[1] in self._struts:
            return
        if isinstance(joint, Cylindrical):
            self._strut(joint)
        elif self._is_rod(names[1]):
            assert isinstance(joint, Spherical | Universal)
            ends = self._rods.setdefault(names[1], [])
            ends.append((names[0], oracle.place(joint.at)))
        elif isinstance(joint, Spherical):
            place = oracle.place(joint.at)
            self._hold(names, (place, place), [1, 1, 1, 0, 0, 0], np.eye(3))
        elif isinstance(joint, Revolute):
            place, along = oracle.place(joint.axis.through), oracle.axis(joint.axis)
            axes = np.column_stack((*perpendiculars(along), along))
            self._hold(names, (place, place), [1, 1, 1, 1, 1, 0], axes)
        else:
            assert isinstance(joint, Prismatic)
            along = oracle.along(joint.direction)
            place = oracle.centers[oracle.index[names[1]]]

            def moved(_mbs: Any, t: float, _item: Any, _given: Any) -> list[float]:
                return [rack(t), 0.0, 0.0, 0.0, 0.0, 0.0]

            # of a joint that holds all translations Exudyn takes the offset in axes of the world
            axes = np.column_stack((along, *perpendiculars(along)))
            self._hold(names, (place, place), [0, 1, 1, 1, 1, 1], axes)
            self._hold(names, (place, place), [1, 0, 0, 0, 0, 0], axes, offsetUserFunction=moved)

    def _hold(
        self,
        bodies: tuple[str, str],
        points: tuple[Array, Array],
        held: list[int],
        axes: Array,
        **more: Any,
    ) -> None:
        markers = [self._marker(b, p) for b, p in zip(bodies, points, strict=True)]
        self._constrain(markers, held, axes, **more)

    def _strut(self, joint: Cylindrical) -> None:
        """Keep the top of the strut, a point of the body, on the axis of the knuckle."""
        oracle = self._oracle
        along = oracle.axis(joint.axis)
        axes = np.column_stack((along, *perpendiculars(along)))
        ends = oracle.place(joint.axis.through), oracle.place(joint.axis.towards)
        self._hold((joint.second.name, "body"), ends, [0, 1, 1, 0, 0, 0], axes)

    # -- forces -----------------------------------------------------------------------------------

    def _force(self, force: Any) -> None:
        oracle = self._oracle
        if isinstance(force, RollingTyre):
            self._tyre(force)
        if not isinstance(force, ForceElement):
            return  # bodies have their weight; torques and the forces of the air are zero here
        path = force.path
        rate = sum(
            oracle.parameters[law.rate.name] for law in force.laws if isinstance(law, LinearSpring)
        )
        if isinstance(path, TwistOfHinges):
            first, second = path.first, path.second
            along = oracle.axis(first.axis)
            axes = np.column_stack((*perpendiculars(along), along))
            markers = [
                self._marker(hinge.second.name, oracle.place(hinge.axis.through))
                for hinge in (first, second)
            ]
            self._system.AddObject(
                items.ObjectConnectorTorsionalSpringDamper(
                    markerNumbers=markers, stiffness=rate,
                    rotationMarker0=axes, rotationMarker1=axes,
                )
            )  # fmt: skip
            return
        (spring,) = (law for law in force.laws if isinstance(law, LinearSpring))
        free = oracle.free_length(force, spring)
        if isinstance(path, AlongTelescope):
            joint = path.joint
            ends = [
                (joint.second.name, oracle.place(joint.axis.through)),
                ("body", oracle.place(joint.axis.towards)),
            ]
        else:
            assert isinstance(path, AlongLine)
            ends = [(body, oracle.place(point)) for body, point in path.ends]
        damping = sum(
            oracle.parameters[law.rate.name] for law in force.laws if isinstance(law, LinearDamper)
        )
        self._system.AddObject(
            items.ObjectConnectorSpringDamper(
                markerNumbers=[self._marker(*end) for end in ends],
                referenceLength=free, stiffness=rate, damping=damping,
            )
        )  # fmt: skip

    def _tyre(self, tyre: RollingTyre) -> None:
        given = {
            key: self._oracle.parameters[f"{tyre.law.name}_{key}"]
            for key in ("unloaded_radius", "effective_radius", "vertical_stiffness", "vxlow",
                        "slip_stiffness", "cornering_stiffness", "friction")
        }  # fmt: skip
        axis = ABOUT_UP.T @ self._oracle.along(tyre.wheel.spin)
        wheel = self._marker(tyre.bearing.second.name, self._oracle.place(tyre.wheel.center))
        self._system.AddObject(
            items.ObjectConnectorRigidBodySpringDamper(
                markerNumbers=[self._marker("world", np.zeros(3)), wheel],
                rotationMarker0=ABOUT_UP,
                rotationMarker1=ABOUT_UP,
                springForceTorqueUserFunction=_road_force(given, axis),
            )
        )


def _of_point(mass: float, arm: Array) -> Array:
    """Return the inertia of a point mass about the origin of its arm."""
    return mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))


def _road_force(given: dict[str, float], design: Array) -> Any:
    """Return the user function: force and moment of a wheel on a level road [N, N m]."""
    stiff, radius = given["vertical_stiffness"], given["unloaded_radius"]
    limit = given["friction"]

    def force(
        _mbs: Any,
        _t: Any,
        _item: Any,
        displacement: Any,
        rotation: Any,
        velocity: Any,
        angular_velocity: Any,
        _stiffness: Any,
        _damping: Any,
        _rotation_0: Any,
        _rotation_1: Any,
        _offset: Any,
    ) -> Any:
        x, y, z = map(float, rotation)
        cx, sx = math.cos(x), math.sin(x)
        cy, sy = math.cos(y), math.sin(y)
        cz, sz = math.cos(z), math.sin(z)
        matrix = (
            (cy * cz, -cy * sz, sy),
            (cx * sz + sx * sy * cz, cx * cz - sx * sy * sz, -sx * cy),
            (sx * sz - cx * sy * cz, sx * cz + cx * sy * sz, cx * cy),
        )
        a, b, c = (
            row[0] * float(design[0]) + row[1] * float(design[1]) + row[2] * float(design[2])
            for row in matrix
        )
        cosine = math.sqrt(1.0 - c * c)
        forward, left = (b / cosine, -a / cosine), (a / cosine, b / cosine)
        ux, uy = float(velocity[0]), float(velocity[1])
        wx, wy, wz = map(float, angular_velocity)
        height = float(displacement[2])
        load = stiff * (radius * cosine - height)
        # the contact, from the centre: down the wheel until the road
        reach = height / cosine
        px, py, pz = reach * a * c / cosine, reach * b * c / cosine, -height
        ahead = forward[0] * ux + forward[1] * uy
        sideways = left[0] * (ux + wy * pz - wz * py) + left[1] * (uy + wz * px - wx * pz)
        size = math.sqrt(ahead * ahead + given["vxlow"] ** 2)
        spin = wx * a + wy * b + wz * c
        fx = given["slip_stiffness"] * (given["effective_radius"] * spin - ahead) / size
        fy = -given["cornering_stiffness"] * sideways / size
        most = limit * load
        share = most / math.sqrt(most * most + fx * fx + fy * fy + 1e-12)
        fx, fy = fx * share, fy * share
        qx, qy = fx * forward[0] + fy * left[0], fx * forward[1] + fy * left[1]
        lx, ly = radius * a * c / cosine, radius * b * c / cosine  # the lowest point
        moment = (-pz * qy + ly * load, pz * qx - lx * load, px * qy - py * qx)
        return [-qx, -qy, -load, -moment[0], -moment[1], -moment[2]]

    return force


if __name__ == "__main__":
    main()
