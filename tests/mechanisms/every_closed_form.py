"""Mechanisms in three dimensions that use every closed form in its general position.

None of them ships. Axes are oblique, points lie in no common plane, and what carries a loop turns
or slides itself, so that no term of a velocity or of a bias is zero by accident.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from kintrafo import generator as g
from support.changes import changed

INERTIA = (0.021, 0.034, 0.029, 0.004, -0.003, 0.005)
"""Of every body, kg m^2: xx, yy, zz, xy, xz, yz; those of a body differ by its number."""


@dataclass(frozen=True)
class Parts:
    """Bodies, points and directions of a mechanism by their names."""

    bodies: Mapping[str, g.Body]
    points: Mapping[str, g.Point]
    directions: Mapping[str, g.Direction]


@dataclass(frozen=True)
class Sketch:
    """A joint as a table has it, by names.

    Attributes
    ----------
    at, to
        Points; the second one is what an angle counts to, or the far end of a rod.
    along
        A direction, or two points between which it is.
    """

    kind: type[g.Joint]
    name: str
    first: str
    second: str
    at: str = ""
    along: str | tuple[str, str] = ""
    to: str | None = None

    def of(self, parts):
        """Return the joint between bodies of a mechanism."""
        named = self.name, parts.bodies[self.first], parts.bodies[self.second]
        at = parts.points.get(self.at)
        to = None if self.to is None else parts.points[self.to]
        if self.kind is g.Spherical:
            return g.Spherical(*named, at)
        along = self._direction(parts)
        if self.kind is g.Prismatic:
            return g.Prismatic(*named, along)
        if self.kind is g.Universal:
            return g.Universal(*named, at, shaft=g.Line(at, to), first_axis=along)
        return g.Revolute(*named, g.Line(at, along), angle_from=g.FORWARD, angle_to=to)

    def _direction(self, parts):
        if isinstance(self.along, str):
            return parts.directions[self.along]
        start, end = (parts.points[name] for name in self.along)
        return g.Direction("_".join(self.along), between=(start, end))


def hinge(name, first, second, at, along, to=None):
    """Return a hinge through a point along a direction, both of them parameters.

    Its angle counts from the design position, or from forward to a point.
    """
    return Sketch(g.Revolute, name, first, second, at, along, to)


def guide(name, first, second, along):
    """Return a guide along a direction."""
    return Sketch(g.Prismatic, name, first, second, along=along)


def ball(name, first, second, at):
    """Return a ball joint at a point."""
    return Sketch(g.Spherical, name, first, second, at)


def cross(name, first, rod, at, to, axis):
    """Return a universal joint that holds a rod at a point; the rod runs to another point."""
    return Sketch(g.Universal, name, first, rod, at, axis, to)


def reported(joints):
    """Return the angles and slides of hinges and guides, named after their joints."""
    return tuple(
        (j.angle if isinstance(j, g.Revolute) else j.slide)(
            f"{j.name}_{j.coordinates[0]}", f"{j.coordinates[0]} of {j.name}"
        )
        for j in joints
        if isinstance(j, g.Revolute | g.Prismatic)
    )


def shaft_angles(joints):
    """Return the angles of the shafts at crosses, named after their joints."""
    crosses = [joint for joint in joints if isinstance(joint, g.Universal)]
    return tuple(
        report(f"{joint.name}_{kind}", f"{kind} of {joint.name}")
        for joint in crosses
        for kind, report in (("azimuth", joint.azimuth), ("elevation", joint.elevation))
    )


def motion_of(joint, name):
    """Return a prescribed motion of a joint."""
    return g.Motion(name, "m" if isinstance(joint, g.Prismatic) else "rad", f"position of {name}")


def declare(
    name,
    bodies,
    joints,
    points,
    directions,
    independent,
    *,
    spring,
    prescribed=None,
    wheel=None,
    crosses=False,
    **more,
):
    """Return a model with weight, a spring with a damper, and a force on every coordinate.

    Parameters
    ----------
    bodies
        Name of every moving body, with its centre of mass.
    spring
        Two points; each is taken with the body whose name begins its own.
    wheel
        Name of a rotor among the bodies, with the direction of its axis.
    crosses
        Whether the angles of the crosses are reported, too.
    more
        Of the model; bodies with mass by their names.
    """
    parts = _parts(bodies, points, directions, wheel)
    built = tuple(sketch.of(parts) for sketch in joints)
    named = {joint.name: joint for joint in built}
    seats = ((parts.bodies[p.split("_", maxsplit=1)[0]], parts.points[p]) for p in spring)
    laws = (
        g.LinearSpring(
            g.SpringRate("spring_rate", 300.0, "rate of the spring"),
            free_length=g.Length("spring_free_length", 0.3, "free length of the spring"),
        ),
        g.LinearDamper(g.DamperRate("damper_rate", 5.0, "rate of the damper")),
    )
    mechanism = g.Mechanism(
        name=name,
        title=name,
        joints=built,
        forces=(
            g.Weight(),
            g.ForceElement("spring", g.AlongLine(*seats), laws),
            *(
                g.JointForce(
                    named[j], g.Input(f"{j}_force", named[j].force_unit, f"force along {j}")
                )
                for j in independent
            ),
        ),
        coordinates=reported(built) + (shaft_angles(built) if crosses else ()),
    )
    given = {named[j]: motion_of(named[j], motion) for j, motion in (prescribed or {}).items()}
    massive = more.pop("massive", bodies)
    return g.Formulation(
        name=name,
        title=name,
        mechanism=mechanism,
        independent=tuple(named[j] for j in independent),
        prescribed=given,
        massive=tuple(parts.bodies[body] for body in massive),
        held={"still": tuple(given)} if given else {},
        **more,
    )


def geared(model, follower, followed, ratio):
    """Return a model in which one of the driven joints follows another through a gear."""
    behind, before = map(model.mechanism.joint, (follower, followed))
    units = ["m" if isinstance(joint, g.Prismatic) else "rad" for joint in (behind, before)]
    unit = "1" if units[0] == units[1] else "/".join(units)
    kind = {"1": g.Ratio, "m/rad": g.Lead, "rad/m": g.TurnPerTravel}[unit]
    gear = g.Gear(before, kind(f"{follower}_ratio", ratio, "ratio of the gear"))
    given = {joint: motion for joint, motion in model.prescribed.items() if joint != behind}
    forces = tuple(f for f in model.mechanism.forces if f.along != behind)
    alone = replace(
        model,
        name=f"{model.name}_{follower}_behind_{followed}",
        mechanism=replace(model.mechanism, forces=forces),
        independent=tuple(joint for joint in model.independent if joint != behind),
        prescribed=given,
        held={"still": tuple(given)} if given else {},
    )
    return changed(alone, (behind, replace(behind, follows=gear)))


def welded(model, body):
    """Return a model with a burden on one of its bodies."""
    center = g.Point("burden_com", (0.5, 0.15, 0.2))
    burden = g.Body("burden", 1.3, center, tuple(0.4 * value for value in INERTIA))
    weld = g.Weld("weld", model.mechanism.body(body), burden)
    return replace(
        model,
        name=f"{model.name}_with_a_burden",
        mechanism=replace(model.mechanism, joints=(*model.mechanism.joints, weld)),
        massive=(*model.massive, burden),
    )


def _parts(bodies, points, directions, wheel):
    centers = {f"{body}_com": place for body, place in bodies.items()}
    places = {n: g.Point(n, place) for n, place in {**points, **centers}.items()}
    along = dict(directions) | ({"spin": wheel[1]} if wheel else {})
    ways = {n: g.Direction(n, way) for n, way in along.items()}
    built = {"ground": g.Ground("ground")}
    for number, body in enumerate(bodies, 1):
        center, scale = places[f"{body}_com"], 1.0 + 0.3 * number
        if wheel and body == wheel[0]:
            built[body] = g.Rotor(body, 1.5, center, axis=ways["spin"], spin=0.03, diametral=0.02)
        else:
            tensor = tuple(scale * value for value in INERTIA)
            built[body] = g.Body(body, 0.8 * scale, center, tensor)
    return Parts(built, places, ways)


# -- oblique planes -------------------------------------------------------------------------------

_NORMAL = np.array([0.48, -0.36, 0.8])
_ACROSS = np.array([0.6, 0.8, 0.0])
_UPWARD = np.cross(_NORMAL, _ACROSS)
_CORNER = np.array([0.1, -0.2, 0.3])


def askew(x, y, off=0.0):
    """Return a place of the oblique plane, or off it."""
    return tuple((_CORNER + x * _ACROSS + y * _UPWARD + off * _NORMAL).tolist())


def heading(angle):
    """Return a direction in the oblique plane, not of unit length."""
    return tuple((1.7 * (np.cos(angle) * _ACROSS + np.sin(angle) * _UPWARD)).tolist())


NORMAL = tuple((2.0 * _NORMAL).tolist())


# -- a spatial four-bar: hinge, rod with a cross and a ball joint, hinge on a skew axis ------------


def spatial_four_bar(name, *, cross_at_rocker=False):
    """Return hinge - rod - hinge on skew axes; the rod's cross at either of its ends."""
    if cross_at_rocker:
        rod = (
            ball("pin", "crank", "rod", "crank_end"),
            cross("cross", "rocker", "rod", "rocker_end", "crank_end", "cross_axis"),
        )
    else:
        rod = (
            cross("cross", "crank", "rod", "crank_end", "rocker_end", "cross_axis"),
            ball("pin", "rod", "rocker", "rocker_end"),
        )
    return declare(
        name,
        {"crank": (0.02, 0.08, 0.03), "rod": (0.21, 0.16, 0.16), "rocker": (0.42, 0.12, 0.2)},
        (
            hinge("drive", "ground", "crank", "crank_bearing", "crank_line"),
            *rod,
            # its second body is the ground: the angle counts the other way round
            hinge("pivot", "rocker", "ground", "rocker_bearing", "rocker_line", to="ground_seat"),
        ),
        {
            "crank_bearing": (0.0, 0.0, 0.0),
            "crank_end": (0.03, 0.14, 0.05),
            "rocker_bearing": (0.45, 0.02, 0.1),
            "rocker_end": (0.4, 0.2, 0.3),
            "ground_seat": (0.2, -0.1, 0.4),
            "rod_seat": (0.18, 0.2, 0.21),
        },
        {
            "crank_line": (0.9, -0.2, 0.3),
            "rocker_line": (0.3, 1.1, -0.5),
            "cross_axis": (0.2, -0.4, 1.0),
        },
        ("drive",),
        spring=("ground_seat", "rod_seat"),
    )


