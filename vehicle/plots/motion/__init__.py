"""Animations of the motion of a car, as a GIF or as a page with a player.

`scene`    positions of all drawn points over time
`picture`  frames of a GIF
`charts`   curves over time, with a line at the shown time
`page`     a page with a player, and a part of a page for reports
"""

from .animate import ENDINGS, animate
from .charts import shown_names

__all__ = ["ENDINGS", "animate", "shown_names"]
