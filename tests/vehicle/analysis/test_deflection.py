"""Bushes that give way by any amount: equilibrium in maximal coordinates, limits, refusals."""

import re
import tomllib

import numpy as np
import pytest
from kintrafo import (
    Axle,
    InputError,
    Model,
    PositionError,
    RigidAxle,
    Suspension,
    arm_angles,
    characteristics,
    compliance,
    loads,
)
from kintrafo.core.validator import Validator
from kintrafo.core.vectors import unit_vector
from kintrafo.vehicle.analysis.compliance.bars import Bars, Foot
from kintrafo.vehicle.analysis.compliance.connections import CompliantJoints
from kintrafo.vehicle.analysis.compliance.equilibrium import ElasticEquilibrium
from kintrafo.vehicle.analysis.compliance.on_bushes import softs_of
from kintrafo.vehicle.analysis.compliance.rigid_displacements import (
    Angles,
    Distances,
    Lengths,
    Radii,
    RigidDisplacements,
    Torsions,
)
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.assembly.part_poses import CornerParts
from kintrafo.vehicle.input.curve import Curve
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.models.reach import at_rest
from oracle.bushes import CURVED, LINKED, SOFTER, STRUT, TRAILING, WISHBONES, Energy, axle_of
from oracle.constraints import Pose
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from support.folders import ROOT

CARS = [STRUT, WISHBONES, LINKED, TRAILING]


def without_stops(car):
    return car.with_changes({"bump_stop": None})


# -- derivatives ----------------------------------------------------------------------------------


def random_measures(rng, places):
    """Return measures of each kind, with the relative error of their second differences."""
    halves, feet = axle_of(WISHBONES).halves, []
    for body, side in ((1, "left"), (2, "right")):
        at = halves[side].foot + 0.02 * rng.normal(size=3) - places.centers[0, body]
        feet.append(Foot(halves[side], body, (places.turned[0, body].T @ at)[None]))
    bodies = np.array([[0, 1], [1, 2], [2, 1], [2, 0]])
    vectors = rng.normal(size=(3, 1, 4, 3))
    found = [
        Distances(bodies, *vectors),
        Angles(bodies, *vectors[:2]),
        Lengths(bodies, *vectors[:2]),
        Torsions(bodies, *vectors[:2], *vectors[::2]),
        Radii(bodies, *vectors, vectors[1], rng.normal(size=(1, 4, 2))),
    ]
    # levers of a bar are a fifth of a metre: higher derivatives are the larger
    return [*((measure, 1e-5) for measure in found), (Bars(*feet), 1e-4)]


@pytest.mark.parametrize("seed", range(3))
def test_derivatives_are_those_along_screws(seed):
    """Slopes against differences, and the whole second-order polynomial against values."""
    rng = np.random.default_rng(seed)
    turned = Rotation.random(3, rng=rng).as_matrix()[None]
    places = RigidDisplacements(rng.normal(size=(1, 3, 3)), turned)
    by = rng.normal(size=(1, 3, 6))
    by[:, 0] = 0.0
    for measure, apart in random_measures(rng, places):
        here = measure.at(places)
        flat = by[:, here.bodies].reshape(1, len(here.bodies), 12)
        first = (here.slope * flat).sum(-1)
        second = np.einsum("nfi,nfij,nfj->nf", flat, here.bend, flat)
        # differences over a step of 1e-4 are off by 1e-8 of the third and fourth derivatives, and
        # by 1e-16 / 1e-8 of the values in second ones
        h = 1e-4
        ahead, behind = (measure.at(places.moved(s * h * by)).value for s in (1.0, -1.0))
        np.testing.assert_allclose((ahead - behind) / (2 * h), first, rtol=0.1 * apart, atol=2e-6)
        bent = (ahead - 2.0 * here.value + behind) / h**2
        np.testing.assert_allclose(bent, second, rtol=apart, atol=2e-5)


# -- equilibrium ----------------------------------------------------------------------------------


