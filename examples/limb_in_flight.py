"""A box with a limb, in the air: a body that moves freely, and a damper that lags at its joint."""

from kintrafo import generator as g

# -- points and directions: x forward, y left, z up -----------------------------------------------

PIN = g.Point("pin", (0.2, 0.2, 0.8), "hinge of the limb")
PIN_LINE = g.Direction("pin_line", (0.0, 1.0, 0.0), "of the hinge")

# -- bodies and the joints between them -----------------------------------------------------------

BOX = g.Body("box", 5.0, (0.0, 0.0, 0.8), (0.11, 0.23, 0.31))
LIMB = g.Body("limb", 1.2, (0.5, 0.3, 0.7), (0.03, 0.07, 0.09))
FLIGHT = g.Free("flight", BOX)
SHOULDER = g.Revolute("shoulder", BOX, LIMB, g.Line(PIN, PIN_LINE))

# -- what acts on them ----------------------------------------------------------------------------

LAGGING = g.LaggingDamper(
    rate=g.TorsionDamperRate("soft_rate", 0.4, "rate of the damper"),
    lag=g.TimeConstant("soft_lag", 0.01, "lag of the damper"),
    state=g.InternalState("soft_moment", "N m", "moment of the lagging damper"),
)

MODEL = g.Formulation(
    name="limb_in_flight",
    title="A box with a limb, thrown",
    mechanism=g.Mechanism(
        name="limb_in_flight",
        title="A box with a limb",
        joints=(FLIGHT, SHOULDER),
        forces=(g.Weight(), g.ForceElement("shoulder_damper", g.AlongHinge(SHOULDER), (LAGGING,))),
        coordinates=(SHOULDER.angle("limb_angle", "angle of the limb"),),
    ),
    independent=(FLIGHT, SHOULDER),
)
