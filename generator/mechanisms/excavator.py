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

from .. import declare as d
from ..declare import flat, hinge

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
_POINTS = {name: flat(name, place, meaning, "y") for name, (place, meaning) in _PLACES.items()}
_BODIES = {
    name: d.Body(name, mass, _POINTS[f"{name}_com"], moment)
    for name, (mass, moment) in _MASSES.items()
}
CHASSIS = d.Ground("chassis")
BOOM, ARM, ROCKER, LINK, BUCKET = (
    _BODIES[name] for name in ("boom", "arm", "rocker", "link", "bucket")
)


def _pin(name: str, first: d.Body, second: d.Body, at: str) -> d.Revolute:
    return hinge(name, first, second, _POINTS[at])


def _cylinder(
    name: str, base: d.Body, body: d.Body, rod_pin: str
) -> tuple[d.Revolute, d.Prismatic, d.Revolute]:
    """Return the joints of a cylinder, its barrel on one body and its rod on another."""
    barrel, rod, barrel_pin = (
        _BODIES[f"{name}_barrel"],
        _BODIES[f"{name}_rod"],
        f"{name}_barrel_pin",
    )
    bore = d.Direction(f"{name}_bore", between=(_POINTS[barrel_pin], _POINTS[rod_pin]))
    return (
        _pin(f"{name}_barrel_hinge", base, barrel, barrel_pin),
        d.Prismatic(f"{name}_bore", barrel, rod, direction=bore),
        _pin(f"{name}_rod_hinge", rod, body, rod_pin),
    )


CYLINDERS = {
    "boom": _cylinder("boom", CHASSIS, BOOM, "boom_rod_pin"),
    "arm": _cylinder("arm", BOOM, ARM, "arm_rod_pin"),
    "bucket": _cylinder("bucket", ARM, ROCKER, "knee"),
}
BORES = {name: bore for name, (_, bore, _) in CYLINDERS.items()}
BOOM_HINGE = _pin("boom_hinge", CHASSIS, BOOM, "boom_foot")
ARM_HINGE = _pin("arm_hinge", BOOM, ARM, "arm_pin")
ROCKER_HINGE = _pin("rocker_hinge", ARM, ROCKER, "rocker_pin")
KNEE_HINGE = _pin("knee_hinge", ROCKER, LINK, "knee")
LINK_HINGE = _pin("link_hinge", LINK, BUCKET, "link_pin")
BUCKET_HINGE = _pin("bucket_hinge", ARM, BUCKET, "bucket_pin")
JOINTS = (
    BOOM_HINGE, *CYLINDERS["boom"], ARM_HINGE, *CYLINDERS["arm"], ROCKER_HINGE,
    *CYLINDERS["bucket"], KNEE_HINGE, LINK_HINGE, BUCKET_HINGE,
)  # fmt: skip


def _angle(name: str, joint: d.Revolute, what: str) -> d.RelativeCoordinate:
    return joint.angle(name, f"{what}, from the start")


COORDINATES = (
    *(
        bore.slide(f"{c}_stroke", f"stroke of the {c} cylinder, from the start")
        for c, bore in BORES.items()
    ),
    _angle("boom_angle", BOOM_HINGE, "angle of the boom on the chassis, positive down"),
    _angle("arm_angle", ARM_HINGE, "angle of the arm on the boom, positive towards the chassis"),
    _angle("rocker_angle", ROCKER_HINGE, "angle of the rocker on the arm"),
    _angle("link_angle", KNEE_HINGE, "angle of the link on the rocker"),
    _angle("bucket_angle", BUCKET_HINGE, "angle of the bucket on the arm, positive curling in"),
    *(
        _angle(f"{c}_cylinder_angle", foot, f"angle of the {c} cylinder")
        for c, (foot, *_) in CYLINDERS.items()
    ),
)
WEIGHT = d.Weight()

EXCAVATOR = d.Mechanism(
    name="excavator",
    title="Planar excavator",
    joints=JOINTS,
    forces=(
        WEIGHT,
        *(
            d.JointForce(
                bore,
                d.Input(f"{c}_force", "N", f"force of the {c} cylinder, positive when it extends"),
            )
            for c, bore in BORES.items()
        ),
    ),
    coordinates=COORDINATES,
)

_EYE = flat("hook", (7.05, 1.55), "eye on the back of the bucket that the load hangs from", "y")
_LOAD_COM = flat("load_com", (7.05, 0.35), "centre of mass of the load", "y")
LOAD = d.Body("load", 1500.0, _LOAD_COM, 300.0)
HOOK = hinge("hook", BUCKET, LOAD, _EYE)

LIFTING = d.Mechanism(
    name="excavator_lifting",
    title="Planar excavator that lifts a load on a hook",
    joints=(*JOINTS, HOOK),
    forces=(WEIGHT,),
    coordinates=(*COORDINATES, _angle("swing", HOOK, "angle of the load on the bucket")),
)

MODELS = (
    d.Formulation(
        name="excavator",
        title="Planar excavator, three degrees of freedom, moved by the forces of its cylinders",
        mechanism=EXCAVATOR,
        independent=tuple(BORES.values()),
        massive=tuple(_BODIES.values()),
    ),
    d.Formulation(
        name="excavator_lifting",
        title="Planar excavator, strokes prescribed, with a load that swings on its bucket",
        mechanism=LIFTING,
        independent=(HOOK,),
        prescribed={
            bore: d.Motion(f"{c}_stroke", "m", f"stroke of the {c} cylinder, from the start")
            for c, bore in BORES.items()
        },
        massive=(LOAD,),
        held={"cylinders_held": tuple(BORES.values())},
    ),
)