def pushed(car, bushes, travel, force):
    """Return the equilibrium under a force at the wheel centre, the wheel held at its height."""
    model = Model(car)
    with Validator("test") as given:
        read = model.suspension.bushes(given, bushes)
    angles = arm_angles(model, [design_height(model) + travel])
    poses = CornerParts.of(model, *at_rest(model, angles))
    suspension = ElasticEquilibrium(
        [(poses, CompliantJoints({bush.point: bush for bush in read}, 0.0, {}))]
    )
    load = np.array([[[0.0] * 6 + force]])
    base = suspension.under(0.0 * load, "height", suspension.start)
    return suspension, suspension.under(load, "height", base)


@pytest.mark.parametrize(
    ("car", "like"),
    [*((car, car) for car in CARS), (CURVED, WISHBONES)],
    ids=[*(car.suspension for car in CARS), "spring by a curve"],
)
@pytest.mark.parametrize(
    ("travel", "force"), [(0.03, [-4000.0, 0.0, 0.0]), (-0.03, [1000.0, -5000.0, 300.0])]
)
def test_nothing_is_left_of_the_potential(car, like, travel, force):
    """Joints hold, and what is left of the potential's slopes is what they can carry.

    Differences over 1e-6 are off by 1e-16 of 100 J by that, 1e-8 N, and by 1e-12 of third ones;
    positions are found to 1e-10 of a metre at 1e7 N/m, 1e-3 N; loads are some thousand newtons.
    """
    suspension, state = pushed(car, SOFTER[like], travel, force)
    assert state.found.all()
    energy = Energy(car, SOFTER[like], like)
    bodies = energy.bodies[1:]
    order = [suspension._connections.index(0, body) for body in bodies]
    position, rotation = energy.pose.position.copy(), energy.pose.rotation.copy()
    for which, (body, place) in enumerate(zip(bodies, order, strict=True)):
        if place:  # the rack stays
            position[which] = state.places.centers[0, place]
            rotation[which] = state.places.turned[0, place] @ suspension.poses[0].turned[body][0]
    energy.pose = Pose(position, rotation)
    left = energy.slopes(np.array(force), float(state.road[0, 0]))
    _, held, *_ = energy.parts(energy.bushes)
    for name, first, second in energy.soft:
        gap = energy.placed(name, second) - energy.placed(name, first)
        if name not in energy.bushes:
            assert np.abs(gap).max() < 1e-10, name
            held.append(energy.point(name, first, second))
    assert np.abs(state.places.centers - suspension.start.places.centers).max() > 0.008
    rows = np.vstack(held)
    carried = np.linalg.lstsq(rows.T, left, rcond=1e-12)[0]
    rest = left - rows.T @ carried
    assert np.abs(rest).max() < 1e-2
    assert np.abs(left).max() > 1e3


# -- limits ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("travel", [-0.06, 0.0, 0.05])
def test_torsion_of_the_arm_adds_to_the_wheel_rate(travel):
    """A bush that only resists torsion leaves the joints where they are: virtual work."""
    model = Model("reference_car")
    stiffness = {"arm_front": {"torsion_Nm_per_deg": 2.0}, "arm_rear": {"torsion_Nm_per_deg": 3.0}}
    step = 1e-4
    travels = travel + step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    found = compliance.elastokinematics(model, stiffness, along=travels, hardpoints="relaxed")
    np.testing.assert_allclose(*found["toe"].values, rtol=0.0, atol=1e-12)
    angles = arm_angles(model, design_height(model) + travels)
    poses = CornerParts.of(model, *at_rest(model, angles))
    # differences of fourth order over 0.1 mm: 1e-16 * 500 mm / 0.1 mm of rounding
    by = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step)
    lever = (by @ angles) / (by @ poses.points["contact"][:, 2])
    moment = 5.0 * 180.0 / np.pi * (angles - model.design_state[0])
    rigid, soft = found["wheel_load"].values
    assert (soft - rigid)[2] == pytest.approx((moment[2] * lever), rel=1e-8, abs=1e-8)
    heights = by @ poses.points["contact"][:, 2]
    for which, force in enumerate((rigid, soft)):
        rate = float(found["contact_rate"][which, 2])
        assert rate == pytest.approx((by @ force) / heights, rel=1e-7)


