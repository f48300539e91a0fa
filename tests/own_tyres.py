"""A wheel on a test rig: it slides, steers, leans and spins, all of it by coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from kintrafo import generator as g

if TYPE_CHECKING:
    from kintrafo.generator.declare.contact_laws import ContactLaw

CENTER = g.Point("wheel_center", (0.0, 0.0, 0.31), "wheel centre")
SPIN = g.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")
ROAD = g.Input("road_height", "m", "height of the road under the tyre")
ROAD_VELOCITY = g.Input("road_velocity", "m/s", "rate of the road's height", ROAD)
DEFLECTIONS = (
    g.InternalState("tyre_along", "m", "deflection of the contact, forward"),
    g.InternalState("tyre_across", "m", "deflection of the contact, to the left"),
)
COORDINATES = ("ahead", "across", "heave", "steering", "lean", "spin")


def rig(
    law: ContactLaw, name: str, *, damped: bool = False, relaxing: bool = False
) -> g.Formulation:
    """Return a wheel that hangs on three guides and turns about three axes through its centre."""
    ground = g.Ground("rig", 1)
    line = {
        axis: g.Direction(f"world_{axis}", fixed=along)
        for axis, along in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1)))
    }
    sled, carriage, column, fork, carrier = (
        g.Body(body, 2.0, (0.0, 0.02, 0.35), (0.01, 0.02, 0.03))
        for body in ("sled", "carriage", "column", "fork", "carrier")
    )
    wheel = g.Rotor("wheel", 18.0, CENTER, axis=SPIN, spin=1.1, diametral=0.6)
    through = {axis: g.Line(CENTER, line[axis]) for axis in "xz"}
    joints = (
        g.Prismatic("ahead", ground, sled, line["x"]),
        g.Prismatic("across", sled, carriage, line["y"]),
        g.Prismatic("heave", carriage, column, line["z"]),
        g.Revolute("steering", column, fork, through["z"]),
        g.Revolute("lean", fork, carrier, through["x"]),
        g.Revolute("spin", carrier, wheel, g.Line(CENTER, SPIN)),
    )
    tyre = g.RollingTyre(
        name="tyre",
        wheel=g.Wheel(carrier, CENTER, SPIN),
        bearing=joints[-1],
        law=law,
        road=ROAD,
        damper=g.DamperRate("tyre_damper_rate", 500.0, "damping") if damped else None,
        road_velocity=ROAD_VELOCITY if damped else None,
        deflections=DEFLECTIONS if relaxing else None,
    )
    mechanism = g.Mechanism(
        name=name,
        title=name,
        joints=joints,
        forces=(g.Weight(), tyre),
        coordinates=(
            *(j.slide(f"{j.name}_slide", f"slide of {j.name}") for j in joints[:3]),
            *(j.angle(f"{j.name}_angle", f"angle of {j.name}") for j in joints[3:]),
        ),
    )
    return g.Formulation(name, name, mechanism, independent=joints)