# -- a spatial slider-crank between two bodies that both turn --------------------------------------


def moving_slider_crank(name, *, prescribed=False):
    """Return crank, rod and slider; the crank's bearing and the slider's guide move by themselves.

    The guide is declared from the slider to its table: the slide counts the other way round.
    """
    return declare(
        name,
        {
            "base": (0.05, -0.1, 0.02),
            "crank": (0.1, 0.03, 0.12),
            "rod": (0.25, 0.12, 0.2),
            "slider": (0.46, 0.17, 0.3),
            "table": (0.55, 0.1, 0.2),
        },
        (
            hinge("swing", "ground", "base", "base_bearing", "base_line"),
            hinge("drive", "base", "crank", "crank_bearing", "crank_line"),
            cross("cross", "crank", "rod", "crank_end", "slider_end", "cross_axis"),
            ball("pin", "rod", "slider", "slider_end"),
            guide("way", "slider", "table", "way_axis"),
            hinge("tilt", "ground", "table", "table_bearing", "table_line"),
        ),
        {
            "base_bearing": (0.0, -0.2, 0.0),
            "crank_bearing": (0.1, 0.0, 0.1),
            "crank_end": (0.14, 0.07, 0.16),
            "slider_end": (0.44, 0.2, 0.26),
            "table_bearing": (0.6, 0.0, 0.1),
            "crank_seat": (0.12, 0.09, 0.1),
            "slider_seat": (0.5, 0.1, 0.33),
        },
        {
            "base_line": (0.2, 1.0, 0.4),
            "crank_line": (0.5, -0.7, 0.6),
            "cross_axis": (0.1, 0.3, 1.0),
            "way_axis": (1.0, 0.3, -0.2),
            "table_line": (-0.3, 0.8, 0.7),
        },
        ("swing", "drive") if prescribed else ("swing", "drive", "tilt"),
        spring=("crank_seat", "slider_seat"),
        prescribed={"tilt": "tilt"} if prescribed else None,
    )


