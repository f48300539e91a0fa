"""The motion of a car that drives, as a GIF.

`scene`    where everything is that is drawn
`picture`  frames of a GIF
"""

from .animate import ENDINGS, animate

__all__ = ["ENDINGS", "animate"]
