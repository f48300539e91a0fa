"""A car as an assembly: its body on the wheels of two axles, or of one corner."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...core.validator import Validator
from ...equations.errors import ModelError
from ...equations.layout import rotation
from ...systems.rest import rest
from ...systems.state import State
from ..input.units import in_metres
from ..kinds import Suspension
from ..models.car.car import AnyAxle, Car, center_of_gravity, masses, suspension_masses
from ..models.car.driving import unlikely_driving
from ..models.car.equations import CarModel
from ..models.model import Model
from ..models.plausibility import LOWEST_CENTER, Plausibility, unlikely_body
from ..models.reach import PositionError
from ..models.sides import LEFT, RIGHT
from .assembly import Assembly, HeldAssembly, WheelNames
from .axle import axle_assembly
from .car_kinematics import CarKinematics, measures_of_axles
from .controls import Controls
from .corner import CornerAssembly
from .measures.measure import Measure
from .quantity import HEAVE, PITCH, ROLL
from .rig import RestConditions, RigMotion, RigPosition, SweepRange
from .running import straight
from .usual import grid

_MOTIONS = {
    "heave": RigMotion(HEAVE, "the body rises and falls on all wheels", "heave of the body"),
    "pitch": RigMotion(
        PITCH, "the axles travel in opposite directions, as the body pitches", "pitch"
    ),
    "roll": RigMotion(
        ROLL, "left and right wheels travel in opposite directions, as the body rolls", "roll"
    ),
}
# Usual pitch to either side, and its step [rad].
_MOST_PITCH, _PITCH_STEP = np.deg2rad(2.0), np.deg2rad(0.1)
# Deflection of the tyres at the start of a search for rest if the car is above the road [m].
_PRESSED = 0.01
# A wheel that carries less than this has left the road [N].
_LEAST_LOAD = 1.0
# The positions of a body that moves freely.
_FREE = ("body_x", "body_y", "body_z", "body_e0", "body_e1", "body_e2", "body_e3")


class CarAssembly(Assembly):
    """A car; `model` has its equations, if they exist already."""

    def __init__(self, car: Car, model: CarModel | None = None) -> None:
        self.subject = self.car = car
        self._model = model
        self.wheels, self.axles = car.wheels, tuple(car.axles)
        self.body_moves, self.drives = True, car.drives
        parts: Mapping[str, Any] = _in_vehicle(car) or {"": car.corner}
        self.held = {end: _held(part) for end, part in parts.items()}
        self.wheeled = [file for part in self.held.values() for file in part.wheeled]
        self.symmetric = all(part.symmetric for part in self.held.values())
        known = _MOTIONS if car.axles else {"heave": _MOTIONS["heave"]}
        self.motions = dict(known)

    # -- its data ---------------------------------------------------------------------------------

    @property
    def held_parts(self) -> Mapping[str, HeldAssembly]:
        return {end or "corner": part for end, part in self.held.items()}

    def plausibility(self) -> Plausibility:
        """Return the unlikely values of its body; those of a quarter car have no meaning alone."""
        if not self.axles:
            return Plausibility((), ())
        base = in_metres(self.car.described.wheelbase_mm or 0.0, "mm")
        described = self.car.described
        found = [*unlikely_body(described.body, center_of_gravity(self.car), base)]
        if self.car.drives:
            total = sum(mass for mass, _ in masses(self.car))
            radius = max(tyre.radius for tyre in self.car.tyres.values())
            found += unlikely_driving(described.brakes, described.air, total * radius)
        return Plausibility(tuple(found), ())

    def described(self) -> dict[str, str]:
        """Return masses, tyres, brakes and drive as text, and the unused data of its files."""
        total = sum(mass for mass, _ in masses(self.car))
        found = {"motions of the body": ", ".join(self.car.coordinates)}
        if self.axles:
            x, y, z = 1e3 * center_of_gravity(self.car)
            found |= {
                "mass": f"{total:.1f} kg",
                "centre of gravity": f"x = {x:.1f} mm, y = {y:.1f} mm, z = {z:.1f} mm",
            }
        if self.car.drives:
            found |= self._described_driving()
        if self.car.unused:
            found["not used"] = "; ".join(self.car.unused)
        return found

    def _described_driving(self) -> dict[str, str]:
        """Return tyres, brakes and drive as text."""
        car, brakes = self.car, self.car.described.brakes
        shares = {end: f"{100 * share:g} %" for end, share in car.drive_shares.items()}
        found = {
            "tyres": ", ".join(f"{end} {tyre.name}" for end, tyre in car.tyres.items()),
            "drive": ", ".join(f"{end} {share}" for end, share in shares.items()) or "none",
        }
        if (column := car.column) is not None:
            found["steering column"] = f"{column.stiffness_Nm_per_deg:g} N m/deg"
        if brakes is not None and car.front_brake_share is not None:
            found["brakes"] = (
                f"{brakes.torque_Nm:g} N m, {100 * car.front_brake_share:g} % at the front"
            )
        return found

    @property
    def design_sections(self) -> dict[str, dict[str, Any]]:
        """The sections of the files of its axles, or of its corner, and those of its own.

        Those of a car that drives have no ``[tyre]``, which has no effect.
        """
        own, left_out = self.car.to_dict(), {"tyre"} if self.car.drives else set()
        found = {
            f"{name}.{begin}": {key: v for key, v in sections.items() if key not in left_out}
            for name, part in self.car.parts.items()  # as their files describe them
            for begin, sections in _held(part).design_sections.items()
        }
        return found | {"": {name: v for name, v in own.items() if name not in self.held_parts}}

    @property
    def input_sections(self) -> dict[str, Any]:
        own = self.car.described
        # a part that is no file's name follows with its sections
        apart = [name for name in self.car.parts if not isinstance(getattr(own, name), str)]
        found: dict[str, Any] = {"": own.model_copy(update=dict.fromkeys(apart))}
        for name, part in self.car.parts.items():  # as their files describe them
            for begin, section in _held(part).input_sections.items():
                found[f"{name} {begin}".strip()] = section
        return found

    @property
    def words(self) -> str:
        return f"A {self.car.heading()}. The body moves: {', '.join(self.car.coordinates)}."

    def without_friction(self) -> "CarAssembly":
        parts = {
            name: _held(part).without_friction().subject for name, part in self.car.parts.items()
        }
        data = {k: v for k, v in self.car.to_dict().items() if k not in parts}
        if self.car.column is not None:
            data["steering_column"] |= {"friction_Nm": 0.0, "rack_friction_N": 0.0}
        return CarAssembly(Car.from_dict(data | parts))

    # -- its positions on a rig -------------------------------------------------------------------

    def usual(
        self, motion: str, ends: SweepRange | None = None, *, travel: float = 0.0, rack: float = 0.0
    ) -> Array:
        far = ends or SweepRange()
        if motion == "pitch":
            return grid(-_MOST_PITCH, _MOST_PITCH, _PITCH_STEP)
        own = {"heave": None, "roll": "roll"}[motion]
        found = [part.usual(own or part.usual_motion, far) for part in self.held.values()]
        low, high = max(f[0] for f in found), min(f[-1] for f in found)
        if motion == "roll":
            return grid(low, high, float(found[0][1] - found[0][0]))
        return grid(-high, -low, far.step)

    def position(
        self, motion: str, along: Array, *, travel: float = 0.0, rack: float = 0.0
    ) -> RigPosition:
        """Return the positions of the wheels on the body along a motion of the body.

        In heave the body moves and the wheels do not. In pitch the travels of an axle are its
        distance from the body's centre of mass times the tangent of the angle. In roll each axle
        has the opposite travels that incline the line through its wheel centres by the angle.
        """
        travels: dict[str, Array] = {}
        for end, part in self.held.items():
            if motion == "roll":
                own = part.position("roll", along, rack=rack if part.steered else 0.0).travels
            else:
                risen = -along if motion == "heave" else self._lever(end) * np.tan(along)
                own = part.at_travel(risen).travels
            travels |= {f"{end}_{side}" if end else side: t for side, t in own.items()}
        return RigPosition(travels, np.asarray(rack, float))

    def _lever(self, end: str) -> float:
        """Return the distance of an axle in front of the body's centre of mass [m]."""
        return float(self.car.axle_positions[end] - self.car.com[0])

    def measures(self, motion: str) -> tuple[Measure, ...]:
        own = {end: part.measures(self._motion_of(part, motion)) for end, part in self.held.items()}
        return measures_of_axles(own) if self.axles else own[""]

    @staticmethod
    def _motion_of(part: Assembly, motion: str) -> str:
        return motion if motion == "roll" else part.usual_motion

    def kinematics(self, position: RigPosition) -> Any:
        found = {}
        for end, part in self.held.items():
            travels = {
                side: position.travels[f"{end}_{side}" if end else side] for side in part.wheels
            }
            rack = position.rack if part.steered and end != "rear" else np.zeros(())
            found[end] = part.kinematics(RigPosition(travels, rack))
        if not self.axles:
            return found[""]
        return CarKinematics(found, len(position.travels[self.wheels[0]]))

    # -- its equations of motion ------------------------------------------------------------------

    @cached_property
    def model(self) -> CarModel:
        """Its equations."""
        return CarModel(self.car) if self._model is None else self._model

    @property
    def coordinates(self) -> tuple[str, ...]:
        own = [
            f"{end}_{name}" if end else name
            for end, p in self.held.items()
            for name in p.coordinates
        ]
        rack = () if self.rack_state is None else (self.rack_state,)
        return (*(_FREE if self.car.drives else self.car.coordinates), *own, *rack)

    @property
    def rack_state(self) -> str | None:
        """The state that is the displacement of the rack [m]; None if the rack is prescribed."""
        return None if self.car.column is None else f"front_{self.car.axles['front'].rack_name}"

    def names_of(self, wheel: str) -> WheelNames:
        end, _, side = wheel.rpartition("_")
        names = self.held[end].names_of(side)
        if not end:
            return names
        prefix = f"{wheel}_"
        tyre = "fz" if self.car.drives else names.tyre
        return WheelNames(prefix, prefix, f"{end}_{names.spin}", f"{end}_{names.actuator}", tyre)

    def coordinates_at_rest(self, held: RestConditions) -> Array:
        """Return the coordinates of the state of rest that is nearest to design.

        Raises `PositionError` if there is none: if the car falls, tips over, or a wheel does not
        reach the road.
        """
        from .rest import at  # noqa: PLC0415 (both know assemblies)

        if held.loads:
            problem = (
                "wheel_load: the loads of a car's wheels follow from its weight. Leave it out."
            )
            raise InputError([problem], "equilibrium")
        model = self.model
        if any(model.slope or ()):
            problem = (
                "slope: a car does not rest on a slope, where nothing holds its wheels. Leave it "
                "out of the CarModel; kintrafo.handling.drive has grade and crossfall."
            )
            raise InputError([problem], self.heading)
        rows = [model.state_names.index(name) for name in self.coordinates]
        _, inputs = at(self, held, model.design_state[rows])
        acting = dict(zip(model.input_names, inputs.tolist(), strict=True))
        try:
            found = np.asarray(rest(model, self._on_its_tyres(held), acting))
        except (InputError, ModelError) as error:
            problem = (
                "the car has no equilibrium near design: its springs and tyres do not carry it. "
                "Check [body] mass_kg, the springs, and free_height_mm of the tyres. "
                f"The search ended with: {error}"
            )
            raise PositionError(problem) from None
        if np.linalg.eigvals(-self._slopes(found, inputs)).real.min() <= 0.0:
            problem = (
                "the equilibrium is not stable: the car tips over, or a linkage snaps through. "
                "Check the springs, and the height of the centre of mass in [body] com_mm."
            )
            raise PositionError(problem)
        self._refuse_lifted(found, inputs)
        self._refuse_on_stops(found, inputs)
        return found[rows]

    def _slopes(self, state: Array, inputs: Array) -> Array:
        """Return the derivatives of the accelerations with respect to the coordinates of rest."""
        model, layout = self.model, self.model.layout
        slopes = model.evaluate("rhs_jacobian", state, inputs)
        speeds = slice(layout.positions, layout.positions + layout.speeds)
        slopes = slopes[speeds, : layout.positions] @ layout.basis(state)
        names = model.state_names[speeds]
        # a body that moves freely rests anywhere on the road, in any direction
        kept = ["body_w", "body_p", "body_q"] if self.car.drives else []
        kept += [f"{name}_rate" for name in self.coordinates if name not in _FREE]
        places = [names.index(name) for name in kept]
        return slopes[np.ix_(places, places)]

    def _on_its_tyres(self, held: RestConditions) -> Array:
        """Return the state at design, lowered until all tyres are deflected."""
        model = self.model
        state: Array = model.design_state.copy()
        gaps = [
            self.car.wheel_centers[wheel][2] - free - held.roads.get(wheel, 0.0)
            for wheel, free in zip(self.wheels, self._free_heights, strict=True)
        ]
        if max(gaps) > 0.0:
            heave = "body_z" if self.car.drives else "heave"
            state[model.state_names.index(heave)] = -max(gaps) - _PRESSED
        return state

    @property
    def tyre_radii(self) -> Sequence[float | None]:
        """The radii of its wheels by wheel [m]: of a car that drives those of its tyres."""
        if self.car.drives:
            return [self.car.tyre(wheel).radius for wheel in self.wheels]
        return super().tyre_radii

    @property
    def _free_heights(self) -> list[float]:
        """The heights of wheel centres above the road with undeflected tyres [m]."""
        if self.car.drives:
            return [self.car.tyre(wheel).free_radius for wheel in self.wheels]
        return [in_metres(tyre.free_height_mm, "mm") for tyre in self.tyres]

    def _refuse_on_stops(self, state: Array, inputs: Array) -> None:
        """Refuse a rest in which a stop carries a load."""
        signals = self.model.signals(state, inputs)
        pressed = {n: abs(float(f)) for n, f in signals.items() if n.endswith("_stop_force")}
        pressed = {name: force for name, force in pressed.items() if force > _LEAST_LOAD}
        if pressed:
            words = ", ".join(f"{name} = {force:.0f} N" for name, force in pressed.items())
            problem = (
                f"at rest the car is on its stops: {words}. Check [body] mass_kg, the springs, and "
                "clearance_mm of the stops."
            )
            raise PositionError(problem)

    def _refuse_lifted(self, state: Array, inputs: Array) -> None:
        """Refuse a rest in which a wheel does not press on the road."""
        model = self.model
        loads = {
            wheel: float(model.signal(self.names_of(wheel).load, state, inputs))
            for wheel in self.wheels
        }
        lifted = [wheel for wheel, load in loads.items() if load < _LEAST_LOAD]
        if lifted:
            words = ", ".join(f"{wheel.replace('_', ' ')} {loads[wheel]:.0f} N" for wheel in lifted)
            problem = (
                f"at rest wheels do not press on the road: {words}. The car does not reach the "
                "ground there, or tips over: check [body] com_mm, free_height_mm of the tyres and "
                "the heights of the road."
            )
            raise PositionError(problem)

    # -- driving ----------------------------------------------------------------------------------

    @cached_property
    def controls(self) -> Controls:
        """Inputs of its equations from steering wheel and pedals.

        Raises `InputError` if it does not drive.
        """
        self.require_driving()
        return Controls(self.car)

    def running(self, speed: float) -> State:
        """Return the state of steady motion straight ahead at a speed, see `running.straight`.

        `speed` is that of the body's centre of mass, more than zero [m/s]. Raises `InputError` if
        the car does not drive, no axle is driven, or no such state is found; `PositionError` if it
        does not rest on its wheels.
        """
        from .rest import at  # noqa: PLC0415 (both know assemblies)

        self.require_driving()
        with Validator("running") as given:
            speed = given.number("speed", speed, "m/s", above=0.0)
            if not self.car.drive_shares:
                given.fail(
                    "no axle is driven, so the car cannot keep a speed. Add [drive] to the file of "
                    "an axle."
                )
        held = RestConditions()
        names = {wheel: self.names_of(wheel) for wheel in self.wheels}
        return straight(self.model, names, at(self, held, self.coordinates_at_rest(held)), speed)

    def require_driving(self) -> None:
        """Raise an `InputError` if the car does not drive."""
        if not self.car.drives:
            problem = (
                f'a car with car = "{self.car.described.car}" does not travel. Write car = "full" '
                "in its file, with [tyres]."
            )
            raise InputError([problem], self.heading)

    def riding(self) -> "CarAssembly":
        """Return the car on the same tyres whose body does not travel, which may be itself."""
        if not self.car.drives:
            return self
        return CarAssembly(Car.from_dict(self.car.to_dict() | {"car": "roll"} | self.car.axles))

    def require_riding(self) -> None:
        """Raise an `InputError` if the body travels."""
        if self.car.drives:
            problem = (
                'a car with car = "full" travels; a ride needs a car that does not. Write car = '
                '"roll"; in Python: car.with_changes({"car": "roll"}).'
            )
            raise InputError([problem], self.heading)

    def body_at(self, state: Array) -> dict[str, float]:
        """Return the pose of its body in a state: heave [m], pitch and roll [rad]."""
        names = self.model.state_names
        if not self.car.drives:
            return {name: float(state[names.index(name)]) for name in self.car.coordinates}
        at = names.index("body_e0")
        turned = rotation(state[at : at + 4])
        return {
            "heave": float(state[names.index("body_z")]),
            "pitch": float(np.arcsin(-turned[2, 0])),
            "roll": float(np.arctan2(turned[2, 1], turned[2, 2])),
        }

    def upright(self, camber: float) -> float:
        """Return the part of a tyre's force that is normal to the road [1].

        The load of a rolling tyre is normal to the road; other tyre forces are in the wheel plane.
        """
        return 1.0 if self.car.drives else float(np.cos(camber))

    # -- ride -------------------------------------------------------------------------------------

    @cached_property
    def _held_wheels(self) -> dict[str, "_HeldWheel"]:
        """The equations of each wheel on a held body."""
        found: dict[str, _HeldWheel] = {}
        for end, part in self.held.items():
            for side in part.wheels:
                wheel = f"{end}_{side}" if end else side
                model, signals, names = part.wheel_equations(side)
                before = f"{end}_" if end else ""
                in_car = {name: f"{before}{own}" for name, own in names.items()}
                found[wheel] = _HeldWheel(model, signals, in_car)
        return found

    def travels(self, states: Array) -> dict[str, Array]:
        """Return the heights of the wheel centres on the body above design, (n,) each [m].

        The rack is assumed in its middle.
        """
        return {
            wheel: one.travel(states, self.model.state_names)
            for wheel, one in self._held_wheels.items()
        }

    def travel_slopes(self, state: Array) -> dict[str, dict[str, float]]:
        """Return the derivatives of `travels` with respect to the coordinates of each wheel."""
        return {
            wheel: one.slopes(state, self.model.state_names)
            for wheel, one in self._held_wheels.items()
        }

    def felt_at(self) -> dict[str, Array]:
        """Return the points of measured body accelerations, from the centre of mass [m]."""
        seats = self.car.described.seat_places()
        places = {f"{name}_acceleration": place - self.car.com for name, place in seats.items()}
        return {"body_acceleration": np.zeros(3)} | places

    def behind(self) -> dict[str, float]:
        """Return the distance of each wheel behind the foremost one at design [m]."""
        x = {wheel: float(center[0]) for wheel, center in self.car.wheel_centers.items()}
        return {wheel: max(x.values()) - at for wheel, at in x.items()}

    @property
    def track(self) -> float:
        """The mean distance of left and right wheel centres at design [m]; 0 of a quarter car."""
        if not self.axles:
            return 0.0
        y = {wheel: center[1] for wheel, center in self.car.wheel_centers.items()}
        return float(np.mean([abs(y[f"{end}_left"] - y[f"{end}_right"]) for end in self.axles]))

    def mode_motions(self, state: Array) -> dict[str, tuple[float, dict[str, float]]]:
        """Return the reference motions that name modes: mass, and amplitude by coordinate.

        They are the motions of the body, and the heights of the wheel centres above the road, in
        phase and opposite. The mass of an axle is that of all its parts; of a pitch and a roll of
        the body it is a moment of inertia. `state` is the state of rest.
        """
        body, inertia = self.car.described.body, self.car.described.body.elements()
        of_body = {"heave": body.mass_kg, "pitch": inertia["yy"], "roll": inertia["xx"]}
        found = {name: (of_body[name], {name: 1.0}) for name in self.car.coordinates}
        heights = self._wheel_heights(state)
        for end, mass in suspension_masses(self.car).items():
            if not end:
                (height,) = heights.values()
                return found | {"hop": (mass, height)}
            left, right = (heights[f"{end}_{side}"] for side in (LEFT, RIGHT))
            for name, sign in (("hop", 1.0), ("tramp", -1.0)):
                shares = {k: 0.5 * left.get(k, 0.0) + 0.5 * sign * right.get(k, 0.0)
                          for k in {**left, **right}}  # fmt: skip
                found[f"{end}_{name}"] = mass, shares
        return found

    def _wheel_heights(self, state: Array) -> dict[str, dict[str, float]]:
        """Return the derivatives of the wheel centres' heights above the road, by coordinate."""
        found = {}
        for wheel, slopes in self.travel_slopes(state).items():
            x, y, _ = self.car.wheel_centers[wheel] - self.car.com if self.axles else np.zeros(3)
            by_body = {"heave": 1.0, "pitch": -x, "roll": y}
            found[wheel] = {n: by_body[n] for n in self.car.coordinates} | slopes
        return found

    def coordinates_at(self, position: RigPosition) -> Array:
        """Raise an `InputError`: a car begins at rest, or in a state of its equations."""
        problem = (
            "height: the motion of a car begins at rest, since its body moves, too. Leave it out."
        )
        raise InputError([problem], self.heading)