@pytest.mark.parametrize("hardpoints", ["loaded", "relaxed"])
def test_a_radial_curve_is_the_same_to_all_sides(hardpoints):
    model = Model("reference_car")
    curve = {"mm": [0.0, 1.0, 3.0], "N": [0.0, 1200.0, 9000.0]}
    found = [
        compliance.nonlinear(
            model,
            {"arm_rear": {"axial_N_per_mm": 500.0, "radial_curve": curve, "radial_axis": axis}},
            "braking",
            [-3000.0, 6000.0],
            hardpoints=hardpoints,
        )
        for axis in ([0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.0, -1.0, 0.3])
    ]
    for other in found[1:]:
        np.testing.assert_allclose(
            other["toe_change"][0], found[0]["toe_change"][0], rtol=1e-7, atol=1e-12
        )


def test_a_curve_goes_on_as_its_last_points_rise():
    """A monotone cubic would end with a zero slope, and carry no further force."""
    places, forces = 1e-3 * np.arange(-2.0, 2.5), np.array([-9, -8, 0.0, 8, 9.0])
    curve = Curve(places, forces, "cubic", as_secants=True)
    outside = np.array([-5e-3, 3e-3])
    np.testing.assert_allclose(curve.force(outside), [-12.0, 10.0], rtol=1e-12)
    np.testing.assert_allclose(curve.rate(outside), 1e3, rtol=1e-12)
    inside = np.linspace(-2e-3, 2e-3, 401)
    assert (np.diff(curve.force(inside)) > 0.0).all()
    assert curve.force(np.array([curve.place(500.0)]))[0] == pytest.approx(500.0)
    flat = {"arm_rear": {"radial_curve": {"mm": [0.0, 1.0, 2.0], "N": [0.0, 9.0, 10.0]}}}
    found = compliance.elastokinematics(Model("reference_car"), flat, along=[0.0])
    np.testing.assert_allclose(*found["toe"].values, rtol=0.0, atol=1e-9)


def test_a_curve_of_straight_lines():
    """Between its points, and in what a load does: as the cubic through points on these lines."""
    lines = {"mm": [0.0, 1.0, 4.0], "N": [0.0, 600.0, 9000.0], "interpolation": "linear"}
    places = np.array([0.0, 1.0, 4.0])
    curve = Curve(1e-3 * places, np.array([0.0, 600.0, 9000.0]), "linear", as_secants=True)
    at = np.linspace(-1.0, 6.0, 15)
    expected = np.where(at < 1.0, 600.0 * at, 600.0 + 2800.0 * (at - 1.0))
    np.testing.assert_allclose(curve.force(1e-3 * at), expected, rtol=1e-12, atol=1e-9)
    rates = np.where(at <= 1.0, 600e3, 2800e3)  # where lines meet, that of the line before
    np.testing.assert_allclose(curve.rate(1e-3 * at), rates, rtol=1e-12)
    fine = np.unique(np.concatenate([np.linspace(0.0, 4.0, 401), [0.999, 1.001]]))
    forces = np.where(fine < 1.0, 600.0 * fine, 600.0 + 2800.0 * (fine - 1.0))
    model = Model("reference_car")
    one, other = (
        compliance.nonlinear(
            model, {"arm_rear": {"axial_N_per_mm": 500.0, "radial_curve": described}}, "lateral",
            [-5000.0, 2000.0, 6000.0],
        )["toe_change"].values[0]
        for described in (lines, {"mm": fine.tolist(), "N": forces.tolist()})
    )  # fmt: skip
    # the cubic rounds the corner off over 2 um
    np.testing.assert_allclose(one, other, rtol=1e-4)


def test_torsion_alone_has_no_linear_deflection():
    bushes = {"arm_rear": {"torsion_Nm_per_deg": 2.0}}
    found = compliance.nonlinear(Model("reference_car"), bushes, "braking", [1000.0], held="spring")
    assert found["displacement"][1, 0] == 0.0
    assert abs(found["displacement"][0, 0]) > 1e-6


