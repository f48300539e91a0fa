"""A car whose wheels slide upright on the body: no kinematics, so that formulas are its oracle.

It has the names of states, inputs and signals of a car that drives. Wheels do not lean or steer as
they travel, except that a rack turns both front wheels by one angle.
"""

from dataclasses import replace

from kintrafo import generator as g
from kintrafo.generator.mechanisms.steering_column import on_a_column
from kintrafo.vehicle.assembly import controls

MASS, CARRIER, WHEEL = 1200.0, 20.0, 20.0
FRONT, REAR, HALF_TRACK = 1.2, -1.5, 0.75
WHEELS = ("front_left", "front_right", "rear_left", "rear_right")
RADIUS, SPRING, TYRE = 0.3, 25e3, 200e3
# What a spring of each end carries [N], and the heights of the wheel centres at design [m].
CARRIED = {
    end: 0.5 * 9.81 * MASS * arm / (FRONT - REAR)
    for end, arm in (("front", -REAR), ("rear", FRONT))
}
HEIGHTS = {end: RADIUS - (own + 9.81 * (CARRIER + WHEEL)) / TYRE for end, own in CARRIED.items()}
TURN = 8.0  # of a front wheel by the rack [rad/m]

BODY = g.Body("body", MASS, (0.0, 0.0, 0.5), (400.0, 1500.0, 1700.0))
LEFT = g.Direction("spin_axis", (0.0, 1.0, 0.0))
RACK = g.Body("rack", 0.0, (FRONT, 0.0, 0.3))
RACK_GUIDE = g.Prismatic("rack_guide", BODY, RACK, g.Direction("rack_axis", fixed=(0, 1, 0)))
RACK_MOTION = g.Motion("rack", "m", "displacement of the rack")
GRAVITY = g.Gravity("gravity", 9.81, "acceleration of gravity")


def _corner(wheel):
    x = FRONT if wheel.startswith("front") else REAR
    y = HALF_TRACK if wheel.endswith("left") else -HALF_TRACK
    end = wheel.partition("_")[0]
    at = (x, y, HEIGHTS[end])
    center = g.Point(f"{wheel}_wheel_center", at, "wheel centre")
    spin_axis = g.Direction(f"{wheel}_spin_axis", (0.0, 1.0, 0.0))
    slide = g.Body(f"{wheel}_slide", CARRIER, at, (0.4, 0.4, 0.4))
    carrier = slide
    wheel_body = g.Rotor(f"{wheel}_wheel", WHEEL, center, axis=spin_axis, spin=1.0, diametral=0.6)
    guide = g.Prismatic(f"{wheel}_guide", BODY, slide, g.UP)
    joints = [guide]
    driven = [guide]
    if end == "front":
        carrier = g.Body(f"{wheel}_knuckle", 0.0, at)
        steer = g.Revolute(
            f"{wheel}_kingpin", slide, carrier, g.Line(center, g.UP),
            follows=g.Gear(RACK_GUIDE, g.TurnPerTravel(f"{wheel}_turn", TURN, "turn by the rack")),
        )  # fmt: skip
        joints.append(steer)
    bearing = g.Revolute(f"{wheel}_bearing", carrier, wheel_body, g.Line(center, spin_axis))
    joints.append(bearing)
    driven.append(bearing)
    rest = g.Displacement(f"{wheel}_free", -CARRIED[end] / SPRING, "slide without force")
    spring = g.ForceElement(
        f"{wheel}_spring", g.AlongGuide(guide),
        (
            g.LinearSpring(g.SpringRate(f"{wheel}_rate", SPRING, "rate"), free_length=rest),
            g.LinearDamper(g.DamperRate(f"{wheel}_damping", 2e3, "damping")),
        ),
    )  # fmt: skip
    tyre = g.RollingTyre(
        name=wheel,
        wheel=g.Wheel(carrier, center, spin_axis),
        bearing=bearing,
        law=g.LinearContact(name=f"{end}_tyre"),
        road=g.Input(f"{wheel}_road_height", "m", "height of the road"),
        deflections=(
            g.InternalState(f"{wheel}_tyre_along", "m", "deflection of the contact, forward"),
            g.InternalState(f"{wheel}_tyre_across", "m", "deflection of the contact, to the left"),
        ),
    )
    torque = g.Input(f"{wheel}_drive_torque", "N m", "torque of the drive")
    forces = [spring, tyre, g.JointForce(bearing, torque)]
    brake = g.Input(f"{wheel}_brake_torque", "N m", "torque of the brake, against the spin")
    forces.append(g.JointForce(bearing, brake))
    coordinates = [
        guide.slide(f"{wheel}_travel", "travel"),
        bearing.angle(f"{wheel}_spin", "angle of the wheel"),
    ]
    return joints, driven, forces, coordinates, (slide, wheel_body)


