"""Bushes of a rigid axle: against springs along its rods, written down here.

To first order beam and wheels are three bodies on stiffnesses, with constraints where nothing gives
way. Under loads of any size a bush that is as stiff in every direction, with its rod, is a spring
along the line to the rod's other end, wherever the axle goes: SciPy puts a beam on four of them.
"""

import math
import re
import tomllib

import numpy as np
import pytest
from cars.rigid_axles import AXLE, FIVE, LOPSIDED, TRIANGULATED, Found
from kintrafo import InputError, PositionError, RigidAxleModel, characteristics, compliance, loads
from kintrafo.vehicle.analysis.checkup import checkup
from kintrafo.vehicle.analysis.compliance.tables import compliances_of_beam
from kintrafo.vehicle.analysis.sheet import sheet
from kintrafo.vehicle.assembly.by_wheel import flat
from oracle.bushes import minimum
from oracle.constraints import skew
from scipy.optimize import root
from scipy.spatial.transform import Rotation
from support.folders import ROOT

UP = np.array([0.0, 0.0, 1.0])
SIDES = {"left": 1.0, "right": -1.0}
# Without preload, as the linear theory has it, and with stops that just touch.
FREE = {
    "gravity.acceleration_m_per_s2": 0.0,
    "spring.force_at_design_N": 0.0,
    "bump_stop": {"clearance_mm": 0.0, "rate_N_per_m": 5e4, "progression_N_per_mm3": 0.05},
}
BUSHES = {
    "left_link_chassis": {"axial_N_per_mm": 900.0, "radial_N_per_mm": [1500.0, 4000.0],
                          "axis": [0.1, 1.0, 0.0], "radial_axis": [1.0, 0.0, 0.3]},
    "left_link_axle": {"axial_N_per_mm": 2500.0},
    "right_link_axle": {"axial_N_per_mm": 700.0, "radial_N_per_mm": 3000.0, "axis": [0, 1, 0.2]},
    "wheel_center": {"axial_N_per_mm": 50e3, "radial_N_per_mm": [80e3, 60e3],
                     "radial_axis": [0.3, 0.4, 1.0], "tilt_Nm_per_deg": 4000.0},
}  # fmt: skip
OF = {
    "Panhard rod": BUSHES | {"panhard_rod_chassis": {"axial_N_per_mm": 1800.0},
                             "upper_link_axle": {"axial_N_per_mm": 1200.0}},
    "triangulated": BUSHES | {"left_upper_chassis": {"axial_N_per_mm": 1200.0},
                              "right_upper_axle": {"axial_N_per_mm": 1500.0}},
}  # fmt: skip


def upward(axis):
    """Return what points up in the plane of a wheel."""
    found = UP - axis * axis[2]
    return found / np.linalg.norm(found)


class Placed:
    """The points of an axle where the root finder puts it."""

    def __init__(self, axle, heave=0.0, roll=0.0):
        self.axle = axle
        fifth = {*axle.rods} - {*axle.guides}
        four = axle.with_changes({f"rods.{name}": None for name in fifth} | {"bushings": None})
        self.finder = Found(four if fifth else axle)
        self.middle, self.turn = self.finder.pose(heave, roll)
        self.rods = {
            name: (inner, self.beam(outer)) for name, (inner, outer) in axle.ends().items()
        }
        self.wheels = {s: self.beam(axle.center + k * axle.half_track * np.eye(3)[1])
                       for s, k in SIDES.items()}  # fmt: skip
        self.contacts = {s: self.contact(s) for s in SIDES}

    def beam(self, point):
        return np.asarray(self.middle + self.turn.apply(point - self.axle.center))

    def contact(self, side):
        radius = self.axle.tyre_radius()
        axis = self.turn.apply(self.axle.wheel.spin_axis(SIDES[side]))
        return self.wheels[side] - radius * upward(axis)

    def ends(self, line, side):
        points = self.axle.points(side)
        return points[f"{line}_top"], self.beam(points[f"{line}_seat"])


