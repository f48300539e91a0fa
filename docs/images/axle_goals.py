"""Draw docs/images/axle_goals.png: ``python docs/images/axle_goals.py``.

The goals are those of the file that stands on docs/suspension/axles.md.
"""

import re
import tomllib
from pathlib import Path

import xarray as xr
from kintrafo import Axle, characteristics, variation
from kintrafo.pictures.figures import STYLE, save
from kintrafo.vehicle.plots.curves import figure
from matplotlib import rc_context

PAGE = Path(__file__).parent.parent / "suspension/characteristics.md"
DRAWN = {"bump": "camber", "roll": "roll_stiffness"}


def described() -> str:
    """Return the file of goals as it stands on the page."""
    found = re.search(r"```toml\n(# axle_goals\.toml.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    assert found is not None
    return found.group(1)


if __name__ == "__main__":
    axle = Axle.load("reference_axle")
    goals = variation.goals(tomllib.loads(described()), ["bump", "roll", "left", "right"])
    curves = {name: characteristics.over(axle, over)[name] for over, name in DRAWN.items()}
    with rc_context(STYLE):
        drawn = figure(xr.Dataset(curves), [*curves], title="reference axle", alone=False,
                       columns=2, goals=goals)  # fmt: skip
        save(drawn, Path(__file__).with_suffix(".png"), force=True)
