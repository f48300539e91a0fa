"""``kintrafo mechanism``: commands for any mechanism, a user's own or that of a suspension."""

from . import animate, derivation, generate, topology

HELP = "Any mechanism: its topology, derivation, equations and animation."
COMMANDS = (topology, derivation, generate, animate)
