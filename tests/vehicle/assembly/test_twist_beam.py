"""Twist-beam axles, against formulations that share nothing with the equations.

`test_mechanisms` compares the equations with maximal coordinates and watches the energy, like those
of every mechanism. Here positions are followed from what holds the two halves of the axle at every
instant, what roll does first is compared with the drawing of textbooks, stiffness with the energy
of springs and beam, and compliance with a frame of two rigid bodies on springs.
"""

from typing import Any

import numpy as np
import pytest
from kintrafo import (
    InputError,
    PositionError,
    characteristics,
    compliance,
    equilibrium,
    load,
    loads,
    model_of,
)
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.of import assembly_of
from kintrafo.vehicle.assembly.rig import RigPosition
from kintrafo.vehicle.assembly.twist_beam import TwistBeamParts
from listed_loads import wrench
from oracle.constraints import skew
from scipy.integrate import solve_ivp

Array = np.ndarray
AXLE = load("twist_beam")
MODEL = model_of(AXLE)
UPRIGHT = AXLE.with_changes({"wheel.camber_deg": 0.0, "wheel.toe_deg": 0.0})
SIDES = {"left": 1.0, "right": -1.0}
PIVOT, WHEEL = (AXLE.hardpoints.metres(name) for name in ("pivot", "wheel_center"))
SHEAR = AXLE.shear_center
MIRROR = np.array([1.0, -1.0, 1.0])
RATE = np.degrees(AXLE.beam.rate_Nm_per_deg)
BUSH = {"axial_N_per_mm": 1200.0, "radial_N_per_mm": 4000.0}
K_AXIAL, K_RADIAL = 1.2e6, 4e6


def of(side: str, point: Array) -> Array:
    """Return the image of a point of the right side."""
    return point if side == "right" else point * MIRROR


# -- positions ------------------------------------------------------------------------------------


def turning(turned: dict[str, Array], rises: Array) -> Array:
    """Return the angular velocities of both halves at rates of both wheels' heights, (2, 3).

    Their pivots are still. In the middle of the beam they have one velocity, and turn against each
    other about the direction of the pivots alone. One row repeats what others say.
    """
    rows, right = [], []
    arms = {s: turned[s] @ (SHEAR - of(s, PIVOT)) for s in SIDES}
    rows.append(np.hstack([-skew(arms["left"]), skew(arms["right"])]))
    against = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    rows.append(np.hstack([against, -against]))
    right += [0.0] * 5
    for i, side in enumerate(SIDES):
        row = np.zeros((1, 6))
        wheel = turned[side] @ (of(side, WHEEL) - of(side, PIVOT))
        row[0, 3 * i : 3 * i + 3] = -skew(wheel)[2]
        rows.append(row)
        right.append(rises[i])
    found, *_ = np.linalg.lstsq(np.vstack(rows), np.array(right), rcond=None)
    return found.reshape(2, 3)


def followed(left: float, right: float) -> dict[str, Array]:
    """Return the rotations of both halves at heights of the wheels, from design on."""

    def rates(_: float, state: Array) -> Array:
        frames = state.reshape(2, 3, 3)
        turned = dict(zip(SIDES, frames, strict=True))
        omega = turning(turned, np.array([left, right]))
        return np.concatenate([(skew(w) @ r).ravel() for w, r in zip(omega, frames, strict=True)])

    start = np.concatenate([np.eye(3).ravel()] * 2)
    found = solve_ivp(rates, (0.0, 1.0), start, "DOP853", rtol=1e-12, atol=1e-13)
    return dict(zip(SIDES, found.y[:, -1].reshape(2, 3, 3), strict=True))


