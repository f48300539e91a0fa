"""The chapter about what bushes do to the curves over wheel travel."""

import xarray as xr
from matplotlib import rc_context

from ...core.arguments import Arguments
from ...plots.curves import figure
from ...plots.figures import STYLE
from ...study.loads.sheets import deflections
from .chapter import Chapter, Picture


def elastokinematics_chapter(found: xr.Dataset) -> Chapter:
    """Return how a wheel moves over its travel on its bushes, beside rigid joints.

    Parameters
    ----------
    found : xarray.Dataset
        From `kintrafo.loads.elastokinematics`.

    Returns
    -------
    Chapter
    """
    with Arguments("elastokinematics_chapter") as given:
        given.dataset(found, over="wheel_travel")
    with rc_context(STYLE):
        drawn = figure(
            found, list(map(str, found)), title="Kinematic and elastokinematic", alone=False
        )
        picture = Picture.of(drawn, "Curves over wheel travel with rigid joints and on the bushes")
    words = (
        f"By equilibrium of all parts, however far bushes give way: {found.attrs['hardpoints']}."
    )
    sheet = deflections(found, "Over wheel travel")
    return Chapter("Elastokinematics", (words,), (sheet,), (picture,))
