"""Motions of axles with different sides, compared with DOP853, energies and single sides.

The packaged axle, two suspensions that are no mirror images of each other on one rack and with a
bar, or a beam on rods are kicked over roads of their own. The reference is DOP853 at 1e-11 around
the bare right-hand side. That in turn is held at some states against the mechanism in maximal
coordinates; where nothing takes or gives energy, the oracle's sum of energies must stay; and where
the bar has no rate, each side moves as it does alone.
"""

from dataclasses import dataclass, field

import numpy as np
from cars.axles import BAR_OF_WISHBONES
from kintrafo import Axle, AxleModel, Model, RigidAxle, RigidAxleModel, Suspension, System, simulate
from kintrafo.equations.errors import ModelError
from kintrafo.generated import front_axle
from kintrafo.generator.mechanisms import model_named
from kintrafo.simulation.solvers import native_methods
from kintrafo.systems.compile.compiler import find_compiler
from kintrafo.vehicle.models.axle.equations import declared
from scipy.integrate import solve_ivp
from support.models import Built

from ..attempts import UnjudgedError, WrongError
from ..courses import AT_REST, Sine
from .axles import moved

SHORT = 4
SECONDS = 60.0
METHODS = tuple(dict.fromkeys([*native_methods(), "Radau", "DOP853"]))
SIDES = ("right", "left")
RATES = ("spring_rate", "damper_rate", "tyre_rate")
PACKAGED = Axle.load("reference_axle")
WISHBONES = Suspension.load("double_wishbone_car")
BEAM = RigidAxle.load("rigid_axle")
# Of coordinates [rad, m]: errors of steps at 1e-8 add up to a hundred tolerances over some
# oscillations.
_TOLERANCE = 1e-6
# Of the reference, whose errors of steps at 1e-11 add up in the same way, as a part of the size;
# where stops begin to act between two steps, to some thousand.
_CLOSE = 1e-8
# Part of a margin's usual size: nearer to a dead point the oracle's joints are rounded, too.
_FAR = 1e-2
# Of accelerations, as of the door `motions`.
_ACCELERATIONS = 1e-7


@dataclass
class Drawn:
    """The model that moves.

    Attributes
    ----------
    built : Built
        The equations with their values, and the mechanism in maximal coordinates.
    start : ndarray
    end : float
        Last time [s].
    roads : dict of str to Sine
        Of each side.
    rack : Sine
        Displacement of the rack, where there is one.
    sides : dict of str to Model
        The suspension of each side, if nothing but the rack joins them.
    lossless : bool
        Whether nothing takes or gives energy.
    """

    built: Built
    start: np.ndarray
    end: float
    roads: dict[str, Sine] = field(default_factory=lambda: dict.fromkeys(SIDES, AT_REST))
    rack: Sine = AT_REST
    sides: dict[str, Model] = field(default_factory=dict)
    lossless: bool = False

    def inputs(self, time):
        """Return all inputs in their order."""
        given = _rack_at(self.rack, time)
        for side, road in self.roads.items():
            given |= {f"{side}_{name}": value for name, value in _road_at(road, time).items()}
        return np.array([given.get(name, 0.0) for name in self.built.module.INPUTS])


def _road_at(road, time):
    return {"road_height": road(time), "road_velocity": road.rate(time)}


def _rack_at(rack, time):
    return {
        "rack_position": rack(time),
        "rack_velocity": rack.rate(time),
        "rack_acceleration": rack.second_rate(time),
    }


def attempt(random):
    """Move an axle, and hold it against each of its references."""
    kinds = [_packaged, _beam, *([_two_sides] * 2 if find_compiler() else [])]
    drawn = kinds[random.integers(len(kinds))](random)
    try:
        reference = _followed(drawn.built.module, drawn.built.constants, drawn.inputs, drawn)
    except ModelError as error:
        raise UnjudgedError("a dead point is reached") from error
    last = reference.y[:, -1]
    margins = drawn.built("margins", last, drawn.inputs(drawn.end))
    if (margins < _FAR * System(drawn.built.module, drawn.built.parameters).usual_margins).any():
        raise UnjudgedError("a dead point is near")
    for time, state in ((0.0, drawn.start), (drawn.end, last)):
        _judge_accelerations(drawn, time, state)
    _judge_energy(drawn, last)
    _judge_sides(drawn, last)
    _judge_motion(drawn, last, random)


def _packaged(random):
    """Return the packaged axle, whose sides are mirror images on roads of their own."""
    return _drawn(random, model_named("front_axle"), System(front_axle), PACKAGED.models)


def _two_sides(random):
    # with a stop on both sides the equations are always the same, and derived once
    def side():
        stop = {"clearance_mm": float(random.uniform(1.0, 20.0)), "rate_N_per_m": 1e5}
        return moved(random, WISHBONES).with_changes({"bump_stop": stop})

    axle = Axle.from_dict(
        {
            "axle": "rear",
            "right": side(),
            "left": side().mirrored(),
            "anti_roll_bar": BAR_OF_WISHBONES,
        }
    )
    return _drawn(random, declared(axle), AxleModel(axle), axle.models)


