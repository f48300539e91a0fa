"""The chapter with the K&C sheet."""

import xarray as xr

from ....core.validator import Validator
from ...analysis.sheet import QUANTITY, tabulated
from .chapter import Chapter


def sheet_chapter(found: xr.Dataset) -> Chapter:
    """Return the chapter of the kinematic and compliance gradients at design, with their signs.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `kintrafo.sheet.sheet`.

    Returns
    -------
    Chapter
    """
    with Validator("sheet_chapter") as given:
        given.dataset(found, over=QUANTITY)
    words = (
        "Kinematic and compliance gradients at design, as in the summary of a rig. Signs are "
        "those of ISO 8855 (x forward, y left, z up) and of SAE J670 with its z axis down."
    )
    return Chapter("K&C sheet", (words,), tuple(tabulated(found, "")), ())
