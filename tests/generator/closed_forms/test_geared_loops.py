"""Loops that iterate and have gears: an answer is where the path from the design position leads.

A five-bar is driven between its first two bodies, and the hinge at its knee, or that between the
other two, follows. The path is followed here in steps of 1/100 of a radian of what turns fastest,
by the positions of the pins alone.
"""

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from support.models import own

PINS = "abcdp"
DESIGN = {"a": (0.0, 0.0), "b": (0.3, 0.0), "c": (0.0, 0.15), "d": (0.3, 0.15), "p": (0.15, 0.35)}
# once they were answered at -1.7 rad, far behind a dead point at -0.08 rad
JUMPED = {
    "a": (0.633, -1.351), "b": (2.917, 0.02), "c": (-0.855, 1.7), "d": (2.609, 2.017),
    "p": (1.425, 3.901),
}  # fmt: skip
STEP = 1e-2
LAST = 2.6


def five_bar(follower):
    """Return the linkage: hinges on the ground, on the cranks, and at the knee."""
    a, b, c, d, p = (g.flat(name, DESIGN[name]) for name in PINS)
    ground = g.Ground("ground")
    bodies = [g.Body(n, 1.0, g.flat(f"{n}_com", (0.1, 0.1)), 0.01) for n in ("u", "v", "x", "y")]
    u, v, x, y = bodies
    ratio = g.Ratio("ratio", -1.0, "ratio")
    lead = g.hinge("j3", u, x, c)
    geared = {"follows": g.Gear(lead, ratio)}

    def joint(name, first, second, at):
        return g.Revolute(
            name, first, second, g.Line(at, g.UP), **(geared if name == follower else {})
        )

    joints = (
        g.hinge("j1", ground, u, a), g.hinge("j2", ground, v, b), lead,
        joint("j4", v, y, d), joint("j5", x, y, p),
    )  # fmt: skip
    named = tuple(j.angle(f"q{j.name[1]}", j.name) for j in joints)
    return g.Formulation(
        name=f"five_bar_{follower}", title="Five-bar", independent=(lead,), allow_iteration=True,
        mechanism=g.Mechanism(f"five_bar_{follower}", "Five-bar", joints, (), named),
    )  # fmt: skip


def turned(angle, vector):
    cosine, sine = np.cos(angle), np.sin(angle)
    return np.array([cosine * vector[0] - sine * vector[1], sine * vector[0] + cosine * vector[1]])


def open_by(angles, at):
    """Return by how much the loop is open at the knee, in place and in angle."""
    q1, q2, q3, q4, q5 = angles
    one = at["a"] + turned(q1, at["c"] - at["a"]) + turned(q1 + q3, at["p"] - at["c"])
    two = at["b"] + turned(q2, at["d"] - at["b"]) + turned(q2 + q4, at["p"] - at["d"])
    return np.array([*(one - two), q1 + q3 + q5 - q2 - q4])


def path(follower, ratio, sense, places):
    """Return the angles along the way, until it ends at a dead point or is as long as is asked."""
    size = max(np.linalg.norm(place - places["a"]) for place in places.values())
    at = {name: place / size for name, place in places.items()}
    found = [i for i in range(5) if i not in (2, int(follower[1]) - 1)]

    def slopes(angles):
        around = np.eye(5)[found] * 1e-6
        return np.transpose(
            [(open_by(angles + d, at) - open_by(angles - d, at)) / 2e-6 for d in around]
        )

    angles, way = np.zeros(5), [np.zeros(5)]
    slope = slopes(angles)
    sign = np.sign(np.linalg.det(slope))
    while abs(angles[2]) < LAST:
        angles = angles.copy()
        angles[2] += sense * STEP / max(1.0, abs(ratio))
        angles[int(follower[1]) - 1] = ratio * angles[2]
        for _ in range(5):  # with the slopes of the step before, each leaves a tenth or less
            angles[found] -= np.linalg.solve(slope, open_by(angles, at))
        slope = slopes(angles)
        far = np.abs(angles - way[-1]).max() > 0.2
        if far or np.sign(np.linalg.det(slope)) != sign or np.abs(open_by(angles, at)).max() > 1e-3:
            break
        way.append(angles)
    return np.array(way)


def cases():
    random = np.random.default_rng(7)
    yield "j5", -6.0, {name: np.array(place) for name, place in JUMPED.items()}
    for ratio, scale in ((3.0, 10.0), (-1.0, 30.0)):
        for follower in ("j4", "j5"):
            off = {name: 0.05 * random.standard_normal(2) for name in PINS}
            yield follower, ratio, {n: scale * (DESIGN[n] + off[n]) for n in PINS}


@pytest.mark.parametrize(("follower", "ratio", "places"), list(cases()))
def test_no_answer_is_beyond_where_a_geared_linkage_closes(follower, ratio, places):
    numbers = {
        f"{n}_{axis}": x for n, at in places.items() for axis, x in zip("xy", at, strict=True)
    }
    system = kintrafo.System(own(five_bar(follower)), numbers | {"ratio": ratio})
    for sense in (1.0, -1.0):
        way = path(follower, ratio, sense, places)
        reach = abs(way[-1, 2])
        for angle in np.arange(0.05, LAST, 0.25):
            state = [[sense * angle, 0.0]]
            if angle > reach + 0.01:
                with pytest.raises(kintrafo.KintrafoError):
                    system.evaluate("rhs", state)
            elif angle < reach - 0.05:
                found = system.evaluate("relative_coordinates", state)[0]
                nearest = way[np.argmin(np.abs(np.abs(way[:, 2]) - angle))]
                # at most half a step away, and what moves ten times as fast that much farther
                assert np.abs(np.sin((found - nearest) / 2.0)).max() < 10.0 * STEP
