"""Messages name redundant branches and bodies that leave their plane."""

import kintrafo
import pytest
from kintrafo import generator as g
from kintrafo.generator.declare.mechanism import Mechanism
from kintrafo.generator.loops.errors import NoClosedFormError
from kintrafo.generator.loops.redundant import redundant
from kintrafo.generator.mechanisms.chains import MODELS as CHAINS
from kintrafo.generator.mechanisms.four_bar import FOUR_BAR
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.generator.planning.proposal import model_of

GROUND = g.Ground("ground")


def couplers(count, apart=0.0):
    """Return a four-bar with several couplers, on the same pins or apart."""
    crank = g.Body("crank", 1.0, g.flat("crank_com", (0.0, 0.05)), 0.01)
    rocker = g.Body("rocker", 1.0, g.flat("rocker_com", (0.3, 0.1)), 0.01)
    joints = [g.hinge("left", GROUND, crank, g.flat("a", (0.0, 0.0)))]
    for k in range(count):
        link = g.Body(f"link_{k}", 1.0, g.flat(f"com_{k}", (0.2, 0.15)), 0.01)
        joints += [
            g.hinge(f"near_{k}", crank, link, g.flat(f"c_{k}", (0.05, 0.1 + apart * k))),
            g.hinge(f"far_{k}", link, rocker, g.flat(f"d_{k}", (0.35, 0.2 + 0.5 * apart * k))),
        ]
    joints.append(g.hinge("right", GROUND, rocker, g.flat("b", (0.3, 0.0))))
    named = joints[0].angle("q", "crank"), joints[-1].angle("p", "rocker")
    return g.Mechanism("couplers", "t", tuple(joints), (), named)


def shafts(count):
    """Return two bearings with several telescopes between crosses from one to the other."""
    upper, lower = g.Point("upper", (0.0, 0.0, 0.0)), g.Point("lower", (0.3, 0.0, -0.1))
    along = g.Direction("along", between=(upper, lower))
    axis, fork = g.Direction("axis", (1.0, 0.0, 0.0)), g.Direction("fork", (0.0, 1.0, 0.0))
    inertia = (1e-3,) * 3
    column = g.Body("column", 1.0, (-0.1, 0.0, 0.0), inertia)
    pinion = g.Body("pinion", 0.5, (0.4, 0.0, -0.1), inertia)
    joints = [g.Revolute("steer", GROUND, column, g.Line(upper, axis))]
    for k in range(count):
        tube = g.Body(f"tube_{k}", 0.5, (0.1, 0.0, -0.03), inertia)
        spline = g.Body(f"spline_{k}", 0.5, (0.2, 0.0, -0.06), inertia)
        joints += [
            g.Universal(f"upper_{k}", column, tube, upper, g.Line(upper, lower), fork),
            g.Prismatic(f"splines_{k}", tube, spline, along),
            g.Universal(f"lower_{k}", pinion, spline, lower, g.Line(lower, upper), fork),
        ]
    joints.append(g.Revolute("rolling", GROUND, pinion, g.Line(lower, axis)))
    named = joints[0].angle("q", "column"), joints[-1].angle("p", "pinion")
    return g.Mechanism("shafts", "t", tuple(joints), (), named)


TWICE = {
    "couplers": (couplers(2), ("link_0 (joints near_0, far_0)", "link_1 (joints near_1, far_1)")),
    "shafts": (shafts(2), ("tube_0 and spline_0 (", "tube_1 and spline_1 (joints upper_1, ")),
}


@pytest.mark.parametrize("name", TWICE)
@pytest.mark.parametrize("allow_iteration", [False, True])
def test_a_branch_that_is_there_twice_is_called_redundant(name, allow_iteration):
    mechanism, words = TWICE[name]
    model = g.Formulation(
        name=name,
        title=name,
        mechanism=mechanism,
        independent=(mechanism.joints[0],),
        allow_iteration=allow_iteration,
    )
    for refused in (lambda: CataloguePlan.of(model), lambda: model_of(mechanism)):
        with pytest.raises(NoClosedFormError) as error:
            refused()
        text = str(error.value)
        assert all(word in text for word in (*words, "redundant", "Leave one of them out"))
        assert "fewer" not in text


@pytest.mark.parametrize(
    "mechanism",
    [couplers(1), shafts(1), FOUR_BAR, *(model.mechanism for model in CHAINS)],
    ids=lambda mechanism: mechanism.name,
)
def test_what_is_there_once_is_not_redundant(mechanism):
    """Bricard's chain and its like move by their dimensions; without any of it they fall apart."""
    assert not redundant(mechanism)


def test_two_couplers_apart_lock_the_mechanism():
    """None of them is redundant: without either it moves, with both it does not."""
    assert not redundant(couplers(2, apart=0.03))


def test_what_holds_to_the_ground_alone_is_not_redundant():
    """Without its only joint there is no ground: the refusal is that of what was declared."""
    crank = couplers(1).joints[0]
    assert not redundant(g.Mechanism("one", "t", (crank,), (), (crank.angle("q", "q"),)))


def test_a_second_bearing_is_redundant():
    """The crank is held at its outer end by a second bearing on the line of the first."""
    (mechanism,) = (couplers(1),)
    pin = g.Body("pin", 0.1, (0.0, 0.0, 0.1), (1e-5,) * 3)
    crank = mechanism.joints[0].second
    line = g.Line(g.Point("outer", (0.0, 0.0, 0.1)), g.UP)
    more = (g.Revolute("on_crank", crank, pin, line), g.Revolute("bearing", GROUND, pin, line))
    found = redundant(Mechanism("held", "t", (*mechanism.joints, *more)))
    assert "pin (joints on_crank, bearing)" in found


def slider_crank(direction):
    ends = {n: g.flat(n, at) for n, at in (("o", (0, 0)), ("a", (0, 0.1)), ("b", (0.3, 0)))}
    crank, rod, slider = (
        g.Body(n, 1.0, g.flat(f"{n}_com", at), 0.01)
        for n, at in (("crank", (0, 0.05)), ("rod", (0.15, 0.05)), ("slider", (0.3, 0)))
    )
    joints = (
        g.hinge("main", GROUND, crank, ends["o"]),
        g.hinge("big_end", crank, rod, ends["a"]),
        g.hinge("small_end", rod, slider, ends["b"]),
        g.Prismatic("way", GROUND, slider, direction),
    )
    named = joints[0].angle("q", "crank"), joints[3].slide("s", "slider")
    return g.Mechanism("slider", "t", joints, (), named)


def test_a_planar_body_that_may_leave_its_plane_is_reported_by_what():
    wrong = g.Direction("along", (1.0, 0.0, 0.0))
    with pytest.raises(kintrafo.MechanismError) as error:
        kintrafo.compile(slider_crank(wrong), backend="numpy")
    text = str(error.value)
    assert "body 'rod' is one of a plane across z" in text
    assert "may leave it by joint 'way'" in text
    assert "inertia_xx" not in text


def test_with_a_guide_in_the_plane_it_is_derived(tmp_path):
    module = kintrafo.compile(slider_crank(g.FORWARD), backend="numpy", folder=tmp_path)
    assert module.relative_coordinates([[0.0, 1.0]])[0, 1] == pytest.approx(0.0, abs=1e-15)
