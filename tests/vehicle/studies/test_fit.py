"""Errors of the file that explain measured curves: known errors, linear regression, noise."""

import numpy as np
import pytest
from kintrafo import InputError, Model, Suspension, characteristics, compliance, load, variation
from kintrafo.core.quantities import display_of
from kintrafo.vehicle.assembly.by_wheel import flat
from kintrafo.vehicle.studies.design_variables import places_of

CAR = Suspension.load("reference_car")
ROD = "hardpoints.tie_rod_inner.z"
BALL = "hardpoints.ball_joint.y"
TRAVEL = np.linspace(-0.06, 0.06, 7)
CURVES = ["toe", "camber", "caster"]
ACCURACY = {"toe": 0.01, "camber": 0.01, "caster": 0.01}


def built(rod, ball):
    """Return the car with the tie rod too high and the ball joint too far to the left [mm]."""
    places, changes = places_of(CAR), {}
    for name, by in ((ROD, rod), (BALL, ball)):
        changes |= places[name].moved(1e-3 * by)
    return CAR.with_changes(changes)


def rig(car, at=TRAVEL, names=CURVES):
    return characteristics.over(Model(car), "travel", at)[names]


AS_BUILT = built(1.5, -1.0)


def test_known_errors_are_found():
    """Accurate to a thousandth of a degree, curves outweigh tolerances by 1e5 to 1."""
    fine = dict.fromkeys(CURVES, 1e-4)
    found = variation.fit(CAR, rig(AS_BUILT), {ROD: 3.0, BALL: 3.0}, accuracy=fine)
    assert found.success
    assert found.moved[ROD] == pytest.approx(1.5, abs=0.01)
    assert found.moved[BALL] == pytest.approx(-1.0, abs=0.01)
    assert all(part > 0.99 for part in found.determined.values())
    assert all(curve.after < 0.02 * curve.before for curve in found.curves)


def test_small_errors_are_those_of_linear_regression():
    """Mean and covariance of a normal prior and normal errors, from derivatives by themselves."""
    tolerances = {ROD: 0.3, BALL: 0.6, "hardpoints.arm_rear.z": 0.9}
    measured = rig(built(0.1, 0.05))
    found = variation.fit(CAR, measured, tolerances, accuracy=ACCURACY)
    slopes = variation.sensitivity(CAR, [*tolerances], positions=TRAVEL, names=CURVES)
    here = rig(CAR)
    order = [str(place) for place in slopes["place"].values]
    rows = np.vstack([slopes[name].sel(place=order).values.T for name in CURVES])
    gaps = np.concatenate([(measured[name] - here[name]).values for name in CURVES])
    weight = 1.0 / np.deg2rad(0.01) ** 2
    prior = np.diag([(3.0 / (1e-3 * tolerances[place])) ** 2 for place in order])
    precision = weight * rows.T @ rows + prior
    mean = 1e3 * np.linalg.solve(precision, weight * rows.T @ gaps)
    deviations = 1e3 * np.sqrt(np.diag(np.linalg.inv(precision)))
    # second derivatives are some 10 per metre of first ones, over 0.1 mm: parts of a thousand
    ours = [found.moved[place] for place in order]
    np.testing.assert_allclose(ours, mean, rtol=5e-3, atol=5e-4)
    np.testing.assert_allclose([found.uncertainty[p] for p in order], deviations, rtol=5e-3)
    told = [1.0 - (3.0 * d / tolerances[p]) ** 2 for p, d in zip(order, deviations, strict=True)]
    np.testing.assert_allclose([found.determined[p] for p in order], told, atol=5e-3)


def test_noise_leaves_what_is_reported():
    """Errors, in parts of the deviation that is told, are normal: the mean of 16 squares near 1."""
    random, squares = np.random.default_rng(3), []
    for _ in range(8):
        off = random.normal(size=2)
        measured = rig(built(*off))
        for name in CURVES:
            measured[name] += random.normal(scale=np.deg2rad(0.01), size=TRAVEL.size)
        found = variation.fit(CAR, measured, {ROD: 3.0, BALL: 3.0}, accuracy=ACCURACY)
        assert found.success  # less sure than 0.99 ** 24, but for two values that are fitted
        for place, true in ((ROD, off[0]), (BALL, off[1])):
            squares.append(((found.moved[place] - true) / found.uncertainty[place]) ** 2)
    # chi-squared with 16 degrees of freedom: 3.9 and 39 are passed once in a thousand
    assert 3.9 < sum(squares) < 39.0


