"""Load cards for strength programs: one file for each part, in equilibrium.

`sheet`    loads on a part, point by point
`nastran`  bulk data
`abaqus`   keywords
`write`    the files
"""

from .write import ENDINGS, write_cards

__all__ = ["ENDINGS", "write_cards"]