@pytest.mark.parametrize(
    ("left", "right"), [(0.06, 0.06), (0.07, -0.05), (0.0, 0.08), (-0.1, 0.03)]
)
def test_positions_are_those_that_the_halves_are_led_to(left: float, right: float) -> None:
    poses = TwistBeamParts.of(MODEL, MODEL.states_at(np.array([left]), np.array([right])))
    for side, turned in followed(left, right).items():
        # a hundred steps with a tolerance of 1e-12
        np.testing.assert_allclose(poses.turned[f"arm_{side}"][0], turned, rtol=0.0, atol=1e-9)
        wheel = of(side, PIVOT) + turned @ (of(side, WHEEL) - of(side, PIVOT))
        np.testing.assert_allclose(poses.points[f"wheel_center_{side}"][0], wheel, atol=1e-9)
    z = [poses.points[f"wheel_center_{side}"][0, 2] - WHEEL[2] for side in SIDES]
    np.testing.assert_allclose(z, [left, right], rtol=0.0, atol=1e-14)


def test_parallel_travel_is_that_of_trailing_arms() -> None:
    found = characteristics.over(UPRIGHT, "bump", np.array([-0.05, 0.0, 0.07]))
    for name in ("camber", "toe", "half_track_change"):
        assert np.abs(found[name].values).max() < 1e-15
    assert np.abs(found["bar_twist"].values).max() < 1e-15
    lever = np.hypot(*(WHEEL - PIVOT)[[0, 2]])
    angles = np.arcsin((found.wheel_travel + WHEEL[2] - PIVOT[2]) / lever)
    back = PIVOT[0] - WHEEL[0] - lever * np.cos(angles)
    # sums over a metre
    np.testing.assert_allclose(found["wheelbase_change"].sel(wheel="left"), back, atol=1e-14)


def test_roll_is_the_angle_of_the_line_through_the_wheels() -> None:
    angles = np.radians([-4.0, 1.0, 3.0])
    states = MODEL.states_at(
        *(assembly_of(AXLE).position("roll", angles).travels[s] for s in SIDES)
    )
    centers = TwistBeamParts.of(MODEL, states).points
    line = centers["wheel_center_left"] - centers["wheel_center_right"]
    found = -np.arctan2(line[:, 2], np.hypot(line[:, 0], line[:, 1]))
    np.testing.assert_allclose(found, angles, rtol=0.0, atol=1e-14)


def test_positions_out_of_reach_are_refused() -> None:
    with pytest.raises(PositionError, match="45 deg"):
        MODEL.states_at(0.5, -0.5)


# -- motion in roll -------------------------------------------------------------------------------


def drawn(side: str = "left") -> dict[str, float]:
    """Return what a drawing of the axle says, without camber and toe.

    In roll a wheel turns about the line from its pivot to the shear centre. Where that passes the
    vertical plane across the vehicle through the wheel is its instant centre there; the roll centre
    is on the line from that through the contact, in the centre plane (Reimpell, Stoll, Betzler).
    """
    axis = SHEAR - of(side, PIVOT)
    contact = of(side, WHEEL) * [1.0, 1.0, 0.0]
    pole = of(side, PIVOT) + axis * (contact[0] - of(side, PIVOT)[0]) / axis[0]
    turn = skew(axis) @ (of(side, WHEEL) - of(side, PIVOT))
    # of the body by the turn of the wheel about the axis: the left wheel up is the left side down
    roll = -SIDES[side] * turn[2] / abs(WHEEL[1])
    return {
        "roll_center_height": pole[2] * contact[1] / (contact[1] - pole[1]),
        "roll_steer": axis[2] / roll,
        # camber is positive with the top outboard, a turn about x with the top to the right
        "roll_camber": -SIDES[side] * axis[0] / roll,
    }


def test_first_order_in_roll_is_that_of_the_drawing() -> None:
    found = characteristics.over(UPRIGHT, "roll", np.array([0.0])).sel(wheel="left")
    for name, value in drawn().items():
        # the equations of a tree at design: rounding
        assert found[name].item() == pytest.approx(value, rel=1e-12), name


def test_a_beam_that_goes_back_to_the_wheels_makes_a_rigid_axle_of_it() -> None:
    """Between a trailing arm and a rigid axle, whose wheels keep camber to the road in roll."""
    camber = []
    for x in (400.0, 300.0, 200.0, 100.0, 0.0):
        changes = {"beam.shear_center_x_mm": x, "beam.shear_center_z_mm": 300.0}
        found = characteristics.over(UPRIGHT.with_changes(changes), "roll", np.array([0.0]))
        camber.append(found["roll_camber"].sel(wheel="left").item())
    assert (np.diff(camber) > 0.0).all()
    assert camber[0] < 0.1
    assert camber[-1] == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(("rise", "toe_in"), [(40.0, True), (-40.0, False)])
