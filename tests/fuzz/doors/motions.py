"""Drops and impulses near dead points, springs of zero length, against a tight reference.

A motion is drawn whose start lies somewhere between the design position and a dead point, with
rates that may carry it there. The reference is SciPy's DOP853 at 1e-11 with short steps around
the bare right-hand side: it shares no code with what watches the margins in an integration. It
ends where a height, the root of a margin, goes through zero, which it sees in a straight line of
the height over time; so does the distance of a spring's ends where they meet. What a result says
has to agree: it ends there with an error, or it goes on and its states are those of the reference,
and its signals can be had at all of its outputs. At some of its states the mechanism in maximal
coordinates, which shares nothing with the equations, says whether hardpoints keep their distances
and what the accelerations are.
"""

from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from kintrafo import Model, SimulationError, System, simulate
from kintrafo.equations.errors import ModelError
from kintrafo.generated import (
    andrews,
    excavator,
    excavator_lifting,
    four_bar,
    front_axle,
    macpherson_free_rack,
    slider_crank,
)
from kintrafo.generator.mechanisms import MODELS
from kintrafo.simulation.solvers import native_methods
from mechanisms.every_closed_form import NORMAL, askew, declare, hinge
from scipy.integrate import DOP853
from support.models import Built, own

from ..attempts import UnjudgedError, WrongError

SHORT = 4
SECONDS = 60.0

_MODULES = (
    four_bar,
    slider_crank,
    andrews,
    excavator,
    excavator_lifting,
    front_axle,
    macpherson_free_rack,
)
_CARS = ("reference_car", "double_wishbone_car", "offset_strut_car")
METHODS = tuple(dict.fromkeys([*native_methods(), "Radau", "LSODA", "RK45", "DOP853"]))

# The seat on the ground is on the circle of that on the arm, 1.2 rad from design.
ON_AN_ARM = declare(
    "spring_on_an_arm",
    {"arm": askew(0.2, 0.02)},
    (hinge("pin", "ground", "arm", "arm_pin", "normal"),),
    {
        "arm_pin": askew(0.0, 0.0),
        "ground_seat": askew(0.3 * 0.3623577544766736, 0.3 * 0.9320390859672263),
        "arm_seat": askew(0.3, 0.0),
    },
    {"normal": NORMAL},
    ("pin",),
    spring=("ground_seat", "arm_seat"),
)

# With two coordinates seats pass each other, at any distance.
ON_TWO_ARMS = declare(
    "spring_on_two_arms",
    {"arm": askew(0.15, 0.02), "hand": askew(0.4, 0.01)},
    (
        hinge("pin", "ground", "arm", "arm_pin", "normal"),
        hinge("elbow", "arm", "hand", "elbow_pin", "normal"),
    ),
    {
        "arm_pin": askew(0.0, 0.0),
        "elbow_pin": askew(0.3, 0.0),
        "ground_seat": askew(0.25, 0.2),
        "hand_seat": askew(0.5, 0.0),
    },
    {"normal": NORMAL},
    ("pin", "elbow"),
    spring=("ground_seat", "hand_seat"),
)

SPRINGS_OF_ZERO_LENGTH = (ON_AN_ARM, ON_TWO_ARMS)


@cache
def systems():
    """Return what is moved."""
    return (
        *(System(module) for module in _MODULES),
        *(Model(name) for name in _CARS),
        *(System(own(model)) for model in SPRINGS_OF_ZERO_LENGTH),
    )


@dataclass(frozen=True)
class Motion:
    """The motion of an attempt.

    Attributes
    ----------
    system : System
    start : ndarray
        The state at time zero.
    end : float
        Last time; before zero for a motion that is followed backwards [s].
    method : str
    rtol : float
    outputs : ndarray or None
    """

    system: System
    start: np.ndarray
    end: float
    method: str
    rtol: float
    outputs: np.ndarray | None

    @property
    def atol(self):
        """The absolute tolerance."""
        return 1e-3 * self.rtol


def drawn(random):
    """Return a random motion."""
    system = systems()[random.integers(len(systems()))]
    start = _start(system, random)
    end = 10.0 ** random.uniform(-1.5, -0.3) * (1.0 if random.random() < 0.9 else -1.0)
    outputs = None
    if random.random() < 0.5:
        outputs = np.linspace(0.0, end, int(random.integers(2, 400)))
    return Motion(
        system,
        start,
        end,
        str(random.choice(METHODS)),
        10.0 ** random.uniform(-10.0, -3.0),
        outputs,
    )