# -- planar loops in an oblique plane, on a base that turns ----------------------------------------


def oblique_four_bar():
    """Return a planar four-bar on a base that turns, with a rotor on its coupler.

    Its hinges' points lie at different heights over the plane, as in a real mechanism.
    """
    return declare(
        "oblique_four_bar",
        {"base": (0.15, -0.3, 0.2), "crank": askew(0.02, 0.06, 0.04),
         "coupler": askew(0.14, 0.2, -0.03), "rocker": askew(0.27, 0.13, 0.02),
         "wheel": askew(0.1, 0.25, 0.08)},
        (hinge("swing", "ground", "base", "base_bearing", "base_line"),
         hinge("drive", "base", "crank", "crank_bearing", "normal"),
         hinge("knee", "crank", "coupler", "crank_pin", "normal"),
         hinge("knuckle", "rocker", "coupler", "rocker_pin", "normal"),
         hinge("pivot", "rocker", "base", "rocker_bearing", "normal"),
         hinge("spinning", "coupler", "wheel", "wheel_com", "spin")),
        {"base_bearing": (0.0, -0.1, 0.1), "crank_bearing": askew(0.0, 0.0, 0.05),
         "crank_pin": askew(0.0, 0.1, -0.02), "rocker_pin": askew(0.24, 0.26, 0.03),
         "rocker_bearing": askew(0.3, 0.0, -0.04), "ground_seat": (0.5, 0.2, 0.4),
         "coupler_seat": askew(0.2, 0.15, 0.06)},
        {"base_line": (0.3, -0.5, 0.9), "normal": NORMAL},
        ("swing", "drive", "spinning"),
        spring=("ground_seat", "coupler_seat"),
        wheel=("wheel", (0.4, 0.7, -0.3)),
    )  # fmt: skip


