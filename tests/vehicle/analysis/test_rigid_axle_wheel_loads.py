"""Loads on the wheels of a rigid axle as inputs in time: against load cases, and part by part."""

import pickle
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from kintrafo import InputError, RigidAxleModel, equilibrium, loads, simulate
from kintrafo.vehicle.analysis.scenario import Scenario, run
from kintrafo.vehicle.corner.wheel_loads import UNITS
from rigid_axles import AXLE, LOPSIDED, Found

LIMITS = {"N": 4000.0, "N m": 400.0}
SIDES = {"left": 1.0, "right": -1.0}
MODEL = RigidAxleModel(LOPSIDED, wheel_loads=True)
CASE: dict[str, Any] = {
    "left": {"contact_N": [-900.0, 700.0, 4900.0], "contact_Nm": [0.0, 0.0, 60.0]},
    "right": {"contact_N": [-1900.0, 1100.0, 7900.0], "center_N": [300.0, 0.0, -200.0]},
}


def inputs_of(case: dict[str, Any]) -> dict[str, float]:
    """Return a load case as inputs."""
    names = {"contact_N": "contact_force", "contact_Nm": "wheel_moment", "center_N": "center_force"}
    return {
        f"{side}_{names[key]}_{axis}": value
        for side, own in case.items()
        for key, vector in own.items()
        for axis, value in zip("xyz", vector, strict=True)
    }


def test_rest_is_that_of_a_load_case() -> None:
    """Wheels without tyres, braked and in a corner: equations of motion against statics."""
    wanted = loads.static(LOPSIDED, {"case": CASE})
    free = LOPSIDED.with_changes({"tyre.rate_N_per_m": 0.0})
    model, given = RigidAxleModel(free, wheel_loads=True), inputs_of(CASE)
    rest = equilibrium(model, inputs=given)
    for side in SIDES:
        height = float(model.signal(f"{side}_axle_wheel_center_z", rest))
        travel = height - LOPSIDED.center[2]
        # roundings of 1e4 N over a stiffness of some 4e4 N/m
        assert travel == pytest.approx(float(wanted["travel"].sel(wheel=side)[0]), abs=1e-11)
    # the state carries the brakes that hold the wheels, against whatever turns them
    rates = model.evaluate("rhs", rest, rest.inputs)
    np.testing.assert_allclose(rates, 0.0, atol=1e-8)
    brake = float(rest.inputs[model.input_names.index("right_hub_torque")])
    assert brake == pytest.approx(-1900.0 * model.parameters["tyre_radius"], rel=1e-3)


def test_power_of_the_loads_is_that_at_the_places_of_the_root_finder() -> None:
    """Generalised forces in heave, roll and spin by differences of where the wheels' points go."""
    random, at, step = np.random.default_rng(2), (0.02, -0.03), 1e-6
    state = MODEL.state(heave=at[0], roll=at[1])
    given = {
        f"{side}_{name}": LIMITS[unit] * random.uniform(-1.0, 1.0)
        for side in SIDES
        for name, unit in UNITS.items()
    }
    ours = MODEL.evaluate("forces", state, MODEL.inputs(given)) - MODEL.evaluate(
        "forces", state, MODEL.inputs({})
    )
    finder, radius = Found(LOPSIDED), LOPSIDED.tyre_radius()
    assert radius is not None
    _, turn = finder.pose(*at)
    wanted = np.zeros(len(ours))
    spins = {side: MODEL.state_names.index(f"{side}_spin_angle") for side in SIDES}
    for side, sign in SIDES.items():
        local = LOPSIDED.wheel.spin_axis(sign)
        axis = turn.apply(local)
        forward = np.cross(axis, [0.0, 0.0, 1.0])
        forward /= np.linalg.norm(forward)
        axes = np.stack([forward, np.cross([0.0, 0.0, 1.0], forward), [0.0, 0.0, 1.0]])
        contact, center, moment = (
            axes.T @ [given[f"{side}_{name}_{x}"] for x in "xyz"]
            for name in ("contact_force", "center_force", "wheel_moment")
        )
        place = LOPSIDED.center + sign * LOPSIDED.half_track * np.eye(3)[1]
        upright = np.array([0.0, 0.0, 1.0]) - axis[2] * axis
        lowest = turn.inv().apply(-radius * upright / np.linalg.norm(upright))
        moment = moment + given[f"{side}_shaft_torque"] * axis
        for which, way in enumerate(np.eye(2)):
            poses = [finder.pose(*(np.array(at) + s * step * way)) for s in (-1.0, 1.0)]
            low, high = (
                np.array([m + t.apply(place + p - LOPSIDED.center) for p in (lowest, 0.0 * lowest)])
                for m, t in poses
            )
            by_contact, by_center = (high - low) / (2.0 * step)
            turning = (poses[1][1] * poses[0][1].inv()).as_rotvec() / (2.0 * step)
            wanted[which] += contact @ by_contact + center @ by_center + moment @ turning
        # spinning by itself, the wheel takes its lowest point with it
        arm = turn.apply(lowest)
        about = moment @ axis + np.cross(axis, arm) @ contact + given[f"{side}_hub_torque"]
        wanted[spins[side]] = about
    # 1e-12 m of the root finder over the step, times forces of 1e4 N
    np.testing.assert_allclose(ours, wanted, rtol=0.0, atol=3e-2)
    assert np.abs(wanted).max() > 1e3