def test_a_curve_is_a_stiffness_where_it_is_straight():
    model = Model("reference_car")
    straight = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    curve = {"mm": [0.0, 5.0], "N": [0.0, 10e3]}
    bent = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_curve": curve}}
    stiff = {"mm": [0.0, 1.0, 5.0], "N": [0.0, 2e3, 50e3]}
    stiffer = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_curve": stiff}}
    amounts = [-6000.0, 100.0, 6000.0]
    first, second, third = (
        compliance.nonlinear(model, bushes, "lateral", amounts)["toe_change"].values
        for bushes in (straight, bent, stiffer)
    )
    np.testing.assert_allclose(first, second, rtol=1e-9)
    assert (np.abs(third[0, [0, 2]]) < 0.95 * np.abs(first[0, [0, 2]])).all()
    relaxed = [
        compliance.elastokinematics(model, bushes, along=[0.02], hardpoints="relaxed")["toe"].values
        for bushes in (straight, bent)
    ]
    np.testing.assert_allclose(*relaxed, rtol=1e-9)


@pytest.mark.parametrize("name", ["push_rod_car", "pull_rod_car", "offset_strut_car"])
def test_other_kinds_deflect_nearly_linearly(name):
    model = Model(name)
    point = "arm_rear" if name == "offset_strut_car" else "lower_arm_rear"
    bushes = {point: {"axial_N_per_mm": 400.0, "radial_N_per_mm": 3000.0}}
    found = compliance.nonlinear(model, bushes, "lateral", [10.0])
    # the static load in turned bushes has an effect of some per cent
    np.testing.assert_allclose(*found["toe_change"].values, rtol=0.05)


# -- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize("side", ["right", "left"])
def test_no_load_presses_a_damper_in_farther_than_it_goes(side, refused):
    """By hand: a brake lifts the contact of a trailing arm as the hinge is high over how far.

    The spring takes that over the wheel rate, and the damper its ratio of the travel. Rates and
    ratios change by some per cent on the way, and stiff bushes give a little.
    """
    car = without_stops(Suspension.load("trailing_arm_car"))
    car = car if side == "right" else car.mirrored()
    design = characteristics.over(Model(car), "travel", [0.0])
    slope = np.tan(abs(float(design["side_view_swing_arm_angle"][0])))
    ratio = float(design["damper_motion_ratio"][0])
    length = float(Model(car).signal("damper_length", Model(car).design_state))
    model = Model(car.with_changes({"damper.length_min_mm": 1e3 * (length - 0.005)}))
    most = 0.005 / ratio * float(design["wheel_rate"][0]) / slope
    stiff = {"arm_inner": {"axial_N_per_mm": 1e6, "radial_N_per_mm": 1e6}}

    def under(amounts):
        return compliance.nonlinear(model, stiff, "braking", amounts, held="spring")

    assert under([-2.0 * most, 0.93 * most])["displacement"].shape == (2, 2)
    refused(PositionError, lambda: under([0.0, 1.07 * most]))
    # held at its height, the wheel does not press it in
    compliance.nonlinear(model, stiff, "braking", [2.0 * most])


def test_what_the_suspension_cannot_do_ends_a_command_with_1(tmp_path, ends):
    """As the page of the command line says of all that is no mistake in what was given."""
    soft = "[bushings.arm_rear]\naxial_N_per_mm = 1.0\nradial_N_per_mm = 1.0\n"
    (tmp_path / "soft.toml").write_text(soft, encoding="utf-8")
    line = "compliance reference_car --bushes soft.toml --nonlinear --under braking --most 900000"
    ends(1, *line.split())
    ends(2, *line.replace("braking", "sideways").split())


