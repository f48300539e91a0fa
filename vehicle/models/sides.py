"""The sides of a vehicle, by the names of wheels in results and files."""

LEFT, RIGHT = "left", "right"
SIDES = (LEFT, RIGHT)
"""The order of every dimension ``wheel``."""

SENSE = {LEFT: 1.0, RIGHT: -1.0}
"""The sign of a wheel's lateral position, which is that of its travel in roll and twist."""
