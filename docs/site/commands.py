"""The directive ``commands``: what each command of ``kintrafo`` says with ``--help``."""

import os

# Before Typer is imported: help without the boxes that it draws in a terminal.
os.environ["TYPER_USE_RICH"] = "0"

from docutils import nodes
from kintrafo.vehicle import cli
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective
from typer.testing import CliRunner

_WIDTH = {"COLUMNS": "90"}


def _help_of(name: str) -> str:
    runner = CliRunner()
    shown = runner.invoke(
        cli.app, [*name.split(), "--help"], prog_name="kintrafo", env=_WIDTH
    ).output
    # brackets that are no mark-up are escaped for the terminal
    return shown.replace(r"\[", "[").strip()


class Commands(SphinxDirective):
    """A section for each command, in the order of the command line."""

    def run(self) -> list[nodes.Node]:
        """Return the sections."""
        return [self._section(name) for name in cli.COMMANDS]

    def _section(self, name: str) -> nodes.section:
        text = _help_of(name)
        section = nodes.section(ids=[name.replace(" ", "-")], names=[name])
        section += nodes.title(text=name)
        section += nodes.literal_block(text, text, language="none")
        return section


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
