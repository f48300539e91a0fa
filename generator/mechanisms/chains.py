"""Closed chains of hinges without a closed form.

Seven hinges in general positions are the general loop: a polynomial of degree 16 in one of its
angles. Bricard's line-symmetric chain has six, and by Grübler's count no degree of freedom; but its
second half is the first one after half a turn about a line, and so it moves. The numbers are this
project's own.

Their models are declared with ``allow_iteration=True``. They are not among those that come with the
project, whose code is all free of iteration.
"""

from __future__ import annotations

from itertools import pairwise

from .. import declare as d

Place = tuple[float, float, float]


def ring(name: str, title: str, places: list[Place], axes: list[Place]) -> d.Formulation:
    """Return a closed chain of hinges, each body hinged to the next and the last to the ground.

    Each hinge has a point, m, and a direction. The first hinge, on the ground, drives.
    """
    ground = d.Ground("ground")
    middles = [
        tuple((a + b) / 2 for a, b in zip(one, two, strict=True)) for one, two in pairwise(places)
    ]
    links = tuple(
        d.Body(f"link_{i}", 0.8, (x, y, z), (0.002, 0.003, 0.004))
        for i, (x, y, z) in enumerate(middles, 1)
    )
    points = [d.Point(f"place_{i}", at, f"point of hinge_{i}") for i, at in enumerate(places)]
    along = [d.Direction(f"axis_{i}", to, f"axis of hinge_{i}") for i, to in enumerate(axes)]
    hinges = tuple(
        d.Revolute(f"hinge_{i}", *pair, axis=d.Line(points[i], along[i]))
        for i, pair in enumerate(pairwise((ground, *links, ground)))
    )
    mechanism = d.Mechanism(
        name=name,
        title=title,
        joints=hinges,
        forces=(
            d.Weight(),
            d.JointForce(hinges[0], d.Input("torque", "N m", "torque on the first link")),
        ),
        coordinates=tuple(
            hinge.angle(f"{hinge.name}_angle", f"angle of {hinge.name} from the design position")
            for hinge in hinges
        ),
    )
    return d.Formulation(
        name=name,
        title=title,
        mechanism=mechanism,
        independent=hinges[:1],
        massive=links,
        allow_iteration=True,
    )


PLACES: list[Place] = [
    (0.3, 0.0, 0.1), (0.15, 0.3, -0.1), (-0.2, 0.25, 0.15), (-0.35, 0.0, 0.3),
    (-0.2, -0.3, 0.2), (0.05, -0.35, 0.0), (0.25, -0.2, 0.05),
]  # fmt: skip
AXES: list[Place] = [
    (0.1, 1.0, 0.4), (1.0, -0.2, 0.3), (0.2, 0.5, -1.0), (0.7, 0.6, 0.2),
    (-0.3, 0.4, 1.0), (1.0, 0.3, 0.3), (0.3, -0.8, 0.5),
]  # fmt: skip

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

EMITTED = False  # they are in tests and examples
MODELS = (SEVEN_HINGES, BRICARD)
