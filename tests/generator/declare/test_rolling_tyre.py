"""A rolling tyre in equations: a wheel on a rig, against NumPy's kinematics and tyres on arrays."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import kintrafo
import numpy as np
import pytest
from cars.tyre_files import ELLIPSE, NEWER, OLDER, without
from kintrafo import generator as g

TMEASY = Path(__file__).parents[2] / "data/chrono/TMeasyTire.json"
RATES = slice(6, 12)
UP = np.array([0.0, 0.0, 1.0])
LAWS = {
    "linear": g.LinearContact(name="tyre"),
    "newer": g.MagicFormulaContact(name="tyre"),
    "ellipse": g.MagicFormulaContact(name="tyre", newer=False, angle=True, weighted=False),
}
FILES = {"newer": NEWER, "ellipse": ELLIPSE}
RELAXING = {"newer": NEWER, "older": OLDER}
CENTER = g.Point("wheel_center", (0.0, 0.0, 0.31), "wheel centre")
SPIN = g.Direction("spin_axis", (0.0, 1.0, 0.0), "spin axis of the wheel, pointing left")
ROAD = g.Input("road_height", "m", "height of the road under the tyre")
ROAD_VELOCITY = g.Input("road_velocity", "m/s", "rate of the road's height", ROAD)
DEFLECTIONS = (
    g.InternalState("tyre_along", "m", "deflection of the contact, forward"),
    g.InternalState("tyre_across", "m", "deflection of the contact, to the left"),
)
COORDINATES = ("ahead", "across", "heave", "steering", "lean", "spin")


def rig(law, name, *, damped=False, relaxing=False):
    """Return a wheel that hangs on three guides and turns about three axes through its centre."""
    ground = g.Ground("rig", 1)
    line = {
        axis: g.Direction(f"world_{axis}", fixed=along)
        for axis, along in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z", (0, 0, 1)))
    }
    sled, carriage, column, fork, carrier = (
        g.Body(body, 2.0, (0.0, 0.02, 0.35), (0.01, 0.02, 0.03))
        for body in ("sled", "carriage", "column", "fork", "carrier")
    )
    wheel = g.Rotor("wheel", 18.0, CENTER, axis=SPIN, spin=1.1, diametral=0.6)
    through = {axis: g.Line(CENTER, line[axis]) for axis in "xz"}
    joints = (
        g.Prismatic("ahead", ground, sled, line["x"]),
        g.Prismatic("across", sled, carriage, line["y"]),
        g.Prismatic("heave", carriage, column, line["z"]),
        g.Revolute("steering", column, fork, through["z"]),
        g.Revolute("lean", fork, carrier, through["x"]),
        g.Revolute("spin", carrier, wheel, g.Line(CENTER, SPIN)),
    )
    tyre = g.RollingTyre(
        name="tyre",
        wheel=g.Wheel(carrier, CENTER, SPIN),
        bearing=joints[-1],
        law=law,
        road=ROAD,
        damper=g.DamperRate("tyre_damper_rate", 500.0, "damping") if damped else None,
        road_velocity=ROAD_VELOCITY if damped else None,
        deflections=DEFLECTIONS if relaxing else None,
    )
    mechanism = g.Mechanism(
        name=name,
        title=name,
        joints=joints,
        forces=(g.Weight(), tyre),
        coordinates=(
            *(j.slide(f"{j.name}_slide", f"slide of {j.name}") for j in joints[:3]),
            *(j.angle(f"{j.name}_angle", f"angle of {j.name}") for j in joints[3:]),
        ),
    )
    return g.Formulation(name, name, mechanism, independent=joints)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("rigs")


@pytest.fixture(scope="module")
def system_of(folder):
    @cache
    def built(name):
        plain = name == "linear"
        backend = "numpy" if name == "ellipse" else "c"
        model = rig(LAWS[name], f"rig_{name}", damped=plain)
        equations = kintrafo.compile(model, folder=folder, backend=backend)
        return kintrafo.System(equations, {} if plain else tyre_of(name).parameters())

    @cache
    def tyre_of(name):
        path = folder / f"{name}.tir"
        path.write_text(FILES[name], encoding="utf-8")
        return kintrafo.tyres.load(path)

    built.tyre = tyre_of
    return built


def states(count, *, speed=15.0):
    """Return states of all six coordinates, pressed onto the road, rolling forward and backward."""
    random = np.random.default_rng(7)
    found = np.zeros((count, 12))
    found[:, 2] = random.uniform(-0.035, -0.015, count)
    found[:, 3] = random.uniform(-0.5, 0.5, count)
    found[:, 4] = random.uniform(-0.12, 0.12, count)
    found[:, 6] = speed * random.choice([-1.0, 1.0], count) * random.uniform(0.5, 1.5, count)
    found[:, 7] = random.uniform(-3.0, 3.0, count)
    found[:, 8] = random.uniform(-0.2, 0.2, count)
    found[:, 9:11] = random.uniform(-0.8, 0.8, (count, 2))
    found[:, 11] = found[:, 6] / 0.3 * random.uniform(0.85, 1.15, count)
    return found


class Wheel:
    """A disc in a state of the rig, by vectors in the world."""

    def __init__(self, state, radius):
        (s, c), (sl, cl) = ((np.sin(x), np.cos(x)) for x in state[3:5])
        turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
        lean = np.array([[1.0, 0.0, 0.0], [0.0, cl, -sl], [0.0, sl, cl]])
        self.axis = turn @ lean @ [0.0, 1.0, 0.0]
        self.velocity = state[RATES][:3]
        self.turning = state[9] * UP + state[10] * turn[:, 0]
        self.spin = state[11] + self.turning @ self.axis
        down = -UP + self.axis * self.axis[2]
        self.down = down / np.linalg.norm(down)
        self.forward = np.cross(self.axis, UP) / np.linalg.norm(np.cross(self.axis, UP))
        self.left = np.cross(UP, self.forward)
        self.height = 0.31 + state[2]
        self.radius = radius
        self.loaded = self.height / -self.down[2]
        self.deflection = -(self.height + radius * self.down[2])

    def slips(self, rolling_radius, lowest):
        """Return speed, longitudinal slip and slip angle."""
        ahead = self.forward @ self.velocity
        contact = self.velocity + np.cross(self.turning, self.loaded * self.down)
        size = np.hypot(ahead, lowest)
        slip = (rolling_radius * self.spin - ahead) / size
        return ahead, slip, np.arctan(self.left @ contact / size)

    def power(self, rates, forces, state):
        """Return the power of forces and moments as the coordinates move at some rates."""
        fx, fy, fz, mx, my, mz = forces
        moved = state.copy()
        moved[RATES] = rates
        other = Wheel(moved, self.radius)
        wheel = other.turning + rates[5] * other.axis
        at_contact = other.velocity + np.cross(wheel, self.loaded * self.down)
        at_lowest = other.velocity + np.cross(wheel, self.radius * self.down)
        force = fx * self.forward + fy * self.left
        moment = mx * self.forward + my * self.left + mz * UP
        return force @ at_contact + fz * UP @ at_lowest + moment @ wheel


def _see_jacobian(system, places):
    """Compare the Jacobian with differences of the right-hand side."""
    inputs = system.inputs({})
    for state in places:
        jacobian = system.evaluate("rhs_jacobian", state, inputs)
        assert np.isfinite(jacobian).all()
        columns = [
            system.evaluate("rhs", state + h, inputs) - system.evaluate("rhs", state - h, inputs)
            for h in 1e-6 * np.eye(len(state))
        ]
        scale = np.abs(jacobian).max()
        differences = np.transpose(columns) / 2e-6
        np.testing.assert_allclose(jacobian, differences, rtol=2e-5, atol=2e-6 * scale)


@pytest.mark.parametrize("name", FILES)
def test_forces_are_those_of_the_tyre_on_arrays(system_of, name):
    """With slips smoothed at 1e-5 m/s, which is 1e-12 of them here."""
    tyre, lowest = system_of.tyre(name), 1e-5
    system = kintrafo.System(system_of(name).equations, tyre.parameters() | {"tyre_vxlow": lowest})
    # the radius does not grow with speed in equations
    slow, inputs = tyre.with_changes({"Q_V1": 0.0}), system.inputs({})
    for state in states(12):
        signals = system.signals(state, inputs)
        wheel = Wheel(state, tyre.free_radius)
        assert signals["tyre_deflection"] == pytest.approx(wheel.deflection, abs=1e-13)
        share = wheel.deflection / tyre.radius
        first, second = (tyre.parameters()[f"tyre_q_fz{i}"] for i in (1, 2))
        load = tyre.coefficients["FNOMIN"] * share * (first + second * share)
        assert signals["tyre_fz"] == pytest.approx(load, rel=1e-12)
        radius = slow.evaluate(load, extrapolate=True).effective_radius
        ahead, slip, angle = wheel.slips(float(radius), lowest)
        assert signals["tyre_slip"] == pytest.approx(slip, abs=1e-11)
        assert signals["tyre_slip_angle"] == pytest.approx(angle, abs=1e-11)
        camber = np.arcsin(wheel.axis[2])
        found = tyre.evaluate(load, angle, slip, camber, speed=ahead, extrapolate=True)
        for what in ("fx", "fy", "mz"):
            wanted = float(vars(found)[what])
            assert signals[f"tyre_{what}"] == pytest.approx(wanted, rel=1e-8, abs=1e-6), what


@pytest.mark.parametrize("damping", [0.0, 500.0])
def test_their_power_is_that_of_forces_at_the_contact(system_of, damping):
    """Of each coordinate, for the linear law; its forces written down once more."""
    system = kintrafo.System(system_of("linear").equations, {"tyre_damper_rate": damping})
    p = {k.removeprefix("tyre_"): v for k, v in system.parameters.items()}
    above = system.inputs({"road_height": -1.0})
    for state in states(8):
        wheel = Wheel(state, p["unloaded_radius"])
        load = p["vertical_stiffness"] * wheel.deflection
        lowest = wheel.velocity + np.cross(wheel.turning, wheel.radius * wheel.down)
        load = max(load - damping * lowest[2], 0.0)
        ahead, slip, angle = wheel.slips(p["effective_radius"], p["vxlow"])
        rolling = ahead / np.hypot(ahead, p["vxlow"])
        fx = p["slip_stiffness"] * slip
        fy = -p["cornering_stiffness"] * np.tan(angle)
        fy -= p["camber_stiffness"] * wheel.axis[2] * rolling
        share = 1.0 / np.sqrt(1.0 + (fx**2 + fy**2) / (p["friction"] * load) ** 2)
        fx, fy = fx * share, fy * share
        mz = -p["trail"] * share**3 * rolling * fy
        found = system.evaluate("forces", state, system.inputs({}))
        weight = system.evaluate("forces", state, above)
        for k, rates in enumerate(np.eye(6)):
            wanted = wheel.power(rates, (fx, fy, load, 0.0, 0.0, mz), state)
            got = found[k] - weight[k]
            assert got == pytest.approx(wanted, rel=1e-10, abs=1e-8), COORDINATES[k]


@pytest.mark.parametrize("name", LAWS)
def test_the_jacobian_is_exact(system_of, name):
    """Against differences of the right-hand side, also at standstill."""
    system = system_of(name)
    rest = np.zeros(12)
    rest[2] = -0.02
    _see_jacobian(system, (*states(3), rest))


@pytest.mark.parametrize("name", LAWS)
def test_standstill_reversing_and_the_air(system_of, name):
    """Nothing is singular, forces oppose the slip, and a tyre in the air has none."""
    system = system_of(name)
    inputs = system.inputs({})
    ahead, across, spin = 6, 7, 11
    for speed in (0.0, 1e-9, 0.1, -0.1, 3.0, -3.0):
        state = np.zeros(12)
        state[[2, 4, ahead, across]] = -0.02, 0.0, speed, 0.05
        state[spin] = speed / 0.29 + 1.0
        signals = system.signals(state, inputs)
        assert signals["tyre_fx"] > 0.0, speed
        assert signals["tyre_fy"] < 0.0, speed
    state[2] = 0.02
    in_air = system.signals(state, inputs)
    assert [in_air[f"tyre_{k}"] for k in ("fx", "fy", "fz", "mz")] == [0.0] * 4


@pytest.mark.parametrize("name", ["vxlow", "vertical_stiffness", "effective_radius"])
def test_what_no_tyre_has_is_refused(system_of, name, refused):
    """Without a lowest speed a slip at standstill would be no number."""
    refused(
        kintrafo.ParameterError,
        lambda: kintrafo.System(system_of("linear").equations, {f"tyre_{name}": 0.0}),
    )


@pytest.fixture(scope="module")
def relaxing(folder):
    @cache
    def built(name):
        laws = {
            "linear": LAWS["linear"],
            "newer": LAWS["newer"],
            "older": g.MagicFormulaContact(name="tyre", newer=False, angle=True),
        }
        model = rig(laws[name], f"relaxing_{name}", relaxing=True)
        equations = kintrafo.compile(model, folder=folder, backend="numpy")
        if name == "linear":
            return kintrafo.System(equations), None
        path = folder / f"relaxing_{name}.tir"
        path.write_text(RELAXING[name], encoding="utf-8")
        tyre = kintrafo.tyres.load(path)
        values = tyre.parameters(relaxing=True) | {"tyre_vxlow": 1e-5}
        return kintrafo.System(equations, values), tyre

    return built


@pytest.mark.parametrize("name", RELAXING)
def test_deflections_follow_the_slip_along_the_relaxation_length(relaxing, name):
    """u' = -Vsx - |Vx| u / sigma; forces are those of the tyre on arrays at u / sigma."""
    system, tyre = relaxing(name)
    slow, inputs = tyre.with_changes({"Q_V1": 0.0}), system.inputs({})
    for position in states(6):
        state = np.append(position, [0.008, -0.011])
        signals, rates = system.signals(state, inputs), system.evaluate("rhs", state, inputs)
        load = float(signals["tyre_fz"])
        wheel = Wheel(position, tyre.free_radius)
        camber = np.arcsin(wheel.axis[2])
        still = slow.evaluate(load, camber=camber, extrapolate=True)
        ahead, slip, angle = wheel.slips(float(still.effective_radius), 1e-5)
        along, across = state[12] / still.relaxation_x, state[13] / still.relaxation_y
        assert rates[12] == pytest.approx(abs(ahead) * (slip - along), rel=1e-7, abs=1e-9)
        assert rates[13] == pytest.approx(abs(ahead) * (np.tan(angle) - across), rel=1e-7, abs=1e-9)
        assert signals["tyre_slip"] == pytest.approx(float(along), rel=1e-8)
        found = tyre.evaluate(load, np.arctan(across), along, camber, speed=ahead, extrapolate=True)
        for what in ("fx", "fy"):
            wanted = float(vars(found)[what])
            assert signals[f"tyre_{what}"] == pytest.approx(wanted, rel=1e-7, abs=1e-5), what


