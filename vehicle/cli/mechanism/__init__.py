"""``kintrafo mechanism``: commands of any mechanism, one of your own or that of a suspension."""

from . import animate, derivation, generate, topology

HELP = "Any mechanism: its topology, derivation, equations and animation."
COMMANDS = (topology, derivation, generate, animate)
