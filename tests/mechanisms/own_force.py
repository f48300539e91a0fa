"""A force with the law of a function, on an arm and a rod."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from kintrafo import generator as g
from kintrafo.generator.declare.forces.force import Force

GROUND = g.Ground("ground")
ARM = g.Body("arm", 1.0, g.flat("com", (0.0, 0.0)), 1.0)
ROD = g.Body("rod", 1.0, g.flat("rod_com", (1.0, 0.0)), 1.0)
A = g.hinge("A", GROUND, ARM, g.flat("a", (0.0, 0.0)))
B = g.hinge("B", ARM, ROD, g.flat("b", (1.0, 0.0)))
GUIDE = g.Prismatic("guide", GROUND, ARM, g.FORWARD)
FOLLOWER = g.Revolute(
    "follower",
    GROUND,
    ROD,
    g.Line(g.flat("f", (2.0, 0.0)), g.UP),
    follows=g.Gear(A, g.Ratio("r", 2.0, "r")),
)


@dataclass(frozen=True)
class Own(Force):
    """A force with the law of a function."""

    does: Callable[[Any], Any] = field(hash=False, compare=False)
    shows: Callable[[Any, Any], Any] | None = field(default=None, hash=False, compare=False)
    parts: tuple[Any, ...] = ()

    @property
    def identity(self):
        return "Own", "force"

    def act(self, at):
        return self.does(at)


@dataclass(frozen=True)
class Showing(Own):
    """One that has signals, too."""

    def signals(self, at, action):
        assert self.shows is not None
        yield from self.shows(at, action)


def mechanism(force, *joints):
    joints = joints or (A,)
    reported = tuple(j.angle(f"q_{j.name}", "angle") for j in joints if j.kind == "revolute")
    return g.Mechanism(
        name="own_force", title="t", joints=joints, forces=(force,), coordinates=reported
    )


def model(force, *joints):
    whole = mechanism(force, *joints)
    return g.Formulation(
        name="own_force",
        title="t",
        mechanism=whole,
        independent=tuple(j for j in whole.joints if not j.follows),
    )