def matrix(bush, axis):
    """Return how soft a bush is, (3, 3) [m/N]."""
    axis = np.array(bush.get("axis", axis), dtype=float)
    axis /= np.linalg.norm(axis)
    first = np.array(bush.get("radial_axis", [0.0, 0.0, 1.0]))
    first = first - (first @ axis) * axis
    first /= np.linalg.norm(first)
    soft = [1e-3 / bush.get("axial_N_per_mm", np.inf)]
    soft += [1e-3 / k for k in np.broadcast_to(bush.get("radial_N_per_mm", np.inf), 2)]
    rows = np.stack([axis, first, np.cross(axis, first)])
    return np.asarray(rows.T @ np.diag(soft) @ rows)


def stiffnesses(  # noqa: C901, PLR0915 (one thing after the other)
    axle, bushes, travel, held
):
    """Return displacements and rotations of both contacts by forces and moments, chassis axes."""
    at = Placed(axle, travel)
    stiff, rigid = np.zeros((18, 18)), []

    def on_beam(point, along):
        return np.concatenate([along, np.cross(point - at.middle, along), np.zeros(12)])

    for name, (inner, outer) in at.rods.items():
        along = (inner - outer) / np.linalg.norm(inner - outer)
        start, end = axle.ends()[name]
        soft = 0.0
        if bush := bushes.get(f"{name}_chassis"):
            soft += along @ matrix(bush, end - start) @ along
        if bush := bushes.get(f"{name}_axle"):
            turned = at.turn.inv().apply(along)
            soft += turned @ matrix(bush, start - end) @ turned
        row = on_beam(outer, along)
        if soft:
            stiff += np.outer(row, row) / soft
        else:
            rigid.append(row)
    loads = np.zeros((12, 18))
    for i, (side, sign) in enumerate(SIDES.items()):
        own = slice(6 + 6 * i, 12 + 6 * i)
        apart = np.zeros((6, 18))
        apart[:, own] = np.eye(6)
        apart[:3, :3], apart[:3, 3:6] = -np.eye(3), skew(at.wheels[side] - at.middle)
        apart[3:, 3:6] = -np.eye(3)
        bush = dict(bushes["wheel_center"])
        spin = axle.wheel.spin_axis(sign)
        # the file's is that of the right side
        bush["radial_axis"] = np.array(bush["radial_axis"]) * [1.0, -sign, 1.0]
        in_beam = at.turn.as_matrix()
        soft = in_beam @ matrix(bush, spin) @ in_beam.T
        stiff += apart[:3].T @ np.linalg.inv(soft) @ apart[:3]
        spin = in_beam @ spin
        tilt = apart[3:] - np.outer(spin, spin) @ apart[3:]
        stiff += math.degrees(bush["tilt_Nm_per_deg"]) * tilt.T @ tilt
        rigid.append(spin @ apart[3:])
        arm = at.contacts[side] - at.wheels[side]
        moved = np.zeros((6, 18))
        moved[:, own] = np.eye(6)
        moved[:3, own][:, 3:] = -skew(arm)
        loads[6 * i : 6 * i + 6] = moved
        for line, rate in (("spring", axle.spring.rate_N_per_m), ("damper", 5e4)):
            top, seat = at.ends(line, side)
            row = on_beam(seat, (seat - top) / np.linalg.norm(seat - top))
            if held == "locked":
                rigid += [row] if line == "spring" else []
            else:
                stiff += rate * np.outer(row, row)
        if held == "height":
            rigid.append(moved[2])
        if held == "tyre":
            stiff += axle.tyre.rate_N_per_m * np.outer(moved[2], moved[2])
    across = at.turn.apply([0.0, 1.0, 0.0])
    about = np.cross(across, UP) / math.hypot(across[0], across[1])
    bar = np.concatenate([np.zeros(3), about, np.zeros(12)])
    stiff += math.degrees(axle.anti_roll_bar.rate_Nm_per_deg) * np.outer(bar, bar)
    return np.asarray(loads @ minimum(stiff, np.array(rigid), loads.T))