def test_tmeasy_is_that_on_arrays(folder):
    """In its deflection as well, which has 1e-9 m more under a root."""
    tyre, law = kintrafo.tyres.load(TMEASY), g.TMeasyContact(name="tyre")
    model = rig(law, "rig_tmeasy", relaxing=True)
    equations = kintrafo.compile(model, folder=folder, backend="numpy")
    system = kintrafo.System(equations, tyre.parameters() | {"tyre_vxlow": 1e-5})
    inputs = system.inputs({})
    for position in states(6):
        state = np.append(position, [0.03, -0.02])
        signals, rates = system.signals(state, inputs), system.evaluate("rhs", state, inputs)
        wheel = Wheel(position, tyre.radius)
        load = wheel.deflection * (1.0 * tyre.values["load_1"]
                                   + tyre.values["load_2"] * wheel.deflection)  # fmt: skip
        assert signals["tyre_fz"] == pytest.approx(load, rel=1e-12)
        still = tyre.evaluate(load, extrapolate=True)
        ahead, slip, _ = wheel.slips(float(still.effective_radius), 1e-5)
        along, across = state[12] / still.relaxation_x, state[13] / still.relaxation_y
        assert rates[12] == pytest.approx(abs(ahead) * (slip - along), rel=1e-7, abs=1e-9)
        camber = np.arcsin(wheel.axis[2])
        found = tyre.evaluate(load, np.arctan(across), along, camber, speed=ahead, extrapolate=True)
        for what in ("fx", "fy", "mz"):
            wanted = float(vars(found)[what])
            assert signals[f"tyre_{what}"] == pytest.approx(wanted, rel=1e-6, abs=1e-5), what
    system = kintrafo.System(equations, tyre.parameters())
    _see_jacobian(system, (state,))
    # where both slips vanish, slopes of TMeasy depend on the direction: there it is their mean
    rest = np.zeros(14)
    rest[2] = -0.02
    assert np.isfinite(system.evaluate("rhs_jacobian", rest, inputs)).all()


