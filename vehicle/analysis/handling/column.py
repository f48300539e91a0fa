"""Twist and torque of the steering column of a car."""

import numpy as np

from ....core.named_types import Array
from ....systems.system import System
from ...models.car.driving import SteeringColumn

COLUMN_TWIST = ("twist of the steering column, positive with the steering wheel to the left", "rad")
"""Meaning and unit."""


def column_twist(model: System, states: Array, inputs: Array, sense: Array) -> Array:
    """Return the twist of the column, positive to the left, (n,) [rad].

    Parameters
    ----------
    model : System
        The equations of a car with a steering column.
    states, inputs : ndarray, shape (n, states) and (n, inputs)
    sense : ndarray
        1 where the rack moves in its positive direction as the steering wheel turns left, else -1.
    """
    return -sense * model.signal("front_column_angle", states, inputs)


def column_torque(
    column: SteeringColumn, model: System, states: Array, inputs: Array, sense: Array
) -> Array:
    """Return the torque of the steering wheel, positive to the left, (n,) [N m].

    It twists the column and overcomes the friction on the side of the steering wheel. Arguments are
    as of `column_twist`.
    """
    twisting = sum(
        model.signal(f"front_column_{law}_moment", states, inputs) for law in ("spring", "damper")
    )
    velocity = inputs[:, model.input_names.index("rack_velocity")]
    smoothed = velocity / np.hypot(velocity, column.friction_velocity_m_per_s)
    return sense * (twisting + column.friction_Nm * smoothed)
