"""Suspensions on bushes as bodies in maximal coordinates: what their joints hold, and how stiffly.

An oracle for compliance: it shares no code with what it is held against.
"""

import numpy as np
from cars.axles import BAR_OF_STRUTS, BAR_OF_WISHBONES
from kintrafo import Axle, Model, Suspension, arm_angles
from kintrafo.vehicle.models.positions import design_height
from kintrafo.vehicle.models.reach import at_rest
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator
from scipy.spatial.transform import Rotation

from oracle.constraints import Assembler, Pose

# Without preload, as the linear theory has it, and with a stop that just touches.
FREE = {
    "bump_stop": {"clearance_mm": 0.0, "rate_N_per_m": 5e4, "progression_N_per_mm3": 0.05},
    "wheel.camber_deg": -1.0,
    "wheel.toe_deg": 0.3,
    "gravity.acceleration_m_per_s2": 0.0,
}
STRUT = Suspension.load("offset_strut_car").with_changes(
    FREE
    | dict.fromkeys(("strut.spring_preload_N", "strut.spring_free_length_mm", "rebound_stop"))
    | {"strut.spring_force_at_design_N": 0.0}
)
WISHBONES = Suspension.load("double_wishbone_car").with_changes(
    FREE | {"spring.free_length_mm": None, "spring.force_at_design_N": 0.0}
)
LINKED = Suspension.load("multi_link_car").with_changes(
    FREE | {"spring.free_length_mm": None, "spring.force_at_design_N": 0.0}
)
TRAILING = Suspension.load("trailing_arm_car").with_changes(
    FREE | {"spring.free_length_mm": None, "spring.force_at_design_N": 0.0}
)
LINKS = ("front_upper_link", "rear_upper_link", "front_lower_link", "rear_lower_link")
BUSHES = {
    "arm_front": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": [8000.0, 5000.0]},
    "arm_rear": {"axial_N_per_mm": 400.0, "radial_N_per_mm": [1200.0, 2500.0],
                 "axis": [1.0, 0.2, 0.1], "radial_axis": [0.0, 1.0, 1.0]},
    "tie_rod_inner": {"axial_N_per_mm": 9000.0, "radial_N_per_mm": 4000.0},
    "wheel_center": {"axial_N_per_mm": 50e3, "radial_N_per_mm": 80e3,
                     "tilt_Nm_per_deg": [4000.0, 6500.0], "radial_axis": [0.3, 0.0, 1.0]},
}  # fmt: skip
BUSHES_OF = {
    STRUT: BUSHES
    | {
        "strut_top": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 700.0},
        "ball_joint": {"radial_N_per_mm": 30e3, "axial_N_per_mm": 20e3, "axis": [0.0, 0.1, 1.0]},
    },
    WISHBONES: {
        f"{arm}_{name}" if name.startswith("arm") else name: bush
        for arm in ("lower", "upper")
        for name, bush in BUSHES.items()
    },
    LINKED: {
        "front_upper_link_inner": BUSHES["arm_front"],
        "rear_upper_link_outer": BUSHES["arm_rear"],
        "rear_lower_link_inner": {"axial_N_per_mm": 700.0, "radial_N_per_mm": 5000.0},
        "front_lower_link_inner": {"axial_N_per_mm": 1500.0, "radial_N_per_mm": 900.0},
        "tie_rod_inner": BUSHES["tie_rod_inner"],
        "wheel_center": BUSHES["wheel_center"],
    },
    TRAILING: {
        "arm_inner": BUSHES["arm_front"],
        "arm_outer": BUSHES["arm_rear"],
        "wheel_center": BUSHES["wheel_center"],
    },
}
# Joints by hand, the arms' hinges as two points: what touches, the parts, and where.
POINTS = {
    STRUT: [("arm_front", 0, "control_arm"), ("arm_rear", 0, "control_arm"),
            ("ball_joint", "control_arm", "knuckle")],
    WISHBONES: [(f"{arm}_{end}", first, second) for arm in ("lower", "upper")
                for end, first, second in (("arm_front", 0, f"{arm}_arm"),
                                           ("arm_rear", 0, f"{arm}_arm"),
                                           ("ball_joint", f"{arm}_arm", "knuckle"))],
    LINKED: [place for link in LINKS for place in ((f"{link}_outer", "knuckle", link),
                                                   (f"{link}_inner", 0, link))],
    TRAILING: [(f"arm_{end}", 0, "trailing_arm") for end in ("inner", "outer")],
}  # fmt: skip
X, Z = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])


