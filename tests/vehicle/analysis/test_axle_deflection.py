"""Whole axles on their bushes by any amount: maximal coordinates, one side, limits."""

from importlib import import_module

import numpy as np
import pytest
from kintrafo import Axle, InputError, Model, PositionError, compliance
from kintrafo.core.validator import Validator
from kintrafo.vehicle.analysis.compliance.on_bushes import on_joints, softs_of
from kintrafo.vehicle.assembly.axle import AxleAssembly
from kintrafo.vehicle.assembly.axle_kinematics import AxleKinematics
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.corner.bushes import mirrored_bushings
from kintrafo.vehicle.report import elastokinematics_chapter
from oracle.bushes import (
    BAR_OF,
    BUSHES_OF,
    RACK,
    SIDES,
    SOFTER,
    STIFFNESS_OF_RACK,
    STRUT,
    TRAILING,
    WISHBONES,
    Energy,
    axle_of,
)
from oracle.constraints import Pose
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation
from support.folders import DATA


def without_bar(car):
    return Axle.from_dict({"axle": "rear", "side": car})


# -- equilibrium --------------------------------------------------------------------------------


def angle_of(half, foot):
    """Return the angle of half a bar by a search for the length of its link."""
    length = np.linalg.norm(half.top - half.foot)

    def too_long(angle):
        top = half.bush + Rotation.from_rotvec(angle * half.axis).apply(half.top - half.bush)
        return float(np.linalg.norm(top - foot) - length)

    return float(brentq(too_long, -0.8, 0.8, xtol=1e-15, rtol=1e-15))