def test_a_shear_centre_above_the_pivots_turns_the_bumped_wheel_in(
    rise: float, toe_in: bool
) -> None:
    """As V-sections that are open downward do it on cars."""
    axle = UPRIGHT.with_changes({"beam.shear_center_z_mm": 315.0 + rise})
    found = characteristics.over(axle, "roll", np.radians([2.0]))
    # the right side of the body is down, and the right wheel up
    assert (found["toe"].sel(wheel="right").item() > 0.0) == toe_in
    assert (found["roll_steer"].sel(wheel="right").item() > 0.0) == toe_in


# -- springs --------------------------------------------------------------------------------------


def energy(left: float, right: float) -> float:
    """Return the energy of springs and beam, from rotations that are followed."""
    turned = followed(left, right)
    total = 0.0
    points = {name: AXLE.hardpoints.metres(name) for name in ("spring_top", "spring_seat")}
    for side in SIDES:
        top, seat, pivot = (of(side, p) for p in (*points.values(), PIVOT))
        length = np.linalg.norm(top - pivot - turned[side] @ (seat - pivot))
        free = MODEL.parameters["spring_free_length"]
        total += 0.5 * MODEL.parameters["spring_rate"] * (length - free) ** 2
    return total


def twist(left: float, right: float) -> float:
    """Return the twist of the beam, the sum of the halves' turns about the pivots' direction."""

    def rates(_: float, state: Array) -> Array:
        frames = state[:-1].reshape(2, 3, 3)
        omega = turning(dict(zip(SIDES, frames, strict=True)), np.array([left, right]))
        moved = [(skew(w) @ r).ravel() for w, r in zip(omega, frames, strict=True)]
        return np.concatenate([*moved, [omega[0, 1] - omega[1, 1]]])

    start = np.concatenate([*[np.eye(3).ravel()] * 2, [0.0]])
    return float(solve_ivp(rates, (0.0, 1.0), start, "DOP853", rtol=1e-12, atol=1e-13).y[-1, -1])


def test_forces_and_rates_are_slopes_of_the_energy() -> None:
    """By differences of fourth order: an error of h^4, and of the tolerance over h or h^2."""
    at, step = np.array([0.03, -0.02]), 4e-3
    weights = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}

    def whole(place: Array) -> float:
        return energy(*place) + 0.5 * RATE * twist(*place) ** 2

    kinematics = _at(at)
    rates = kinematics.springs[0] + kinematics.bar[0]
    np.testing.assert_allclose(kinematics.parts.twist[0], twist(*at), rtol=1e-9)
    for i, side in enumerate(SIDES):
        unit = np.eye(2)[i]
        slope = sum(w * whole(at + n * step * unit) for n, w in weights.items()) / step
        assert kinematics.wheel_force(side)[0] == pytest.approx(slope, rel=1e-6)
    for i in range(2):
        change = [
            sum(
                w * _force(at + n * step * np.eye(2)[i], side) for n, w in weights.items()
            ) / step
            for side in SIDES
        ]  # fmt: skip
        np.testing.assert_allclose(rates[:, i], change, rtol=1e-6, atol=1e-6 * np.abs(rates).max())


def _at(heights: Array) -> Any:
    position = RigPosition({"left": heights[:1], "right": heights[1:]}, np.zeros(()))
    return assembly_of(AXLE).kinematics(position)


def _force(heights: Array, side: str) -> float:
    return float(_at(heights).wheel_force(side)[0])