class Stiffness:
    """A suspension as bodies on springs, held where its joints do not deflect."""

    def __init__(self, car, travel, rack, like=None):
        self.car, self.model, self.like = car, Model(car), like or car
        state = at_rest(
            self.model, arm_angles(self.model, design_height(self.model) + travel, rack), rack
        )
        self.carrier = "trailing_arm" if self.like is TRAILING else "knuckle"
        self.bodies = ("chassis", *self.model.equations.BODIES)
        self.pose = Pose(
            self.model.evaluate("positions", *state), self.model.evaluate("orientations", *state)
        )
        self.rack = rack
        points = car.hardpoints
        self.at = {name: points.metres(name) for name in (*points.names(), *points.STAND_INS)}
        parameters = self.model.parameters
        centers = [
            self.at["wheel_center"]
            if body == "wheel"
            else [parameters[f"{body}_com_{axis}"] for axis in "xyz"]
            for body in self.bodies[1:]
        ]
        self.centres = np.array([np.zeros(3), *centers])
        self.size = 6 * len(self.bodies[1:])

    def index(self, body):
        return body if isinstance(body, int) else self.bodies.index(body)

    def rows(self, build):
        """Return the rows of equations that are written down by some code."""
        assembler = Assembler(self.centres)
        build(assembler)
        _, rows = assembler.equations().evaluate(self.pose)
        return rows

    def point(self, name, first, second):
        """Return the displacement of a joint's second part against the first, (3, size)."""
        bodies = self.index(first), self.index(second)
        return -self.rows(lambda a: a.spherical(*bodies, self.at[name]))

    def placed(self, name, body):
        which = self.index(body)
        if which == 0:
            return self.at[name]
        center, turned = self.pose.position[which - 1], self.pose.rotation[which - 1]
        return center + turned @ (self.at[name] - self.centres[which])

    def along(self, first, start, second, end):
        """Return how a distance grows, (size,)."""
        away = self.placed(end, second) - self.placed(start, first)
        away /= np.linalg.norm(away)
        row = np.zeros((len(self.bodies), 6))
        for body, name, sign in ((first, start, -1.0), (second, end, 1.0)):
            which = self.index(body)
            center = self.pose.position[which - 1] if which else np.zeros(3)
            row[which] += sign * np.concatenate(
                [away, np.cross(self.placed(name, body) - center, away)]
            )
        return row[1:].ravel()

    def flexibility(self, bushes, held):
        """Return displacement and rotation of the contact by force and moment there."""
        stiff = np.zeros((self.size, self.size))
        joints, rigid, spring, stop = self.parts(bushes)
        if "wheel_center" in bushes:
            rates = np.degrees(np.broadcast_to(bushes["wheel_center"]["tilt_Nm_per_deg"], 2))
            turning = self.tilting(bushes["wheel_center"].get("radial_axis", Z))
            stiff += turning.T @ np.diag(rates) @ turning
        for name, first, second in joints:
            rows = self.point(name, first, second)
            if name not in bushes:
                rigid.append(rows)
                continue
            matrix = self.matrix(name, bushes[name])
            fixed_in = self.turned(first)
            stiff += rows.T @ fixed_in @ matrix @ fixed_in.T @ rows
        moved = self.moved()
        if held == "locked":
            rigid.append(self.along(*spring)[None])
        else:
            rate = getattr(self.car, "strut" if self.like is STRUT else "spring")
            rate = getattr(rate, "spring_rate_N_per_m" if self.like is STRUT else "rate_N_per_m")
            stiff += rate * np.outer(self.along(*spring), self.along(*spring))
            stiff += 5e4 * np.outer(self.along(*stop), self.along(*stop))
        if held == "height":
            rigid.append(moved[2][None])
        if held == "tyre":
            stiff += self.car.tyre.rate_N_per_m * np.outer(moved[2], moved[2])
        return moved @ minimum(stiff, np.vstack(rigid), moved.T)

    def turned(self, body):
        rotation = self.pose.rotation[self.index(body) - 1]
        return np.eye(3) if body in (0, "rack") else rotation

    def tilting(self, about=Z):
        """Return how the wheel tilts about a direction across its axis, and another, (2, size)."""
        knuckle, wheel, spin, *_ = self.bearing()
        other = np.cross(spin, about)
        other /= np.linalg.norm(other)
        # the axis leaves each direction as it turns about the other
        ways = (other, np.cross(other, spin))
        return self.rows(lambda a: [a.perpendicular(knuckle, wheel, spin, v) for v in ways])

    def bearing(self):
        spin = self.car.wheel.spin_axis(self.car.vehicle.sign)
        across, other = np.linalg.svd(spin[None])[2][1:]
        return self.index(self.carrier), self.index("wheel"), spin, across, other

    def parts(self, bushes):
        """Return rigid and elastic points, other constraints, and the ends of the lines."""
        rigid = []
        knuckle, wheel, _, across, other = self.bearing()
        joints = [*POINTS[self.like], ("wheel_center", self.carrier, "wheel")]
        if self.like is not TRAILING:
            joints.append(("tie_rod_outer", "knuckle", "tie_rod"))
            joints.append(("tie_rod_inner", "rack", "tie_rod"))
            rigid.append(np.eye(self.size)[6 * self.index("rack") - 6 :][:6])
            rigid.append(self.cross("rack", "tie_rod"))
        if self.like is STRUT:
            strut = self.index("upper_strut")
            axis = self.at["strut_top"] - self.at["strut_lower"]
            joints.append(("strut_top", 0, "upper_strut"))
            ends = (self.at["strut_lower"], self.at["strut_top"])
            rigid.append(self.rows(lambda a: a.cylindrical(knuckle, strut, axis, ends)))
            rigid.append(self.rows(lambda a: a.perpendicular(0, strut, X, np.cross(X, axis))))
            spring = (0, "spring_top", "knuckle", "spring_seat")
            stop = ("upper_strut", "strut_top", "knuckle", "strut_lower")
        elif self.like is LINKED:
            rigid += [self.cross(0, link) for link in LINKS]
            spring = (0, "spring_top", "rear_lower_link", "spring_seat")
            stop = (0, "damper_top", "knuckle", "damper_seat")
        elif self.like is TRAILING:
            spring = (0, "spring_top", "trailing_arm", "spring_seat")
            stop = (0, "damper_top", "trailing_arm", "damper_seat")
        else:
            spring = stop = (0, "spring_top", "lower_arm", "spring_seat")
        rigid.append(self.rows(lambda a: a.perpendicular(knuckle, wheel, across, other)))
        if "wheel_center" not in bushes:
            rigid.append(self.tilting())
        return joints, rigid, spring, stop

    def cross(self, first, rod):
        """Return how a rod turns about itself in the cross at its inner end, (1, size)."""
        shaft = self.at[f"{rod}_outer"] - self.at[f"{rod}_inner"]
        bodies = self.index(first), self.index(rod)
        return self.rows(lambda a: a.perpendicular(*bodies, Z, np.cross(Z, shaft)))

    def moved(self):
        """Return displacement and rotation of the contact by those of the bodies, (6, size)."""
        wheel = 6 * self.index("wheel") - 6
        rows = np.zeros((6, self.size))
        rows[:, wheel : wheel + 6] = np.eye(6)
        x, y, z = self.contact() - self.placed("wheel_center", "wheel")
        rows[:3, wheel + 3 : wheel + 6] = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
        return rows

    def matrix(self, name, bush):
        """Return a bush's stiffness in chassis axes at design, (3, 3) [N/m]."""
        rows = self.axes_of(name, bush)
        radial = np.broadcast_to(bush["radial_N_per_mm"], 2)
        rates = 1e3 * np.array([bush["axial_N_per_mm"], *radial])
        return rows.T @ np.diag(rates) @ rows

    def axes_of(self, name, bush):
        """Return the axes of a bush, and the two across it, as rows in chassis axes at design."""
        ends = {"strut_top": ("strut_lower", "strut_top"),
                "tie_rod_inner": ("tie_rod_inner", "tie_rod_outer")}  # fmt: skip
        if "axis" in bush:
            axis = np.array(bush["axis"])
        elif name == "wheel_center":
            axis = self.car.wheel.spin_axis(self.car.vehicle.sign)
        else:
            rod = name.rpartition("_")[0]
            arm = name.replace("front", "").replace("rear", "")
            along = "link" in rod or self.like is TRAILING
            usual = (f"{rod}_inner", f"{rod}_outer") if along else (f"{arm}front", f"{arm}rear")
            start, end = ends.get(name, usual)
            axis = self.at[end] - self.at[start]
        axis = axis / np.linalg.norm(axis)
        first = np.array(bush.get("radial_axis", [0.0, 0.0, 1.0]))
        first = first - (first @ axis) * axis
        first /= np.linalg.norm(first)
        return np.stack([axis, first, np.cross(axis, first)])

    def contact(self):
        spin = self.car.wheel.spin_axis(self.car.vehicle.sign)
        axis = self.pose.rotation[self.index("wheel") - 1] @ spin
        upward = Z - axis[2] * axis
        radius = self.car.tyre_radius()
        assert radius is not None
        return self.placed("wheel_center", "wheel") - radius * upward / np.linalg.norm(upward)


