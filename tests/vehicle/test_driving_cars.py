"""Cars that drive: their files, rest, running straight, brakes and steering against formulas."""

import kintrafo
import numpy as np
import pytest
from cars.driving_cars import FILE, TYRE, light_car
from kintrafo.equations.layout import rotation
from kintrafo.vehicle.assembly.car import CarAssembly
from kintrafo.vehicle.models.car import Car
from kintrafo.vehicle.models.car.car import center_of_gravity, masses
from kintrafo.vehicle.models.car.equations import CarModel, _parameters, declared

SPEED = 20.0
_ANGLES = ("camber", "steer")


@pytest.fixture(scope="module")
def assembly():
    car = light_car()
    return CarAssembly(car, CarModel(car))


def test_a_packaged_car_drives():
    car = kintrafo.load("driving_car")
    assert car.drives
    assert {wheel: car.tyre(wheel).name for wheel in car.wheels} == dict.fromkeys(
        car.wheels, "MF 6.1"
    )
    assert car.tyre("front_right") == car.tyre("front_left").mirrored()
    assert Car.from_dict(car.to_dict()).to_dict() == car.to_dict()
    unused = car.with_changes({"car": "roll"}).unused
    assert unused[:3] == ("[tyres]", "[brakes], except front_share", "[air]")


def test_tyres_are_files_beside_the_car_or_tables(tmp_path, refused):
    tyre = kintrafo.tyres.load("passenger_205_55")
    kintrafo.tyres.write_tir(tyre, tmp_path / "own.tir")
    data = FILE | {"tyres": {"front": "own.tir", "rear": TYRE}}
    car = Car.from_dict(data, folder=tmp_path)
    assert car.tyre("front_left").radius == tyre.radius
    assert car.tyre("rear_left").friction == 1.1
    again = kintrafo.load(car.save(tmp_path / "car.toml"))
    assert (again.to_dict(), again.tyres) == (car.to_dict(), car.tyres)
    slippery = car.with_changes({"tyres.rear.friction": 0.3, "tyres.front": tyre})
    assert (slippery.tyre("rear_right").friction, car.tyre("rear_right").friction) == (0.3, 1.1)
    refused(kintrafo.InputError, lambda: slippery.save(tmp_path / "slippery.toml"))


@pytest.mark.parametrize(
    "changes",
    [
        {"tyres": None},
        {"tyres.front": "nowhere.tir"},
        {"tyres.front": 3.0},
        {"tyres.front": {"radius_mm": 316.0}},
        {"tyres.front.radius_mm": 150.0},
        {"tyres.relaxation": 1.0},
        {"tyres.colour": "black"},
        {"brakes.torque_Nm": -1.0},
        {"brakes.front_share": 0.6},
        {"brakes.standstill_rad_per_s": 0.0},
        {"air.density_kg_per_m3": 0.0},
        {"air.drag_area_m2": -0.1},
        {"body.inertia_zz_kg_m2": 0.0},
        {"front.drive.share": 0.5},
        {"brakes.front_share": 0.6, "rear.side.vehicle.front_brake_share": 0.5},
        {"tyres.front.vertical_stiffness_N_per_mm": 5.0},
    ],
)
def test_what_contradicts_itself_is_refused(changes, refused):
    refused(kintrafo.InputError, lambda: light_car(**changes))


@pytest.mark.parametrize("key", ["inertia_zz_kg_m2", "inertia_xx_kg_m2"])
def test_a_missing_moment_of_inertia_is_named(key, refused):
    body = {name: value for name, value in FILE["body"].items() if name != key}
    refused(kintrafo.InputError, lambda: Car.from_dict(FILE | {"body": body}))


def on_a_rigid_axle():
    """Return the file of one whose rear axle has no sides."""
    rear = kintrafo.load("rigid_axle").to_dict()
    rear = {name: section for name, section in rear.items() if name not in ("drive", "vehicle")}
    return FILE | {"rear": rear, "body": FILE["body"] | {"com_mm": [-1300.0, 0.0, 585.8]}}


def _parameters_of(car):
    """Return values of the parameters of a car, and names of those of massive bodies without."""
    formulation = declared(car)
    needed = {p.name: {"unit": p.unit} for p in formulation.mechanism.parameters}
    found = _parameters(car, needed)
    bodies = formulation.mechanism.bodies
    light = tuple(f"{body.name}_" for body in bodies if not formulation.has_mass(body.name))
    return found, {name for name in needed if name not in found and not name.startswith(light)}


