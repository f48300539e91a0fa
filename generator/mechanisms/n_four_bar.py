"""A chain of N four-bar linkages side by side: benchmark A02 of the IFToMM library.

N + 1 rockers of 1 m stand on the ground 1 m apart, and N couplers of 1 m join their upper ends; one
degree of freedom whatever N is. The benchmark starts it upright. All rockers level is a singular
position (every loop is a flat parallelogram there), which this formulation reports and does not
pass.
"""

from __future__ import annotations

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.joint_force import JointForce
from ..declare.forces.weight import Weight
from ..declare.inputs import Input
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from .planar import flat, hinge, inertia


def _bar(name: str, x: float, z: float) -> list[Parameter]:
    """Return the parameters of a slender bar of 1 kg and 1 m, its centre at a given place."""
    return [
        Parameter(f"{name}_com_x", x, "m", f"centre of {name}, x"),
        Parameter(f"{name}_com_z", z, "m", f"centre of {name}, z"),
        *inertia(name, 1.0, 1.0 / 12.0, "y"),
    ]


def n_four_bar(count: int) -> Model:
    """Return the chain of some number of four-bar linkages."""
    rockers = [f"rocker_{i}" for i in range(count + 1)]
    couplers = [f"coupler_{i}" for i in range(1, count + 1)]
    bodies = [Body("ground", 0, center=flat("base_0", "y"))]
    joints = [hinge("crank", "ground", rockers[0], "base_0", "y")]
    parameters: list[Parameter] = []
    for i, name in enumerate(rockers):
        bodies.append(Body(name, len(bodies), center=flat(f"{name}_com", "y")))
        parameters += [
            Parameter(f"base_{i}_x", float(i), "m", f"hinge of {name} on the ground, x"),
            Parameter(f"base_{i}_z", 0.0, "m", f"hinge of {name} on the ground, z"),
            Parameter(f"top_{i}_x", float(i), "m", f"upper end of {name}, x"),
            Parameter(f"top_{i}_z", 1.0, "m", f"upper end of {name}, z"),
            *_bar(name, float(i), 0.5),
        ]
    for i, name in enumerate(couplers, 1):
        bodies.append(Body(name, len(bodies), center=flat(f"{name}_com", "y")))
        parameters += _bar(name, i - 0.5, 1.0)
        joints += [
            hinge(f"left_{i}", rockers[i - 1], name, f"top_{i - 1}", "y"),
            hinge(f"right_{i}", name, rockers[i], f"top_{i}", "y"),
            hinge(f"foot_{i}", "ground", rockers[i], f"base_{i}", "y"),
        ]
    mechanism = Mechanism(
        name=f"four_bars_{count}",
        fixed="ground",
        title=f"Chain of {count} four-bar linkages",
        bodies=tuple(bodies),
        joints=tuple(joints),
        forces=(Weight(gravity="gravity"), JointForce(joint="crank", input="crank_torque")),
        parameters=(*parameters, Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity")),
        coordinates=(
            RelativeCoordinate("crank_angle", "crank", "angle", "rad", "angle from upright"),
        ),
        inputs=(Input("crank_torque", "N m", "torque on the first rocker"),),
    )
    return Model(
        name=mechanism.name,
        title=mechanism.title,
        mechanism=mechanism,
        independent=("crank",),
        massive=tuple(b.name for b in bodies[1:]),
    )