def oblique_slider_crank(name, *, driven):
    """Return a planar slider-crank on a base that turns; the crank or the piston is driven."""
    return declare(
        name,
        {"base": (0.15, -0.3, 0.2), "crank": askew(0.02, 0.06, 0.04),
         "rod": askew(0.14, 0.1, -0.03), "piston": askew(0.33, 0.04, 0.02)},
        (hinge("swing", "ground", "base", "base_bearing", "base_line"),
         hinge("drive", "base", "crank", "crank_bearing", "normal"),
         hinge("knee", "crank", "rod", "crank_pin", "normal"),
         hinge("wrist", "piston", "rod", "piston_pin", "normal"),
         guide("way", "base", "piston", "way_axis")),
        {"base_bearing": (0.0, -0.1, 0.1), "crank_bearing": askew(0.0, 0.0, 0.05),
         "crank_pin": askew(0.0, 0.1, -0.02), "piston_pin": askew(0.3, 0.02, 0.03),
         "ground_seat": (0.5, 0.2, 0.4), "rod_seat": askew(0.2, 0.15, 0.06)},
        {"base_line": (0.3, -0.5, 0.9), "normal": NORMAL, "way_axis": heading(0.2)},
        ("swing", driven),
        spring=("ground_seat", "rod_seat"),
    )  # fmt: skip


def oblique_trammel():
    """Return two sliders on guides of one base, joined by a rod: Archimedes' trammel."""
    return declare(
        "oblique_trammel",
        {"base": (0.15, -0.3, 0.2), "ram": askew(0.02, 0.06, 0.04), "rod": askew(0.14, 0.1, -0.03),
         "piston": askew(0.33, 0.04, 0.02)},
        (hinge("swing", "ground", "base", "base_bearing", "base_line"),
         guide("drive", "base", "ram", "drive_axis"),
         hinge("knee", "ram", "rod", "ram_pin", "normal"),
         hinge("wrist", "piston", "rod", "piston_pin", "normal"),
         guide("way", "base", "piston", "way_axis")),
        {"base_bearing": (0.0, -0.1, 0.1), "ram_pin": askew(0.0, 0.15, -0.02),
         "piston_pin": askew(0.3, 0.02, 0.03), "ground_seat": (0.5, 0.2, 0.4),
         "rod_seat": askew(0.2, 0.15, 0.06)},
        {"base_line": (0.3, -0.5, 0.9), "normal": NORMAL, "drive_axis": heading(1.4),
         "way_axis": heading(0.2)},
        ("swing", "drive"),
        spring=("ground_seat", "rod_seat"),
    )  # fmt: skip


