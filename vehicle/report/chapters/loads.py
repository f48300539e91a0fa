"""The chapter of load cases."""

import xarray as xr
from matplotlib import rc_context

from ....core.validator import Validator
from ....pictures.figures import STYLE
from ...analysis.loads.sheets import overview
from ...plots.loads import free_bodies
from .chapter import Chapter, ChapterPicture


def loads_chapter(found: xr.Dataset) -> Chapter:
    """Return the chapter of load cases, with a picture of the free bodies for each.

    Parameters
    ----------
    found : xarray.Dataset
        Result of `kintrafo.loads.static`.

    Returns
    -------
    Chapter
    """
    with Validator("loads_chapter") as given:
        given.dataset(found, over="case")
    reasons = {
        str(case): str(reason)
        for case, reason in zip(found["case"].values, found["reason"].values, strict=True)
    }
    words = ["; ".join(filter(None, (found.attrs["message"], found.attrs["rules"]))) + "."]
    words += [f"{case}: {reason}" for case, reason in reasons.items() if reason]
    pictures = []
    for case in (case for case, reason in reasons.items() if not reason):
        with rc_context(STYLE):
            drawn = free_bodies(found, case, title=f"Forces on the parts: {case}")
            # in svg the halo of its letters would be many lines
            pictures.append(ChapterPicture.of(drawn, f"Free bodies in the load case {case}", "png"))
    sizes = overview(found, "Magnitudes of the forces [N]")
    return Chapter("Load cases", tuple(words), (sizes,), tuple(pictures))
