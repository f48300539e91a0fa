"""Mistakes in declarations: each has a message with its name and a remedy."""

from dataclasses import replace

import kintrafo
import numpy as np
import pytest
from kintrafo import generator as g
from kintrafo.generator import hinge
from kintrafo.generator.declare.default_values import value_problems
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.mechanisms.held_by_rods import MODELS as MULTI_LINKS
from kintrafo.vehicle.cli import app
from support.changes import changed, with_default
from typer.testing import CliRunner

CRANK_PIN = g.Point("crank_pin", (0.0, 0.0, 0.0))
ROD_START = g.Point("rod_start", (0.03, 0.14, 0.05))
ROCKER_PIN = g.Point("rocker_pin", (0.45, 0.02, 0.1))
ROD_END = g.Point("rod_end", (0.4, 0.2, 0.3))
CRANK_LINE = g.Direction("crank_line", (0.9, -0.2, 0.3))
ROCKER_LINE = g.Direction("rocker_line", (0.3, 1.1, -0.5))
CROSS_AXIS = g.Direction("cross_axis", (0.2, -0.4, 1.0))
GROUND = g.Ground("ground")
CRANK_BODY, ROD, ROCKER_BODY = (
    g.Body(name, 1.0, place, (0.01, 0.01, 0.01))
    for name, place in (
        ("crank", (0.02, 0.08, 0.03)),
        ("rod", (0.2, 0.16, 0.16)),
        ("rocker", (0.42, 0.1, 0.2)),
    )
)
CRANK = g.Revolute("A", GROUND, CRANK_BODY, axis=g.Line(CRANK_PIN, CRANK_LINE))
ROCKER = g.Revolute("D", GROUND, ROCKER_BODY, axis=g.Line(ROCKER_PIN, ROCKER_LINE))
CROSS = g.Universal(
    "B", CRANK_BODY, ROD, at=ROD_START, shaft=g.Line(ROD_START, ROD_END), first_axis=CROSS_AXIS
)
BALL = g.Spherical("C", ROD, ROCKER_BODY, at=ROD_END)


def spatial(*joints, reported=("A", "D"), **changes):
    """Return a mechanism of crank, rod and rocker with some joints."""
    fields = {
        "name": "spatial",
        "title": "Crank, rod and rocker",
        "joints": joints,
        "coordinates": tuple(
            j.angle(f"angle_{j.name}", "angle")
            for name in reported
            for j in joints
            if j.name == name
        ),
    }
    return g.Mechanism(**fields | changes)


def model(mechanism, *independent, **changes):
    """Return a model of a mechanism, all bodies massive."""
    joints = tuple(mechanism.joint(name) for name in independent)
    return g.Formulation(
        mechanism.name, mechanism.title, mechanism, **{"independent": joints} | changes
    )


RUSR = spatial(CRANK, CROSS, BALL, ROCKER)


class TestDrivenJoints:
    @pytest.mark.parametrize(
        "joint",
        [
            BALL,
            CROSS,
            g.Cylindrical(
                "S",
                ROD,
                ROCKER_BODY,
                axis=g.Line(ROD_END, ROD_START),
                length_at_zero_slide=g.Distance("length", 1.0, "length"),
                angle_to=ROCKER_PIN,
            ),
        ],
        ids=lambda joint: joint.kind,
    )
    def test_of_several_coordinates(self, joint, refused):
        others = [j for j in (CRANK, CROSS, BALL, ROCKER) if j != joint]
        refused(g.DeclarationError, lambda: model(spatial(*others, joint), joint.name))

    def test_that_cannot_be(self, refused):
        chain = spatial(CRANK, replace(ROCKER, first=CRANK_BODY))
        refused(
            kintrafo.KintrafoError,
            lambda: model(spatial(CRANK, CROSS, BALL, ROCKER, reported=("A",)), "D"),
            lambda: model(RUSR, "A", "A"),
            lambda: model(RUSR, "A", massive=(GROUND, CRANK_BODY)),
            lambda: kintrafo.compile(model(chain, "A", "D", massive=(CRANK_BODY,))),
            lambda: kintrafo.compile(model(chain, "A", "D", massive=())),
        )


class TestForces:
    PUSHED = replace(
        RUSR, forces=(g.JointForce(ROCKER, g.Input("torque", "N m", "torque on the rocker")),)
    )

    def test_along_a_joint_that_follows(self, refused):
        """It would not appear in any equation."""
        refused(g.DeclarationError, lambda: model(self.PUSHED, "A"))

    def test_such_joints_are_proposed_as_independent(self):
        assert [p.independent for p in kintrafo.proposals(self.PUSHED)] == [("D",)]
        assert [p.independent for p in kintrafo.proposals(RUSR)] == [("A",), ("D",)]


