"""What the declarations of suspensions share: their inputs."""

from .. import declare as d

RACK_MOTION = d.Motion(
    "rack",
    "m",
    "displacement of the rack along its axis",
    "velocity of the rack along its axis",
    "acceleration of the rack along its axis",
)
RACK_FORCE = d.Input("rack_force", "N", "force on the rack along its axis")
ROAD_HEIGHT = d.Input("road_height", "m", "height of the road under the tyre, positive up")
ROAD_VELOCITY = d.Input("road_velocity", "m/s", "rate of the road's height", ROAD_HEIGHT)