OF["five"] = OF["Panhard rod"] | {"right_upper_link_axle": {"axial_N_per_mm": 700.0}}


@pytest.mark.parametrize(
    ("held", "travel"),
    [("spring", 1e-9), ("height", 1e-9), ("tyre", 1e-9), ("locked", 0.05), ("locked", -0.04)],
)
@pytest.mark.parametrize(
    ("axle", "rods"),
    [
        (AXLE, "Panhard rod"),
        (TRIANGULATED, "triangulated"),
        (LOPSIDED, "Panhard rod"),
        (FIVE, "five"),
    ],
    ids=["three links", "triangulated", "lopsided", "five rods"],
)
def test_the_axle_deflects_as_on_springs(axle, rods, held, travel):
    """Forces by statics and least energy against stiffnesses and constraints, two theories."""
    axle = axle.with_changes(FREE)
    found = flat(compliance.linear(axle, OF[rods], [travel], held=held))
    theirs = stiffnesses(axle, OF[rods], travel, held)
    at = Placed(axle, travel)
    axes = np.zeros((12, 12))
    for i, (side, sign) in enumerate(SIDES.items()):
        spin = at.turn.apply(axle.wheel.spin_axis(sign))
        forward = np.cross(spin, UP) / np.linalg.norm(np.cross(spin, UP))
        own = slice(6 * i, 6 * i + 6)
        axes[own, own] = np.kron(np.eye(2), np.stack([forward, np.cross(UP, forward), UP]))
        assert side in str(found["moved"].values[6 * i])
    ours, theirs = found["flexibility"].values[0], axes @ theirs @ axes.T
    # with the stop gone by the rounding of its length, and 1e-9 of least squares
    np.testing.assert_allclose(ours, theirs, rtol=0.0, atol=1e-6 * abs(theirs).max())
    np.testing.assert_allclose(ours, ours.T, rtol=0.0, atol=1e-12 * abs(ours).max())
    # the line through both wheel centres, by the wheels' own motions in the tyre's axes
    left, right = (at.wheels[side] for side in SIDES)
    both = np.array([-1.0, 1.0])  # forces to the left: outward, and inward
    inward = np.array([-1.0, 1.0])
    force = np.zeros(12)
    force[[1, 7]] = both * inward
    moved = axes.T @ (theirs @ force)
    centers = [
        moved[6 * i : 6 * i + 3]
        + np.cross(moved[6 * i + 3 : 6 * i + 6], at.wheels[side] - at.contacts[side])
        for i, side in enumerate(SIDES)
    ]
    line, change = left - right, centers[0] - centers[1]
    steer = (change[1] * line[0] - change[0] * line[1]) / (line[:2] @ line[:2])
    names = ("axle_steer", "axle_lateral", "axle_longitudinal")
    reported = {name: float(found[f"{name}_by_lateral_parallel"][0]) for name in names}
    middle = np.mean(centers, axis=0)
    want = {"axle_steer": steer, "axle_lateral": middle[1], "axle_longitudinal": middle[0]}
    for name, value in want.items():
        assert reported[name] == pytest.approx(value, rel=1e-5, abs=1e-6 * abs(theirs).max())


# -- loads of any size ----------------------------------------------------------------------------

STOPPED = AXLE.with_changes(
    {"bump_stop": {"clearance_mm": 10.0, "rate_N_per_m": 4e4, "progression_N_per_mm3": 0.05}}
)
RATES = {"left_link_chassis": 400.0, "right_link_axle": 600.0, "upper_link_chassis": 500.0,
         "panhard_rod_axle": 900.0}  # fmt: skip