def test_the_part_of_the_beam_in_roll_stiffness_is_a_formula() -> None:
    """Torque by twist: twice the half distance of pivots over that of the shear centre, squared."""
    found = characteristics.over(UPRIGHT, "roll", np.array([0.0]))
    axis = SHEAR - PIVOT
    rise = (skew(axis) @ (WHEEL - PIVOT))[2]
    by_roll = 2.0 * PIVOT[1] / rise * WHEEL[1]
    assert found["roll_stiffness_bar"].item() == pytest.approx(RATE * by_roll**2, rel=1e-12)
    whole = found["roll_stiffness_bar"] + found["roll_stiffness_springs"]
    assert found["roll_stiffness"].item() == pytest.approx(whole.item(), rel=1e-12)


def test_it_rests_at_design() -> None:
    assert abs(equilibrium(MODEL)[0]) < 5e-3


# -- loads and bushes -----------------------------------------------------------------------------


def test_loads_of_a_cornering_axle_by_hand() -> None:
    """Lateral forces behind the pivots are held by a couple of forces along the vehicle."""
    case = {"travel_mm": 0.0, "contact_N": [0.0, 2000.0, 0.0]}
    found = loads.static(UPRIGHT, {"left_turn": case})
    on_arms = {side: found.isel(case=0).where(found["part"] == f"arm_{side}", drop=True)
               for side in SIDES}  # fmt: skip
    at_pivot = {
        side: own.isel(load=own["point"].values == f"pivot_{side}")["force"].values[0]
        for side, own in on_arms.items()
    }
    # how both share the force along their axis is statically indeterminate
    assert sum(force[1] for force in at_pivot.values()) == pytest.approx(-4000.0, rel=1e-9)
    couple = 0.5 * (at_pivot["left"][0] - at_pivot["right"][0])
    assert couple == pytest.approx(2000.0 * (PIVOT[0] - WHEEL[0]) / PIVOT[1], rel=1e-9)
    for side in SIDES:
        balance = wrench(found.isel(case=0, load=found["part"].values == f"arm_{side}"))
        # forces of 4 kN and arms of a metre
        np.testing.assert_allclose(balance, 0.0, atol=1e-8)


class Frame:
    """Two rigid halves on bushes and springs, with contacts at their heights: linear, at design.

    The halves keep together at the shear centre in all but the twist, against which the beam has
    its rate. Unknown are six motions of each half, and what holds them.
    """

    def __init__(self) -> None:
        self.stiffness = np.zeros((12, 12))
        pivot = np.diag([K_RADIAL, K_AXIAL, K_RADIAL])
        for i, side in enumerate(SIDES):
            rows = self.at(i, of(side, PIVOT))
            self.stiffness += rows.T @ pivot @ rows
        against = np.hstack([np.zeros(3), [0.0, 1.0, 0.0], np.zeros(3), [0.0, -1.0, 0.0]])
        self.stiffness += RATE * np.outer(against, against)
        together = self.at(0, SHEAR) - self.at(1, SHEAR)
        turned = np.zeros((2, 12))
        turned[0, 3], turned[0, 9], turned[1, 5], turned[1, 11] = 1.0, -1.0, 1.0, -1.0
        held = [together, turned]
        for i, side in enumerate(SIDES):
            held.append(self.at(i, of(side, WHEEL) * [1.0, 1.0, 0.0])[2:])
        self.held = np.vstack(held)
        self.springs = np.zeros((12, 12))
        for i, side in enumerate(SIDES):
            top, seat = (of(side, AXLE.hardpoints.metres(f"spring_{e}")) for e in ("top", "seat"))
            way = (top - seat) / np.linalg.norm(top - seat)
            row = way @ self.at(i, seat)
            self.springs += MODEL.parameters["spring_rate"] * np.outer(row, row)

    @staticmethod
    def at(half: int, point: Array) -> Array:
        """Return how a point moves by the motions of a half, which are about the origin."""
        rows = np.zeros((3, 12))
        rows[:, 6 * half : 6 * half + 3], rows[:, 6 * half + 3 : 6 * half + 6] = (
            np.eye(3),
            -skew(point),
        )
        return rows

    def under(self, forces: dict[str, Array]) -> Array:
        """Return the motions of both halves under forces at the contacts, (2, 6)."""
        load = sum(
            self.at(i, of(side, WHEEL) * [1.0, 1.0, 0.0]).T @ forces[side]
            for i, side in enumerate(SIDES)
        )
        size = 12 + len(self.held)
        matrix = np.zeros((size, size))
        matrix[:12, :12] = self.stiffness + self.springs
        matrix[:12, 12:], matrix[12:, :12] = self.held.T, self.held
        right = np.concatenate([load, np.zeros(len(self.held))])
        return np.linalg.solve(matrix, right)[:12].reshape(2, 6)