@pytest.mark.parametrize(
    "described",
    [
        "driving_car",
        "reference_vehicle",
        FILE | {"rear": "twist_beam"},
        FILE | {"rear": "twist_beam", "car": "roll"},
        on_a_rigid_axle(),
    ],
    ids=["packaged", "roll", "twist beam", "twist beam that rolls", "rigid axle"],
)
def test_equations_have_every_number_of_the_files(described):
    """All but those of bodies without mass, free angles of bars, and the slope of the road."""
    car = Car.load(described) if isinstance(described, str) else Car.from_dict(described)
    found, missing = _parameters_of(car)
    slope = {"upward_x", "upward_y", "upward_z"}
    assert missing <= {"rear_beam_free_angle", "rear_bar_free_angle", *slope}
    assert found["front_rack_axis_y"] == car.axles["front"].right.rack.axis[1]
    sided = [n for n in found if n.startswith("rear_right_") and n.endswith(("_pivot_y", "seat_y"))]
    for name in sided:
        assert found[name.replace("right", "left")] == -found[name] != 0.0


def test_controls_are_inputs_by_name():
    controls = CarAssembly(light_car()).controls
    assert controls.drive(300.0) == {
        "front_left_drive_torque": 150.0,
        "front_right_drive_torque": 150.0,
    }
    assert controls.brakes(0.5)["rear_left_brake_torque"] == pytest.approx(0.5 * 0.15 * 6000.0)
    turned = controls.rack(np.array([0.0, np.pi]), rate=2.0)
    assert turned["rack_position"] == pytest.approx([0.0, -0.025])
    assert turned["rack_velocity"] == pytest.approx(-0.05 / np.pi)


@pytest.mark.parametrize(
    "asked",
    [
        lambda c: c.controls.brakes(1.1),
        lambda c: c.controls.brakes(np.nan),
        lambda c: c.running(0.0),
        lambda c: c.running("fast"),
        kintrafo.ride.modes,
        lambda c: CarAssembly(c.car.with_changes({"brakes": None})).controls.brakes(0.1),
        lambda c: CarAssembly(c.car.with_changes({"front.drive": None})).controls.drive(1.0),
        lambda c: CarAssembly(c.car.with_changes({"front.drive": None})).running(10.0),
        lambda c: CarAssembly(c.car.with_changes({"car": "roll"})).running(10.0),
        lambda c: CarAssembly(c.car.with_changes({"car": "roll"})).controls,
    ],
)
def test_what_is_not_possible_is_refused(asked, refused):
    refused(kintrafo.InputError, lambda: asked(CarAssembly(light_car())))


def test_a_car_rests_on_its_tyres(assembly):
    """Loads carry the weight, with its moment about the wheels; tyres are pressed by them."""
    model, car = assembly.model, assembly.car
    rest = kintrafo.ride.at_rest(assembly)
    weight = 9.81 * sum(mass for mass, _ in masses(car))
    assert float(rest["load"].sum()) == pytest.approx(weight, rel=1e-12)
    state = kintrafo.equilibrium(model)
    x = model.evaluate("positions", state)[:, 0]
    mass = [model.parameters[f"{name}_mass"] for name in model.equations.BODIES]
    center = np.array(mass) @ x / np.sum(mass)
    wheels = [float(model.signal(f"{w}_wheel_center_x", state)) for w in assembly.wheels]
    # the lowest point of a disc that leans and toes in is off the centre by r sin(toe) sin(camber)
    assert float(rest["load"].values @ (np.array(wheels) - center)) == pytest.approx(0.0, abs=200.0)
    for wheel in assembly.wheels:
        signals = {
            k: float(model.signal(f"{wheel}_{k}", state)) for k in ("fz", "deflection", "fy")
        }
        assert signals["fz"] == pytest.approx(2e5 * signals["deflection"], rel=1e-12)
        assert signals["fy"] == pytest.approx(0.0, abs=1e-9)


