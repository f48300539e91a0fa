"""Figures of commands: a line on the terminal names each of them while it is drawn."""

from io import StringIO

from kintrafo.vehicle.cli import outputs
from kintrafo.vehicle.cli.outputs import PlotOptions
from rich.console import Console


def test_each_figure_is_reported(tmp_path, monkeypatch):
    """In the order of drawing, with its number; nothing is written without a terminal."""
    pages = [tmp_path / "a.png", tmp_path / "b [1].pdf"]
    for terminal in (True, False):
        lines = StringIO()
        shown = Console(file=lines, force_terminal=terminal, width=200)
        monkeypatch.setattr(outputs, "problems", shown)
        found = PlotOptions(plot=pages).files(suffixes=["_bump", "_roll"])
        for suffix in ("_bump", "_roll"):
            found.draw(lambda _, path, **_options: path, None, suffix=suffix)
        expected = ["a_bump.png", "b [1]_bump.pdf", "a_roll.png", "b [1]_roll.pdf"]
        texts = [f"drawing figure {i} of 4: {name}" for i, name in enumerate(expected, 1)]
        places = [lines.getvalue().find(text) for text in texts]
        assert places == sorted(places) if terminal else lines.getvalue().strip() == ""
        assert terminal == (min(places) >= 0)
