"""What the declarations of suspensions share: inputs, and what cars have beyond plain springs.

The latter costs a fifth of an evaluation, so that it is in variants of its own: a damper with a
curve, friction, stops, and a tyre that damps and lifts off. With the defaults of all these a
variant is the plain suspension.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..declare.assembly import Parameter
from ..declare.inputs import Input
from ..declare.laws import DamperTable, Friction, Stop

if TYPE_CHECKING:
    from ..declare.laws import Law

INPUTS = (
    Input("rack_position", "m", "displacement of the rack along its axis"),
    Input(
        "rack_velocity",
        "m/s",
        "velocity of the rack along its axis",
        derivative_of="rack_position",
    ),
    Input(
        "rack_acceleration",
        "m/s^2",
        "acceleration of the rack along its axis",
        derivative_of="rack_velocity",
    ),
    Input("road_height", "m", "height of the road under the tyre, positive up"),
    Input("road_velocity", "m/s", "rate of the road's height", derivative_of="road_height"),
    Input("rack_force", "N", "force on the rack along its axis"),
)

DAMPER_TABLE = DamperTable(name="damper_table", segments=10)


def further_laws(damper: str) -> tuple[Law, ...]:
    """Return what acts along a damper besides its linear part: a curve, friction, two stops.

    Parameters
    ----------
    damper
        Begins the names of the friction's parameters.
    """
    return (
        DAMPER_TABLE,
        Friction(level=f"{damper}_friction", speed=f"{damper}_friction_speed"),
        Stop(
            side="bump",
            length="bump_stop_length",
            rate="bump_stop_rate",
            progression="bump_stop_progression",
        ),
        Stop(
            side="rebound",
            length="rebound_stop_length",
            rate="rebound_stop_rate",
            progression="rebound_stop_progression",
        ),
    )


def further_parameters(damper: str, longest: float) -> tuple[Parameter, ...]:
    """Return the parameters of `further_laws`, and of a tyre that damps and lifts off.

    Parameters
    ----------
    damper
        What the damper is called.
    longest
        A length that it does not exceed [m].
    """
    return (
        *(Parameter(*entry) for entry in DAMPER_TABLE.parameters()),
        Parameter(f"{damper}_friction", 0.0, "N", f"friction of the {damper} in full sliding"),
        Parameter(
            f"{damper}_friction_speed",
            0.01,
            "m/s",
            "velocity at which 71 % of the friction is reached",
        ),
        Parameter(
            "bump_stop_length", 0.0, "m", f"{damper} length at which the bump stop is touched"
        ),
        Parameter("bump_stop_rate", 0.0, "N/m", "rate of the bump stop at first touch"),
        Parameter("bump_stop_progression", 0.0, "N/m^3", "cubic term of the bump stop"),
        Parameter(
            "rebound_stop_length",
            longest,
            "m",
            f"{damper} length at which the rebound stop is touched",
        ),
        Parameter("rebound_stop_rate", 0.0, "N/m", "rate of the rebound stop at first touch"),
        Parameter("rebound_stop_progression", 0.0, "N/m^3", "cubic term of the rebound stop"),
        Parameter("tyre_damper_rate", 0.0, "N s/m", "radial damping of the tyre"),
        Parameter(
            "tyre_lifts_off", 0.0, "1", "1: the tyre can leave the road; 0: it holds on to it"
        ),
    )