@dataclass(frozen=True)
class _HeldWheel:
    """The equations of a wheel on a held body, with the coordinates of a car."""

    model: Any
    prefix: str  # prefix of the names of its signals in the equations
    names: Mapping[str, str]  # coordinates of the car by those of the equations

    def _states(self, states: Array, of_car: Sequence[str]) -> Array:
        own = np.broadcast_to(
            self.model.design_state, (*states.shape[:-1], self.model.design_state.size)
        ).copy()
        for name, in_car in self.names.items():
            own[..., self.model.state_names.index(name)] = states[..., of_car.index(in_car)]
        return own

    def travel(self, states: Array, of_car: Sequence[str]) -> Array:
        name, model = f"{self.prefix}wheel_center_z", self.model
        found: Array = model.signal(name, self._states(states, of_car))
        return found - float(model.signal(name, model.design_state))

    def slopes(self, state: Array, of_car: Sequence[str]) -> dict[str, float]:
        model = self.model
        row = model.signal_names.index(f"{self.prefix}wheel_center_z")
        jacobian = model.evaluate("signals_jacobian", self._states(state, of_car))[row]
        return {
            in_car: float(jacobian[model.state_names.index(name)])
            for name, in_car in self.names.items()
        }


def _in_vehicle(car: Car) -> dict[str, AnyAxle]:
    """Return the axles with the data of the car that their characteristics need, by end.

    These are the data that ``[vehicle]`` in the file of an axle lacks.
    """
    height = float(1e3 * center_of_gravity(car)[2])
    known = {
        "wheelbase_mm": car.described.wheelbase_mm,
        # without it where the check of the car finds it impossible
        "center_of_gravity_height_mm": height if height >= 1e3 * LOWEST_CENTER else None,
        "front_brake_share": car.front_brake_share,
    }
    return {end: axle.in_vehicle(known) for end, axle in car.axles.items()}


def _held(part: Suspension | AnyAxle) -> HeldAssembly:
    """Return an axle, or the corner of a quarter car, on a held body."""
    return CornerAssembly(Model(part)) if isinstance(part, Suspension) else axle_assembly(part)