class Whole:
    """The potential of both sides, a bar and a rack, whose parts are where an equilibrium has them.

    Both sides have a body for the rack; these are tied together.
    """

    def __init__(self, axle, car, suspension, state):
        self.axle, self.rack_axis = axle, np.array(car.rack.axis) / np.linalg.norm(car.rack.axis)
        bushes = {"left": mirrored_bushings(SOFTER[car]), "right": SOFTER[car]}
        self.energies = {s: Energy(axle.sides[s], bushes[s], car) for s in SIDES}
        self.begin = {"left": 0, "right": self.energies["left"].size}
        self.size = sum(energy.size for energy in self.energies.values())
        moved = state.places.centers[0] - suspension.start.places.centers[0]
        for which, energy in enumerate(self.energies.values()):
            position, rotation = energy.pose.position.copy(), energy.pose.rotation.copy()
            for i, body in enumerate(energy.bodies[1:]):
                place = suspension._connections.index(which, body)
                position[i] += moved[place]
                rotation[i] = state.places.turned[0, place] @ rotation[i]
            energy.pose = Pose(position, rotation)
        self.shift = float(moved[suspension._connections.index(0, "rack")] @ self.rack_axis)

    def twist(self):
        found = []
        for side, energy in self.energies.items():
            half = self.axle.halves[side]
            i = energy.index(half.body)
            arm = half.foot - energy.centres[i]
            at = energy.pose.position[i - 1] + energy.pose.rotation[i - 1] @ arm
            found.append(angle_of(half, at))
        return found[0] - found[1]

    def torque(self):
        return float(self.axle.bar.rate() * (self.twist() - self.axle.bar.free_twist()))

    def slopes(self, forces, road):
        """Return the derivatives by all displacements and rotations, those of the bar too."""
        own = zip(SIDES, self.energies.values(), road, strict=True)
        found = np.concatenate([e.slopes(np.array(forces[s]), float(up)) for s, e, up in own])
        torque = self.torque()
        for side, energy in self.energies.items():
            first = 6 * (energy.index(self.axle.halves[side].body) - 1)
            for component in range(6):
                turned = [self.twist_after(side, first // 6, component, h) for h in (1e-6, -1e-6)]
                by = (turned[0] - turned[1]) / 2e-6
                found[self.begin[side] + first + component] += torque * by
        rack = self.of_rack("left")
        found[rack : rack + 3] += STIFFNESS_OF_RACK * self.shift * self.rack_axis
        return found

    def twist_after(self, side, body, component, size):
        energy = self.energies[side]
        at = energy.pose
        position, rotation = at.position.copy(), at.rotation.copy()
        if component < 3:
            position[body, component] += size
        else:
            turn = Rotation.from_rotvec(size * np.eye(3)[component - 3])
            rotation[body] = turn.as_matrix() @ rotation[body]
        energy.pose = Pose(position, rotation)
        found = self.twist()
        energy.pose = at
        return found

    def of_rack(self, side):
        return self.begin[side] + 6 * (self.energies[side].index("rack") - 1)

    def held(self):
        """Return what all joints hold, the guide of the rack among them."""
        left, right = self.of_rack("left"), self.of_rack("right")
        tied, guide = np.zeros((6, self.size)), np.zeros((5, self.size))
        tied[:, left : left + 6], tied[:, right : right + 6] = np.eye(6), -np.eye(6)
        guide[:2, left : left + 3] = np.linalg.svd(self.rack_axis[None])[2][1:]
        guide[2:, left + 3 : left + 6] = np.eye(3)
        found = [tied, guide]
        for side, energy in self.energies.items():
            _, own, *_ = energy.parts(energy.bushes)
            # there the rack is held by six rows
            first = 6 * (energy.index("rack") - 1)
            fixed = np.eye(energy.size)[first : first + 6]
            rigid = [rows for rows in own if not np.array_equal(rows, fixed)]
            assert len(rigid) == len(own) - 1
            for name, one, other in energy.soft:
                if name not in energy.bushes:
                    gap = energy.placed(name, other) - energy.placed(name, one)
                    assert np.abs(gap).max() < 1e-10, name
                    rigid.append(energy.point(name, one, other))
            rows = np.vstack(rigid)
            found.append(np.zeros((len(rows), self.size)))
            found[-1][:, self.begin[side] : self.begin[side] + energy.size] = rows
        return np.vstack(found)


@pytest.mark.parametrize("car", [STRUT, WISHBONES], ids=lambda car: car.suspension)
def test_nothing_is_left_of_the_potential(car):
    """Slopes of the energy of both sides, the bar and the rack are what the joints carry.

    As `test_deflection` has it for one side: to 1e-2 N of some thousand.
    """
    axle = axle_of(car, free_twist_deg=3.0)
    with Validator("test") as given:
        assembly = AxleAssembly(axle)
        softs = softs_of(given, assembly, SOFTER[car] | RACK, "relaxed")
    poses = assembly.poses(assembly.at_travel(np.zeros(1)))
    suspension = on_joints(assembly, poses, softs)
    forces = {"left": [-3000.0, 500.0, 0.0], "right": [1500.0, 2500.0, 300.0]}
    load = np.array([[[0.0] * 6 + forces[side] for side in SIDES]])
    base = suspension.under(0.0 * load, "height", suspension.start)
    state = suspension.under(load, "height", base)
    assert base.found.all()
    assert state.found.all()
    whole = Whole(axle, car, suspension, state)
    assert abs(whole.torque()) > 30.0
    assert suspension.torque_of_bar(state)[0] == pytest.approx(whole.torque(), rel=1e-9)
    assert abs(whole.shift) > 1e-3
    slopes, rows = whole.slopes(forces, state.road[0]), whole.held()
    carried = np.linalg.lstsq(rows.T, slopes, rcond=1e-12)[0]
    moved = state.places.centers - suspension.start.places.centers
    assert np.abs(moved).max() > 0.008
    assert np.abs(slopes).max() > 1e3
    assert np.abs(slopes - rows.T @ carried).max() < 1e-2


# -- limits ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("held", ["height", "tyre", "spring", "locked"])
def test_wheels_that_share_nothing_are_those_of_one_side(held):
    """No bar, a rigid rack: each side by itself, its image among them, to rounding."""
    parts = 0.4, -1.0
    for under in ("lateral", "braking"):
        both = flat(
            compliance.nonlinear(
                without_bar(WISHBONES),
                BUSHES_OF[WISHBONES],
                under,
                [3000.0],
                wheels=parts,
                held=held,
            )
        )
        for part, side in zip(parts, SIDES, strict=True):
            alone = flat(
                compliance.nonlinear(
                    Model(WISHBONES), BUSHES_OF[WISHBONES], under, [3000.0 * part], held=held
                )
            )
            for name in ("toe_change", "camber_change", "displacement"):
                # loads of 1e4 N in the last step of Newton's method: 1e-11 m or rad
                np.testing.assert_allclose(
                    both[f"{name}_{side}"], alone[name], rtol=1e-8, atol=1e-11
                )
            np.testing.assert_allclose(both[f"wheel_load_{side}"], alone["wheel_load"], atol=1e-3)


@pytest.mark.parametrize("car", [WISHBONES, TRAILING], ids=lambda car: car.suspension)
def test_curves_of_wheels_that_share_nothing_are_those_of_one_side(car):
    travels = np.array([-0.04, 0.0, 0.03])
    both = flat(compliance.elastokinematics(without_bar(car), BUSHES_OF[car], "left", travels))
    alone = flat(compliance.elastokinematics(Model(car), BUSHES_OF[car], along=travels))
    for name in ("toe", "camber", "half_track_change", "wheelbase_change"):
        np.testing.assert_allclose(both[f"{name}_left"], alone[name], rtol=0.0, atol=1e-10)
        still = both[f"{name}_right"] - alone[name].sel(wheel_travel=0.0)
        np.testing.assert_allclose(still, 0.0, atol=1e-10)
    for name in ("wheel_load", "contact_rate"):
        np.testing.assert_allclose(both[f"{name}_left"], alone[name], rtol=1e-7)


def test_rates_are_slopes_of_the_loads():
    """Wheel rates and the stiffness in roll against differences of what both wheels carry."""
    # the stop begins at design, where rates would jump
    car = WISHBONES.with_changes({"bump_stop": None})
    bar = {"anti_roll_bar": BAR_OF[WISHBONES]}
    axle = Axle.from_dict({"axle": "front", "side": car} | bar)
    soft = BUSHES_OF[WISHBONES] | RACK
    step = 1e-4
    travels = step * np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
    # differences of fourth order over 0.1 mm: forces are good to 1e-5 N
    by = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * step)
    stiffness = np.zeros((2, 2, 2))
    for column, moved in enumerate(SIDES):
        found = flat(compliance.elastokinematics(axle, soft, moved, travels))
        contact = AxleKinematics.at(
            axle, *(travels if side == moved else 0.0 * travels for side in SIDES), 0.0 * travels
        ).corners[moved]
        center, axis, radius = contact.center, contact.axis, contact.vehicle.tyre_radius
        rise = by @ (center[:, 2] - radius * np.sqrt(1.0 - axis[:, 2] ** 2))
        for row, side in enumerate(SIDES):
            stiffness[:, row, column] = found[f"wheel_load_{side}"].values @ by / rise
        for which in range(2):
            own = float(found[f"contact_rate_{moved}"][which, 2])
            assert own == pytest.approx(stiffness[which, column, column], rel=1e-6)
    np.testing.assert_allclose(stiffness[:, 0, 1], stiffness[:, 1, 0], rtol=1e-6)
    assert (stiffness[:, 0, 1] < -1e3).all()  # the bar
    roll = compliance.elastokinematics(axle, soft, "roll", [0.0])
    pair = AxleKinematics.at(axle, 0.0, 0.0, 0.0)
    y = np.array([_contact(pair.corners[side])[1] for side in SIDES])
    # springs are relaxed, so that on the bushes the contacts are where they are with rigid joints
    expected = np.einsum("i,kij,j->k", y, stiffness, y)
    np.testing.assert_allclose(roll["roll_stiffness_at_contacts"][:, 0], expected, rtol=1e-6)


def _contact(corner):
    """Return the lowest point of a wheel by hand."""
    axis, up = corner.axis, np.array([0.0, 0.0, 1.0])
    across = up - axis[2] * axis
    return corner.center - corner.vehicle.tyre_radius * across / np.linalg.norm(across)


# -- refusals -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "given",
    [
        {"under": "sideways"},
        {"wheels": "both"},
        {"wheels": [1.0, 2.0]},
        {"wheels": [1.0]},
        {"amounts": [1e9]},
        {"bushings": {}},
        {"bushings": None},
    ],
)
def test_what_cannot_be_is_refused(given, refused):
    usual = {"bushings": RACK, "under": "lateral", "amounts": [100.0]}
    refused(InputError, lambda: compliance.nonlinear(axle_of(STRUT), **usual | given))


