"""Lengths and forces over wheel travel, from derivatives by the arm's angle and the chain rule."""

import numpy as np

from ...core.named_types import Array
from ...systems.system import System
from .corner import SpringForce, Stroke


class Strokes:
    """Lengths and forces of a model's force elements in n positions at rest.

    `arm` is the state of the arm's angle.
    """

    def __init__(self, model: System, states: Array, inputs: Array, arm: str) -> None:
        # at unit rate velocities are first derivatives, and their derivatives second ones
        states = states.copy()
        states[..., model.state_names.index(f"{arm}_rate")] = 1.0
        self.parameters = model.parameters
        self._signals = model.signals(states, inputs)
        by_arm = model.evaluate("signals_jacobian", states, inputs)[..., 0]
        self._by_arm = dict(zip(model.signal_names, np.moveaxis(by_arm, -1, 0), strict=True))

    def __contains__(self, signal: str) -> bool:
        """Return whether the model has a signal of this name."""
        return signal in self._signals

    def stroke(self, path: str) -> Stroke:
        """Return the length of a path, such as "strut"."""
        rise, rise_change = self._signals["wheel_velocity"], self._by_arm["wheel_velocity"]
        slope = self._signals[f"{path}_velocity"] / rise
        change = self._by_arm[f"{path}_velocity"]
        return Stroke(
            length=self._signals[f"{path}_length"],
            slope=slope,
            curvature=(change - slope * rise_change) / rise**2,
        )

    def spring(self, force: str, path: str) -> SpringForce:
        """Return a force along a path, from the name of its signal."""
        slope = self._by_arm[force] / self._signals["wheel_velocity"]
        return SpringForce(self.stroke(path), self._signals[force], slope)
