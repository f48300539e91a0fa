"""Handling of a car: manoeuvres of the standards, and steady turns without a simulation.

`drive`           a manoeuvre, by name or by its file
`circle`          steady turns at constant speed, radius or steering wheel angle
`dynamic_loads`   the loads on every part in a manoeuvre
`load_manoeuvre`  the manoeuvre of a file
"""

from .driving import circle, drive
from .dynamic_loads import dynamic_loads
from .manoeuvres import MANOEUVRES, load_manoeuvre
from .result import HandlingResult

__all__ = ["MANOEUVRES", "HandlingResult", "circle", "drive", "dynamic_loads", "load_manoeuvre"]