def test_motions_that_cannot_be_are_refused(refused):
    for motion, along in (("jump", None), ("steer", None), ("roll", [2.0])):
        with refused(InputError):
            compliance.elastokinematics(without_bar(TRAILING), BUSHES_OF[TRAILING], motion, along)
    for wrong in ({"motion": "roll", "travel": 0.01}, {"motion": "steer", "rack_position": 0.01}):
        with refused(InputError):
            compliance.elastokinematics(axle_of(STRUT), RACK, **wrong)
    weak = {"arm_inner": {"axial_N_per_mm": 1.0, "radial_N_per_mm": 1.0}}
    heavy = Axle.from_dict(
        {"axle": "rear", "side": TRAILING.with_changes({"spring.force_at_design_N": 4000.0})}
    )
    refused(
        PositionError,
        lambda: compliance.elastokinematics(
            heavy, weak, "roll", np.deg2rad([1.5]), hardpoints="relaxed"
        ),
    )


def test_loads_that_nothing_holds_are_refused(monkeypatch, refused):
    module = import_module("kintrafo.vehicle.analysis.compliance.under_load")
    monkeypatch.setattr(module, "_LEAST_STEP", 0.3)  # a short search for the greatest one
    weak = {"arm_rear": {"axial_N_per_mm": 1.0, "radial_N_per_mm": 1.0}}
    refused(PositionError, lambda: compliance.nonlinear(axle_of(STRUT), weak, "braking", [9e5]))


