"""Scotch yokes: a crank moves a body on a guide by a pin in a slot."""

from __future__ import annotations

from kintrafo.generator import (
    Body,
    Direction,
    Formulation,
    Ground,
    Input,
    JointForce,
    Mechanism,
    Prismatic,
    flat,
    hinge,
)
from own_mechanisms import reported


def yoke(name: str, *, turned: bool = False, carried: bool = False) -> Formulation:
    """Return a Scotch yoke in a plane.

    Parameters
    ----------
    turned
        Whether both guides are declared the other way round, with a crank behind the yoke.
    carried
        Whether bearing and guide are on a body that turns on the ground.
    """
    moving = [*(["frame"] if carried else []), "crank", "block", "yoke"]
    bodies: dict[str, Body] = {"ground": Ground("ground")}
    bearings = {
        "frame": flat("frame_bearing", (-0.2, 0.1), "bearing of the frame"),
        "crank": flat("crank_bearing", (0.0, 0.0), "bearing of the crank"),
        "block": flat("crank_pin", (0.03, 0.04), "pin of the crank"),
    }
    centers = {b: flat(f"{b}_com", (0.1 * i, 0.05), b) for i, b in enumerate(moving)}
    for i, body in enumerate(moving, 1):
        bodies[body] = Body(body, 0.4 * i, centers[body], 2e-3 * i)
    ground, base = bodies["ground"], bodies["frame" if carried else "ground"]
    crank, block, moved = (bodies[b] for b in ("crank", "block", "yoke"))
    slot = (block, moved) if turned else (moved, block)
    guide = (moved, base) if turned else (base, moved)
    driving = hinge("A", base, crank, bearings["crank"])
    joints = (
        *([hinge("F", ground, base, bearings["frame"])] if carried else []),
        driving,
        hinge("B", crank, block, bearings["block"]),
        Prismatic("slot", *slot, Direction("slot", (0.3, 1.0, 0.0), "the slot")),
        Prismatic("guide", *guide, Direction("guide", (1.0, 0.2, 0.0), "the guide")),
    )
    mechanism = Mechanism(
        name=name,
        title="Scotch yoke",
        joints=joints,
        forces=(JointForce(driving, Input("torque", "N m", "torque on the crank")),),
        coordinates=reported(joints),
    )
    return Formulation(name, "Scotch yoke", mechanism, joints[: 2 if carried else 1])


SCOTCH_YOKE = yoke("scotch_yoke")