def _start(system, random):
    """Return a state on the way from design to where the loops close no more, and rates."""
    half = system.design_state.size // 2
    design = system.design_state[:half]
    way = random.normal(size=half) * _reach(system)
    near, far = 0.0, 1.0
    while _closes(system, design + far * way) and far < 64.0:
        far *= 2.0
    for _ in range(40):
        middle = 0.5 * (near + far)
        near, far = (middle, far) if _closes(system, design + middle * way) else (near, middle)
    share = 1.0 - 10.0 ** random.uniform(-4.0, 0.0)
    rates = random.normal(size=half) * _reach(system) * 10.0 ** random.uniform(-1.0, 2.0)
    if random.random() < 0.3:
        rates = np.zeros(half)
    return np.concatenate([design + share * near * way, rates])


def _reach(system):
    """Return by how much each coordinate may be moved at a time."""
    names = system.state_names[: system.design_state.size // 2]
    units = [system.equations.STATE[name]["unit"] for name in names]
    return np.array([0.1 if unit == "rad" else 0.02 for unit in units])


def _closes(system, coordinates):
    state = np.concatenate([coordinates, np.zeros_like(coordinates)])
    try:
        system.evaluate("rhs", state)
    except ModelError:
        return False
    return True


# -- the reference --------------------------------------------------------------------------------

# Steps of the reference, as parts of the time: so short that a height is a straight line over some
# of them, and so short that it is one down to zero. A motion that needs very many is not judged.
_LONGEST, _SHORTEST, _MOST = 1.0 / 300.0, 1e-5, 4000


@dataclass(frozen=True)
class Reference:
    """The tight reference.

    Attributes
    ----------
    time : float
        When the motion came to its dead point, or its end [s].
    dead : bool
        Whether it did.
    state : ndarray
        The state there.
    """

    time: float
    dead: bool
    state: np.ndarray


def reference(motion):
    """Follow a motion as well as double precision can; None for one that is too fast for that."""
    system, sign, whole = motion.system, np.sign(motion.end), abs(motion.end)
    time, state, step = 0.0, motion.start, _SHORTEST * whole
    solver, fresh = _begun(motion, time, state, step), True
    for _ in range(_MOST):
        failed = False
        try:
            solver.step()
        except ModelError:
            failed = True
        # a step that fails was up to ten times longer than the last: only a first one is known
        took = (step if fresh else 4.0 * step) if failed else abs(solver.t - time)
        if failed or _through_zero(system, (time, state), (solver.t, solver.y)):
            step = 0.25 * took
            if step < _SHORTEST * whole:
                left = _left(system, state, sign * step)
                return Reference(time + sign * min(left, step), dead=True, state=state)
            solver, fresh = _begun(motion, time, state, step), True
            continue
        time, state, step, fresh = solver.t, solver.y, took, False
        left = _left(system, state, sign * step)
        if left < _SHORTEST * whole:
            return Reference(time + sign * left, dead=True, state=state)
        if solver.status == "finished":
            return Reference(time, dead=False, state=state)
    return None


def _begun(motion, time, state, step):
    return DOP853(
        lambda _, y: motion.system.evaluate("rhs", y),
        time,
        state,
        motion.end,
        max_step=_LONGEST * abs(motion.end),
        first_step=min(step, abs(motion.end - time)),
        rtol=1e-11,
        atol=1e-13,
    )


def _heights(system, state, lapse):
    """Return the roots of the margins that positions and forces need, and their rates."""
    acting = system.equations.ACTING_GUARDS
    needed = set(acting["positions"]) | set(acting["forces"])
    chosen = sorted(set(acting["rhs"]) & needed)
    half = state.size // 2
    move = np.concatenate([lapse * state[half:], np.zeros(half)])
    # to both sides: the motion is no straight line, and a height is a small root of what changes
    three = np.stack([state - move, state, state + move])
    before, now, after = system.evaluate("margins", three)[:, chosen]
    height = np.sqrt(np.maximum(now, 0.0))
    return height, (after - before) / (4.0 * lapse * np.maximum(height, 1e-300))


def _through_zero(system, before, after):
    """Return whether a height falls to zero and rises again within a step, seen from both ends."""
    step = after[0] - before[0]
    if step == 0.0:
        return True
    height, rate = _heights(system, before[1], step / 64.0)
    falls = height + step * rate <= 0.0
    if not falls.any():
        return False
    height, rate = _heights(system, after[1], -step / 64.0)
    return bool((falls & (height - step * rate <= 0.0)).any())


def _left(system, state, step):
    """Return the time until a height is zero, by a straight line."""
    height, rate = _heights(system, state, step / 64.0)
    speed = -rate * np.sign(step)
    falling = speed > 0.0
    return float((height[falling] / speed[falling]).min(initial=np.inf))


# -- the attempt ----------------------------------------------------------------------------------


def attempt(random):
    motion = drawn(random)
    try:
        motion.system.evaluate("rhs", motion.start)
    except ModelError as error:
        raise UnjudgedError("the start itself is beyond a dead point") from error
    expected = reference(motion)
    if expected is None:
        raise UnjudgedError("too fast to be followed by the reference")
    ended = _moved(motion)
    _judge(motion, expected, ended)
    refused = isinstance(ended, SimulationError)
    _judge_states(motion, ended.partial if refused else ended)
    if refused:
        raise ended


def _moved(motion):
    """Return what comes of a motion, or the error that ends it."""
    try:
        return simulate(
            motion.system,
            (0.0, motion.end),
            motion.start,
            method=motion.method,
            rtol=motion.rtol,
            atol=motion.atol,
            t_eval=motion.outputs,
            max_steps=200_000,
        )
    except SimulationError as error:
        return error


def _wrong(motion, text):
    name = motion.system.equations.NAME
    raise WrongError(f"{name} by {motion.method} at {motion.rtol:.1e} to {motion.end:g} s: {text}")


def _judge(motion, expected, ended):
    ends = f"the reference {'ends' if expected.dead else 'goes on'} at {expected.time:.9g} s"
    if isinstance(ended, SimulationError):
        text = f"refused at {ended.time:.9g} s ({str(ended)[:300]})"
    else:
        text = "goes on"
        _check_signals(motion, ended)
    if isinstance(ended, SimulationError) != expected.dead:
        _wrong(motion, f"{text}, and {ends}")
    off = _off(motion, expected, ended)
    if off > 1.0 and not _mended(motion, expected, off):
        _wrong(motion, f"{text}, {off:.3g} times what the tolerance lets expect; {ends}")


def _check_signals(motion, result):
    try:
        list(result.signals.items())
    except ModelError as error:
        _wrong(motion, f"success, and signals that cannot be had: {error}")


def _off(motion, expected, ended):
    """Return the distance from the reference, as a multiple of what the tolerance lets expect.

    Errors of a step add up to some hundred tolerances over an oscillation or two; and the
    reference ends a 100,000th of its time before a dead point, and goes on in a straight line.
    """
    slack = abs(motion.end) * (300.0 * motion.rtol + 1e-4)
    if isinstance(ended, SimulationError):
        return abs(ended.time - expected.time) / slack
    # rates change by some thousand a second near a dead point
    allowed = 1e3 * slack * (1.0 + np.abs(expected.state).max())
    return float(np.abs(ended.y[:, -1] - expected.state).max() / allowed)


def _mended(motion, expected, off):
    """Return whether it was no more than a loose tolerance: a tight one brings it to the reference.

    A motion that has bounced off a dead point, or was refused without one, does not come nearer.
    """
    ended = _moved(replace(motion, rtol=max(1e-2 * motion.rtol, 1e-12)))
    same = isinstance(ended, SimulationError) == expected.dead
    return same and _off(motion, expected, ended) < 0.25 * off


# -- in maximal coordinates -----------------------------------------------------------------------

# Part of a margin's usual size. Near a dead point what is a rounding of a length is more of an
# angle, by the root of this, and of an acceleration, by its third power.
_FAR = 1e-2
_STATES = 3


def _judge_states(motion, result):
    """Hold the first, the last and a middle state, as far as they are far from dead points."""
    system, built = motion.system, _built(motion.system)
    for place in np.linspace(0, result.t.size - 1, _STATES).astype(int):
        state, inputs = result.y[:, place], result.inputs[place]
        if (system.evaluate("margins", state, inputs) < _FAR * system.usual_margins).any():
            continue
        at = built.motion(state, inputs)
        gap = np.abs(built.oracle.closure(at).value).max()
        axes = at.rotation @ np.swapaxes(at.rotation, 1, 2) - np.eye(3)
        if gap > 1e-9 or np.abs(axes).max() > 1e-9:
            _wrong(motion, f"joints {gap:.3g} m open, axes {np.abs(axes).max():.3g} off")
        given = dict.fromkeys(built.model.motions, 0.0)  # nothing is driven
        expected = built.oracle.reduced(at, built.named(inputs), given).accelerations
        found = system.evaluate("rhs", state, inputs)[built.size :]
        # centripetal accelerations are what roundings are a part of, where they cancel
        scale = np.abs(expected).max() + np.square(state[built.size :]).max()
        off = np.abs(found - expected).max()
        if off > 1e-7 * (1.0 + scale):
            _wrong(motion, f"accelerations {found}, in maximal coordinates {expected}")


@cache
def _built(system):
    known = {model.name: model for model in (*MODELS, *SPRINGS_OF_ZERO_LENGTH)}
    model = known[system.equations.NAME]
    return Built.of(model, system.equations, system.parameters)
