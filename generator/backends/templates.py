"""The texts that are printed around the equations: templates beside the printers."""

from importlib.resources import files
from string import Template


def template(backend: str, name: str) -> Template:
    """Return a template of a back end by its name, which says what it is printed in.

    Parameters
    ----------
    backend
        The folder of the back end.
    name
        The file, without ``.in``.
    """
    folder = files(__package__).joinpath(backend, "templates")
    return Template(folder.joinpath(f"{name}.in").read_text(encoding="utf-8"))