def test_what_curves_do_not_determine_stays():
    mass = "bodies.wheel.mass_kg"
    found = variation.fit(CAR, rig(AS_BUILT), {ROD: 3.0, BALL: 3.0, mass: 1.0}, accuracy=ACCURACY)
    assert found.moved[mass] == 0.0
    assert found.determined[mass] == pytest.approx(0.0, abs=1e-12)
    assert found.uncertainty[mass] == pytest.approx(1.0 / 3.0)
    assert found.message == f"the curves do not determine: {mass}"


def test_what_is_beyond_tolerances_is_not_explained():
    found = variation.fit(CAR, rig(AS_BUILT), {ROD: 0.2, BALL: 0.2}, accuracy=ACCURACY)
    assert not found.success
    assert "not explained: toe" in found.message
    assert "at the end of its tolerance" in found.message


def test_many_points_count_as_ten():
    """The same points again and again, as a loop of a rig has them, tell nothing more."""
    often = np.tile(np.linspace(-0.05, 0.05, 10), 4)
    few, many = (
        variation.fit(CAR, rig(AS_BUILT, at), {ROD: 3.0, BALL: 3.0}, accuracy=ACCURACY)
        for at in (often[:10], often)
    )
    assert many.uncertainty[ROD] == pytest.approx(few.uncertainty[ROD], rel=1e-6)
    assert many.moved[ROD] == pytest.approx(few.moved[ROD], abs=1e-6)
    assert {curve.name: curve.within for curve in many.curves} == pytest.approx(
        {name: np.deg2rad(0.01) for name in CURVES}
    )


def test_empty_cells_count_nothing(refused):
    measured = rig(AS_BUILT)
    measured["caster"][:] = np.nan
    measured["toe"][3] = np.nan
    refused(InputError, lambda: variation.fit(CAR, measured, {ROD: 3.0}))
    found = variation.fit(CAR, measured, {ROD: 3.0, BALL: 3.0}, names=["toe", "camber"])
    assert [curve.name for curve in found.curves] == ["toe", "camber"]
    assert found.moved[ROD] == pytest.approx(1.5, abs=0.1)


def test_curves_of_an_axle_are_named_beside_a_suspension(refused):
    """A file has no characteristics of another assembly: none is left out without a word."""
    measured = rig(AS_BUILT, names=["toe"])
    measured["camber_left"] = measured["toe"]
    found = variation.fit(CAR, measured, {ROD: 3.0})
    assert "not computed, and not fitted: camber_left" in found.message
    assert [curve.name for curve in found.curves] == ["toe"]
    refused(InputError, lambda: variation.fit(CAR, measured[["camber_left"]], {ROD: 3.0}))


@pytest.mark.parametrize(
    ("name", "over", "end", "own", "other"),
    [
        ("reference_car", "rack", 0.02, "toe", "camber_left"),
        ("reference_axle", "rack", 0.02, "toe_left", "camber"),
        ("reference_axle", "roll", 0.03, "toe_left", "roll_center_height_front"),
    ],
)
def test_curves_of_another_subject_are_named_over_every_axis(name, over, end, own, other):
    """Axes of one name have other curves for other subjects."""
    subject, at = load(name), np.linspace(-end, end, 5)
    measured = flat(characteristics.over(subject, over, at))[[own]]
    measured[other] = measured[own]
    place = ROD if name == "reference_car" else f"side.{ROD}"
    found = variation.fit(subject, measured, {place: 3.0})
    assert f"not computed, and not fitted: {other}" in found.message
    assert [curve.name for curve in found.curves] == [own]