def test_what_cannot_be_is_refused(refused):
    model = Model("reference_car")
    bushes = {"arm_rear": {"axial_N_per_mm": 500.0}}
    refused(
        InputError,
        lambda: compliance.nonlinear(model, bushes, "sideways", [1.0]),
        lambda: compliance.nonlinear(model, bushes, "lateral", [1e9]),
    )
    for curve in (
        {"mm": [0.0, 1.0]},
        {"mm": [0.0, 1.0], "N": [0.0]},
        {"mm": [0.0, 1.0], "N": [0.0, -5.0]},
        {"mm": [1.0, 2.0], "N": [1.0, 2.0]},
    ):
        with refused(InputError):
            compliance.elastokinematics(model, {"arm_rear": {"axial_curve": curve}}, along=[0.0])
    for point, key in (("wheel_center", "torsion_Nm_per_deg"), ("arm_rear", "tilt_Nm_per_mm")):
        with refused(InputError):
            compliance.elastokinematics(model, {point: {key: 5.0}}, along=[0.0])
    too_close = {"mm": [-1.0, 0.0, 5e-324, 1.0], "N": [-5.0, 0.0, 1.0, 9.0]}
    refused(InputError, lambda: compliance.linear(model, {"arm_rear": {"axial_curve": too_close}}))
    one_sided = {"mm": [0.0, 1.0, 2.0], "N": [0.0, 1.0, 1000.0]}
    refused(InputError, lambda: compliance.linear(model, {"arm_rear": {"axial_curve": one_sided}}))
    curve = {"mm": [-1.0, 0.0, 1.0], "N": [-5.0, 0.0, 9.0]}
    compliance.elastokinematics(model, {"arm_rear": {"axial_curve": curve}}, along=[0.0])
    with refused(InputError):
        compliance.elastokinematics(model, {"arm_rear": {"radial_curve": curve}}, along=[0.0])
    both = {"arm_rear": {"axial_N_per_mm": 1.0, "axial_curve": {"mm": [0, 1], "N": [0, 1]}}}
    refused(InputError, lambda: compliance.linear(model, both))


# -- what the bearings of an arm carry where the hardpoints are ----------------------------------

_STIFF, _LOOSE = 4000.0, 300.0
_BENT = {"mm": [-3.0, -1.0, 0.0, 1.0, 3.0], "N": [-9000.0, -700.0, 0.0, 500.0, 8000.0]}
BEARINGS = {
    "along the arm": (
        {"axial_N_per_mm": _STIFF, "radial_N_per_mm": 2000.0},
        {"axial_N_per_mm": _LOOSE, "radial_N_per_mm": 9000.0},
    ),
    "one bent": (
        {"axial_curve": _BENT, "radial_N_per_mm": 2000.0},
        {"axial_N_per_mm": _LOOSE},
    ),
    "across the arm": (
        {"axial_N_per_mm": 900.0, "radial_N_per_mm": [300.0, 5000.0], "axis": [0.3, 0.2, 1.0]},
        {"axial_N_per_mm": _LOOSE, "radial_curve": {"mm": [0, 1, 3], "N": [0, 900, 9000]},
         "axis": [1.0, 0.4, 0.2]},
    ),
    "one rigid": ({"radial_N_per_mm": 2000.0}, {"axial_N_per_mm": _LOOSE}),
}  # fmt: skip


def _given_way(bush, force):
    """Return where a bush goes under a force, by a search along each of its axes [m]."""
    carried = bush.axes @ force
    found = bush.soft * carried
    axial, radial, _ = bush.curves
    if axial is not None:
        found[0] = brentq(lambda d: axial.force(np.array(d)) - carried[0], -0.1, 0.1, xtol=1e-15)
    if radial is not None:
        size = np.linalg.norm(carried[1:])
        far = brentq(lambda d: radial.force(np.array(d)) - size, 0.0, 0.1, xtol=1e-15)
        found[1:] = far * carried[1:] / size
    return bush.axes.T @ found


@pytest.mark.parametrize("kind", BEARINGS)
@pytest.mark.parametrize("on", ["suspension", "axle"])
def test_two_bearings_share_a_force_as_their_bushes_do(kind, on):
    """Along their axis the bearings of a rigid arm move alike: there the energy is least."""
    front, rear = BEARINGS[kind]
    names = {"reference_car": ("arm_front", "arm_rear", "control_arm"),
             "double_wishbone_car": ("lower_arm_front", "lower_arm_rear", "lower_arm")}  # fmt: skip
    for name, (one, other, arm) in names.items():
        car = Suspension.load(name)
        model = Model(car)
        bushes = {one: front, other: rear}
        with Validator("test") as given:
            axle = Axle.from_dict({"axle": "front", "side": car})
            assembly = assembly_of(model if on == "suspension" else axle)
            suffix = "" if on == "suspension" else f"_{car.vehicle.side}"
            soft = softs_of(given, assembly, bushes, "loaded")[suffix]
        forces = {at: soft.carried["chassis", arm, at][:3] for at in (one, other)}
        axis = unit_vector(car.hardpoints.metres(other) - car.hardpoints.metres(one))
        moved = {at: _given_way(soft.bushes[at], forces[at]) @ axis for at in forces}
        # a search for forces of 1e3 N to 1e-14 of them, that give way by a millimetre
        assert moved[one] == pytest.approx(moved[other], abs=1e-12)
        # both together are what statics says
        held = loads.static(model, {"design": {"travel_mm": 0.0}})
        both = held["force"].sel(load=[f"{arm} at {at} by chassis" for at in forces])
        np.testing.assert_allclose(sum(forces.values()), both[0].sum("load"), atol=1e-6)
        if kind == "along the arm":
            share = (forces[one] @ axis) / (forces[other] @ axis)
            assert share == pytest.approx(_STIFF / _LOOSE, rel=1e-9)
        if kind == "one rigid":
            assert abs(forces[other] @ axis) < 1e-6