def test_with_relaxation_no_speed_is_stiff(relaxing, system_of):
    """Spin settles with r^2 C / (I v) without, and about sqrt(r^2 C / (I s)) with it."""
    plain, (system, _) = system_of("linear"), relaxing("linear")
    for speed in (0.3, 2.0, 10.0):
        state = np.zeros(14)
        state[[2, 6, 11]] = -0.02, speed, speed / 0.29
        fast, slow = (
            np.abs(np.linalg.eigvals(one.evaluate("rhs_jacobian", x, one.inputs({})))).max()
            for one, x in ((plain, state[:12]), (system, state))
        )
        settling = 0.29**2 * 9e4 / (1.1 * np.hypot(speed, 1.0))
        assert fast > 0.9 * settling
        assert slow < 1.6 * np.sqrt(0.29**2 * 9e4 / (1.1 * 0.3))


def test_relaxation_lengths_that_a_file_does_not_say_are_asked_for(folder, refused):
    path = folder / "without.tir"
    path.write_text(without(NEWER, "LATERAL_STIFFNESS"), encoding="utf-8")
    tyre = kintrafo.tyres.load(path)
    assert tyre.parameters()["tyre_pcx1"] == 1.62
    refused(kintrafo.InputError, lambda: tyre.parameters(relaxing=True))