class TestRods:
    BALL_AT_CRANK = g.Spherical("B", CRANK_BODY, ROD, at=ROD_START)
    RSSR = spatial(CRANK, BALL_AT_CRANK, BALL, ROCKER)

    def test_with_mass_between_two_ball_joints(self, refused):
        refused(g.DeclarationError, lambda: model(self.RSSR, "A"))

    def test_without_mass_the_turn_is_no_degree_of_freedom(self):
        light = model(self.RSSR, "A", massive=(CRANK_BODY, ROCKER_BODY))
        assert [p.independent for p in kintrafo.proposals(light)] == [("A",), ("D",)]

    def test_the_turn_is_not_counted_in_a_refusal(self, refused):
        light = model(self.RSSR, "A", "D", massive=(CRANK_BODY, ROCKER_BODY))
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(light))


class TestNames:
    @pytest.mark.parametrize("name", ["gate 2", "2nd", "café", ""])
    def test_of_models_and_mechanisms(self, name, refused):
        for named in (RUSR, model(RUSR, "A"), ROD, RUSR.parameters[0], CRANK):
            with refused(g.DeclarationError):
                replace(named, name=name)

    def test_of_force_elements(self, refused):
        (spring,) = FOUR_BAR.elements
        refused(
            g.DeclarationError,
            lambda: replace(FOUR_BAR, forces=(replace(spring, name="my spring"),)),
        )


class TestTexts:
    @pytest.mark.parametrize("text", ["two\nlines", "N*/m", '"""', "\\N"])
    def test_that_would_end_a_comment(self, text, refused):
        (entry, *_) = RUSR.coordinates
        torque = g.JointForce(CRANK, g.Input("torque", "N m", text))
        point = replace(CRANK_PIN, meaning=text)
        for make in (
            lambda: replace(RUSR, title=text),
            lambda: changed(RUSR, (CRANK_PIN, point)),
            lambda: replace(RUSR, coordinates=(replace(entry, meaning=text),)),
            lambda: replace(RUSR, forces=(torque,)),
            lambda: replace(RUSR, outputs=(g.PositionOf("pin", ROD, CRANK_PIN, text),)),
        ):
            with refused(g.DeclarationError):
                make()
        refused(g.DeclarationError, lambda: replace(model(RUSR, "A"), title=text))


class TestNumbers:
    @pytest.mark.parametrize("value", [float("nan"), float("inf"), "1.0", None, 1j])
    def test_that_are_none(self, value, refused):
        refused(g.DeclarationError, lambda: replace(RUSR.parameters[0], default=value))

    @pytest.mark.parametrize(
        "body",
        [
            replace(CRANK_BODY, mass=-1.0),
            replace(CRANK_BODY, inertia=(1.0, -1.0, 1.0)),
            replace(CRANK_BODY, inertia=(1.0, 1.0, 9.0)),
            g.Rotor("crank", 1.0, CRANK_PIN, axis=CRANK_LINE, spin=0.5, diametral=0.2),
        ],
        ids=["mass", "moment", "moments", "rotor"],
    )
    def test_that_no_body_has(self, body, refused):
        error = refused(g.DeclarationError, lambda: changed(RUSR, (CRANK_BODY, body)))
        assert len(error.problems) == 1

    @pytest.mark.parametrize("seed", range(20))
    def test_bodies_of_point_masses_are_accepted(self, seed):
        """Also flat ones and rods, in any axes: they are at the edge of what is possible."""
        random = np.random.default_rng(seed)
        spread = np.array([1.0, seed % 2, seed % 3 > 0])
        places = random.standard_normal((5, 3)) * spread
        turn, _ = np.linalg.qr(random.standard_normal((3, 3)))
        places = (places - places.mean(axis=0)) @ turn.T
        tensor = sum(place @ place * np.eye(3) - np.outer(place, place) for place in places)
        elements = dict(zip(("xx", "yy", "zz"), np.diag(tensor).tolist(), strict=True))
        elements |= {"xy": tensor[0, 1], "xz": tensor[0, 2], "yz": tensor[1, 2]}
        inertia = {f"crank_inertia_{e}": float(value) for e, value in elements.items()}
        assert value_problems(with_default(RUSR, **inertia)) == []


