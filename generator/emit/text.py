"""The texts that are printed around the equations: templates beside the printers."""

from importlib.resources import files
from string import Template


def template(name: str) -> Template:
    """Return a template by its name, which says what it is printed in."""
    return Template(
        files(__package__).joinpath("templates", f"{name}.in").read_text(encoding="utf-8")
    )
