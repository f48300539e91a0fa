"""Bodies that are welded to others: the same as one body of both."""

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from oracle.constraints import skew

FRAME = g.Ground("frame")
PIVOT = g.Point("pivot", (0.1, 0.0, 1.0))
ACROSS = g.Direction("across", (0.2, 1.0, 0.1))
MASSES = {"arm": (2.0, 0.03, 0.04, 0.02), "burden": (1.5, 0.01, 0.02, 0.03)}
ARM = g.Body("arm", MASSES["arm"][0], (0.3, 0.05, 0.7), MASSES["arm"][1:])
SWING = g.Revolute("swing", FRAME, ARM, g.Line(PIVOT, ACROSS))
BURDEN = g.Body("burden", MASSES["burden"][0], (0.5, 0.2, 0.4), MASSES["burden"][1:])
WELD = g.Weld("weld", ARM, BURDEN)
TIP = g.Point("tip", (0.6, 0.3, 0.3))


def pendulum():
    """Return an arm with a burden, and where a point of the burden is."""
    mechanism = g.Mechanism(
        "welded_pendulum",
        "Pendulum of two bodies",
        (SWING, WELD),
        (g.Weight(),),
        (SWING.angle("swing_angle", "arm"),),
        (g.PositionOf("tip", BURDEN, TIP, "tip of the burden"),),
    )
    return kintrafo.System(kintrafo.compile(mechanism))


def test_both_swing_as_one_body():
    """By the moments of inertia about the hinge, and the moment of the weights."""
    system = pendulum()
    n = np.array(ACROSS.along) / np.linalg.norm(ACROSS.along)
    turn, rate = 0.7, 1.3
    cross = skew(n)
    rotation = np.eye(3) + np.sin(turn) * cross + (1.0 - np.cos(turn)) * cross @ cross
    inertia, moment = 0.0, 0.0
    for body in (ARM, BURDEN):
        mass, *moments = MASSES[body.name]
        tensor = np.diag(moments)
        arm = np.array(body.center.place) - PIVOT.place
        inertia += n @ tensor @ n + mass * (arm @ arm - (arm @ n) ** 2)
        moment += n @ np.cross(rotation @ arm, [0.0, 0.0, -9.81 * mass])
    found = system.evaluate("rhs", [turn, rate])
    assert found[1] == pytest.approx(moment / inertia, rel=1e-14)
    tip = PIVOT.place + rotation @ (np.array(TIP.place) - PIVOT.place)
    signals = system.signals([turn, rate])
    np.testing.assert_allclose([signals[f"tip_{axis}"] for axis in "xyz"], tip, rtol=1e-15)


def test_what_is_joined_to_a_welded_body_belongs_to_the_other(refused):
    hand = g.Body("hand", 1.0, (0.6, 0.3, 0.2), (0.01, 0.01, 0.01))
    wrist = g.Revolute("wrist", BURDEN, hand, g.Line(TIP, ACROSS))
    refused(g.DeclarationError, lambda: g.Mechanism("hand", "Hand", (SWING, WELD, wrist)))


def test_a_weld_to_the_ground_is_refused(refused):
    post = g.Body("post", 1.0, (0.6, 0.3, 0.2), (0.01, 0.01, 0.01))
    refused(
        g.DeclarationError,
        lambda: g.Mechanism("post", "Post", (SWING, g.Weld("rivet", FRAME, post))),
    )


def test_a_weld_is_not_driven(refused):
    system = g.Mechanism("p", "P", (SWING, WELD), (), (SWING.angle("a", "arm"),))
    refused(g.DeclarationError, lambda: g.Formulation("p", "P", system, (WELD,)))
