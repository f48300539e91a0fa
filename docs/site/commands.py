"""The directive ``commands``: the help of each command of ``kintrafo``, its output and picture."""

import os
from pathlib import Path

# Before Typer is imported: help without the boxes that it draws in a terminal.
os.environ["TYPER_USE_RICH"] = "0"

from docutils import nodes
from kintrafo.vehicle import cli
from shown import Shown, outputs
from sphinx.addnodes import pending_xref
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
        shown = outputs(Path(self.env.srcdir), [*cli.COMMANDS])
        return [self._section(name, shown[name]) for name in cli.COMMANDS]

    def _section(self, name: str, shown: Shown) -> nodes.section:
        text = _help_of(name)
        section = nodes.section(ids=[name.replace(" ", "-")], names=[name])
        section += nodes.title(text=name)
        section += nodes.literal_block(text, text, language="none")
        section += nodes.paragraph("", "Output, from ", self._link(shown.page), nodes.Text(":"))
        printed = f"$ {shown.line}\n{shown.text}"
        section += nodes.literal_block(printed, printed, language="none")
        if shown.picture:
            words, path = shown.picture
            there = os.path.relpath(Path(shown.page).parent / path, Path(self.env.docname).parent)
            section += nodes.image(uri=there, alt=words)
        return section

    def _link(self, page: str) -> nodes.Node:
        """Return a link to a page, with its title."""
        title = self.env.titles.get(page)
        words = title.astext() if title is not None else page
        link = pending_xref(
            "", reftype="doc", refdomain="std", refexplicit=True, reftarget=f"/{page}",
            refdoc=self.env.docname, refwarn=True,
        )  # fmt: skip
        link += nodes.inline("", words)
        return link


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("commands", Commands)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