# -- telescopes in an oblique plane, on a base that turns ------------------------------------------


def given_telescope():
    """Return a boom held by a cylinder of given stroke, whose guide passes beside both pins."""
    return declare(
        "given_telescope",
        {"base": (0.15, -0.3, 0.2), "boom": askew(0.1, 0.2, 0.04),
         "barrel": askew(0.24, 0.05, -0.03), "piston": askew(0.2, 0.15, 0.02)},
        (
            hinge("swing", "ground", "base", "base_bearing", "base_line"),
            hinge("foot", "base", "barrel", "barrel_pin", "normal"),
            guide("bore", "piston", "barrel", "bore_axis"),
            hinge("head", "piston", "boom", "piston_pin", "normal"),
            hinge("pivot", "base", "boom", "boom_bearing", "normal", to="boom_seat"),
        ),
        {"base_bearing": (0.0, -0.1, 0.1), "boom_bearing": askew(0.0, 0.0, 0.05),
         "barrel_pin": askew(0.3, -0.05, -0.02), "piston_pin": askew(0.12, 0.25, 0.03),
         "ground_seat": (0.5, 0.2, 0.4), "boom_seat": askew(0.1, 0.4, 0.06)},
        {"base_line": (0.3, -0.5, 0.9), "normal": NORMAL, "bore_axis": heading(2.4)},
        ("swing",),
        spring=("ground_seat", "boom_seat"),
        prescribed={"bore": "bore"},
    )  # fmt: skip


def inverted_slider_crank():
    """Return a crank whose pin carries a block that slides along a rocker.

    All joints but the driven ones are declared from the far body to the near one.
    """
    return declare(
        "inverted_crank",
        {"base": (0.15, -0.3, 0.2), "crank": askew(0.02, 0.06, 0.04),
         "block": askew(0.05, 0.12, -0.03), "rocker": askew(0.2, 0.15, 0.02)},
        (
            hinge("swing", "ground", "base", "base_bearing", "base_line"),
            hinge("pivot", "rocker", "base", "rocker_bearing", "normal", to="ground_seat"),
            guide("way", "rocker", "block", "way_axis"),
            hinge("pin", "block", "crank", "crank_pin", "normal"),
            hinge("drive", "base", "crank", "crank_bearing", "normal", to="crank_pin"),
        ),
        {"base_bearing": (0.0, -0.1, 0.1), "crank_bearing": askew(0.0, 0.0, 0.05),
         "crank_pin": askew(0.0, 0.1, -0.02), "rocker_bearing": askew(0.4, 0.05, 0.03),
         "ground_seat": (0.5, 0.2, 0.4), "rocker_seat": askew(0.2, 0.15, 0.06)},
        {"base_line": (0.3, -0.5, 0.9), "normal": NORMAL, "way_axis": heading(0.1)},
        ("swing", "drive"),
        spring=("ground_seat", "rocker_seat"),
    )  # fmt: skip


def pushed_slider():
    """Return a slider on a guide, pushed by a cylinder whose stroke is driven."""
    return declare(
        "pushed_slider",
        {"barrel": askew(0.06, 0.1, 0.04), "piston": askew(0.2, 0.06, -0.03),
         "slider": askew(0.33, 0.04, 0.02)},
        (hinge("foot", "ground", "barrel", "barrel_pin", "normal"),
         guide("bore", "barrel", "piston", "bore_axis"),
         hinge("wrist", "slider", "piston", "slider_pin", "normal"),
         guide("way", "slider", "ground", "way_axis")),
        {"barrel_pin": askew(0.0, 0.12, 0.05), "slider_pin": askew(0.3, 0.02, 0.03),
         "ground_seat": (0.5, 0.2, 0.4), "slider_seat": askew(0.36, 0.1, 0.06)},
        {"normal": NORMAL, "bore_axis": heading(-0.5), "way_axis": heading(0.2)},
        ("bore",),
        spring=("ground_seat", "slider_seat"),
    )  # fmt: skip


