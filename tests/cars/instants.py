"""The compiled models, and cars and instants at which several tests compare them with the oracles.

An instant is given in the words of the oracles; the generated models name the same quantities
after the paper: beta1 the arm angle, beta5 the spin angle, beta9 or an input the rack.
"""

from dataclasses import dataclass
from types import ModuleType

import numpy as np
from kintrafo.generated import macpherson, macpherson_free_rack, macpherson_general
from oracle.constraints import BODIES, Array
from oracle.multipliers import solve_free, solve_prescribed
from oracle.newton import solve_pose
from oracle.reference import (
    completed,
    general_parameters,
    perturbed_parameters,
    reference_parameters,
    set_inertia,
)

MODELS = {module.NAME: module for module in (macpherson, macpherson_free_rack, macpherson_general)}
"""The compiled modules by name."""


@dataclass(frozen=True)
class Instant:
    """A state and inputs: rad, m, their rates, N; the rack's along its unit axis."""

    beta1: float
    spin: float = 0.0
    rack: float = 0.0
    beta1_rate: float = 0.0
    spin_rate: float = 0.0
    rack_rate: float = 0.0
    rack_acceleration: float = 0.0
    road_height: float = 0.0
    road_velocity: float = 0.0
    strut_force: float = 0.0
    rack_force: float = 0.0

    def state(self, model):
        """Return the state array of a compiled model."""
        return np.array([self._named()[name] for name in model.STATE])

    def inputs(self, model):
        """Return the input array of a compiled model."""
        return np.array([self._named()[name] for name in model.INPUTS])

    def arrays(self, model):
        """Return state and inputs of a compiled model."""
        return self.state(model), self.inputs(model)

    def _named(self):
        return vars(self) | {
            "beta5": self.spin,
            "beta9": self.rack,
            "beta5_rate": self.spin_rate,
            "beta9_rate": self.rack_rate,
            "rack_position": self.rack,
            "rack_velocity": self.rack_rate,
        }

    def pose(self, car, start=None):
        """Solve the joints with the oracle."""
        return solve_pose(car, self.beta1, self.rack, self.spin, start)

    def solution(self, model, car):
        """Solve the dynamics of a model's kind with the oracle."""
        rates = self.beta1_rate, self.spin_rate, self.rack_rate
        pose, inputs = self.pose(car), self.road_and_strut()
        if is_prescribed(model):
            inputs["rack_acceleration"] = self.rack_acceleration
            return solve_prescribed(car, pose, *rates, **inputs)
        return solve_free(car, pose, *rates, rack_force=self.rack_force, **inputs)

    def road_and_strut(self):
        """Return the inputs that all models share, in the words of the oracle."""
        return {name: vars(self)[name] for name in ("road_height", "road_velocity", "strut_force")}


@dataclass(frozen=True)
class At:
    """A compiled model at a state, inputs and constants."""

    model: ModuleType
    instant: Instant
    constants: Array

    @property
    def state(self):
        """State array."""
        return self.instant.state(self.model)

    @property
    def inputs(self):
        """Input array."""
        return self.instant.inputs(self.model)

    @property
    def size(self):
        """Number of independent coordinates."""
        return len(self.model.STATE) // 2

    def __call__(self, function):
        """Evaluate a function of the model."""
        return getattr(self.model, function)(self.state, self.inputs, self.constants)


def random_instants(rng, car, count):
    """Return instants within most of the travel, at the rates and forces of a rough road."""
    return [
        Instant(
            beta1=car.beta1_design + rng.uniform(-0.35, 0.35),
            spin=rng.uniform(-4.0, 4.0),
            rack=rng.uniform(-0.04, 0.04),
            beta1_rate=4.0 * rng.standard_normal(),
            spin_rate=80.0 * rng.standard_normal(),
            rack_rate=0.4 * rng.standard_normal(),
            rack_acceleration=8.0 * rng.standard_normal(),
            road_height=0.02 * rng.standard_normal(),
            road_velocity=rng.standard_normal(),
            strut_force=600.0 * rng.standard_normal(),
            rack_force=300.0 * rng.standard_normal(),
        )
        for _ in range(count)
    ]


def is_prescribed(model):
    """Return whether the rack of a model follows its inputs."""
    return "rack_position" in model.INPUTS


def car_parameters(seed, model=macpherson):
    """Return the reference car for seed 0, a general car near it for every other seed.

    For the general model those have all that it describes; with every third of them the tyre
    holds on to the road.
    """
    if seed == 0:
        return of_model(model, reference_parameters())
    rng = np.random.default_rng(seed)
    if model is not macpherson_general:
        return perturbed_parameters(rng)
    parameters = general_parameters(rng, offset=rng.uniform(0.0, 0.08))
    return of_model(model, parameters | {"tyre_lifts_off": float(seed % 3 != 0)})


def of_model(model, parameters):
    """Return exactly the parameters that a model takes; those that are absent have no effect."""
    complete = completed(parameters)
    return {name: complete[name] for name in model.PARAMETERS}


def counted_by(model, parameters):
    """Return the parameters of what a model describes: bodies that it leaves out have no mass."""
    counted = dict(parameters)
    for body in BODIES:
        if body not in model.MASSIVE_BODIES:
            counted[f"{body}_mass"] = 0.0
            set_inertia(counted, body, np.zeros((3, 3)))
    return counted
