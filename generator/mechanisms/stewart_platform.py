"""A Stewart platform: a body that six struts carry and move, without a closed form.

Each strut hangs at a cross of the ground, lengthens along its guide and holds the platform with a
ball joint; the slides of the six guides are the coordinates. ISO 8855 axes, the numbers are this
project's own. The model is declared with ``allow_iteration=True``: one block finds the pose of the
platform from six equations. It is an example of the price of large equations
(docs/theory/growth.md).
"""

from __future__ import annotations

from math import cos, pi, sin

from .. import declare as d

BASE_RADIUS, PLATFORM_RADIUS, HEIGHT = 1.2, 0.8, 1.5  # [m]
# Angles of the struts' ends, in pairs: wide below, close together above [rad].
_BASE_ANGLES = [k * 2 * pi / 3 + s * 0.20 for k in range(3) for s in (-1, 1)]
_PLATFORM_ANGLES = [k * 2 * pi / 3 + s * 0.85 for k in range(3) for s in (-1, 1)]

GROUND = d.Ground("ground", 1)
PLATFORM = d.Body("platform", 150.0, (0.02, -0.01, HEIGHT + 0.1), (25.0, 27.0, 45.0))


def _place(radius: float, angle: float, height: float) -> tuple[float, float, float]:
    return (round(radius * cos(angle), 4), round(radius * sin(angle), 4), height)


def _strut(number: int) -> tuple[tuple[d.Joint, d.Prismatic, d.Joint], d.ForceElement]:
    """Return the joints of a strut, and the spring and damper along it that carry the platform."""
    low = _place(BASE_RADIUS, _BASE_ANGLES[number], 0.0)
    high = _place(PLATFORM_RADIUS, _PLATFORM_ANGLES[number], HEIGHT)
    name = f"strut_{number + 1}"
    lower = d.Point(f"{name}_foot", low, f"cross of strut {number + 1}")
    upper = d.Point(f"{name}_head", high, f"ball joint of strut {number + 1}")

    def part(which: str, share: float) -> d.Body:
        x, y, z = (a + share * (b - a) for a, b in zip(low, high, strict=True))
        return d.Body(f"{name}_{which}", 4.0, (x, y, z), (0.12, 0.12, 0.01))

    tube, rod = part("tube", 0.3), part("rod", 0.7)
    line = d.Direction(f"{name}_line", between=(lower, upper))
    joints = (
        d.Universal(
            f"{name}_cross", GROUND, tube, at=lower, shaft=d.Line(lower, upper), first_axis=d.UP
        ),
        d.Prismatic(f"{name}_guide", tube, rod, direction=line),
        d.Spherical(f"{name}_ball", rod, PLATFORM, at=upper),
    )
    spring = d.ForceElement(
        f"{name}_spring", d.AlongLine((GROUND, lower), (PLATFORM, upper)), (_COIL, _DAMPER)
    )
    return joints, spring


_COIL = d.LinearSpring(
    rate=d.SpringRate("spring_rate", 30000.0, "rate of the spring along each strut"),
    free_length=d.Length("spring_free_length", 1.77, "length of each spring without force"),
)
_DAMPER = d.LinearDamper(
    rate=d.DamperRate("damper_rate", 800.0, "rate of the damper along each strut")
)
_STRUTS = tuple(_strut(number) for number in range(6))
GUIDES = tuple(joints[1] for joints, _ in _STRUTS)

MECHANISM = d.Mechanism(
    name="stewart_platform",
    title="Stewart platform on six struts",
    joints=tuple(joint for joints, _ in _STRUTS for joint in joints),
    forces=(d.Weight(), *(spring for _, spring in _STRUTS)),
    coordinates=tuple(
        guide.slide(f"extension_{number}", f"by how much strut {number} is longer than at design")
        for number, guide in enumerate(GUIDES, 1)
    ),
)

STEWART_PLATFORM = d.Formulation(
    name="stewart_platform",
    title="Stewart platform, its six struts free to move",
    mechanism=MECHANISM,
    independent=GUIDES,
    massive=MECHANISM.bodies[1:],
    allow_iteration=True,
)