# -- one loop after another ------------------------------------------------------------------------


def chain():
    """Return a planar four-bar whose rocker drives a spatial one, which drives a slider."""
    return declare(
        "chain",
        {"crank": askew(0.02, 0.06, 0.04), "coupler": askew(0.14, 0.2, -0.03),
         "rocker": askew(0.27, 0.13, 0.02), "link": (0.4, 0.15, 0.5), "lever": (0.6, 0.1, 0.45),
         "rod": (0.75, 0.2, 0.5), "slider": (0.95, 0.2, 0.4)},
        (hinge("drive", "ground", "crank", "crank_bearing", "normal"),
         hinge("knee", "crank", "coupler", "crank_pin", "normal"),
         hinge("knuckle", "coupler", "rocker", "rocker_pin", "normal"),
         hinge("pivot", "ground", "rocker", "rocker_bearing", "normal"),
         cross("link_cross", "rocker", "link", "rocker_horn", "lever_end", "cross_axis"),
         ball("link_pin", "link", "lever", "lever_end"),
         hinge("bell", "ground", "lever", "lever_bearing", "lever_line"),
         cross("rod_cross", "lever", "rod", "lever_horn", "slider_end", "cross_axis"),
         ball("rod_pin", "rod", "slider", "slider_end"),
         guide("way", "ground", "slider", "way_axis")),
        {"crank_bearing": askew(0.0, 0.0, 0.05), "crank_pin": askew(0.0, 0.06, -0.02),
         "rocker_pin": askew(0.24, 0.26, 0.03), "rocker_bearing": askew(0.3, 0.0, -0.04),
         "rocker_horn": askew(0.33, 0.14, 0.1), "lever_bearing": (0.62, 0.0, 0.4),
         "lever_end": (0.55, 0.15, 0.55), "lever_horn": (0.66, 0.18, 0.47),
         "slider_end": (0.93, 0.22, 0.45), "ground_seat": (0.8, -0.1, 0.7),
         "rod_seat": (0.78, 0.21, 0.52)},
        {"normal": NORMAL, "cross_axis": (0.1, 0.3, 1.0), "lever_line": (0.8, -0.1, 0.5),
         "way_axis": (1.0, 0.25, -0.2)},
        ("drive",),
        spring=("ground_seat", "rod_seat"),
    )  # fmt: skip


# -- a boom on a turret, held by a cylinder in space -----------------------------------------------


def turret(name, driven, *, carriage=False, reverse=False):
    """Return turret, boom and cylinder: guide between a cross and a ball joint.

    Parameters
    ----------
    driven
        What drives beside the turret: ``lift``, the boom's joint, or ``stroke``, the guide.
    carriage
        Whether the boom is on a guide of the turret, instead of a hinge.
    reverse
        Whether the guide is declared from the ball joint to the cross, and the piston first.
    """
    links = ("piston", "barrel") if reverse else ("barrel", "piston")
    stroke = guide("stroke", *links, ("eye", "foot") if reverse else ("foot", "eye"))
    lift = guide("lift", "turret", "boom", "lift_line")
    if not carriage:
        lift = hinge("lift", "turret", "boom", "boom_bearing", "boom_line")
    return declare(
        name,
        {"turret": (0.05, -0.1, 0.2), "boom": (0.6, 0.05, 0.4), "barrel": (0.7, 0.25, 0.1),
         "piston": (1.1, 0.15, 0.6)},
        (hinge("slew", "ground", "turret", "turret_bearing", "slew_line"), lift,
         cross("cross", "turret", "barrel", "foot", "eye", "cross_axis"), stroke,
         ball("pin", "boom", "piston", "eye")),
        {"turret_bearing": (0.0, 0.0, 0.0), "boom_bearing": (0.1, 0.0, 0.3),
         "foot": (0.5, 0.3, -0.2), "eye": (1.3, 0.1, 0.9), "ground_seat": (0.3, 0.4, 1.0),
         "piston_seat": (1.0, 0.2, 0.5)},
        {"slew_line": (0.1, -0.2, 1.0), "boom_line": (0.3, 1.1, -0.5), "lift_line": (0.4, 0.2, 1.0),
         "cross_axis": (0.9, -0.2, 0.3)},
        ("slew", driven),
        spring=("ground_seat", "piston_seat"),
        crosses=True,
    )  # fmt: skip


