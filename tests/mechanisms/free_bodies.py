"""Bodies that move freely in the world, with bodies and forces on them."""

from dataclasses import replace

import numpy as np
from kintrafo import generator as g
from kintrafo.generator.declare.world import WORLD
from support.changes import changed

INERTIA = (0.11, 0.23, 0.31, 0.02, -0.03, 0.01)


def freed(model):
    """Return a model whose ground is a body that moves freely in the world."""
    mechanism = model.mechanism
    ground = next(body for body in mechanism.bodies if isinstance(body, g.Ground))
    moving = g.Body(ground.name, 4.0, (0.1, -0.1, 0.2), INERTIA, order=ground.order)
    joint = g.Free("flight", moving)
    pairs = [(ground, moving)]
    parts = ("joints", "forces", "coordinates", "outputs")
    found = {name: changed(getattr(mechanism, name), *pairs) for name in parts}
    moved = replace(mechanism, **found | {"joints": (joint, *found["joints"])})
    return replace(
        model,
        name=f"free_{model.name}",
        mechanism=moved,
        independent=(joint, *changed(model.independent, *pairs)),
        prescribed=changed(dict(model.prescribed), *pairs),
        held=changed(dict(model.held), *pairs),
        massive=(moving, *model.massive),
    )


def thrown():
    """Return a body in the air."""
    body = g.Body("block", 3.0, (0.4, -0.2, 0.9), INERTIA)
    joint = g.Free("flight", body)
    kinds = ("x", "y", "z", "yaw", "pitch", "roll")
    mechanism = g.Mechanism(
        "thrown",
        "a body in the air",
        joints=(joint,),
        forces=(g.Weight(),),
        coordinates=tuple(joint.coordinate(kind, kind, f"{kind} of the block") for kind in kinds),
    )
    return g.Formulation("thrown", "a body in the air", mechanism, independent=(joint,))


def rig():
    """Return a box with a limb and a flywheel, and a ball beside it: both move freely."""
    box = g.Body("box", 5.0, (0.0, 0.1, 0.8), INERTIA)
    ball = g.Body("ball", 0.7, (0.4, 0.8, 0.5), (0.02, 0.03, 0.025))
    limb = g.Body("limb", 1.2, (0.5, 0.3, 0.7), tuple(0.3 * value for value in INERTIA))
    spin_axis = g.Direction("spin_axis", (0.3, 0.9, -0.2))
    flywheel = g.Rotor(
        "flywheel", 0.8, g.Point("hub", (-0.2, 0.1, 0.9)), axis=spin_axis, spin=0.05, diametral=0.03
    )
    shoulder = g.Point("shoulder", (0.2, 0.2, 0.8), "shoulder")
    tip, hook, post, eye = (
        g.Point("tip", (0.8, 0.5, 0.6)),
        g.Point("hook", (-0.1, -0.2, 0.9)),
        g.Point("post", (-0.4, 0.3, 1.4)),
        g.Point("eye", (0.45, 0.7, 0.55)),
    )
    swing = g.Revolute(
        "swing", box, limb, g.Line(shoulder, g.Direction("swing_line", (0.2, -0.5, 0.8)))
    )
    spinning = g.Revolute("spinning", box, flywheel, g.Line(flywheel.center, spin_axis))
    joints = (g.Free("box_flight", box), g.Free("ball_flight", ball), swing, spinning)
    mechanism = g.Mechanism(
        "rig",
        "a box with a limb, and a ball",
        joints=joints,
        forces=(
            g.Weight(g.Gravity("gravity", 9.81, "acceleration of gravity")),
            _spring("tether", (WORLD, post), (box, hook), damping=4.0),
            _spring("band", (ball, eye), (limb, tip)),
            g.AppliedForce(
                limb,
                tip,
                g.Direction("pull_line", (0.6, 0.5, -0.7)),
                g.Input("pull", "N", "pull at the tip"),
            ),
        ),
        coordinates=(
            swing.angle("swing_angle", "angle of the limb"),
            spinning.angle("spin_angle", "angle of the flywheel"),
        ),
        outputs=(
            g.PositionOf("tip_place", limb, tip, "tip"),
            g.VelocityOf("tip_velocity", limb, tip, "tip"),
            g.AccelerationOf("tip_acceleration", limb, tip, "tip"),
            g.DistanceBetween("gap", (box, hook), (ball, eye), "gap of hook and eye"),
        ),
    )
    return g.Formulation("rig", "a box with a limb, and a ball", mechanism, independent=joints)


def _spring(name, first, second, damping=0.0):
    spring = g.LinearSpring(
        g.SpringRate(f"{name}_stiffness", 90.0, f"rate of the {name}"),
        free_length=g.Length(f"{name}_free_length", 0.3, f"length of the {name} without force"),
    )
    damper = g.LinearDamper(g.DamperRate(f"{name}_damping", damping, f"damping of the {name}"))
    return g.ForceElement(name, g.AlongLine(first, second), (spring, damper))


def unit_quaternion(random):
    """Return a random rotation with a uniform distribution."""
    q = random.normal(size=4)
    return q / np.linalg.norm(q)


def product(a, b):
    """Return the product of two quaternions, scalar first."""
    scalar = a[0] * b[0] - a[1:] @ b[1:]
    return np.array([scalar, *(a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:]))])


def rotation(q):
    """Return the matrix of a unit quaternion, by its products with the axes."""
    back = q * [1.0, -1.0, -1.0, -1.0]
    columns = [product(product(q, np.array([0.0, *axis])), back)[1:] for axis in np.eye(3)]
    return np.array(columns).T


def state_near(built, random, reach=0.05, speed=2.0):
    """Return a state of a compiled model with free bodies anywhere, and joints near design."""
    layout, state = built.module.LAYOUT, built.module.design_state(built.parameters)
    for place in layout.joints:
        state[place] += random.uniform(-reach, reach)
    for place in layout.free:
        state[place : place + 3] += random.normal(size=3) * reach
        state[place + 3 : place + 7] = unit_quaternion(random)
    state[layout.positions :] = random.uniform(-speed, speed, layout.speeds)
    return state


def compared(built, count, reach=0.05):
    """Yield random states and inputs, the motion there, and its accelerations by the oracle.

    The last element is the number of positions, which come before the speeds in a state.
    """
    random, layout = np.random.default_rng(0), built.module.LAYOUT
    names = list(built.module.INPUTS)
    for _ in range(count):
        state, inputs = state_near(built, random, reach), random.uniform(-1.0, 1.0, len(names))
        inputs[[name.endswith("_position") for name in names]] *= reach
        motion, named = built.motion(state, inputs), built.named(inputs)
        given = {joint: named[moved.rates[1]] for joint, moved in built.model.motions.items()}
        yield state, inputs, motion, built.oracle.reduced(motion, named, given), layout.positions


def tethered():
    """Return a body in the air that hangs on a spring, with a damper beside it."""
    block = g.Body("block", 3.0, (0.4, -0.2, 0.9), INERTIA)
    hook, post = g.Point("hook", (0.5, -0.1, 1.1)), g.Point("post", (0.6, 0.1, 1.6))
    joint = g.Free("flight", block)
    mechanism = g.Mechanism(
        "tethered",
        "a body on a spring",
        joints=(joint,),
        forces=(g.Weight(), _spring("tether", (WORLD, post), (block, hook))),
        outputs=(g.PositionOf("hook_place", block, hook, "hook"),),
    )
    return g.Formulation("tethered", "a body on a spring", mechanism, independent=(joint,))
