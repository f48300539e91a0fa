"""The sides of a vehicle, by the names that wheels have in results and files."""

LEFT, RIGHT = "left", "right"
SIDES = (LEFT, RIGHT)
"""In the order of every dimension ``wheel``."""
