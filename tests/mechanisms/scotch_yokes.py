"""Scotch yokes: a crank moves a body on a guide by a pin in a slot."""

from kintrafo import generator as g

from mechanisms.every_closed_form import NORMAL, askew, declare, guide, heading, reported
from mechanisms.every_closed_form import hinge as sketched


def yoke(name, *, turned=False, carried=False):
    """Return a Scotch yoke in a plane.

    Parameters
    ----------
    turned
        Whether both guides are declared the other way round, with a crank behind the yoke.
    carried
        Whether bearing and guide are on a body that turns on the ground.
    """
    moving = [*(["frame"] if carried else []), "crank", "block", "yoke"]
    bodies = {"ground": g.Ground("ground")}
    bearings = {
        "frame": g.flat("frame_bearing", (-0.2, 0.1), "bearing of the frame"),
        "crank": g.flat("crank_bearing", (0.0, 0.0), "bearing of the crank"),
        "block": g.flat("crank_pin", (0.03, 0.04), "pin of the crank"),
    }
    centers = {b: g.flat(f"{b}_com", (0.1 * i, 0.05), b) for i, b in enumerate(moving)}
    for i, body in enumerate(moving, 1):
        bodies[body] = g.Body(body, 0.4 * i, centers[body], 2e-3 * i)
    ground, base = bodies["ground"], bodies["frame" if carried else "ground"]
    crank, block, moved = (bodies[b] for b in ("crank", "block", "yoke"))
    slot = (block, moved) if turned else (moved, block)
    guide = (moved, base) if turned else (base, moved)
    driving = g.hinge("A", base, crank, bearings["crank"])
    joints = (
        *([g.hinge("F", ground, base, bearings["frame"])] if carried else []),
        driving,
        g.hinge("B", crank, block, bearings["block"]),
        g.Prismatic("slot", *slot, g.Direction("slot", (0.3, 1.0, 0.0), "the slot")),
        g.Prismatic("guide", *guide, g.Direction("guide", (1.0, 0.2, 0.0), "the guide")),
    )
    mechanism = g.Mechanism(
        name=name,
        title="Scotch yoke",
        joints=joints,
        forces=(g.JointForce(driving, g.Input("torque", "N m", "torque on the crank")),),
        coordinates=reported(joints),
    )
    return g.Formulation(name, "Scotch yoke", mechanism, joints[: 2 if carried else 1])


SCOTCH_YOKE = yoke("scotch_yoke")

WHEEL_ON_A_YOKE = declare(
    "wheel_on_a_yoke",
    {"crank": askew(0.02, 0.02), "block": askew(0.03, 0.05), "yoke": askew(0.2, 0.05),
     "wheel": askew(0.03, 0.03, 0.05)},
    (sketched("crank_hinge", "ground", "crank", "crank_pivot", "normal"),
     sketched("pin", "crank", "block", "crank_pin", "normal"),
     guide("slot", "yoke", "block", "slot_direction"),
     guide("rail", "ground", "yoke", "rail_direction"),
     sketched("bearing", "crank", "wheel", "wheel_com", "normal")),
    {"crank_pivot": askew(0.0, 0.0), "crank_pin": askew(0.03, 0.04), "ground_top": askew(0.2, 0.6),
     "yoke_seat": askew(0.25, 0.3)},
    {"normal": NORMAL, "slot_direction": heading(1.4), "rail_direction": heading(0.2)},
    ("crank_hinge", "bearing"),
    spring=("ground_top", "yoke_seat"),
    wheel=("wheel", NORMAL),
)  # fmt: skip
"""One in an oblique plane, with a wheel on its crank: directions that must agree in two ways."""