def minimum(stiff, held, loads):
    """Return the displacements of least energy under loads, some of them zero."""
    # so that stiffnesses of 1e6 N/m and constraints of 1 are of a size
    held = 1e5 * held
    matrix = np.block([[stiff, held.T], [held, np.zeros((len(held), len(held)))]])
    right = np.vstack([loads, np.zeros((len(held), loads.shape[1]))])
    return np.linalg.lstsq(matrix, right, rcond=1e-15)[0][: len(stiff)]


UNDER = ["lateral", "braking", "recession", "aligning"]
# A tenth as stiff, so that parts are displaced by some 10 mm; the bearing, which tilts, is rigid.
SOFTER = {
    car: {
        point: {k: 0.1 * np.array(v) if k.endswith("mm") else v for k, v in bush.items()}
        | ({"tilt_Nm_per_deg": [3.0, 10.0]} if "axis" in bush else {})
        for point, bush in bushes.items()
        if point != "wheel_center"
    }
    for car, bushes in BUSHES_OF.items()
}
# a spring that has nothing to do at design, and twice its rate in bump
PRESSED, PUSHING = (
    np.array([-60.0, -15.0, 0.0, 20.0, 60.0]),
    np.array([-3e3, -800.0, 0.0, 1300.0, 5500.0]),
)
CURVED = WISHBONES.with_changes(
    {
        "spring.rate_N_per_m": None,
        "spring.compression_mm": PRESSED.tolist(),
        "spring.force_N": PUSHING.tolist(),
    }
)
_SLOPES = PchipInterpolator(PRESSED, PUSHING).derivative()(PRESSED)
_SLOPES[[0, -1]] = np.diff(PUSHING)[[0, -1]] / np.diff(PRESSED)[[0, -1]]
BY_CURVE = CubicHermiteSpline(1e-3 * PRESSED, PUSHING, 1e3 * _SLOPES)