def test_what_cannot_be_is_refused(refused):
    measured = rig(AS_BUILT)
    for arguments in (
        {"tolerances": {}},
        {"tolerances": {"bodies.wheel.mass_kg": 1.0}},
        {"tolerances": {ROD: 1.0}, "accuracy": {"toes": 1.0}},
        {"tolerances": {ROD: 1.0}, "accuracy": {"toe": 0.0}},
        {"tolerances": {ROD: 1.0}, "names": ["x"]},
        {"tolerances": {ROD: 1.0}, "measured": measured.rename(wheel_travel="t")},
        {"tolerances": {ROD: 1.0}, "measured": measured.assign_coords(rack_position=0.01)},
        {"tolerances": {ROD: 1.0},
          "measured": measured.assign_coords(rack_position=("wheel_travel", TRAVEL))},
        {"tolerances": {ROD: 1.0}, "measured": measured.assign_coords(rack_position=np.nan)},
        {"tolerances": {ROD: 1.0},
          "measured": measured.assign_coords(wheel_travel=TRAVEL * np.nan)},
        {"tolerances": {ROD: 1.0}, "measured": measured[["toe"]].astype(str)},
        {"tolerances": {ROD: 1.0}, "measured": 0.0 * measured}):  # fmt: skip
        with refused(InputError):
            variation.fit(**{"suspension": CAR, "measured": measured, **arguments})


def test_the_command_reports_it(kintrafo, tmp_path):
    from kintrafo import export

    export.write(rig(AS_BUILT, names=["toe", "camber"]), tmp_path / "rig.csv")
    text = f'[tolerances]\n"{ROD}" = 3.0\n"{BALL}" = 3.0\n[accuracy]\ntoe = 0.01\n'
    (tmp_path / "t.toml").write_text(text, encoding="utf-8")
    files = ("reference_car", "rig.csv", "t.toml")
    code, out, _ = kintrafo("fit", *files, "-o", "as_built.toml", "--plot", "a.svg")
    assert (code, "explained" in out) == (0, True)
    found = Suspension.load(tmp_path / "as_built.toml")
    assert found.hardpoints.tie_rod_inner[2] == pytest.approx(281.5, abs=0.2)
    assert (tmp_path / "a.svg").stat().st_size > 1000
    code, out, _ = kintrafo("fit", *files, "--json")
    assert (code, '"determined"' in out) == (0, True)
    (tmp_path / "t.toml").write_text(text.replace("3.0", "0.1"), encoding="utf-8")
    code, out, _ = kintrafo("fit", *files)
    assert (code, "not explained" in out) == (1, True)


# -- bushes -------------------------------------------------------------------------------------

SOFT = CAR.with_changes(
    {
        "bushings": {
            "arm_front": {"axial_N_per_mm": 800.0},
            "arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": 1200.0},
            "strut_top": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 700.0},
            "rack": {"axial_N_per_mm": 5000.0},
        }
    }
)
REAR, TOP = "bushings.arm_rear.axial_N_per_mm", "bushings.strut_top.radial_N_per_mm"
BY_LOAD = ["toe_by_lateral", "toe_by_braking", "camber_by_lateral", "displacement_by_braking"]


def soft_rig(car, held="height"):
    """Return toe, and what a rig finds with loads on the wheel."""
    by_load = compliance.linear(Model(car), None, TRAVEL, held=held)
    return by_load[BY_LOAD].merge(rig(car, names=["toe"]), compat="override")


@pytest.mark.parametrize("held", ["height", "spring"])
def test_known_rates_of_bushes_are_found(held):
    """A third softer, a fifth stiffer, and the tie rod too high, which toe over travel tells."""
    changes = {REAR: 270.0, TOP: 850.0} | places_of(SOFT)[ROD].moved(1.5e-3)
    measured = soft_rig(SOFT.with_changes(changes), held)
    # accurate to a thousandth of what they are, curves outweigh tolerances by 1e4 to 1
    fine = {"toe": 1e-4, "toe_by_lateral": 1e-5, "toe_by_braking": 1e-5, "camber_by_lateral": 1e-4}
    tolerances = {REAR: "60 %", TOP: 400.0, ROD: 3.0}
    found = variation.fit(SOFT, measured, tolerances, accuracy=fine, held=held)
    assert found.success, found.message
    assert found.moved[REAR] == pytest.approx(-130.0, abs=2.0)
    assert found.moved[TOP] == pytest.approx(150.0, abs=2.0)
    assert found.moved[ROD] == pytest.approx(1.5, abs=0.02)
    assert found.suspension.bushings["arm_rear"]["axial_N_per_mm"] == pytest.approx(270.0, abs=2.0)
    if held == "height":
        other = variation.fit(SOFT, measured, tolerances, accuracy=fine, held="locked")
        assert other.moved != found.moved


