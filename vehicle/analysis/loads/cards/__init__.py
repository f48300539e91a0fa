"""Loads as cards of programs for strength: one file for each part, in equilibrium.

`part`     what acts on a part, point by point
`nastran`  as bulk data
`abaqus`   as keywords
`write`    the files
"""

from .write import ENDINGS, write_cards

__all__ = ["ENDINGS", "write_cards"]
