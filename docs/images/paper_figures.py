"""Draw the paper's figures: ``python docs/images/paper_figures.py``.

Figures 1 to 3 as the generator draws those of any mechanism, and the two solutions of Eq. 15: the
end D of the tie rod turns about the strut's axis BC on a circle, and keeps its distance from E.
"""

import tempfile
from pathlib import Path

import numpy as np
from kintrafo import Suspension
from kintrafo.generator.backends.report.figures import draw_figures
from kintrafo.generator.mechanisms import MODELS
from kintrafo.generator.planning.plan import CataloguePlan
from kintrafo.pictures.figures import BLUE, GREEN, ORANGE, STYLE
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle
from numpy.typing import NDArray

Array = NDArray[np.float64]
FOLDER = Path(__file__).parent
GREY = "#9a9a9a"


def main() -> None:
    """Write all of them."""
    with tempfile.TemporaryDirectory() as folder:
        for path in draw_figures(CataloguePlan.of(MODELS[0]), Path(folder)):
            if path.suffix == ".svg":
                name = path.name.replace("macpherson", "paper")
                (FOLDER / name).write_bytes(path.read_bytes())
    with rc_context({**STYLE, "svg.hashsalt": "kintrafo"}):
        figure = Figure(figsize=(5.0, 5.8), layout="constrained")
        _assemblies(figure.add_subplot())
        figure.savefig(FOLDER / "second_assembly.png", dpi=150)


def _assemblies(axes: Axes) -> None:
    """Draw both assemblies, seen along the strut."""
    points = Suspension.load("reference_car").hardpoints.at_design()
    top, foot = points["strut_top"], points["ball_joint"]
    along = (top - foot) / np.linalg.norm(top - foot)
    left = np.array([0.0, 1.0, 0.0]) - along * along[1]
    left /= np.linalg.norm(left)
    forward = np.cross(left, along)

    def seen(point: Array) -> Array:
        """Return a point in the plane across the strut, forward to the right [mm]."""
        return 1e3 * np.array([forward @ (point - foot), left @ (point - foot)])

    d, e, wheel = (seen(points[n]) for n in ("tie_rod_outer", "tie_rod_inner", "wheel_center"))
    # D and its mirror image in the line from the strut to E are as far from both
    away = e / np.linalg.norm(e)
    other = 2.0 * away * (away @ d) - d
    turned = float(np.arctan2(d[0] * other[1] - d[1] * other[0], d @ other))
    turn = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
    assert np.isclose(np.linalg.norm(other - e), np.linalg.norm(d - e), rtol=1e-12)
    assert np.allclose(turn @ d, other, rtol=1e-12)
    axes.add_patch(Circle((0.0, 0.0), float(np.linalg.norm(d)), fill=False, ls=":", color=GREY))
    for end, rotation, colour, words in (
        (d, np.eye(2), BLUE, "at the design position"),
        (other, turn, ORANGE, "the second solution"),
    ):
        axes.plot(*np.transpose([e, end]), color=GREEN, lw=3, solid_capstyle="round")
        axes.plot(*np.transpose([[0.0, 0.0], end]), color=colour, lw=3, label=words)
        hub = rotation @ wheel
        spin = rotation @ seen(foot + np.array([1.0, 0.0, 0.0])) / 1e3
        ends = [hub - 150.0 * spin, hub + 150.0 * spin]
        axes.plot(*np.transpose([[0.0, 0.0], hub]), color=colour, lw=1.5)
        axes.plot(*np.transpose(ends), color=colour, lw=7, alpha=0.35, solid_capstyle="butt")
    for name, place, shift in (
        ("strut axis BC", np.zeros(2), (10, -14)),
        ("E", e, (8, 4)),
        ("D", d, (-16, 2)),
        ("D'", other, (10, 2)),
    ):
        axes.plot(*place, "o", color="white", mec="#222222", ms=6, zorder=4)
        axes.annotate(name, place, shift, textcoords="offset points")
    axes.set(xlabel="forward, across the strut [mm]", ylabel="to the left [mm]", aspect="equal")
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2)
    caption = f"the knuckle is turned\nby {abs(np.rad2deg(turned)):.0f}° about BC"
    axes.annotate(caption, (0.97, 0.97), xycoords="axes fraction", ha="right", va="top")


if __name__ == "__main__":
    main()
