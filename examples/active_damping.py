"""A learning environment: an agent sets the force in a strut, the wheel follows a rough road.

It needs ``pip install "kintrafo[learning]"``. The body is held, as on a rig: the agent can only
keep the wheel on the road.
"""

from typing import Any

import gymnasium
import kintrafo
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float32]

STEP = 1e-3  # s
DECISIONS = 500  # of an episode
STEPS_OF_A_DECISION = 10
ROUGHNESS = 0.03  # m, standard deviation of the road after a second without its return to zero
FORCE = 2000.0  # N, the greatest
OBSERVED = ("wheel_center_z", "wheel_velocity", "tyre_force")
SCALES = np.array([0.1, 1.0, 4000.0])  # m, m/s, N


class ActiveDamping(gymnasium.Env[Array, Array]):
    """The wheel of the reference car over a road that is a random walk.

    The action is the force in the strut as a part of its greatest, positive when it pushes the
    wheel down. The observation is height and velocity of the wheel centre and the tyre's force,
    minus those at rest, in units of `SCALES`. The reward of a decision is minus the square of the
    tyre's force minus that at rest, as a part of the latter.
    """

    def __init__(self) -> None:
        self.action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
        self.observation_space = gymnasium.spaces.Box(-np.inf, np.inf, (3,), np.float32)
        self.model = kintrafo.Model("reference_car")
        self.rest = kintrafo.equilibrium(self.model)
        self.stepper = kintrafo.Stepper(self.model, STEP, self.rest)
        self._force = self.model.input_names.index("strut_force")
        self._road = self.model.input_names.index("road_height")
        self._at_rest = self._observed()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Array, dict[str, Any]]:
        """Begin an episode at rest."""
        super().reset(seed=seed, options=options)
        self.stepper.reset(self.rest)
        self._left = DECISIONS
        return self._observation(), {}

    def step(self, action: Array) -> tuple[Array, float, bool, bool, dict[str, Any]]:
        """Hold a force for ten steps."""
        inputs = self.stepper.inputs
        inputs[self._force] = FORCE * float(np.clip(action[0], -1.0, 1.0))
        for bump in self.np_random.normal(0.0, ROUGHNESS * STEP**0.5, STEPS_OF_A_DECISION):
            inputs[self._road] += bump - STEP * inputs[self._road]
            self.stepper.step()
        self._left -= 1
        observation = self._observation()
        reward = -((SCALES[2] * float(observation[2]) / self._at_rest[2]) ** 2)
        return observation, reward, False, self._left == 0, {}

    def _observed(self) -> NDArray[np.float64]:
        signals = self.stepper.signals()
        return np.array([signals[name] for name in OBSERVED])

    def _observation(self) -> Array:
        return ((self._observed() - self._at_rest) / SCALES).astype(np.float32)


def main() -> None:
    """Compare an episode without force with one in which the strut damps more."""
    environment = ActiveDamping()
    for gain in (0.0, 0.5):
        observation, _ = environment.reset(seed=1)
        cost, ended = 0.0, False
        while not ended:
            action = np.array([gain * observation[1]], np.float32)
            observation, reward, _, ended, _ = environment.step(action)
            cost -= reward
        print(f"gain {gain}: the tyre's force varies by {(cost / DECISIONS) ** 0.5:.1%} RMS")


if __name__ == "__main__":
    main()