def test_its_axles_are_on_its_tyres(assembly):
    """The tyre of each axle has the height, stiffness and slopes of the equations at rest."""
    model, car = assembly.model, assembly.car
    state = np.asarray(kintrafo.equilibrium(model))
    inputs = np.zeros(len(model.input_names))
    by_state = model.evaluate("signals_jacobian", state, inputs)
    names = model.state_names, model.signal_names
    for wheel in assembly.wheels:
        end, _, side = wheel.partition("_")
        tyre = getattr(car.axles[end], side).tyre
        signals = {
            k: float(model.signal(f"{wheel}_{k}", state))
            for k in ("wheel_center_z", "camber", "fz")
        }
        # of an upright wheel whose lowest point is as high
        height = signals["wheel_center_z"] + 0.316 * (1.0 - np.cos(signals["camber"]))
        rates = [
            by_state[names[1].index(f"{wheel}_{force}"), names[0].index(name)]
            for force, name in (
                ("fz", "body_z"), ("fx", f"{wheel}_tyre_along"), ("fy", f"{wheel}_tyre_across")
            )
        ]  # fmt: skip
        # the load is that at design; as the car settles, its springs move the wheels by millimetres
        assert 1e-3 * tyre.radius_mm == pytest.approx(height, abs=5e-5)
        assert tyre.rate_N_per_m == pytest.approx(-rates[0], rel=1e-9)
        assert tyre.longitudinal_rate_N_per_m == pytest.approx(abs(rates[1]), rel=1e-6)
        assert tyre.lateral_rate_N_per_m == pytest.approx(abs(rates[2]), rel=1e-6)
        load = tyre.rate_N_per_m * (1e-3 * tyre.free_height_mm - height)
        assert load == pytest.approx(signals["fz"], rel=1e-5)


def _numbers(car):
    """Return characteristics, loads and the parameters of the car that rides."""
    curves = kintrafo.characteristics.over(CarAssembly(car), "roll", [0.01])
    loads = kintrafo.loads.static(car.axles["front"], {"curb": {"contact_N": [900.0, 0.0, 3e3]}})
    return {
        "curves": np.concatenate([np.ravel(v) for v in curves.values()]),
        "loads": loads["force"].values,
        "riding": list(_parameters_of(CarAssembly(car).riding().car)[0].values()),
    }


def test_the_tyre_in_the_file_of_an_axle_has_no_effect(assembly):
    others = {"rate_N_per_m": 4e5, "radius_mm": 500.0, "free_height_mm": 290.0}
    changes = {
        f"{end}.side.tyre.{key}": v for end in ("front", "rear") for key, v in others.items()
    }
    wanted, found = (_numbers(car) for car in (assembly.car, light_car(**changes)))
    for name, numbers in wanted.items():
        np.testing.assert_array_equal(found[name], numbers, err_msg=name)


def test_it_runs_straight_at_a_steady_speed(assembly):
    """Drag and the forces of toed-in tyres are what the drive overcomes; nothing leaves that."""
    model = assembly.model
    start = assembly.running(SPEED)
    rates = model.evaluate("rhs", start)
    assert np.abs(rates[model.layout.positions :]).max() < 1e-8
    found = kintrafo.simulate(model, (0.0, 2.0), start, method="BDF", rtol=1e-8, atol=1e-9)
    assert found.success
    x, y = found.y[0] - found.y[0, 0], found.y[1]
    assert x[-1] == pytest.approx(2.0 * SPEED, rel=1e-6)
    assert np.abs(y).max() < 1e-6
    signals = {name: float(value) for name, value in model.signals(start).items()}
    ahead = sum(
        signals[f"{w}_fx"] * np.cos(signals[f"{w}_steer"])
        - signals[f"{w}_fy"] * np.sin(signals[f"{w}_steer"])
        for w in assembly.wheels
    )
    drag, lift = (0.5 * 1.2 * area * SPEED**2 for area in (0.65, 0.15))
    leant = lift * np.sin(assembly.body_at(np.asarray(start))["pitch"])
    assert ahead == pytest.approx(drag - leant, rel=1e-6)


def test_the_rack_keeps_a_lopsided_car_straight(assembly):
    car = light_car(**{"body.com_mm.y": 60.0})
    lopsided = CarAssembly(car, CarModel(car))
    assert lopsided.model.equations is assembly.model.equations
    loads = kintrafo.ride.at_rest(lopsided)["load"]
    assert float(loads.sel(wheel="front_left") - loads.sel(wheel="front_right")) > 400.0
    start = lopsided.running(SPEED)
    assert abs(float(start.inputs[lopsided.model.input_names.index("rack_position")])) > 1e-5
    found = kintrafo.simulate(lopsided.model, (0.0, 2.0), start, method="BDF", rtol=1e-8)
    assert found.y[0, -1] - found.y[0, 0] == pytest.approx(2.0 * SPEED, rel=1e-9)
    assert np.ptp(found.y[1]) < 1e-6


