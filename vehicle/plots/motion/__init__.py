"""The motion of a car as a GIF, or as a page that plays it.

`scene`    where everything is that is drawn
`picture`  frames of a GIF
`charts`   curves over time that follow
`page`     a page to play, stop and turn, and the part of a page that does so
"""

from .animate import ENDINGS, animate
from .charts import shown_names

__all__ = ["ENDINGS", "animate", "shown_names"]
