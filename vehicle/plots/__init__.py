"""Pictures for print.

`curves`     variables of a dataset, in one figure each or grouped on a page
`paper`      the figures of the paper
`overview`   one picture of a suspension
`variation`  effects of values of the input file, and bands of tolerances
"""

from .curves import FORMATS, check_formats, figure, first_curves, grouped, write, write_overview

__all__ = [
    "FORMATS", "check_formats", "figure", "first_curves", "grouped", "write", "write_overview",
]  # fmt: skip