RATES_OF_FIVE = RATES | {"right_upper_link_chassis": 700.0}


def every_way(rates):
    """Return bushes that are as stiff in every direction."""
    return {p: {"axial_N_per_mm": rate, "radial_N_per_mm": rate} for p, rate in rates.items()}


EVERY_WAY = every_way(RATES)


class OnSprings:
    """A beam with its wheels on springs along its rods, with springs, stops, bar and road."""

    def __init__(self, axle, *, loaded):
        self.axle, self.center = axle, axle.center
        self.rates = RATES_OF_FIVE if len(axle.rods) > len(RATES) else RATES
        at = Placed(axle)
        pulls = self.at_design(at) if loaded else dict.fromkeys(at.rods, 0.0)
        self.rods = {}
        for point, rate in self.rates.items():
            name, _, end = point.rpartition("_")
            inner, outer = at.rods[name]
            way = inner - outer
            shift = pulls[name] / (1e3 * rate) * way / np.linalg.norm(way)
            # where the bush would be without what it carries
            moved = (inner + shift, outer) if end == "chassis" else (inner, outer - shift)
            self.rods[name] = (*moved, 1e3 * rate, np.linalg.norm(way))

    def at_design(self, at):
        """Return the pull of each rod at design, the road holding both wheels."""
        arms = [(outer, inner - outer) for inner, outer in at.rods.values()]
        columns = [np.concatenate([w, np.cross(p - self.center, w)]) / np.linalg.norm(w)
                   for p, w in arms]  # fmt: skip
        columns += [np.concatenate([UP, np.cross(at.contacts[s] - self.center, UP)]) for s in SIDES]
        # what balance does not decide makes the energy of the bushes least
        balance, soft = np.stack(columns, -1), np.zeros(len(columns))
        by_rod = {point.rpartition("_")[0]: 1e-3 / rate for point, rate in self.rates.items()}
        soft[: len(at.rods)] = [1e6 * by_rod[name] for name in at.rods]
        matrix = np.block([[np.diag(soft), balance.T], [balance, np.zeros((6, 6))]])
        right = np.concatenate([np.zeros(len(columns)), -self.inside(at)])
        return dict(zip(at.rods, np.linalg.solve(matrix, right), strict=False))

    def inside(self, at):
        """Return force and moment of springs, stops, bar and weight about the design's middle."""
        axle, total = self.axle, np.zeros(6)

        def push(point, force):
            total[:3] += force
            total[3:] += np.cross(point - self.center, force)

        weight = axle.gravity.acceleration_m_per_s2
        push(at.beam(axle.bodies.beam.centre_of_mass(axle.hardpoints)),
             -weight * axle.bodies.beam.mass_kg * UP)  # fmt: skip
        for side in SIDES:
            push(at.wheels[side], -weight * axle.bodies.wheel.mass_kg * UP)
            points = axle.points(side)
            for line in ("spring", "damper"):
                top, seat = at.ends(line, side)
                away, length = seat - top, np.linalg.norm(seat - top)
                design = float(np.linalg.norm(points[f"{line}_seat"] - points[f"{line}_top"]))
                if line == "spring":
                    force = axle.spring.rate_N_per_m * (axle.spring.free_length(design) - length)
                else:
                    pressed = design - length - 0.01
                    force = (4e4 * pressed + 5e7 * pressed**3) * (pressed > 0.0)
                    force *= axle.bump_stop is not None
                push(seat, force * away / length)
        across = at.turn.apply([0.0, 1.0, 0.0])
        roll, level = math.asin(across[2]), math.hypot(across[0], across[1])
        total[3:] -= math.degrees(axle.anti_roll_bar.rate_Nm_per_deg) * roll * (
            np.cross(across, UP) / level
        )  # fmt: skip
        return total

    def solve(self, loads, heights, road):
        """Return where it is under force and moment on each wheel, (2, 6), and the road's forces.

        At some heights of the contacts, or under the road's forces as they are given.
        """
        at = Placed(self.axle)

        def misfit(x):
            at.middle, at.turn = self.center + x[:3], Rotation.from_rotvec(x[3:6])
            at.wheels = {s: at.beam(self.center + k * self.axle.half_track * np.eye(3)[1])
                         for s, k in SIDES.items()}  # fmt: skip
            at.contacts = {side: at.contact(side) for side in SIDES}
            total = self.inside(at)
            for inner, outer, rate, length in self.rods.values():
                point = at.beam(outer)
                way = inner - point
                pull = rate * (np.linalg.norm(way) - length) * way / np.linalg.norm(way)
                total += np.concatenate([pull, np.cross(point - self.center, pull)])
            for i, side in enumerate(SIDES):
                force = loads[i, :3] + 1e4 * x[6 + i] * UP
                total[:3] += force
                total[3:] += loads[i, 3:] + np.cross(at.contacts[side] - self.center, force)
            ends = 1e4 * x[6:] - road
            if heights is not None:
                ends = 1e6 * (np.array([at.contacts[s][2] for s in SIDES]) - heights)
            return np.concatenate([total, ends])

        found = root(misfit, np.concatenate([np.zeros(6), 0.6 * np.ones(2)]), tol=1e-13)
        assert np.abs(misfit(found.x)).max() < 1e-6, found.message
        return at, 1e4 * found.x[6:]