class Energy(Stiffness):
    """The potential of a suspension whose parts are anywhere."""

    def __init__(self, car, bushes, like=None):
        super().__init__(car, 0.0, 0.0, like)
        self.bushes = bushes
        self.soft, _, *self.lines = self.parts(bushes)
        self.free = [self.length(line) for line in self.lines]

    def length(self, line):
        first, start, second, end = line
        return float(np.linalg.norm(self.placed(end, second) - self.placed(start, first)))

    def stored(self):
        total = 0.0
        for name, first, second in self.soft:
            if name in self.bushes:
                gap = self.placed(name, second) - self.placed(name, first)
                gap = self.turned(first).T @ gap
                total += 0.5 * gap @ self.matrix(name, self.bushes[name]) @ gap
                total += self.of_tilt(name, first, second)
        spring, stop = (
            self.length(line) - free for line, free in zip(self.lines, self.free, strict=True)
        )
        pressed = max(-stop, 0.0)
        total += 0.5 * 5e4 * pressed**2 + 0.25 * 0.05e9 * pressed**4
        return float(total + self.of_spring(spring))

    def of_tilt(self, name, first, second):
        """Return what a bush has stored whose axis has left that of the other part."""
        rates = np.degrees(self.bushes[name].get("tilt_Nm_per_deg", [0.0, 0.0]))
        axis, *across = self.axes_of(name, self.bushes[name])
        away = self.turned(first).T @ self.turned(second) @ axis
        # the axis goes along the one as it turns about the other
        return 0.5 * float(rates[0] * (across[1] @ away) ** 2 + rates[1] * (across[0] @ away) ** 2)

    def of_spring(self, stretch):
        """Return what the spring has stored by how much longer than at design it is."""
        car = self.car
        if self.like is not STRUT and car.spring.by_curve:
            return float(BY_CURVE.antiderivative()(-stretch) - BY_CURVE.antiderivative()(0.0))
        rate = car.strut.spring_rate_N_per_m if self.like is STRUT else car.spring.rate_N_per_m
        return 0.5 * float(rate) * stretch**2

    def slopes(self, force, road):
        """Return the derivatives of the potential by all displacements and rotations."""
        at, found = self.pose, np.zeros(self.size)
        for which in range(self.size):
            values = []
            for sense in (1e-6, -1e-6):
                position, rotation = at.position.copy(), at.rotation.copy()
                body, component = divmod(which, 6)
                if component < 3:
                    position[body, component] += sense
                else:
                    axis = np.eye(3)[component - 3]
                    rotation[body] = Rotation.from_rotvec(sense * axis).as_matrix() @ rotation[body]
                self.pose = Pose(position, rotation)
                work = force @ self.placed("wheel_center", "wheel") + road * self.contact()[2]
                values.append(self.stored() - work)
            found[which] = (values[0] - values[1]) / 2e-6
        self.pose = at
        return found


SIDES = ("left", "right")
STIFFNESS_OF_RACK = 2.5e5  # N/m: a tenth of what is usual
RACK = {"rack": {"axial_N_per_mm": 1e-3 * STIFFNESS_OF_RACK}}
BAR_OF = {STRUT: BAR_OF_STRUTS, WISHBONES: BAR_OF_WISHBONES}


def axle_of(car, **bar):
    """Return a car and its image with an anti-roll bar."""
    return Axle.from_dict({"axle": "front", "side": car, "anti_roll_bar": BAR_OF[car] | bar})
