"""Scotch yokes: a crank moves a body on a guide by a pin in a slot."""

from __future__ import annotations

from kintrafo.generator import (
    Body,
    Direction,
    Input,
    JointForce,
    Mechanism,
    Model,
    Prismatic,
    RelativeCoordinate,
    direction,
)
from kintrafo.generator.mechanisms.planar import flat, hinge, inertia, places


def yoke(name: str, *, turned: bool = False, carried: bool = False) -> Model:
    """Return a Scotch yoke in a plane.

    Parameters
    ----------
    turned
        Whether both guides are declared the other way round, with a crank behind the yoke.
    carried
        Whether bearing and guide are on a body that turns on the ground.
    """
    base = "frame" if carried else "ground"
    slot = ("block", "yoke") if turned else ("yoke", "block")
    guide = ("yoke", base) if turned else (base, "yoke")
    frame = [hinge("F", "ground", "frame", "frame_bearing")] if carried else []
    joints = (
        *frame,
        hinge("A", base, "crank", "crank_bearing"),
        hinge("B", "crank", "block", "crank_pin"),
        Prismatic(name="slot", first=slot[0], second=slot[1], direction=Direction("slot")),
        Prismatic(name="guide", first=guide[0], second=guide[1], direction=Direction("guide")),
    )
    moving = [*(["frame"] if carried else []), "crank", "block", "yoke"]
    parameters = (
        *places(
            {
                "frame_bearing": ((-0.2, 0.1), "bearing of the frame"),
                "crank_bearing": ((0.0, 0.0), "bearing of the crank"),
                "crank_pin": ((0.03, 0.04), "pin of the crank"),
                **{f"{b}_com": ((0.1 * i, 0.05), b) for i, b in enumerate(moving)},
            }
        ),
        *(p for i, b in enumerate(moving, 1) for p in inertia(b, 0.4 * i, 2e-3 * i)),
        *direction("slot", (0.3, 1.0, 0.0), "the slot"),
        *direction("guide", (1.0, 0.2, 0.0), "the guide"),
    )
    mechanism = Mechanism(
        name=name,
        fixed="ground",
        title="Scotch yoke",
        bodies=(
            Body("ground", 0, center=flat("crank_bearing")),
            *(Body(b, i, center=flat(f"{b}_com")) for i, b in enumerate(moving, 1)),
        ),
        joints=joints,
        forces=(JointForce(joint="A", input="torque"),),
        parameters=parameters,
        coordinates=tuple(
            RelativeCoordinate(f"{j.name}_coordinate", j.name, j.coordinates[0], "1", j.name)
            for j in joints
        ),
        inputs=(Input("torque", "N m", "torque on the crank"),),
    )
    independent = ("F", "A") if carried else ("A",)
    return Model(name, "Scotch yoke", mechanism, independent, tuple(moving))


SCOTCH_YOKE = yoke("scotch_yoke")