def _beam(random):
    places = {
        f"rods.{name}.{end}": (np.array(getattr(rod, end)) + random.uniform(-20, 20, 3)).tolist()
        for name, rod in BEAM.rods.items()
        for end in ("chassis", "axle")
    }
    model = RigidAxleModel(BEAM.with_changes(places))
    return _drawn(random, model_named("rigid_axle"), model, {})


def _drawn(random, declaration, system, sides):
    """Return an axle with rates, kicks and roads; what has no bar between its sides with them."""
    what = str(random.choice(["driven", "lossless", "apart"] if sides else ["driven", "lossless"]))
    values = _values(random, system, lossless=what == "lossless")
    if what == "apart":
        values["bar_rate"] = 0.0
    built = Built.of(declaration, system.equations, values)
    half = built.size
    spins = np.array(["spin" in name for name in system.state_names[:half]])
    kick = random.normal(size=half) * np.where(spins, 30.0, 0.3)
    drawn = Drawn(
        built, np.concatenate([built.design, kick]), float(10.0 ** random.uniform(-1.5, -0.7))
    )
    if what == "lossless":
        drawn.lossless = True
        return drawn
    drawn.roads = {side: _sine(random, 0.01) for side in SIDES}
    drawn.rack = _sine(random, 0.005) if declaration.motions else AT_REST
    drawn.sides = sides if what == "apart" else {}
    return drawn


def _values(random, system, *, lossless):
    """Return parameters whose rates are others on each side, where a side has its own."""
    values = dict(system.parameters)
    for name in [n for n in values if n.removeprefix("left_") in RATES]:
        values[name] *= 10.0 ** random.uniform(-0.3, 0.3)
        if lossless:
            # no wheel stands on the road, and springs push gently where they go
            values[name] *= 0.1 if name.endswith("spring_rate") else 0.0
    return values


def _sine(random, size):
    return Sine(size * random.normal(), 2.0 * np.pi * random.uniform(0.5, 8.0))


def _followed(module, constants, inputs, drawn, start=None):
    """Integrate the bare right-hand side as tightly as double precision allows."""
    return solve_ivp(
        lambda t, y: module.rhs(y, inputs(t), constants),
        (0.0, drawn.end),
        drawn.start if start is None else start,
        "DOP853",
        rtol=1e-11,
        atol=1e-13,
        max_step=0.005,
    )


def _judge_accelerations(drawn, time, state):
    """Hold the equations against the mechanism in maximal coordinates."""
    built, inputs = drawn.built, drawn.inputs(time)
    at, named = built.motion(state, inputs), built.named(inputs)
    given = {joint: named[m.rates[1]] for joint, m in built.model.motions.items()}
    expected = built.oracle.reduced(at, named, given).accelerations
    found = built("rhs", state, inputs)[built.size :]
    scale = 1.0 + np.abs(expected).max() + np.square(state[built.size :]).max()
    if not np.abs(found - expected).max() <= _ACCELERATIONS * scale:
        raise WrongError(f"accelerations {found} at {time} s, in maximal coordinates {expected}")


def _judge_energy(drawn, last):
    if not drawn.lossless:
        return
    built, none = drawn.built, drawn.inputs(0.0)
    first, end = (built.oracle.energy(built.motion(y, none)) for y in (drawn.start, last))
    # what is exchanged is of the size of what springs and weight hold
    if not abs(end - first) <= _CLOSE * max(abs(first), 1.0):
        raise WrongError(f"{built.module.NAME}: {first} J at first, {end} J after {drawn.end} s")


def _judge_sides(drawn, last):
    names = list(drawn.built.module.STATE)
    for side, model in drawn.sides.items():
        own = [names.index(f"{side}_{name}") for name in model.state_names]
        prefix = "left_" if side == "left" else ""
        values = drawn.built.parameters
        rates = {name: values.get(f"{prefix}{name}", values[name]) for name in RATES}
        constants = model.equations.prepare({**model.parameters, **rates})

        def inputs(time, side=side, model=model):
            given = _rack_at(drawn.rack, time) | _road_at(drawn.roads[side], time)
            return np.array([given.get(name, 0.0) for name in model.input_names])

        alone = _followed(model.equations, constants, inputs, drawn, drawn.start[own]).y[:, -1]
        if not (np.abs(last[own] - alone) <= _CLOSE * (1.0 + np.abs(alone).max())).all():
            raise WrongError(f"the {side} side moves to {last[own]}, alone to {alone}")


def _judge_motion(drawn, last, random):
    built, method = drawn.built, str(random.choice(METHODS))
    courses = {f"{side}_road_height": road for side, road in drawn.roads.items()}
    if built.model.motions:  # a rack
        courses["rack_position"] = drawn.rack
    found = simulate(
        System(built.module, built.parameters), (0.0, drawn.end), drawn.start, inputs=courses,
        method=method, rtol=1e-8, atol=1e-11, t_eval=[drawn.end],
    )  # fmt: skip
    off = np.abs(found.y[:, -1] - last)[: built.size]
    if not (off <= _TOLERANCE * (1.0 + np.abs(last[: built.size]))).all():
        raise WrongError(f"{built.module.NAME} by {method}: {off} off after {drawn.end} s")