def deflections(at):
    left, right = at.wheels["left"], at.wheels["right"]
    axis = at.turn.apply(at.axle.wheel.spin_axis(-1.0))
    return {
        "axle_steer": math.atan2(-(left - right)[0], (left - right)[1]),
        "axle_lateral": float(0.5 * (left + right)[1]),
        "axle_longitudinal": float(0.5 * (left + right)[0] - at.axle.center[0]),
        # a right wheel's toe-in turns its front to the left, and the axis' left end backward
        "toe_right": math.atan2(-axis[0], axis[1]),
        "camber_right": math.atan2(axis[2], axis[1]),
    }


FIVE_STOPPED = FIVE.with_changes(
    {"bump_stop": STOPPED.to_dict()["bump_stop"], "bushings": every_way(RATES_OF_FIVE)}
)


@pytest.mark.parametrize("hardpoints", ["loaded", "relaxed"])
@pytest.mark.parametrize(("motion", "along"), [("bump", 0.04), ("roll", 0.05), ("left", -0.05)])
@pytest.mark.parametrize("axle", [STOPPED, FIVE_STOPPED], ids=["four rods", "five rods"])
def test_motions_on_bushes_are_those_of_a_beam_on_springs(axle, motion, along, hardpoints):
    bushes = None if axle is FIVE_STOPPED else EVERY_WAY
    found = flat(compliance.elastokinematics(axle, bushes, motion, [along], hardpoints=hardpoints))
    heave, roll = along, 0.0
    if motion == "roll":
        heave, roll = 0.0, -along
    elif motion == "left":
        heave, roll = 0.5 * along, math.asin(0.5 * along / axle.half_track)
    rigid = Placed(axle, heave, roll)
    heights = np.array([rigid.contacts[side][2] for side in SIDES])
    on = OnSprings(axle, loaded=hardpoints == "loaded")
    at, road = on.solve(np.zeros((2, 6)), heights, np.zeros(2))
    places = {"kinematic": rigid, "elastokinematic": at}
    if axle is FIVE_STOPPED:  # five rigid rods do not let it move
        del places["kinematic"]
    assert found["data_set"].values.tolist() == [*places]
    for data_set, place in places.items():
        for name, value in deflections(place).items():
            ours = float(found[name].sel(data_set=data_set)[0])
            # steps of 1e-9 m end Newton's method; 1e-6 N over stiffnesses of 1e6 N/m this one
            assert ours == pytest.approx(value, abs=2e-10), (data_set, name)
    for i, side in enumerate(SIDES):
        carried = float(found[f"wheel_load_{side}"].sel(data_set="elastokinematic")[0])
        assert carried == pytest.approx(road[i], rel=1e-7)
    turned = math.asin(at.turn.apply([0.0, 1.0, 0.0])[2])
    torque = float(found["bar_torque"].sel(data_set="elastokinematic")[0])
    assert torque == pytest.approx(180.0 * math.degrees(turned), rel=1e-6, abs=1e-4)