# -- tables and messages --------------------------------------------------------------------------


@pytest.mark.usefixtures("rough_drawings")
def test_tables_have_each_wheel_and_both(refused):
    found = compliance.elastokinematics(axle_of(STRUT), RACK, "roll", [0.0, 0.02])
    chapter = elastokinematics_chapter(found)
    left, right, both = chapter.tables
    assert [table.title for table in (left, right, both)] == [
        "Over roll angle, left wheel", "Over roll angle, right wheel", "Over roll angle, both",
    ]  # fmt: skip
    toe = np.rad2deg(found["toe"].sel(wheel="right").values[1, 1])
    assert right.rows[1][2] == f"{toe:.4f}"
    stiffness = found["roll_stiffness_at_contacts"].values[0, 1] * np.pi / 180.0
    assert both.rows[1][1] == f"{stiffness:.4f}"
    words = "Curves over roll angle with rigid joints and on the bushes"
    assert [picture.words for picture in chapter.pictures] == [f"{words}, {i} of 2" for i in (1, 2)]
    refused(InputError, elastokinematics_chapter)


def test_options_that_do_not_go_together_are_refused(ends):
    for line in (
        "reference_car --over roll",
        "reference_axle --over travel",
        "reference_axle --wheels left",
        "reference_axle --over roll --bump 10",
        "reference_axle --under braking --over bump",
        "reference_axle --over roll --at 5",
    ):
        file, *options = line.split()
        bushes = str(DATA / "studies/bushes.toml")
        ends(2, "compliance", file, "--bushes", bushes, "--nonlinear", *options)
