"""Twist-beam axles, against formulations that share nothing with the equations.

`test_mechanisms` compares the equations with maximal coordinates and watches the energy, like those
of every mechanism. Here positions are followed from what holds the two halves of the axle at every
instant, what roll does first is compared with the drawing of textbooks, stiffness with the energy
of springs and beam, and compliance with a frame of two rigid bodies on springs.
"""

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
from oracle.constraints import skew
from scipy.integrate import solve_ivp

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


def of(side, point):
    """Return the image of a point of the right side."""
    return point if side == "right" else point * MIRROR


# -- positions ------------------------------------------------------------------------------------


def turning(turned, rises):
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


def followed(left, right):
    """Return the rotations of both halves at heights of the wheels, from design on."""

    def rates(_, state):
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
def test_positions_are_those_that_the_halves_are_led_to(left, right):
    poses = TwistBeamParts.of(MODEL, MODEL.states_at(np.array([left]), np.array([right])))
    for side, turned in followed(left, right).items():
        # a hundred steps with a tolerance of 1e-12
        np.testing.assert_allclose(poses.turned[f"arm_{side}"][0], turned, rtol=0.0, atol=1e-9)
        wheel = of(side, PIVOT) + turned @ (of(side, WHEEL) - of(side, PIVOT))
        np.testing.assert_allclose(poses.points[f"wheel_center_{side}"][0], wheel, atol=1e-9)
    z = [poses.points[f"wheel_center_{side}"][0, 2] - WHEEL[2] for side in SIDES]
    np.testing.assert_allclose(z, [left, right], rtol=0.0, atol=1e-14)


def test_roll_is_the_angle_of_the_line_through_the_wheels():
    angles = np.radians([-4.0, 1.0, 3.0])
    states = MODEL.states_at(
        *(assembly_of(AXLE).position("roll", angles).travels[s] for s in SIDES)
    )
    centers = TwistBeamParts.of(MODEL, states).points
    line = centers["wheel_center_left"] - centers["wheel_center_right"]
    found = -np.arctan2(line[:, 2], np.hypot(line[:, 0], line[:, 1]))
    np.testing.assert_allclose(found, angles, rtol=0.0, atol=1e-14)


def test_positions_out_of_reach_are_refused():
    with pytest.raises(PositionError, match="45 deg"):
        MODEL.states_at(0.5, -0.5)


# -- motion in roll -------------------------------------------------------------------------------


def drawn(side="left"):
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


def test_first_order_in_roll_is_that_of_the_drawing():
    found = characteristics.over(UPRIGHT, "roll", np.array([0.0])).sel(wheel="left")
    for name, value in drawn().items():
        # the equations of a tree at design: rounding
        assert found[name].item() == pytest.approx(value, rel=1e-12), name


# -- springs --------------------------------------------------------------------------------------


def energy(left, right):
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


def twist(left, right):
    """Return the twist of the beam, the sum of the halves' turns about the pivots' direction."""

    def rates(_, state):
        frames = state[:-1].reshape(2, 3, 3)
        omega = turning(dict(zip(SIDES, frames, strict=True)), np.array([left, right]))
        moved = [(skew(w) @ r).ravel() for w, r in zip(omega, frames, strict=True)]
        return np.concatenate([*moved, [omega[0, 1] - omega[1, 1]]])

    start = np.concatenate([*[np.eye(3).ravel()] * 2, [0.0]])
    return float(solve_ivp(rates, (0.0, 1.0), start, "DOP853", rtol=1e-12, atol=1e-13).y[-1, -1])


def test_forces_and_rates_are_slopes_of_the_energy():
    """By differences of fourth order: an error of h^4, and of the tolerance over h or h^2."""
    at, step = np.array([0.03, -0.02]), 4e-3
    weights = {-2: 1 / 12, -1: -8 / 12, 1: 8 / 12, 2: -1 / 12}

    def whole(place):
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


def _at(heights):
    position = RigPosition({"left": heights[:1], "right": heights[1:]}, np.zeros(()))
    return assembly_of(AXLE).kinematics(position)


def _force(heights, side):
    return float(_at(heights).wheel_force(side)[0])


def test_the_beam_resists_a_difference_of_the_wheel_loads():
    """Twist by travel: twice the half distance of pivots over the rise of a wheel by its arm."""
    rise = (skew(SHEAR - PIVOT) @ (WHEEL - PIVOT))[2]
    by_travel = 2.0 * PIVOT[1] / rise  # up on the left and down on the right
    more, rates = 10.0, []
    for part in (0.0, 1.0):
        axle = UPRIGHT.with_changes({"beam.rate_Nm_per_deg": part * AXLE.beam.rate_Nm_per_deg})
        even = float(loads.static(axle, {"held": {"travel_mm": 0.0}})["wheel_load"][0, 0])
        case = {s: {"contact_N": [0.0, 0.0, even + sign * more]} for s, sign in SIDES.items()}
        travel = loads.static(axle, {"uneven": case})["travel"].sel(wheel=[*SIDES])
        rates.append(2.0 * more / (travel[0] - travel[1]).item())
    # the second order of 0.5 mm of travel over arms of some 0.4 m
    assert rates[1] - rates[0] == pytest.approx(0.5 * RATE * by_travel**2, rel=1e-6)


def test_it_rests_at_design():
    assert abs(equilibrium(MODEL)[0]) < 5e-3


# -- loads and bushes -----------------------------------------------------------------------------


class Frame:
    """Two rigid halves on bushes and springs, with contacts at their heights: linear, at design.

    The halves keep together at the shear centre in all but the twist, against which the beam has
    its rate. Unknown are six motions of each half, and what holds them.
    """

    def __init__(self):
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
    def at(half, point):
        """Return how a point moves by the motions of a half, which are about the origin."""
        rows = np.zeros((3, 12))
        rows[:, 6 * half : 6 * half + 3], rows[:, 6 * half + 3 : 6 * half + 6] = (
            np.eye(3),
            -skew(point),
        )
        return rows

    def under(self, forces):
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
def test_compliance_is_that_of_a_frame(how):
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
def test_axles_that_cannot_be_are_refused(changes, refused):
    refused(InputError, lambda: AXLE.with_changes(changes))


def test_without_a_rate_nothing_couples_the_wheels():
    free = AXLE.with_changes({"beam.rate_Nm_per_deg": 0.0})
    found = characteristics.over(free, "roll", np.radians([-2.0, 2.0]))
    assert np.abs(found["bar_torque"].values).max() == 0.0
    assert compliance.linear(free, {"pivot": BUSH}, [0.0])["toe_by_lateral_parallel"].size == 2
    assert "bar_torque" not in loads.static(free, {"held": {"travel_mm": 0.0}})