def test_a_tyre_has_all_parameters_of_its_law(system_of):
    linear = kintrafo.tyres.LinearSlip(
        radius=0.3, effective_radius=0.29, vertical_stiffness=2e5, slip_stiffness=9e4,
        cornering_stiffness=7e4,
    )  # fmt: skip
    tmeasy = kintrafo.tyres.load(TMEASY)
    assert {p.name for p in g.TMeasyContact(name="tyre").numbers} == set(tmeasy.parameters())
    for name, tyre in (("linear", linear), ("newer", system_of.tyre("newer"))):
        assert {p.name for p in LAWS[name].numbers} == set(tyre.parameters()), name


WITHOUT = ("RHX1", "RHY1", "RHY2", *(f"QSX{i}" for i in range(4, 15)), "PKX3", "QSY7", "QSY8")


def test_coefficients_that_do_nothing_cost_nothing(folder, system_of, refused):
    law = replace(LAWS["newer"], without=WITHOUT)
    model = rig(law, "rig_without")
    system = kintrafo.System(kintrafo.compile(model, folder=folder, backend="numpy"))
    path = folder / "neutral.tir"
    path.write_text(without(NEWER, *WITHOUT), encoding="utf-8")
    tyre = kintrafo.tyres.load(path)
    lean = kintrafo.System(system.equations, tyre.parameters(without=WITHOUT))
    full = kintrafo.System(system_of("newer").equations, tyre.parameters())
    for state in states(5):
        one, two = (each.evaluate("rhs", state, each.inputs({})) for each in (lean, full))
        np.testing.assert_allclose(one, two, rtol=1e-9, atol=1e-9 * np.abs(two).max())
    arcs, every = (each.equations.rhs.operations["trigonometric"] for each in (lean, full))
    assert arcs <= every - 14
    refused(kintrafo.InputError, lambda: system_of.tyre("newer").parameters(without=WITHOUT))
    refused(g.DeclarationError, lambda: replace(LAWS["newer"], without=("PTX1", "LONGVL")))


