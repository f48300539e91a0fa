"""The speeds of cars on a road."""

LEAST_SPEED, GREATEST_SPEED = 1.0, 500.0
"""The range of the speed of a simulation [km/h]: others are mistakes, such as of units."""
