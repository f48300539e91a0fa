"""The motion of a car that drives, as a GIF or as a page that plays it.

`scene`    where everything is that is drawn
`picture`  frames of a GIF
`page`     a page to play, stop and turn
"""

from .animate import ENDINGS, animate

__all__ = ["ENDINGS", "animate"]