def declared(*, column=False):
    """Return its declaration, also with a steering column."""
    free = g.Free("body_free", BODY)
    corners = [_corner(wheel) for wheel in WHEELS]
    joints = (free, RACK_GUIDE, *(j for corner in corners for j in corner[0]))
    mechanism = g.Mechanism(
        name="rail_car",
        title="Rail car",
        joints=joints,
        forces=(g.Weight(GRAVITY), *(f for corner in corners for f in corner[2])),
        coordinates=(
            *(free.coordinate(k, f"body_{k}", k) for k in ("yaw", "pitch", "roll")),
            *(c for corner in corners for c in corner[3]),
            *([RACK_GUIDE.slide("rack_displacement", "displacement")] if column else []),
        ),
    )
    found = g.Formulation(
        name="rail_car",
        title="Rail car",
        mechanism=mechanism,
        independent=(free, *(j for corner in corners for j in corner[1])),
        massive=(BODY, *(b for corner in corners for b in corner[4])),
        prescribed={RACK_GUIDE: RACK_MOTION},
    )
    if not column:
        return found
    found = on_a_column(found)
    # as in other cars, signals of the rack do not have the names of its inputs
    forces = [
        replace(force, name="front_rack") if getattr(force, "name", "") == "rack" else force
        for force in found.mechanism.forces
    ]
    mechanism = replace(found.mechanism, forces=tuple(forces))
    return replace(found, name="rail_car_column", mechanism=mechanism)


class Controls:
    """A rack by 10 rad/m, rear drive, brakes of 6,000 N m in equal parts."""

    RATIO = 100.0  # of the steering wheel by the rack [rad/m]

    def rack(self, angle, rate=0.0, acceleration=0.0):
        return dict(zip(controls.RACK, self.rack_at(angle, rate, acceleration), strict=True))

    def rack_at(self, *values):
        return tuple(value / self.RATIO for value in values)

    def brakes(self, pedal):
        return {f"{wheel}_brake_torque": -1500.0 * pedal for wheel in WHEELS}

    def drive(self, torque):
        return {f"{wheel}_drive_torque": 0.5 * torque for wheel in WHEELS[2:]}


def car(*, column=False, **parameters):
    """Return it as handling sees it."""
    import kintrafo
    import numpy as np
    from kintrafo.vehicle.analysis.handling.body_motion import ReferencePoint
    from kintrafo.vehicle.analysis.handling.car import DrivingCar

    model = kintrafo.System(kintrafo.compile(declared(column=column)), parameters)
    rest = kintrafo.rest(model)
    center = np.array([0.0, 0.0, 0.5])
    total = MASS + 4 * (CARRIER + WHEEL)
    wheels = (
        2
        * (CARRIER + WHEEL)
        * np.array([[FRONT, 0.0, HEIGHTS["front"]], [REAR, 0.0, HEIGHTS["rear"]]])
    )
    reference = (MASS * center + wheels.sum(axis=0)) / total
    return DrivingCar(
        model=model,
        wheels=WHEELS,
        spins=tuple(f"{wheel}_spin" for wheel in WHEELS),
        radii=(0.29,) * 4,
        rest=rest,
        base=np.array(rest.inputs),
        controls=Controls(),
        motion=ReferencePoint(model.state_names, center, reference),
        wheelbase=FRONT - REAR,
        front=FRONT - reference[0],
        mass=total,
        rack_state="rack_displacement" if column else None,
    )
