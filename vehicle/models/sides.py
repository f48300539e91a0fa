"""The sides of a vehicle, by the names that wheels have in results and files."""

LEFT, RIGHT = "left", "right"
SIDES = (LEFT, RIGHT)
"""In the order of every dimension ``wheel``."""

SENSE = {LEFT: 1.0, RIGHT: -1.0}
"""Lateral position of a wheel, in half tracks to the left; its sign in roll and twist."""