def test_a_mirrored_copy_has_the_mirror_image_of_the_tyre(folder, system_of):
    """Its coordinates have the values of the other side in a mirrored motion, but for `across`."""
    tyre = system_of.tyre("newer")
    neutral = {key: 0.0 for key in WITHOUT if key.startswith(("QSX", "RH", "PKX", "QSY8"))}
    tyre = tyre.with_changes(neutral | {"QSY7": 1.0})
    mechanism = rig(replace(LAWS["newer"], without=WITHOUT), "one", relaxing=True).mechanism
    both = g.combined(
        "both", "both", (g.Copy(mechanism, "left_", mirrored=True), g.Copy(mechanism, "right_"))
    )
    model = g.Formulation("both", "both", both, independent=both.joints)
    equations = kintrafo.compile(model, folder=folder, backend="numpy")
    system = kintrafo.System(equations, tyre.parameters(relaxing=True, without=WITHOUT))
    position = states(1)[0]
    state = np.concatenate(
        [np.tile(position[:6], 2), np.tile(position[6:], 2), [0.005, 0.01, 0.005, -0.01]]
    )
    signals = system.signals(state, system.inputs({}))
    assert abs(signals["right_tyre_fy"]) > 300.0
    for what, sign in (("fx", 1), ("fy", -1), ("fz", 1), ("mz", -1), ("slip_angle", -1)):
        left, right = (float(signals[f"{side}_tyre_{what}"]) for side in ("left", "right"))
        assert left == pytest.approx(sign * right, rel=1e-10), what


def test_it_is_refused_by_name(refused):
    law = LAWS["linear"]
    tyre = next(f for f in rig(law, "rig").mechanism.forces if isinstance(f, g.RollingTyre))
    parts = {k: v for k, v in vars(tyre).items() if not k.startswith("_")}
    height = g.Input("height", "N", "not a height")
    damper = g.DamperRate("rate", 1.0, "damping")
    lean = next(j for j in rig(law, "rig").mechanism.joints if j.name == "lean")
    for changes in (
        {"road": height},
        {"damper": damper},
        {"bearing": lean},
        {"deflections": (g.InternalState("u", "N", "no length"),) * 2},
        {"bearing": lean},
    ):
        with refused(g.DeclarationError):
            g.RollingTyre(**(parts | changes))