@pytest.mark.parametrize(
    ("kind", "under", "wheels", "held", "load"),
    [
        (STOPPED, "lateral", "parallel", "height", [[0, 1, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0]]),
        (STOPPED, "braking", "left", "spring", [[-1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]),
        (STOPPED, "lateral", "parallel", "tyre", [[0, 1, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0]]),
        (STOPPED, "aligning", "parallel", "height", [[0, 0, 0, 0, 0, 0.1]] * 2),
        (FIVE_STOPPED, "braking", "left", "spring", [[-1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0]]),
    ],
)
def test_large_loads_move_it_as_a_beam_on_springs(kind, under, wheels, held, load):
    axle = kind.with_changes({"anti_roll_bar": {"rate_Nm_per_deg": 90.0}})
    bushes = None if kind is FIVE_STOPPED else EVERY_WAY
    most = 6000.0 * (0.1 if under == "aligning" else 1.0)
    on, design = OnSprings(axle, loaded=True), Placed(axle)
    heights = np.array([design.contacts[side][2] for side in SIDES])
    base, road = on.solve(np.zeros((2, 6)), heights, np.zeros(2))
    found = flat(compliance.nonlinear(axle, bushes, under, [most], wheels=wheels, held=held))
    here = found.sel(data_set="equilibrium").isel(load=0)
    ends = None if held == "spring" else heights
    if held == "tyre":  # where tyres are that carry so much; whether they do is seen below
        more = np.array([float(here[f"wheel_load_{side}"]) for side in SIDES]) - road
        assert np.ptp(more) > 1000.0
        ends = heights - more / axle.tyre.rate_N_per_m
    at, carried = on.solve(6000.0 * np.array(load), ends, road)
    for name, value in deflections(at).items():
        key = name.replace("_right", "_change_right") if "right" in name else f"{name}_change"
        assert float(here[key]) == pytest.approx(value - deflections(base)[name], abs=3e-10), name
    for i, side in enumerate(SIDES):
        assert float(here[f"wheel_load_{side}"]) == pytest.approx(carried[i], rel=1e-7)
    assert abs(deflections(at)["axle_lateral"]) + abs(deflections(at)["axle_steer"]) > 1e-3


# -- files, commands and errors -------------------------------------------------------------------


def test_five_rods_move_only_as_their_bushes_give_way(refused):
    """Softer in heave with softer bushes; all else than bushes is refused by name."""
    rates = []
    for times in (1.0, 10.0):
        bushes = every_way({point: times * rate for point, rate in RATES_OF_FIVE.items()})
        found = compliance.elastokinematics(FIVE, bushes, "roll", [0.0, 0.02])
        rates.append(float(found["roll_stiffness_at_contacts"][0, 0]))
    # in roll the fifth rod strains the others
    assert rates[1] > 1.02 * rates[0]
    radial = {"radial_N_per_mm": 900.0}
    refused(
        InputError,
        lambda: flat(characteristics.over(FIVE, "bump")),
        lambda: loads.static(FIVE),
        lambda: checkup(FIVE),
        lambda: RigidAxleModel(FIVE),
        lambda: sheet(FIVE),
        lambda: FIVE.with_changes({"bushings": {"upper_link_axle": radial}}),
        lambda: FIVE.with_changes({"bushings": None}),
    )
    hinged = radial | {"axis": [0.0, 1.0, 0.0]}
    FIVE.with_changes({"bushings": {"upper_link_axle": hinged}})


WRONG = [
    {},
    {"panhard_rod": {"axial_N_per_mm": 900.0}},
    {"panhard_rod_axle": {"axial_N_per_mm": -1.0}},
    {"rack": {"axial_N_per_mm": 900.0}},
    {"panhard_rod_axle": {"tilt_Nm_per_deg": 5.0}},
    {"wheel_center": {"torsion_Nm_per_deg": 5.0}},
]


@pytest.mark.parametrize("bushes", WRONG)
def test_bushes_that_cannot_be_are_refused_by_name(bushes, refused):
    refused(InputError, lambda: compliance.linear(AXLE, bushes, [0.0]))


def test_what_else_cannot_be(refused):
    soft = {"panhard_rod_axle": {"axial_N_per_mm": 900.0}}
    with pytest.raises(PositionError):
        compliance.linear(AXLE, soft, [0.9])
    weak = AXLE.with_changes({"spring.rate_N_per_m": 0.0, "spring.force_at_design_N": None,
                              "spring.free_length_mm": 300.0})  # fmt: skip
    refused(InputError, lambda: compliance.linear(weak, soft, [0.0]))
    with pytest.raises(InputError, match=r"bushings.*panhard"):
        AXLE.with_changes({"bushings": {"panhard_rod": {"axial_N_per_mm": 900.0}}})


def test_the_page_has_what_the_command_prints():
    page = (ROOT / "docs/suspension/compliance.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"```toml\n# axle_bushes\.toml\n(.*?)```", page, flags=re.DOTALL)
    found = flat(compliance.linear(AXLE, tomllib.loads(text)["bushings"], [0.0]))
    (table,) = compliances_of_beam(found, "")
    rows = {"| " + " | ".join(row) + " |" for row in table.rows}
    printed = [line for line in page.splitlines() if re.search(r"\| (kN|100 N m) \|", line)]
    assert len(printed) == 5
    assert set(printed) <= rows


def test_a_file_has_its_bushes(kintrafo, tmp_path, as_stored):
    """In the tables, the sheet and the report, as those that are given in their place."""
    soft = {"panhard_rod_axle": {"radial_N_per_mm": 900.0, "axis": [1.0, 0.0, 0.0]}}
    own = AXLE.with_changes({"bushings": soft})
    one, other = (
        flat(compliance.linear(own, None, [0.0])),
        flat(compliance.linear(AXLE, soft, [0.0])),
    )
    assert one.identical(other)
    text = "[bushings.panhard_rod_axle]\nradial_N_per_mm = 900.0\naxis = [1.0, 0.0, 0.0]\n"
    (tmp_path / "soft.toml").write_text(text, encoding="utf-8")
    soft = ("rigid_axle", "--bushes", "soft.toml")
    code, out, err = kintrafo("compliance", *soft)
    assert code == 0, err
    shift = 1e6 * float(one["axle_lateral_by_lateral_parallel"][0])
    assert re.search(rf"both to the left .*{re.escape(f'{shift:.5g}')}", out), out
    code, out, err = kintrafo("sheet", *soft, "-o", "sheet.csv")
    assert code == 0, err
    assert "of each wheel, the contact stays at its height" in out
    told = (tmp_path / "sheet.csv").read_text(encoding="utf-8")
    assert "axle_lateral_by_lateral_parallel" in told
    for more in (["--over", "roll"], ["--under", "aligning", "--wheels", "opposed"]):
        code, out, err = kintrafo("compliance", *soft, "--nonlinear", *more)
        assert code == 0, err
        assert "axle" in out
    for options in (["compliance", "--rack", "5"], ["compliance", "--nonlinear", "--at", "5"]):
        code, _, err = kintrafo(options[0], *soft, *options[1:])
        assert code != 0
        as_stored(" ".join(err.split()))
