"""Templates of the texts around the equations, beside the printers."""

from importlib.resources import files
from string import Template


def template(backend: str, name: str) -> Template:
    """Return a template of a back end, by the name of its file without ``.in``."""
    folder = files(__package__).joinpath(backend, "templates")
    return Template(folder.joinpath(f"{name}.in").read_text(encoding="utf-8"))
