"""Anti-roll bars on soft bushes and drop links: springs in series, statics of a body on springs."""

import numpy as np
import pytest
from cars.axles import BAR_OF_STRUTS
from kintrafo import Axle, InputError, characteristics, compliance, loads
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.assembly.rig import SweepRange
from kintrafo.vehicle.models.axle.bar import AntiRollBar

STRAIGHT = BAR_OF_STRUTS | {"link_top": [30.0, -580.0, 320.0]}
INCLINED = STRAIGHT | {"link_top": [30.0, -560.0, 340.0], "link_foot": [60.0, -590.0, 210.0]}
SOFT = {"bush_radial_N_per_mm": 900.0, "link_axial_N_per_mm": 2500.0}
# What is rigid is so many times as stiff as all else [N/m, N m/rad].
RIGID = 1e14


def test_springs_in_series():
    """A link that stands at right angles to its lever of 210 mm, 580 mm from the middle."""
    bar = 17.5 / np.deg2rad(1.0)
    links = 2.0 / (2.5e6 * 0.21**2)
    bushes = 2.0 * (580.0 / 400.0 / 0.21) ** 2 / 900e3  # by the lever rule
    soft = {"bush_radial_N_per_mm": 1.0 / bar + bushes, "link_axial_N_per_mm": 1.0 / bar + links}
    for key, expected in soft.items():
        found = AntiRollBar(**STRAIGHT | {key: SOFT[key]})
        assert found.rate() == pytest.approx(1.0 / expected, rel=1e-12)
        assert found.rate_of_bar() == pytest.approx(bar, rel=1e-12)
    both = AntiRollBar(**STRAIGHT | SOFT)
    assert both.rate() == pytest.approx(1.0 / (1.0 / bar + links + bushes), rel=1e-12)
    assert AntiRollBar(**STRAIGHT).rate() == pytest.approx(bar, rel=1e-12)


def statics(bar, up, *, rigid):
    """Return twist and torque of a bar, a body on springs, for a little further roll.

    Its coordinates are displacement, rotation and twist. One foot is moved up, the other one down,
    and both by so much more that the twist is small.
    """
    halves = [bar.half(mirrored=mirrored) for mirrored in (False, True)]
    feet = [half.foot + np.array([0.0, 0.0, z]) for half, z in zip(halves, (up, -up), strict=True)]
    stiffness, load = np.zeros((7, 7)), np.zeros(7)
    middle = halves[0].bush * (1.0, 0.0, 1.0)

    def spring(at, along, twist, rate, moved):
        row = np.concatenate([along, np.cross(at - middle, along), [twist @ along]])
        stiffness[...] += rate * np.outer(row, row)
        load[...] += rate * row * moved

    stiffness[6, 6] = bar.rate_of_bar()
    for half, foot, sense in zip(halves, feet, (-1.0, 1.0), strict=True):
        for axis in np.eye(3):
            held = RIGID if rigid or axis[1] else SOFT["bush_radial_N_per_mm"] * 1e3
            spring(half.bush, axis, np.zeros(3), held, 0.0)
        top = half.top_at(half.turn(foot))
        along = (top - foot) / np.linalg.norm(top - foot)
        # the left half turns by half of the twist more, about the axis that points left
        turned = 0.5 * sense * np.cross([0.0, 1.0, 0.0], top - half.bush)
        foot_moved = -sense * np.array([0.0, 0.0, 1e-6])
        rate = RIGID if rigid else SOFT["link_axial_N_per_mm"] * 1e3
        spring(top, along, turned, rate, float(along @ foot_moved))
    moved = np.linalg.solve(stiffness, load)
    return float(moved[6]), float(bar.rate_of_bar() * moved[6])


@pytest.mark.parametrize("points", [STRAIGHT, INCLINED], ids=["straight", "inclined"])
def test_a_bar_as_a_body_on_springs(points):
    """Torque of the soft bar by the twist that a rigid one has where its links move alike."""
    bar = AntiRollBar(**points | SOFT)
    # rigid springs are 1e-8 of others; away from design its levers are not those of design
    for up, tolerance in ((0.0, 1e-7), (0.05, 0.008)):
        twist, _ = statics(bar, up, rigid=True)
        _, torque = statics(bar, up, rigid=False)
        assert bar.rate() == pytest.approx(torque / twist, rel=tolerance)
    assert bar.rate() < 0.9 * bar.rate_of_bar()


# -- in an axle ---------------------------------------------------------------------------------


def axle_with(**keys):
    """Return the reference axle with a bar that has further keys."""
    axle = Axle.load("reference_axle")
    bar = axle.bar.model_dump(exclude_none=True) | keys
    return Axle.from_dict({"axle": "front", "side": axle.right, "anti_roll_bar": bar})


STIFF, YIELDING = axle_with(), axle_with(**SOFT)


def test_an_axle_rolls_as_much_more():
    """Roll stiffness, the torque of the bar, and the loads on its links and bearings."""
    share = YIELDING.bar.rate() / YIELDING.bar.rate_of_bar()
    extent = SweepRange(roll=0.02)
    stiff, soft = (
        flat(characteristics.over(axle, "roll", extent=extent)) for axle in (STIFF, YIELDING)
    )
    for name in ("roll_stiffness_bar", "bar_torque", "link_force_left"):
        assert soft[name].values == pytest.approx(share * stiff[name].values, rel=1e-9, abs=1e-6)
    cases = {"corner": {"left": {"travel_mm": -20.0}, "right": {"travel_mm": 25.0}}}
    hard, given = (loads.static(axle, cases) for axle in (STIFF, YIELDING))
    for load in ("anti_roll_bar at bar_bush_left by chassis", "drop_link_right at link_top_right"):
        (name,) = {str(n) for n in given["load"].values if str(n).startswith(load)}
        one, other = (e["force"].sel(load=name, case="corner").values for e in (given, hard))
        assert one == pytest.approx(share * other, rel=1e-9)


def test_the_matrix_of_both_contacts_has_the_bar():
    """Stiffness of both wheels under vertical forces: with the bar, its rate times slopes."""
    bushes, vertical = {"rack": {"axial_N_per_mm": 5000.0}}, [2, 8]
    without = Axle.from_dict({"axle": "front", "side": STIFF.right})

    def stiffness(axle):
        found = compliance.linear(axle, bushes, [0.0], held="spring")["flexibility"].values[0]
        return np.linalg.inv(found[np.ix_(vertical, vertical)])

    by = 1e-3
    twists = characteristics.over(STIFF, "left")["bar_twist"]
    slope = float(twists.interp(wheel_travel=by) - twists.interp(wheel_travel=-by)) / (2.0 * by)
    slopes = np.array([slope, -slope])
    added = stiffness(YIELDING) - stiffness(without)
    # by the wheel's centre, of which the contact moves as much but for camber; curves are coarse
    assert added == pytest.approx(YIELDING.bar.rate() * np.outer(slopes, slopes), rel=0.01)


def test_what_is_no_bush(refused):
    for keys in (
        {"bush_radial_N_per_mm": 0.0},
        {"link_axial_N_per_mm": -3.0},
        {"bush_radial_N_per_mm": 1e3, "bush": [240.0, -0.1, 320.0]},
    ):
        with refused(InputError):
            axle_with(**keys)
