"""Steady motion of a car straight ahead."""

from collections.abc import Mapping

import numpy as np

from ...core.errors import InputError
from ...core.named_types import Array
from ...equations.errors import ModelError
from ...systems.state import State
from ..models.car.equations import CarModel
from .assembly import WheelNames
from .controls import Controls

_MOST_STEPS, _HALVINGS = 40, 20
# Residual accelerations and velocities [m/s^2, rad/s^2, m/s].
_STEADY = 1e-8
# Scales of the unknown drive torque and rack relative to angles [N m, m].
_TORQUE, _RACK = 1e3, 0.1


def straight(
    model: CarModel, wheels: Mapping[str, WheelNames], rest: tuple[Array, Array], speed: float
) -> State:
    """Return the state of a car in steady motion straight ahead, along x of the world.

    The drive torque keeps the speed of the body's centre of mass [m/s], and the rack keeps a car
    with unequal sides straight; the state contains both as its inputs. `rest` are state and inputs
    at rest. Raises `InputError` if no such state is found.

    Newton's method with the exact Jacobians starts from the car at rest on wheels that roll at its
    speed. Unknown are height and attitude of the body, the coordinates of the suspensions, the
    velocity of the body, the spin of the wheels, the deflections of the tyres, drive torque and
    rack. Every acceleration vanishes, and the velocity of the body along x is given.
    """
    return _StraightSearch(model, wheels, speed).from_rest(*rest)


class _StraightSearch:
    def __init__(self, model: CarModel, wheels: Mapping[str, WheelNames], speed: float) -> None:
        self.model, self.wheels, self.speed = model, wheels, speed
        layout, self.names = model.layout, list(model.state_names)
        self.layout = layout
        spins = [names.spin for names in wheels.values()]
        places = {name: i for i, name in enumerate(self.names)}
        # directions of positions, except x and y of the body and the spin angles of the wheels
        idle = {layout.directions[places[name]] for name in ("body_x", "body_y", *spins)}
        self.moved = [i for i in layout.directions.values() if i not in idle]
        rates = [places[f"body_{name}"] for name in "uvw"] + [places[f"{s}_rate"] for s in spins]
        internal = range(layout.positions + layout.speeds, len(self.names))
        self.free = [*rates, *internal]
        self.columns = self._columns_of_inputs()

    def _columns_of_inputs(self) -> Array:
        """Return the directions of the unknown inputs, drive torque and rack."""
        names = list(self.model.input_names)
        drive, rack = Controls(self.model.car).drive(_TORQUE), {"rack_position": _RACK}
        unknown = [drive, rack] if self.model.car.steered() else [drive]
        columns = np.zeros((len(names), len(unknown)))
        for column, values in enumerate(unknown):
            for name, value in values.items():
                columns[names.index(name), column] = value
        return columns

    def from_rest(self, state: Array, inputs: Array) -> State:
        """Return the steady state, searched from a state of rest."""
        loads = {w: float(self.model.signal(n.load, state, inputs)) for w, n in self.wheels.items()}
        state, inputs = state.copy(), inputs.copy()
        state[self.names.index("body_u")] = self.speed
        for wheel, names in self.wheels.items():
            found = self.model.car.tyre(wheel).evaluate(loads[wheel], extrapolate=True)
            rate = self.names.index(f"{names.spin}_rate")
            state[rate] = self.speed / float(found.effective_radius)
        left = self._left(state, inputs)
        for _ in range(_MOST_STEPS):
            if np.abs(left).max() <= _STEADY:
                break
            step, changed = self._step(state, inputs, left)
            state, inputs, left, moved = self._shortened(state, inputs, left, step, changed)
            if not moved:
                break
        if np.abs(left).max() > _STEADY:
            problem = (
                f"no steady motion straight ahead at {self.speed:g} m/s was found: "
                f"{np.abs(left).max():.3g} m/s^2 or rad/s^2 are left. Try another speed, and see "
                "that tyres, drive and the sides of the car allow it."
            )
            raise InputError([problem], "running")
        return State.of(state, inputs, self.model.names_of_states)

    def _left(self, state: Array, inputs: Array) -> Array:
        """Return the residuals: velocity except the speed, accelerations, rates of tyres."""
        rates = self.model.evaluate("rhs", state, inputs)
        along = rates[:3] - [self.speed, 0.0, 0.0]
        return np.concatenate((along, rates[self.layout.positions :]))

    def _step(self, state: Array, inputs: Array, left: Array) -> tuple[Array, Array]:
        """Return the change of state and of inputs by Newton's method."""
        positions = self.layout.positions
        directions = np.zeros((len(state), len(self.moved) + len(self.free)))
        directions[:positions, : len(self.moved)] = self.layout.basis(state)[:, self.moved]
        directions[self.free, range(len(self.moved), directions.shape[1])] = 1.0
        rows = [0, 1, 2, *range(positions, len(state))]
        by_state = self.model.evaluate("rhs_jacobian", state, inputs)[rows] @ directions
        by_input = self.model.evaluate("rhs_input_jacobian", state, inputs)[rows] @ self.columns
        unknown = np.linalg.lstsq(np.hstack((by_state, by_input)), -left, rcond=1e-12)[0]
        count = directions.shape[1]
        return directions @ unknown[:count], self.columns @ unknown[count:]

    def _shortened(
        self, state: Array, inputs: Array, left: Array, step: Array, changed: Array
    ) -> tuple[Array, Array, Array, bool]:
        """Return state, inputs and residuals after a step, halved until the residuals decrease.

        The last item is False if no part of the step decreases them.
        """
        part = 1.0
        for _ in range(_HALVINGS):
            moved, acting = self.layout.normalised(state + part * step), inputs + part * changed
            part *= 0.5
            try:
                after = self._left(moved, acting)
            except ModelError:
                continue
            if np.linalg.norm(after) < np.linalg.norm(left):
                return moved, acting, after, True
        return state, inputs, left, False