class TestJoints:
    def test_of_a_body_with_itself(self, refused):
        refused(g.DeclarationError, lambda: replace(CRANK, second=GROUND))

    def test_of_the_angles_of_a_ball_joint_none_can_be_reported(self, refused):
        refused(g.DeclarationError, lambda: g.RelativeCoordinate("turn", BALL, "x", "turn"))

    def test_a_coordinate_is_one_of_its_joint(self, refused):
        refused(g.DeclarationError, lambda: g.RelativeCoordinate("slide", CRANK, "slide", "slide"))

    def test_none_reported_at_the_ground(self, tmp_path):
        """A boom moved by its cylinder, of which the stroke alone is reported."""
        module = kintrafo.compile(boom(), backend="numpy", folder=tmp_path)
        system = kintrafo.System(module)
        assert not hasattr(module, "absolute_jacobian")
        pin = place_of(system, "boom", np.array([0.2, 0.0, 1.2]), [0.01, 0.0])
        # the cylinder is along its pins: its length is that of the design position and the stroke
        length = np.linalg.norm(pin - [1.0, 0.0, 0.0])
        assert length == pytest.approx(np.hypot(0.8, 1.2) + 0.01, rel=1e-15)


def boom():
    foot, low, high = (
        g.Point(name, place)
        for name, place in (
            ("foot", (0.0, 0.0, 0.0)),
            ("barrel_pin", (1.0, 0.0, 0.0)),
            ("piston_pin", (0.2, 0.0, 1.2)),
        )
    )
    normal, inertia = g.Direction("normal", (0.0, 1.0, 0.0)), (0.1, 0.1, 0.1)
    ground = g.Ground("ground")
    barrel = g.Body("barrel", 2.0, (0.8, 0.0, 0.3), inertia)
    piston = g.Body("piston", 2.0, (0.3, 0.0, 0.9), inertia)
    lifted = g.Body("boom", 2.0, (0.1, 0.0, 0.9), inertia)
    bore = g.Prismatic("bore", barrel, piston, g.Direction("way", between=(low, high)))
    mechanism = g.Mechanism(
        name="boom",
        title="Boom",
        joints=(
            g.Revolute("pivot", ground, lifted, g.Line(foot, normal)),
            g.Revolute("low", ground, barrel, g.Line(low, normal)),
            bore,
            g.Revolute("high", piston, lifted, g.Line(high, normal)),
        ),
        coordinates=(bore.slide("stroke", "stroke"),),
    )
    return model(mechanism, "bore")


def place_of(system, body, point_at_design, state):
    """Return where a point of a body is, from the pose of the body."""
    number = system.equations.BODIES.index(body)
    centre = [system.parameters[f"{body}_com_{axis}"] for axis in "xyz"]
    turned = system.evaluate("orientations", state)[number] @ (point_at_design - centre)
    return system.evaluate("positions", state)[number] + turned


class TestPoses:
    def test_the_rod_is_the_second_body_of_a_cross(self, refused):
        wrong = replace(CROSS, first=ROD, second=CRANK_BODY)
        mechanism = spatial(CRANK, wrong, BALL, ROCKER)
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(mechanism, "A")))

    def test_the_joint_that_would_determine_one_is_named(self, refused):
        lever = g.Body("lever", 1.0, (0.4, 0.2, 0.3), (0.01, 0.01, 0.01))
        pin = g.Revolute("E", ROCKER_BODY, lever, axis=g.Line(ROD_END, ROCKER_PIN))
        mechanism = replace(RUSR, joints=(*RUSR.joints, pin))
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(mechanism, "A")))

    def test_a_body_that_hangs_at_a_ball_joint(self, refused):
        mechanism = spatial(CRANK, g.Spherical("B", CRANK_BODY, ROD, at=ROD_START), reported=("A",))
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(mechanism, "A")))


# -- proposals -------------------------------------------------------------------------------------

STEPHENSON = {
    "a": (0.0, 0.0),
    "b": (0.1, 0.2),
    "c": (0.5, 0.35),
    "d": (0.5, 0.0),
    "e": (0.3, 0.5),
    "f": (0.8, 0.45),
    "g": (0.9, 0.1),
}


def stephenson(*reported):
    """Return a four-bar whose coupler drives a rocker by a link: two closed forms from the crank.

    From the rocker, two loops have no closed form one by one.
    """

    points = {name: g.Point(name, (*place, 0.0)) for name, place in STEPHENSON.items()}
    normal = g.Direction("normal", (0.0, 0.0, 1.0))

    def hinge(name, first, second):
        return g.Revolute(name, first, second, axis=g.Line(points[name.lower()], normal))

    ground = g.Ground("ground")
    crank, coupler, rocker, link, lever = (
        g.Body(name, 1.0, (0.0, 0.0, 0.0), (0.01, 0.01, 0.01))
        for name in ("crank", "coupler", "rocker", "link", "lever")
    )
    joints = (
        hinge("A", ground, crank),
        hinge("B", crank, coupler),
        hinge("C", coupler, rocker),
        hinge("D", rocker, ground),
        hinge("E", coupler, link),
        hinge("F", link, lever),
        hinge("G", ground, lever),
    )
    named = {joint.name: joint for joint in joints}
    return g.Mechanism(
        name="stephenson",
        title="Stephenson's chain",
        joints=joints,
        coordinates=tuple(named[n].angle(f"angle_{n}", "angle") for n in reported),
    )


