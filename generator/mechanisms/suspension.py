"""What the declarations of suspensions share: their inputs."""

from ..declare.inputs import Input

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
