"""A chain of N four-bar linkages side by side: benchmark A02 of the IFToMM library.

N + 1 rockers of 1 m are on the ground 1 m apart, and N couplers of 1 m join their upper ends; one
degree of freedom for any N. The benchmark starts it upright. All rockers level is a singular
position (every loop is a flat parallelogram there), which this formulation reports and does not
pass.
"""

from __future__ import annotations

from .. import declare as d
from ..declare import flat, hinge


def _bar(name: str, x: float, z: float) -> d.Body:
    """Return a slender bar of 1 kg and 1 m, its centre at a given place."""
    return d.Body(name, 1.0, flat(f"{name}_com", (x, z), f"centre of {name}", "y"), 1.0 / 12.0)


def n_four_bar(count: int) -> d.Formulation:
    """Return the chain of some number of four-bar linkages."""
    ground = d.Ground("ground")
    rockers, feet, tops = [], [], []
    for i in range(count + 1):
        name = f"rocker_{i}"
        feet.append(flat(f"base_{i}", (float(i), 0.0), f"hinge of {name} on the ground", "y"))
        tops.append(flat(f"top_{i}", (float(i), 1.0), f"upper end of {name}", "y"))
        rockers.append(_bar(name, float(i), 0.5))
    couplers = [_bar(f"coupler_{i}", i - 0.5, 1.0) for i in range(1, count + 1)]
    crank = hinge("crank", ground, rockers[0], feet[0])
    joints = [crank]
    for i, coupler in enumerate(couplers, 1):
        joints += [
            hinge(f"left_{i}", rockers[i - 1], coupler, tops[i - 1]),
            hinge(f"right_{i}", coupler, rockers[i], tops[i]),
            hinge(f"foot_{i}", ground, rockers[i], feet[i]),
        ]
    mechanism = d.Mechanism(
        name=f"four_bars_{count}",
        title=f"Chain of {count} four-bar linkages",
        joints=tuple(joints),
        forces=(
            d.Weight(),
            d.JointForce(crank, d.Input("crank_torque", "N m", "torque on the first rocker")),
        ),
        coordinates=(crank.angle("crank_angle", "angle from upright"),),
    )
    return d.Formulation(
        name=mechanism.name,
        title=mechanism.title,
        mechanism=mechanism,
        independent=(crank,),
        massive=(*rockers, *couplers),
    )