class TestProposals:
    def test_closed_forms_come_before_iterations(self):
        found = [(p.independent, p.iterates) for p in kintrafo.proposals(stephenson("G", "A"))]
        assert found == [(("A",), False), (("G",), True)]

    def test_what_is_prescribed_stays(self):
        multi_link, *_ = MULTI_LINKS
        (found,) = kintrafo.proposals(multi_link)
        assert found.independent == tuple(joint.name for joint in multi_link.independent)
        assert found.iterates

    def test_a_search_ends_in_time(self):
        assert list(kintrafo.proposals(stephenson("G", "A"), seconds=1e-9)) == []

    def test_of_a_file_and_a_name_in_it(self, tmp_path):
        path = tmp_path / "mine.py"
        path.write_text(
            "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"
            "from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK\n"
        )
        (found,) = kintrafo.proposals(path, name="slider_crank")
        assert found.independent == ("A",)

    def test_the_command_lists_them(self, tmp_path, monkeypatch):
        monkeypatch.setenv("KINTRAFO_CACHE", str(tmp_path))
        path = tmp_path / "mine.py"
        path.write_text("from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK as S")
        result = CliRunner().invoke(app, ["mechanism", "topology", str(path)])
        assert "Can be independent: A\n" in result.output


class TestRefusals:
    def test_of_a_choice_name_those_that_close(self, refused):
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(stephenson("A", "G"), "G")))

    def test_of_a_choice_that_has_no_better_one(self, refused):
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(model(stephenson("G"), "G")))

    def test_of_a_mechanism_have_loop_pairs_equations_and_remedy(self, refused):
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(MULTI_LINKS[0].mechanism))

    def test_too_few_coordinates_are_reported(self, refused):
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(stephenson()))

    def test_nothing_moves(self, refused):
        mechanism = stephenson("A")
        pin = mechanism.joint("F")
        stiff = g.Revolute("S", pin.first, mechanism.bodies[0], axis=pin.axis)
        mechanism = replace(mechanism, joints=(*mechanism.joints, stiff))
        refused(kintrafo.MechanismError, lambda: kintrafo.compile(mechanism))


# -- files ----------------------------------------------------------------------------------------


class TestFiles:
    def test_problems_have_the_line_of_their_declaration(self, tmp_path):
        path = tmp_path / "mine.py"
        path.write_text(
            "from dataclasses import replace\n"
            "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n\n"
            "MINE = replace(\n    FOUR_BAR,\n    name='four bar',\n)\n"
        )
        with pytest.raises(kintrafo.InputError) as caught:
            kintrafo.compile(path)
        (problem,) = caught.value.problems
        start = "Line 4: Mechanism 'four bar': name 'four bar' cannot be written in C"
        assert problem.startswith(start)

    IMPORTING = "from beside_it import FOUR_BAR\n"
    BESIDE = "from kintrafo.generator.mechanisms.four_bar import FOUR_BAR\n"

    def test_import_those_beside_them_as_they_are_now(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path.parent)
        path = tmp_path / "mine.py"
        path.write_text(self.IMPORTING)
        (tmp_path / "beside_it.py").write_text(self.BESIDE)
        assert [p.independent for p in kintrafo.proposals(path)] == [("A",)]
        changed = "from dataclasses import replace\nFOUR_BAR = replace(FOUR_BAR, forces=())\n"
        (tmp_path / "beside_it.py").write_text(self.BESIDE + changed)
        assert [p.independent for p in kintrafo.proposals(path)] == [("A",), ("D",), ("B",)]

    @pytest.mark.parametrize("end", ["sys.exit()", "sys.exit('done')", "raise SystemExit(0)"])
    def test_that_end_the_program(self, tmp_path, end, refused):
        path = tmp_path / "mine.py"
        path.write_text(f"import sys\n{end}\n")
        refused(kintrafo.InputError, lambda: kintrafo.compile(path))


def test_planar_helpers_name_what_is_of_no_plane(refused):
    refused(g.DeclarationError, lambda: g.flat("p", (0.0, 0.0), normal="x"))
    anywhere, body = g.Point("p", (0.0, 0.0, 0.0)), g.Body("b", 1.0, g.flat("c", (0.1, 0.0)), 1e-3)
    refused(g.DeclarationError, lambda: hinge("A", g.Ground("g"), body, anywhere))