def test_every_part_is_in_balance_along_a_motion() -> None:
    """What Newton and Euler leave over, and what bearings carry about their axes."""
    time = [0.0, 0.02, 0.05]
    inputs = {
        "left_contact_force_x": (time, [0.0, 0.0, -3000.0]),
        "right_contact_force_y": (time, [0.0, 500.0, 2500.0]),
        "left_hub_torque": (time, [0.0, 0.0, -900.0]),
        "right_shaft_torque": (time, [0.0, 100.0, 300.0]),
        "right_wheel_moment_z": (time, [0.0, 0.0, 80.0]),
        "left_center_force_z": (time, [0.0, 900.0, 0.0]),
    }
    start = equilibrium(MODEL, spin_rate=30.0)
    motion = simulate(MODEL, (0.0, 0.05), start, inputs=inputs, t_eval=np.linspace(0.0, 0.05, 6))
    found = loads.along(MODEL, motion)
    most = abs(found["force"]).max()
    for side, sign in SIDES.items():
        assert abs(found["holding_force"].sel(wheel=side)).max() < 1e-9 * most
        rows = ((found["part"] == f"wheel_{side}") & (found["by"] == "beam")).values
        (carried,) = found.isel(load=rows)["moment_in_part"].values[-1]
        # the brake is on the axle; in the axes of design, which the wheel does not spin out of
        hub = -900.0 if side == "left" else 0.0
        assert carried @ LOPSIDED.wheel.spin_axis(sign) == pytest.approx(hub, abs=1e-6)


def test_a_ride_under_loads_and_what_is_refused() -> None:
    braked = {"contact_force_x": -1500.0, "hub_torque": -540.0}
    model = RigidAxleModel(AXLE, wheel_loads=True)
    again = pickle.loads(pickle.dumps(model))
    assert again.wheel_loads
    result, _ = run(model, Scenario(duration=0.05, inputs=braked), wheels="left")
    # at rest from the beginning: one brake alone steers and rolls the axle, and it stays
    assert np.ptp(result.y[:2], axis=1).max() < 1e-6
    assert abs(result.y[1, 0]) > 1e-5
    plain = Scenario(duration=0.01)
    ways = [run(m, plain)[0].y[:, -1] for m in (model, RigidAxleModel(AXLE))]
    np.testing.assert_allclose(ways[0], ways[1], atol=1e-12)
    with pytest.raises(InputError, match="wheel_loads=True"):
        run(RigidAxleModel(AXLE), replace(plain, inputs=braked))
    low = {f"hardpoints.{name}": [p[0], p[1], p[2] - 330.0] for name, p in
           AXLE.to_dict()["hardpoints"].items() if name != "unit"}  # fmt: skip
    low |= {f"rods.{name}.{end}": [p[0], p[1], p[2] - 330.0]
            for name, rod in AXLE.to_dict()["rods"].items() for end, p in rod.items()}  # fmt: skip
    with pytest.raises(InputError, match="radius_mm is missing"):
        RigidAxleModel(AXLE.with_changes(low), wheel_loads=True)


def test_measured_loads_are_driven(kintrafo: Any, tmp_path: Path) -> None:
    text = "time_s,contact_force_x_N,hub_torque_Nm\n0,0,0\n0.02,0,0\n0.05,-2000,-720\n"
    (tmp_path / "braked.csv").write_text(text, encoding="utf-8")
    command = "simulate rigid_axle --measured braked.csv --wheels left --loads loads.csv"
    code, _, err = kintrafo(*command.split())
    assert code == 0, err
    assert "contact_left" in (tmp_path / "loads.csv").read_text(encoding="utf-8")
