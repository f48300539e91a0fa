"""The chapter about compliance."""

import xarray as xr
from matplotlib import rc_context

from ...core.arguments import Arguments
from ...plots.curves import figure, grouped
from ...plots.figures import STYLE
from ...study.axles import by_side
from ...study.loads.sheets import compliances, compliances_of_axle
from .chapter import Chapter, Picture


def compliance_chapter(found: xr.Dataset) -> Chapter:
    """Return how the wheel gives way on its bushes, or both wheels of an axle.

    Parameters
    ----------
    found : xarray.Dataset
        From `kintrafo.loads.compliance`, `kintrafo.axles.compliance` or
        `kintrafo.rigid_axles.compliance`.

    Returns
    -------
    Chapter
    """
    with Arguments("compliance_chapter") as given:
        given.dataset(found, over="wheel_travel")
    curves = by_side(found.drop_dims([name for name in ("moved", "by") if name in found.dims]))
    names = [name for group in grouped(curves).values() for name in group]
    with rc_context(STYLE):
        drawn = figure(curves, names, title="Compliance over wheel travel", alone=False)
        picture = Picture.of(drawn, "Compliances over wheel travel")
    words = f"By the unit-load theorem, linear, bushes relaxed: {found.attrs['held']}."
    sheets = compliances(found, "At design"), *compliances_of_axle(found, "At design, the axle")
    return Chapter("Compliance", (words,), sheets, (picture,))
