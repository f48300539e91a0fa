"""What the declarations of suspensions share: their inputs."""

from ..declare.inputs import Input, Motion

RACK_MOTION = Motion(
    "rack",
    "m",
    "displacement of the rack along its axis",
    "velocity of the rack along its axis",
    "acceleration of the rack along its axis",
)
RACK_FORCE = Input("rack_force", "N", "force on the rack along its axis")
ROAD_HEIGHT = Input("road_height", "m", "height of the road under the tyre, positive up")
ROAD_VELOCITY = Input("road_velocity", "m/s", "rate of the road's height", ROAD_HEIGHT)