# -- a steering column whose shaft telescopes between two crosses ----------------------------------


def steering_shaft(name, *, turned=False):
    """Return column, shaft of two links and pinion; the bearings of both ends move by themselves.

    The crosses have axes that are oblique to their bearings, and the column's is beside its own.

    Parameters
    ----------
    turned
        Whether guide and driven hinge are declared the other way round.
    """
    links = ("lower", "upper") if turned else ("upper", "lower")
    ends = ("upper_center", "lower_center")
    bearing = hinge("rolling", "box", "pinion", "lower_center", "pinion_line")
    if turned:
        bearing = hinge("rolling", "pinion", "box", "lower_center", "pinion_line", to="box_seat")
    return declare(
        name,
        {
            "bracket": (0.1, -0.1, 0.5),
            "column": (0.2, 0.03, 0.55),
            "upper": (0.4, 0.05, 0.45),
            "lower": (0.5, 0.15, 0.3),
            "pinion": (0.65, 0.22, 0.2),
            "box": (0.7, 0.1, 0.1),
        },
        (
            hinge("tilt", "ground", "bracket", "bracket_bearing", "bracket_line"),
            hinge("steer", "bracket", "column", "column_bearing", "column_line"),
            cross("upper_cross", "column", "upper", *ends, "upper_fork"),
            guide("spline", *links, ends),
            cross("lower_cross", "pinion", "lower", *ends[::-1], "lower_fork"),
            bearing,
            hinge("shake", "ground", "box", "box_bearing", "box_line"),
        ),
        {
            "bracket_bearing": (0.0, 0.1, 0.4),
            "column_bearing": (0.1, 0.0, 0.6),
            "upper_center": (0.3, 0.03, 0.53),
            "lower_center": (
                0.6,
                0.2,
                0.25,
            ),  # beside y = 0, where the sine of an azimuth is least exact
            "box_bearing": (0.8, 0.0, 0.0),
            "box_seat": (0.72, 0.2, 0.1),
            "ground_seat": (0.5, 0.3, 0.4),
            "column_seat": (0.2, 0.1, 0.6),
        },
        {
            "bracket_line": (0.2, 1.0, -0.3),
            "column_line": (0.9, 0.1, -0.2),
            "upper_fork": (0.3, -0.4, 1.0),
            "lower_fork": (0.1, 1.0, 0.3),
            "pinion_line": (0.7, 0.3, -0.8),
            "box_line": (0.4, -0.3, 0.9),
        },
        ("tilt", "steer", "shake"),
        spring=("ground_seat", "column_seat"),
        crosses=True,
    )


MODELS = (
    spatial_four_bar("spatial_four_bar"),
    spatial_four_bar("cross_at_rocker", cross_at_rocker=True),
    moving_slider_crank("moving_slider_crank"),
    moving_slider_crank("tilted_slider_crank", prescribed=True),
    oblique_four_bar(),
    oblique_slider_crank("oblique_crank", driven="drive"),
    oblique_slider_crank("oblique_piston", driven="way"),
    oblique_trammel(), given_telescope(), inverted_slider_crank(), pushed_slider(),
    turret("lifted_turret", "lift"), turret("pushed_turret", "stroke"),
    turret("pulled_carriage", "stroke", carriage=True, reverse=True),
    chain(), steering_shaft("steering_shaft"),
    steering_shaft("turned_shaft", turned=True),
    welded(geared(steering_shaft("shaft"), "shake", "tilt", -1.7), "box"),
    geared(given_telescope(), "bore", "swing", 0.13),
)  # fmt: skip
"""All of them, each as one model."""

DIFFERENTIATED = ("spatial_four_bar", "oblique_trammel", "inverted_crank", "pushed_slider",
                  "lifted_turret", "pulled_carriage", "shaft_shake_behind_tilt_with_a_burden",
                  "given_telescope_bore_behind_swing")  # fmt: skip
"""Those whose derivatives are looked at; no other such model has what they have of the catalogue.

The rest is derived without, in a third of the time.
"""
