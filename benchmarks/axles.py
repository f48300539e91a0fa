"""How long the motions of an axle take: `make benchmark-axles` fills docs/suspension/axles.md."""

import platform
import shutil
import tempfile
from pathlib import Path

from kintrafo import Axle, Suspension, characteristics
from kintrafo.vehicle.plots import curves

from .report import fill_page, milliseconds, seconds_of

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs/suspension/axles.md"
PICTURE = ROOT / "docs/images/axle.png"
REFERENCE = Axle.load("reference_axle")
BAR = {
    "unit": "mm",
    "bush": [-250.0, -380.0, 260.0],
    "link_top": [-60.0, -600.0, 300.0],
    "link_foot": [-50.0, -610.0, 195.0],
    "link_on": "lower_arm",
    "rate_Nm_per_deg": 25.0,
}
WISHBONES = Axle.from_dict(
    {"axle": "rear", "side": Suspension.load("double_wishbone_car"), "anti_roll_bar": BAR}
)
DRAWN = ("roll_moment", "camber", "roll_center_height", "roll_center_lateral", "jacking", "steer")
REPEATED = 5


def main() -> None:
    """Measure everything, draw, and fill the page."""
    table = ["| all characteristics over | positions | reference axle, ms | double wishbone, ms |"]
    table.append("|---|---:|---:|---:|")
    for motion in ("bump", "roll", "left", "steer"):
        times, count = [], 0
        for axle in (REFERENCE, WISHBONES):
            (count,) = characteristics.over(axle, motion)["track"].sizes.values()
            times.append(milliseconds(_quickest(axle, motion)))
        table.append(f"| `{motion}` | {count} | {' | '.join(times)} |")
    table += ["", f"On {platform.machine()}, Python {platform.python_version()}; the quickest of"]
    table[-1] += f" {REPEATED} runs, the search for the range of the wheels included."
    print("\n".join(table))
    fill_page(PAGE, {"axles": "\n".join(table)})
    _draw()


def _quickest(axle: Axle, motion: str) -> float:
    return min(seconds_of(lambda: characteristics.over(axle, motion)) for _ in range(REPEATED))


def _draw() -> None:
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "axle.png"
        drawn = characteristics.over(REFERENCE, "roll")
        curves.write_overview(drawn, path, DRAWN, "reference axle, rolling")
        shutil.copyfile(path, PICTURE)


if __name__ == "__main__":
    main()
