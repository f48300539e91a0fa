"""Loads on every part of a car that drives, by the equations of Newton and Euler.

Each axle is balanced in the axes of the body, in which its linkages move as on a held body. The
motion of the body enters by the accelerations of the parts, the direction of weights in these axes,
and the forces of rolling tyres.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np
import xarray as xr

from ....core.named_types import Array
from ....core.vectors import cross, unit_vector
from ...assembly.car import CarAssembly
from ...assembly.coupling import STEERING
from ...assembly.load import Load
from ...assembly.part_poses import CENTER, CONTACT, PartPoses
from ...assembly.steering_linkage import steering_force
from ...corner.corner import RoadWheel
from ...corner.structure import GROUND
from ...models.sides import SIDES
from .applied_loads import WHEEL, of_wheel
from .dataset import AXIS, LOAD, PART, BalancedLoads
from .inertia import PartTwists
from .mounts import ALL, MOUNT

# Names of parts and loads that both axles share.
_SHARED = (*GROUND, "gravity", "inertia", "mass", STEERING, ALL)
_ALONG = (LOAD, "moving_part", MOUNT, "wheel")
_AT = ("at", "at_in_part", "total_at")


class CarInMotion:
    """A car that drives, in n states with inputs."""

    def __init__(self, assembly: CarAssembly, states: Array, inputs: Array) -> None:
        self.assembly, self.states, self.inputs = assembly, states, inputs
        self.model = assembly.model
        columns = dict(zip(self.model.state_names, states.T, strict=True))
        self._values = columns | dict(zip(self.model.input_names, inputs.T, strict=True))
        if (rack := assembly.rack_state) is not None:  # its inputs are those of a rigid column
            self._values |= {
                "rack_position": self._values[rack],
                "rack_velocity": self._values[f"{rack}_rate"],
            }

    @cached_property
    def body(self) -> Array:
        """The rotation of the body from design, (n, 3, 3)."""
        place = self.model.equations.BODIES.index("body")
        return self.model.evaluate("orientations", self.states, self.inputs)[:, place]

    @cached_property
    def up(self) -> Array:
        """The normal of the road in the axes of the body, (n, 3)."""
        return self.body[:, 2]

    @cached_property
    def upward(self) -> Array:
        """The direction opposite to gravity in the axes of the body, (n, 3)."""
        along = unit_vector([self.model.parameters[f"upward_{axis}"] for axis in "xyz"])
        return np.einsum("nji,j->ni", self.body, along)

    @cached_property
    def signals(self) -> dict[str, Array]:
        """The signals of its equations, each (n,)."""
        return self.model.signals(self.states, self.inputs)

    @cached_property
    def twists(self) -> PartTwists:
        """Velocities and accelerations of its parts in the world, in the axes of the body."""
        by_time = self.model.evaluate("rhs", self.states, self.inputs)
        names, rates = self.model.input_names, np.zeros_like(self.inputs)
        for name, entry in self.model.equations.INPUTS.items():
            if entry["derivative_of"] is not None:
                rates[:, names.index(entry["derivative_of"])] = self.inputs[:, names.index(name)]
        found = PartTwists.of(self.model, self.states, self.inputs, by_time, rates)
        return replace(found, twists=self._seen(found.twists), rates=self._seen(found.rates))

    def _seen(self, twists: Array) -> Array:
        """Return the components of pairs of vectors, (n, parts, 6), along the axes of the body."""
        pairs = twists.reshape(*twists.shape[:-1], 2, 3)
        found: Array = np.einsum("nji,npkj->npki", self.body, pairs)
        return found.reshape(twists.shape)

    def axle(self, end: str) -> BalancedLoads:
        """Return the loads on an axle in its own axes; a dead point is a `PositionError`."""
        axle, begin = self.assembly.held[end], f"{end}_"
        own = (begin, "rack_") if end == "front" else (begin,)  # a rear rack is fixed to the body
        values = {
            name.removeprefix(begin): value
            for name, value in self._values.items()
            if name.startswith(own)
        }
        poses = axle.parts_with(values, len(self.states))
        known = {}
        for suffix, loads in axle.acting(poses).items():
            acting = [
                replace(load, force=load.force[..., 2:] * self.upward)
                if load.by == "gravity"
                else load
                for load in loads
            ]
            further = self._on_wheels, self._inertia
            known[suffix] = acting + [
                load for each in further for load in each(end, suffix, poses[suffix])
            ]
        return BalancedLoads.of(axle, poses, known)

    def _inertia(self, end: str, suffix: str, group: PartPoses) -> Iterator[Load]:
        """Yield the inertia of each part, as loads."""
        begin = f"{end}{suffix}_"
        names = tuple(name.removeprefix(begin) for name in self.twists.bodies)
        twists = replace(self.twists, bodies=names)
        for part, mass in group.masses().items():
            yield twists.load(part, mass, group.turned[part], group.centers[part])

    def _on_wheels(self, end: str, suffix: str, group: PartPoses) -> Iterator[Load]:
        """Yield the forces of the road, and torques whose reaction is on the body."""
        for part, wheel in group.wheels.items():
            side = (suffix or part).rpartition("_")[2]
            yield from of_wheel(part, [*self._on_wheel(end, f"{end}_{side}", wheel)])

    def _on_wheel(self, end: str, name: str, wheel: RoadWheel) -> Iterator[Load]:
        """Yield the loads on a wheel in the equations of the tyre, see `generator.RollingTyre`."""
        left, up = wheel.vehicle.side * wheel.axis, self.up
        leaning = cross(left, up)
        cosine = np.linalg.norm(leaning, axis=-1)
        forward = leaning / cosine[:, None]
        across = cross(up, forward)
        down = cross(left, forward)
        axes = np.stack([forward, across, up], axis=1)
        forces, moments = (
            np.stack([self.signals[f"{name}_{what}{axis}"] for axis in "xyz"], axis=-1)
            for what in ("f", "m")
        )
        # the normal force acts at the lowest point, others where the plane meets the road
        road = self._values[self.assembly.names_of(name).road]
        height = self.signals[f"{name}_wheel_center_z"] - road
        below = (self.signals[f"{name}_deflection"] / cosine)[:, None]
        lower = cross(below * down, forces[:, 2:] * up)
        at = wheel.center + (height / cosine)[:, None] * down
        force, moment = (np.einsum("na,nai->ni", each, axes) for each in (forces, moments))
        yield Load(WHEEL, CONTACT, "road", force, moment + lower, at)
        torque = self._by_shaft(end, name)
        if torque is not None:
            yield Load(WHEEL, CENTER, "shaft", np.zeros(3), torque[:, None] * left, wheel.center)

    def _by_shaft(self, end: str, name: str) -> Array | None:
        """Return the torque of brakes and drive on the body, if any; others load the bearing."""
        axle = self.assembly.held[end]
        kinds = {"brake": axle.torque_on("brakes"), "drive": axle.torque_on("drive")}
        torques = [
            self.signals[f"{name}_{kind}_moment"]
            for kind, on in kinds.items()
            if on == "body" and f"{name}_{kind}_moment" in self.signals
        ]
        return np.sum(torques, axis=0) if torques else None


def rack_force(assembly: CarAssembly, states: Array, inputs: Array) -> Array:
    """Return the force of the steering along the rack, see `steering_force`, (n,) [N]."""
    front = CarInMotion(assembly, states, inputs).axle("front")
    loads = [load for own in front.loads.values() for load in own]
    return steering_force(next(iter(front.poses.values())), loads)


def of_car(assembly: CarAssembly, states: Array, inputs: Array) -> xr.Dataset:
    """Return the loads in states of a car that drives, (n, states), over time."""
    motion = CarInMotion(assembly, states, inputs)
    return _together(
        {
            end: _named(motion.axle(end).dataset(), end, assembly.car.origins[end])
            for end in assembly.held
        }
    )


def _named(found: xr.Dataset, end: str, origin: float) -> xr.Dataset:
    """Return the loads of an axle with names and axes of the car, its origin at x = `origin`."""
    names = {
        key: [_name(str(name), end) for name in found[key].values]
        for key in (PART, "point", "by", "moving_part", MOUNT)
    }
    wheels = [f"{end}_{side}" for side in found[WHEEL].values]
    rows = zip(names[PART], names["point"], names["by"], strict=True)
    labels = {
        LOAD: [f"{part} at {point} by {by}" for part, point, by in rows],
        **{key: (LOAD, names[key]) for key in (PART, "point", "by")},
        "moving_part": names["moving_part"],
        MOUNT: names[MOUNT],
        WHEEL: found[WHEEL].copy(data=np.array(wheels)),
    }
    moved, shift = {}, xr.DataArray([origin, 0.0, 0.0], dims=AXIS)
    for name in _AT:
        at = found[name]
        moved[name] = (at + shift).transpose(*at.dims).assign_attrs(at.attrs)
    by = [
        ", ".join(_name(one, end) for one in str(text).split(", "))
        for text in found["total_by"].values
    ]
    moved["total_by"] = found["total_by"].copy(data=np.array(by))
    own = {name: f"{end}_{name}" for name in ("bar_torque", "rack_force") if name in found}
    return found.assign(moved).rename(own).assign_coords(labels)


def _name(name: str, end: str) -> str:
    if name in _SHARED and (name not in GROUND[1:] or end == "front"):
        return name
    stem, _, side = name.rpartition("_")
    return f"{stem}_{end}_{side}" if side in SIDES else f"{name}_{end}"


def _together(found: Mapping[str, xr.Dataset]) -> xr.Dataset:
    """Return the loads of both axles as those of the car."""
    parts = list(found.values())
    every = dict.fromkeys(str(name) for one in parts for name in one.variables)
    data = {name: _joined([one[name].variable for one in parts if name in one]) for name in every}
    rules = dict.fromkeys(rule for one in parts for rule in one.attrs["rules"].split("; ") if rule)
    joined = xr.Dataset(data, attrs={"rules": "; ".join(rules)})
    return joined.set_coords([name for name in parts[0].coords if name in joined])


def _joined(variables: Sequence[xr.Variable]) -> xr.Variable:
    """Return the variables of both axles, joined along the dimension of each axle."""
    along = [name for name in _ALONG if name in variables[0].dims]
    first = variables[0]
    if not along:
        return first
    values = [one.transpose(*first.dims).values for one in variables]
    joined = np.concatenate(values, axis=first.dims.index(along[0]))
    return xr.Variable(first.dims, joined, first.attrs)