# -- loads beyond the bushes ---------------------------------------------------------------------


@pytest.mark.parametrize("subject", ["suspension", "axle", "rigid axle"])
@pytest.mark.parametrize("what", ["bush", "tyre"])
def test_loads_that_no_rubber_carries_are_refused(subject, what, refused):
    """They are what a slip of the hand makes, and used to give metres without a word."""
    bushes = {"arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 1200.0}}
    tyre = {"tyre.lateral_rate_N_per_m": 55e3} if what == "tyre" else {}
    car = Suspension.load("reference_car").with_changes(tyre)
    rods = {"panhard_rod_chassis": {"axial_N_per_mm": 500.0}}
    doors = {
        "suspension": lambda most: compliance.nonlinear(Model(car), bushes, "lateral", [most]),
        "axle": lambda most: compliance.nonlinear(
            Axle.from_dict({"axle": "front", "side": car}), bushes, "lateral", [most]
        ),
        "rigid axle": lambda most: compliance.nonlinear(
            RigidAxle.load("rigid_axle").with_changes(tyre), rods, "lateral", [most]
        ),
    }
    refused(PositionError, lambda: doors[subject]({"bush": 1e5, "tyre": 12e3}[what]))
    assert doors[subject](4e3).sizes["load"] == 1


def test_wheels_that_lie_in_their_bushes_at_rest_are_refused(refused):
    of, soft = "upper_arm_front", {"axial_N_per_mm": 1.0, "radial_N_per_mm": 1.0}
    bushes = {of: soft | {"axis": [0.0, 0.0, 1.0]}}
    refused(
        PositionError,
        lambda: compliance.elastokinematics(
            Model("double_wishbone_car"), bushes, along=[0.0], hardpoints="relaxed"
        ),
    )


def _of_page(page, name):
    """Return the bushes that a page of the documentation has."""
    text = (ROOT / "docs/suspension" / page).read_text(encoding="utf-8")
    block = re.search(rf"```toml\n# {name}\n(.*?)```", text, re.DOTALL)
    return tomllib.loads(block[1])["bushings"]


def _slope_over_first_order(changes):
    """Return the slope at zero, by central differences, over that of first order."""
    slopes = changes.values[:, 1] - changes.values[:, 0]
    return float(slopes[0] / slopes[1])


def test_what_the_pages_say_of_small_loads_under_a_static_one():
    """Preloaded parts turn, which first order leaves out."""
    small = [-10.0, 10.0]
    car = compliance.nonlinear(
        Model("reference_car"), _of_page("compliance.md", "bushes.toml"), "lateral", small,
        held="spring",
    )  # fmt: skip
    found = {"toe": (_slope_over_first_order(car["toe_change"]), 1.28)}
    axle, bushes = RigidAxle.load("rigid_axle"), _of_page("compliance.md", "axle_bushes.toml")
    for under, ratios in {
        "lateral": {
            "axle_steer_change": 1.19,
            "axle_lateral_change": 1.12,
            "displacement": 1.15,
            "camber_change": 1.15,
        },
        "braking": {"camber_change": 1.18},
        "aligning": {"axle_lateral_change": 0.68},
    }.items():
        rigid = compliance.nonlinear(axle, bushes, under, small, held="spring").sel(wheel="left")
        for name, ratio in ratios.items():
            found[f"{name} by {under}"] = _slope_over_first_order(rigid[name]), ratio
    for name, (ratio, of_page) in found.items():
        assert ratio == pytest.approx(of_page, abs=5e-3), name
