"""The motion of a car as a GIF, or as a page that plays it.

`scene`    positions of all drawn points over time
`picture`  frames of a GIF
`charts`   curves over time, with a line at the shown time
`page`     a page to play, stop and turn, and the part of a page for a report
"""

from .animate import ENDINGS, animate
from .charts import shown_names

__all__ = ["ENDINGS", "animate", "shown_names"]
