"""The chapter about what bushes do to the curves over wheel travel, and over roll."""

import xarray as xr

from ...core.arguments import Arguments
from ...study.characteristics.datasets import DATA_SET
from ...study.loads.sheets import deflections, deflections_of_axle
from .chapter import Chapter, Picture
from .curves import pictures


def elastokinematics_chapter(*found: xr.Dataset) -> Chapter:
    """Return how wheels move on their bushes, beside rigid joints.

    Parameters
    ----------
    *found : xarray.Dataset
        From `kintrafo.loads.elastokinematics`, or those of some motions from
        `kintrafo.axles.elastokinematics`.

    Returns
    -------
    Chapter
    """
    with Arguments("elastokinematics_chapter") as given:
        if not found:
            given.refuse("dataset: one or more are needed.")
        for dataset in found:
            given.dataset(dataset, over=DATA_SET)
    sheets = []
    drawn: list[Picture] = []
    for dataset in found:
        over = _over(dataset)
        title = f"Kinematic and elastokinematic, over {over}"
        words = f"Curves over {over} with rigid joints and on the bushes"
        drawn += pictures(dataset, list(map(str, dataset)), title, words)
        if "toe_left" in dataset:
            sheets += deflections_of_axle(dataset, f"Over {over}")
        else:
            sheets.append(deflections(dataset, f"Over {over}"))
    hardpoints = found[0].attrs["hardpoints"]
    words = f"By equilibrium of all parts, however far bushes give way: {hardpoints}."
    return Chapter("Elastokinematics", (words,), tuple(sheets), tuple(drawn))


def _over(dataset: xr.Dataset) -> str:
    (name,) = (str(name) for name in dataset.sizes if name != DATA_SET)
    return str(dataset[name].attrs["long_name"])
