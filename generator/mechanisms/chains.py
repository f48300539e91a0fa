"""Closed chains of hinges, for which there is no closed form.

Seven hinges in general positions are the general loop: a polynomial of degree 16 in one of its
angles. Bricard's line-symmetric chain has six, and by Grübler's count no freedom; but its second
half is the first one after half a turn about a line, and so it moves. The numbers are this
project's own.

Their models are declared with ``allow_iteration=True``. They are not among those that come with the
project, whose code is all free of iteration.
"""

from __future__ import annotations

from itertools import pairwise

from ..declare.assembly import Body, Parameter, RelativeCoordinate
from ..declare.forces.joint_force import JointForce
from ..declare.forces.weight import Weight
from ..declare.geometry import Direction, Line, Point
from ..declare.inputs import Input
from ..declare.joints import Revolute
from ..declare.mechanism import Mechanism
from ..declare.model import Model
from ..declare.parameters import direction, point, rigid_body

Place = tuple[float, float, float]


def ring(name: str, title: str, places: list[Place], axes: list[Place]) -> Model:
    """Return a closed chain of hinges, each body hinged to the next and the last to the ground.

    Parameters
    ----------
    places, axes
        Of every hinge: a point, m, and a direction. The first hinge, on the ground, drives.
    """
    links = [f"link_{i}" for i in range(1, len(places))]
    hinges = [f"hinge_{i}" for i in range(len(places))]
    bodies = ["ground", *links, "ground"]
    middles = [
        tuple((a + b) / 2 for a, b in zip(one, two, strict=True)) for one, two in pairwise(places)
    ]
    mechanism = Mechanism(
        name=name,
        fixed="ground",
        title=title,
        bodies=(
            Body("ground", 0, center=Point("place_0")),
            *(Body(link, i, center=Point(f"{link}_com")) for i, link in enumerate(links, 1)),
        ),
        joints=tuple(
            Revolute(
                name=hinge,
                first=bodies[i],
                second=bodies[i + 1],
                axis=Line(Point(f"place_{i}"), Direction(f"axis_{i}")),
            )
            for i, hinge in enumerate(hinges)
        ),
        forces=(Weight(gravity="gravity"), JointForce(joint="hinge_0", input="torque")),
        parameters=(
            *(
                p
                for i, at in enumerate(places)
                for p in point(f"place_{i}", at, f"point of hinge_{i}")
            ),
            *(
                p
                for i, to in enumerate(axes)
                for p in direction(f"axis_{i}", to, f"axis of hinge_{i}")
            ),
            *(
                parameter
                for link, (x, y, z) in zip(links, middles, strict=True)
                for parameter in rigid_body(link, 0.8, (x, y, z), (0.002, 0.003, 0.004))
            ),
            Parameter("gravity", 9.81, "m/s^2", "acceleration of gravity"),
        ),
        coordinates=tuple(
            RelativeCoordinate(
                f"{hinge}_angle",
                hinge,
                "angle",
                "rad",
                f"angle of {hinge} from the design position",
            )
            for hinge in hinges
        ),
        inputs=(Input("torque", "N m", "torque on the first link"),),
    )
    return Model(
        name=name,
        title=title,
        mechanism=mechanism,
        independent=("hinge_0",),
        massive=tuple(links),
        allow_iteration=True,
    )


def _at(number: int, hinge: str, place: Place, axis: Place) -> list[Parameter]:
    """Return the parameters of a hinge."""
    return [
        *point(f"place_{number}", place, f"point of {hinge}"),
        *direction(f"axis_{number}", axis, f"axis of {hinge}"),
    ]


PLACES: list[Place] = [
    (0.3, 0.0, 0.1),
    (0.15, 0.3, -0.1),
    (-0.2, 0.25, 0.15),
    (-0.35, 0.0, 0.3),
    (-0.2, -0.3, 0.2),
    (0.05, -0.35, 0.0),
    (0.25, -0.2, 0.05),
]
AXES: list[Place] = [
    (0.1, 1.0, 0.4),
    (1.0, -0.2, 0.3),
    (0.2, 0.5, -1.0),
    (0.7, 0.6, 0.2),
    (-0.3, 0.4, 1.0),
    (1.0, 0.3, 0.3),
    (0.3, -0.8, 0.5),
]

SEVEN_HINGES = ring("seven_hinges", "Closed chain of seven hinges", PLACES, AXES)


def half_turned(vectors: list[Place]) -> list[Place]:
    """Return places or directions, and the same after half a turn about z."""
    return [*vectors, *((-x, -y, z) for x, y, z in vectors)]


BRICARD = ring(
    "bricard",
    "Bricard's line-symmetric chain of six hinges",
    half_turned([(0.3, 0.0, 0.1), (0.1, 0.3, -0.1), (-0.2, 0.2, 0.15)]),
    half_turned([(0.1, 1.0, 0.4), (1.0, -0.2, 0.3), (0.2, 0.5, -1.0)]),
)

MODELS = (SEVEN_HINGES, BRICARD)