def test_a_brake_does_not_drive_and_a_locked_wheel_slips_by_one(assembly):
    model, start = assembly.model, assembly.running(SPEED)
    row, moment = model.input_names.index("rear_left_brake_torque"), "rear_left_brake_moment"
    acting = np.array(start.inputs)
    for torque, expected in ((-500.0, 0.0), (0.0, 0.0), (500.0, -500.0)):
        acting[row] = torque
        assert float(model.signal(moment, start, acting)) == pytest.approx(expected, abs=0.02)
    acting[row] = 0.0
    slopes = model.evaluate("signals_input_jacobian", start, acting)
    # a brake without torque has the slope towards a positive torque
    assert slopes[model.signal_names.index(moment), row] == pytest.approx(-1.0, abs=1e-4)
    inputs = dict.fromkeys(assembly.controls.drive(0.0), 0.0) | assembly.controls.brakes(1.0)
    found = kintrafo.simulate(model, (0.0, 1.0), start, inputs=inputs)
    slips = np.array([found.signals[f"{wheel}_slip"] for wheel in assembly.wheels])
    # not below -1, to the tolerance: relaxation lengths of these tyres do not depend on the load
    assert -1.0 - 1e-3 < slips.min() < -0.98


def test_a_small_angle_steers_it_like_the_bicycle_model(assembly):
    """r = v (d_f - d_r) / (L + K v^2), with the angles that the wheels have to the body."""
    model, car = assembly.model, assembly.car
    start = assembly.running(SPEED)
    straight = model.signals(start)
    turn = assembly.controls.rack(0.02)
    time = np.linspace(0.0, 5.0, 501)
    rack = turn["rack_position"] * 0.5 * (1.0 - np.cos(np.pi * np.minimum(time, 1.0)))
    found = kintrafo.simulate(
        model, (0.0, 5.0), start, inputs={"rack_position": (time, rack)}, method="BDF"
    )
    assert found.success
    state = found.y[:, -1]
    acting = np.array(start.inputs)
    acting[model.input_names.index("rack_position")] = turn["rack_position"]
    signals = model.signals(state, acting)

    def steer(end):
        return sum(
            0.5 * float(signals[f"{end}_{side}_steer"] - straight[f"{end}_{side}_steer"])
            for side in ("left", "right")
        )

    mass, center = sum(m for m, _ in masses(car)), float(center_of_gravity(car)[0])
    base, stiffness = 2.6, 2.0 * 6.5e4
    rear = center + base
    understeer = mass / base * (rear / stiffness + center / stiffness)
    expected = SPEED * (steer("front") - steer("rear")) / (base + understeer * SPEED**2)
    rate = float(state[model.state_names.index("body_r")])
    assert rate > 0.0
    assert rate == pytest.approx(expected, rel=0.01)


def test_camber_is_to_the_vertical_and_inclination_follows_from_it(assembly):
    """The axis of a steered wheel in the world, of a car with yaw, pitch and roll, has them."""
    model = assembly.model
    state, inputs = model.design_state.copy(), np.zeros(len(model.input_names))
    first = model.state_names.index("body_e0")
    state[first : first + 4] = turned = np.array([0.9, 0.03, 0.02, 0.4]) / np.sqrt(0.9713)
    inputs[model.input_names.index("rack_position")] = 0.03
    heading = rotation(turned)[:, 0]
    ahead = np.array([heading[0], heading[1], 0.0]) / np.hypot(heading[0], heading[1])
    for wheel in assembly.wheels[:2]:
        carrier = model.equations.BODIES.index(f"{wheel}_knuckle")
        spin = [model.parameters[f"{wheel}_spin_axis_{axis}"] for axis in "xyz"]
        axis = model.evaluate("orientations", state, inputs)[carrier] @ spin
        side = 1.0 if wheel.endswith("left") else -1.0
        across = axis @ np.cross([0.0, 0.0, 1.0], ahead)
        camber, steer = (float(model.signal(f"{wheel}_{k}", state, inputs)) for k in _ANGLES)
        assert camber == pytest.approx(np.arctan2(-side * axis[2], across), rel=1e-9)
        assert steer == pytest.approx(np.arctan2(-axis @ ahead, across), rel=1e-9)
        sine = np.tan(camber) / np.sqrt(1.0 + np.tan(camber) ** 2 + np.tan(steer) ** 2)
        assert sine == pytest.approx(-side * axis[2], rel=1e-9)  # docs/reference/conventions.md