def test_small_errors_of_bushes_are_those_of_linear_regression():
    """Normal prior and normal errors by formula, slopes by differences of compliances."""
    measured = soft_rig(SOFT.with_changes({REAR: 402.0, TOP: 699.0}))[BY_LOAD]
    tolerances, within = {REAR: 9.0, TOP: 6.0}, 1e-4
    here = soft_rig(SOFT)[BY_LOAD]
    factors = [display_of(here[name].attrs).factor for name in BY_LOAD]
    rows = []
    for place, rate in ((REAR, 400.0), (TOP, 700.0)):
        up, down = (soft_rig(SOFT.with_changes({place: rate + by})) for by in (0.1, -0.1))
        rows.append(
            [f * (up[n] - down[n]).values / 0.2 for f, n in zip(factors, BY_LOAD, strict=True)]
        )
    slopes = np.reshape(rows, (2, -1)).T
    gaps = np.concatenate(
        [f * (measured[n] - here[n]).values for f, n in zip(factors, BY_LOAD, strict=True)]
    )
    prior = np.diag([(3.0 / tolerance) ** 2 for tolerance in tolerances.values()])
    precision = slopes.T @ slopes / within**2 + prior
    mean = np.linalg.solve(precision, slopes.T @ gaps / within**2)
    accuracy = dict.fromkeys(BY_LOAD, within)
    found = variation.fit(SOFT, measured, tolerances, accuracy=accuracy)
    # second derivatives by a rate are 2 / rate of first ones, over 2 N/mm: a hundredth
    np.testing.assert_allclose([*found.moved.values()], mean, rtol=0.02)
    deviations = np.sqrt(np.diag(np.linalg.inv(precision)))
    np.testing.assert_allclose([*found.uncertainty.values()], deviations, rtol=0.02)


def test_parts_that_are_none_are_refused(refused):
    measured = soft_rig(SOFT)
    for tolerances in ({REAR: "some"}, {REAR: "-3 %"}, {REAR: "0 %"}, {"wheel.toe_deg": "3 %"}):
        with refused(InputError):
            variation.fit(SOFT, measured, tolerances)
    refused(InputError, lambda: variation.fit(CAR, measured, {ROD: 3.0}))
    with pytest.raises(InputError, match="held"):
        variation.fit(SOFT, measured, {REAR: "30 %"}, held="nothing")


def test_the_command_fits_bushes(kintrafo, tmp_path):
    from kintrafo import export
    from kintrafo.vehicle.input.toml_writer import write_toml

    write_toml(SOFT, tmp_path / "soft.toml")
    everything = compliance.linear(Model(SOFT.with_changes({REAR: 300.0})), None, TRAVEL)
    names = ["toe_by_lateral", "toe_by_aligning", "displacement_by_recession"]
    export.write(everything[names], tmp_path / "rig.csv")
    assert "toe_by_aligning [deg/100 N m]" in (tmp_path / "rig.csv").read_text(encoding="utf-8")
    (tmp_path / "t.toml").write_text(f'[tolerances]\n"{REAR}" = "60 %"\n', encoding="utf-8")
    files = ("soft.toml", "rig.csv", "t.toml")
    code, out, err = kintrafo("fit", *files, "-o", "found.toml", "--plot", "a.png")
    assert (code, "N/mm" in out) == (0, True), err
    found = Suspension.load(tmp_path / "found.toml")
    assert found.bushings["arm_rear"]["axial_N_per_mm"] == pytest.approx(300.0, rel=0.03)
    assert (tmp_path / "a.png").stat().st_size > 1000
