"""What the declarations of suspensions share: their inputs."""

INPUTS = {
    "rack_position": ("m", "displacement of the rack along its axis"),
    "rack_velocity": ("m/s", "velocity of the rack along its axis"),
    "rack_acceleration": ("m/s^2", "acceleration of the rack along its axis"),
    "road_height": ("m", "height of the road under the tyre, positive up"),
    "road_velocity": ("m/s", "rate of the road's height"),
    "rack_force": ("N", "force on the rack along its axis"),
}