@pytest.mark.parametrize("how", ["parallel", "opposed"])
def test_compliance_is_that_of_a_frame(how: str) -> None:
    light = UPRIGHT.with_changes(
        {"gravity.acceleration_m_per_s2": 0.0, "spring.force_at_design_N": 1e-6}
    )
    found = flat(compliance.linear(light, {"pivot": BUSH}, [0.0]))
    senses = {"left": 1.0 if how == "parallel" else -1.0, "right": 1.0}
    moved = Frame().under({s: np.array([0.0, senses[s], 0.0]) for s in SIDES})
    for i, side in enumerate(SIDES):
        # toe is positive with the front inboard, camber with the top outboard
        values = {"toe": -SIDES[side] * moved[i, 5], "camber": -SIDES[side] * moved[i, 3]}
        for name, value in values.items():
            data = found[f"{name}_by_lateral_{how}_{side}"].item()
            # sums over some metres and 1e6 N/m; what nothing moves is their rounding
            assert data == pytest.approx(value, rel=1e-8, abs=1e-14), (name, side)


def test_lateral_forces_turn_it_on_its_bushes_as_textbooks_say() -> None:
    """Both wheels steer with the force, which is oversteer: F L / (2 b^2 k), two forces F."""
    soft = {"pivot": {"axial_N_per_mm": 1e9, "radial_N_per_mm": 4000.0}}
    found = compliance.linear(UPRIGHT, soft, [0.0], held="height")
    toe = found["toe_by_lateral_parallel"].isel(wheel_travel=0)
    steer = -toe.values * np.array([1.0, -1.0])
    expected = (PIVOT[0] - WHEEL[0]) / (PIVOT[1] ** 2 * K_RADIAL)
    # the drawing leaves out what the beam does as the pivots move up and down: a few percent
    np.testing.assert_allclose(np.abs(steer), expected, rtol=0.1)
    assert steer[0] == pytest.approx(steer[1], rel=1e-9)


def test_stiff_bushes_leave_the_motion_of_rigid_joints() -> None:
    stiff = {"pivot": {"axial_N_per_mm": 1e8, "radial_N_per_mm": 1e8}}
    for motion, at in (("bump", [-0.03, 0.05]), ("roll", np.radians([2.0]))):
        found = compliance.elastokinematics(AXLE, stiff, motion, at)
        soft = (
            found.sel(data_set="on bushes")
            if "on bushes" in found.data_set
            else found.isel(data_set=-1)
        )
        rigid = found.isel(data_set=0)
        for name in ("toe", "camber"):
            np.testing.assert_allclose(soft[name], rigid[name], rtol=0.0, atol=1e-6)


# -- the file -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes",
    [
        {"beam.rate_Nm_per_deg": -1.0},
        {"hardpoints.pivot": [420.0, 560.0, 315.0]},
        {"hardpoints.pivot": [0.0, -560.0, 300.0]},
        {"beam.shear_center_x_mm": 1500.0, "beam.shear_center_z_mm": 330.0},
        {"beam.colour": 1.0},
    ],
)
def test_axles_that_cannot_be_are_refused(changes: dict[str, Any], refused: Any) -> None:
    refused(InputError, lambda: AXLE.with_changes(changes))


def test_without_a_rate_nothing_couples_the_wheels() -> None:
    free = AXLE.with_changes({"beam.rate_Nm_per_deg": 0.0})
    found = characteristics.over(free, "roll", np.radians([-2.0, 2.0]))
    assert np.abs(found["bar_torque"].values).max() == 0.0
    assert compliance.linear(free, {"pivot": BUSH}, [0.0])["toe_by_lateral_parallel"].size == 2
    assert "bar_torque" not in loads.static(free, {"held": {"travel_mm": 0.0}})
