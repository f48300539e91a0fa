"""A planar excavator: boom, arm and bucket, each moved by a hydraulic cylinder.

Four loops in series, as in the machines to which Hiller and Kecskeméthy applied the method of
kinematic transformers: chassis, boom and boom cylinder; boom, arm and arm cylinder; arm, rocker and
bucket cylinder; arm, rocker, link and bucket. A cylinder is a telescope between two pins. Its
stroke is a coordinate, so that with the third pin it is a triangle with one known, variable side.

Dimensions, masses and inertias are this project's own, of the size of a machine of 20 t: a boom of
5.7 m, an arm of 2.9 m, a bucket of 1 m^3. The two boom cylinders count as one, and so do the two
sides of rocker and link. x is forward and z up, from the ground below the slewing axis; strokes are
zero in the position of the table, with the arm upright and the bucket above the ground.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.joint_force import JointForce
from ..declare.forces.weight import Weight
from ..declare.geometry import Direction
from ..declare.inputs import Input, motion
from ..declare.joints import Prismatic
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from .planar import flat, hinge, inertia, places

if TYPE_CHECKING:
    from ..declare.joints import Joint

_PLACES = {
    "boom_foot": ((0.2, 1.9), "hinge of the boom on the chassis"),
    "boom_barrel_pin": ((0.7, 1.35), "pin of the boom cylinder on the chassis"),
    "boom_rod_pin": ((2.2, 3.3), "pin of the boom cylinder on the boom"),
    "arm_pin": ((5.3, 4.4), "hinge of the arm on the boom"),
    "arm_barrel_pin": ((2.7, 4.75), "pin of the arm cylinder on the boom"),
    "arm_rod_pin": ((5.05, 5.15), "pin of the arm cylinder on the arm"),
    "bucket_barrel_pin": ((5.9, 4.27), "pin of the bucket cylinder on the arm"),
    "knee": ((6.82, 2.41), "pin that bucket cylinder, rocker and link have in common"),
    "rocker_pin": ((6.26, 2.14), "hinge of the rocker on the arm"),
    "bucket_pin": ((6.4, 1.75), "hinge of the bucket on the arm"),
    "link_pin": ((6.84, 1.78), "hinge of the link on the bucket"),
    "boom_com": ((2.75, 3.8), "centre of mass of the boom"),
    "boom_barrel_com": ((1.15, 1.95), "centre of mass of the barrel of the boom cylinder"),
    "boom_rod_com": ((1.8, 2.8), "centre of mass of the rod of the boom cylinder"),
    "arm_com": ((5.65, 3.5), "centre of mass of the arm"),
    "arm_barrel_com": ((3.4, 4.87), "centre of mass of the barrel of the arm cylinder"),
    "arm_rod_com": ((4.5, 5.05), "centre of mass of the rod of the arm cylinder"),
    "bucket_barrel_com": ((6.15, 3.75), "centre of mass of the barrel of the bucket cylinder"),
    "bucket_rod_com": ((6.6, 2.85), "centre of mass of the rod of the bucket cylinder"),
    "rocker_com": ((6.55, 2.28), "centre of mass of the rocker"),
    "link_com": ((6.83, 2.1), "centre of mass of the link"),
    "bucket_com": ((6.75, 1.2), "centre of mass of the bucket"),
}
_MASSES = {  # kg, kg m^2
    "boom": (1650.0, 4700.0),
    "boom_barrel": (260.0, 65.0),
    "boom_rod": (150.0, 40.0),
    "arm": (820.0, 720.0),
    "arm_barrel": (160.0, 38.0),
    "arm_rod": (95.0, 24.0),
    "rocker": (55.0, 2.2),
    "bucket_barrel": (95.0, 16.0),
    "bucket_rod": (60.0, 10.0),
    "link": (45.0, 1.9),
    "bucket": (740.0, 190.0),
}
_CYLINDERS = ("boom", "arm", "bucket")


def _pin(name: str, first: str, second: str, at: str) -> Joint:
    return hinge(name, first, second, at, "y")


def _cylinder(name: str, base: str, body: str, rod_pin: str) -> tuple[Joint, ...]:
    """Return the joints of a cylinder, its barrel on one body and its rod on another."""
    barrel, rod, barrel_pin = f"{name}_barrel", f"{name}_rod", f"{name}_barrel_pin"
    bore = Direction(f"{name}_bore", between=(flat(barrel_pin, "y"), flat(rod_pin, "y")))
    return (
        _pin(f"{name}_barrel_hinge", base, barrel, barrel_pin),
        Prismatic(name=f"{name}_bore", first=barrel, second=rod, direction=bore),
        _pin(f"{name}_rod_hinge", rod, body, rod_pin),
    )


BODIES = (
    Body("chassis", 0, center=flat("boom_foot", "y")),
    *(Body(name, i, center=flat(f"{name}_com", "y")) for i, name in enumerate(_MASSES, 1)),
)
JOINTS = (
    _pin("boom_hinge", "chassis", "boom", "boom_foot"),
    *_cylinder("boom", "chassis", "boom", "boom_rod_pin"),
    _pin("arm_hinge", "boom", "arm", "arm_pin"),
    *_cylinder("arm", "boom", "arm", "arm_rod_pin"),
    _pin("rocker_hinge", "arm", "rocker", "rocker_pin"),
    *_cylinder("bucket", "arm", "rocker", "knee"),
    _pin("knee_hinge", "rocker", "link", "knee"),
    _pin("link_hinge", "link", "bucket", "link_pin"),
    _pin("bucket_hinge", "arm", "bucket", "bucket_pin"),
)


def _angle(name: str, joint: str, what: str) -> RelativeCoordinate:
    return RelativeCoordinate(name, joint, "angle", "rad", f"{what}, from the start")


COORDINATES = (
    *(
        RelativeCoordinate(
            f"{c}_stroke", f"{c}_bore", "slide", "m", f"stroke of the {c} cylinder, from the start"
        )
        for c in _CYLINDERS
    ),
    _angle("boom_angle", "boom_hinge", "angle of the boom on the chassis, positive down"),
    _angle("arm_angle", "arm_hinge", "angle of the arm on the boom, positive towards the chassis"),
    _angle("rocker_angle", "rocker_hinge", "angle of the rocker on the arm"),
    _angle("link_angle", "knee_hinge", "angle of the link on the rocker"),
    _angle("bucket_angle", "bucket_hinge", "angle of the bucket on the arm, positive curling in"),
    *(
        _angle(f"{c}_cylinder_angle", f"{c}_barrel_hinge", f"angle of the {c} cylinder")
        for c in _CYLINDERS
    ),
)
PARAMETERS = (
    *places(_PLACES, "xz"),
    *(entry for name, values in _MASSES.items() for entry in inertia(name, *values, "y")),
    Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
)

EXCAVATOR = Mechanism(
    name="excavator",
    fixed="chassis",
    title="Planar excavator",
    bodies=BODIES,
    joints=JOINTS,
    forces=(
        Weight(gravity="gravity"),
        *(JointForce(joint=f"{c}_bore", input=f"{c}_force") for c in _CYLINDERS),
    ),
    parameters=PARAMETERS,
    coordinates=COORDINATES,
    inputs=tuple(
        Input(f"{c}_force", "N", f"force of the {c} cylinder, positive when it extends")
        for c in _CYLINDERS
    ),
)

_LOAD = {
    "hook": ((7.05, 1.55), "eye on the back of the bucket that the load hangs from"),
    "load_com": ((7.05, 0.35), "centre of mass of the load"),
}

LIFTING = Mechanism(
    name="excavator_lifting",
    fixed="chassis",
    title="Planar excavator that lifts a load on a hook",
    bodies=(*BODIES, Body("load", len(BODIES), center=flat("load_com", "y"))),
    joints=(*JOINTS, _pin("hook", "bucket", "load", "hook")),
    forces=(Weight(gravity="gravity"),),
    parameters=(*PARAMETERS, *places(_LOAD, "xz"), *inertia("load", 1500.0, 300.0, "y")),
    coordinates=(*COORDINATES, _angle("swing", "hook", "angle of the load on the bucket")),
    inputs=tuple(
        entry
        for c in _CYLINDERS
        for entry in motion(f"{c}_stroke", "m", f"stroke of the {c} cylinder, from the start")
    ),
)

MODELS = (
    Model(
        name="excavator",
        title="Planar excavator, three degrees of freedom, moved by the forces of its cylinders",
        mechanism=EXCAVATOR,
        independent=tuple(f"{c}_bore" for c in _CYLINDERS),
        massive=tuple(_MASSES),
    ),
    Model(
        name="excavator_lifting",
        title="Planar excavator, strokes prescribed, with a load that swings on its bucket",
        mechanism=LIFTING,
        independent=("hook",),
        prescribed={f"{c}_bore": f"{c}_stroke" for c in _CYLINDERS},
        massive=("load",),
        held={"cylinders_held": tuple(f"{c}_bore" for c in _CYLINDERS)},
    ),
)
