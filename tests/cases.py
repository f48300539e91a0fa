"""The compiled models, and cars and instants at which several tests compare them with the oracles.

An instant is given in the words of the oracles; the generated models name the same quantities
after the paper: beta1 the arm angle, beta5 the spin angle, beta9 or an input the rack.
"""

from dataclasses import dataclass
from types import ModuleType

import numpy as np
from kintrafo.generated import macpherson, macpherson_free_rack
from oracle.constraints import Array, Pose
from oracle.multipliers import Solution, solve_free, solve_prescribed
from oracle.newton import Mechanism, solve_pose
from oracle.reference import Parameters, perturbed_parameters, reference_parameters, set_inertia

MODELS = {module.NAME: module for module in (macpherson, macpherson_free_rack)}
"""The compiled modules by name."""

MASSLESS = ("tie_rod", "rack", "upper_strut")
"""The bodies whose mass the model with a prescribed rack leaves out."""


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
    strut_force: float = 0.0
    rack_force: float = 0.0

    def state(self, model: ModuleType) -> Array:
        """Return the state array of a compiled model."""
        return np.array([self._named()[name] for name in model.STATE])

    def inputs(self, model: ModuleType) -> Array:
        """Return the input array of a compiled model."""
        return np.array([self._named()[name] for name in model.INPUTS])

    def arrays(self, model: ModuleType) -> tuple[Array, Array]:
        """Return state and inputs of a compiled model."""
        return self.state(model), self.inputs(model)

    def _named(self) -> dict[str, float]:
        return vars(self) | {
            "beta5": self.spin,
            "beta9": self.rack,
            "beta5_rate": self.spin_rate,
            "beta9_rate": self.rack_rate,
            "rack_position": self.rack,
            "rack_velocity": self.rack_rate,
        }

    def pose(self, car: Mechanism, start: Pose | None = None) -> Pose:
        """Solve the joints with the oracle."""
        return solve_pose(car, self.beta1, self.rack, self.spin, start)

    def solution(self, model: ModuleType, car: Mechanism) -> Solution:
        """Solve the dynamics of a model's kind with the oracle."""
        rates = self.beta1_rate, self.spin_rate, self.rack_rate
        inputs = {"road_height": self.road_height, "strut_force": self.strut_force}
        if model is macpherson:
            inputs["rack_acceleration"] = self.rack_acceleration
            return solve_prescribed(car, self.pose(car), *rates, **inputs)
        inputs["rack_force"] = self.rack_force
        return solve_free(car, self.pose(car), *rates, **inputs)


@dataclass(frozen=True)
class At:
    """A compiled model at a state, inputs and constants."""

    model: ModuleType
    instant: Instant
    constants: Array

    @property
    def state(self) -> Array:
        """State array."""
        return self.instant.state(self.model)

    @property
    def inputs(self) -> Array:
        """Input array."""
        return self.instant.inputs(self.model)

    @property
    def size(self) -> int:
        """Number of independent coordinates."""
        return len(self.model.STATE) // 2

    def __call__(self, function: str) -> Array:
        """Evaluate a function of the model."""
        return getattr(self.model, function)(self.state, self.inputs, self.constants)


def random_instants(rng: np.random.Generator, car: Mechanism, count: int) -> list[Instant]:
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
            strut_force=600.0 * rng.standard_normal(),
            rack_force=300.0 * rng.standard_normal(),
        )
        for _ in range(count)
    ]


def car_parameters(seed: int) -> Parameters:
    """Return the reference car for seed 0, a general car near it for every other seed."""
    if seed == 0:
        return reference_parameters()
    return perturbed_parameters(np.random.default_rng(seed))


def counted_by(model: ModuleType, parameters: Parameters) -> Parameters:
    """Return the parameters of what a model describes: the prescribed one leaves masses out."""
    counted = dict(parameters)
    if model is macpherson:
        for body in MASSLESS:
            counted[f"{body}_mass"] = 0.0
            set_inertia(counted, body, np.zeros((3, 3)))
    return counted
