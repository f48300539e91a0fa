"""Packaged data sets, and the annotated copy of one that begins a new project."""

from collections.abc import Container
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from ...core.errors import InputError
from ...core.files import refuse, write_text
from ...core.suggestions import suggestion
from . import data_sets

_ENDING = ".toml"
AXLES = f"{__package__}.axles"
"""Package of the axles."""

WHOLE_AXLES = f"{__package__}.whole_axles"
"""Package of the axles without separate sides, such as rigid ones."""

CARS = f"{__package__}.cars"
"""Package of the cars."""

MANOEUVRES = f"{__package__}.manoeuvres"
"""Package of the manoeuvres."""

AXLE = "axle"
"""Top-level key of the file of an axle."""

CAR = "car"
"""Top-level key of the file of a car."""

DEFAULT = "macpherson"
"""Kind of a suspension file without the key ``suspension``."""

# Sections and keys of a new file that are commented out in the data sets.
_SECTIONS = ("# [bump_stop]", "# [rebound_stop]")
_KEYS = ("# lifts_off = ", "# length_min_mm = ", "# length_max_mm = ")


def kinds() -> tuple[str, ...]:
    """Return the kinds of suspension, the default first; their modules are not imported.

    Examples
    --------
    >>> from kintrafo import starter
    >>> starter.kinds()
    ('macpherson', 'double_wishbone', 'multi_link', 'pull_rod', 'push_rod', 'trailing_arm')
    """
    files = resources.files("kintrafo.vehicle").joinpath("kinds").iterdir()
    names = sorted(f.name.removesuffix(".py") for f in files if f.name.endswith(".py"))
    return DEFAULT, *(name for name in names if name not in (DEFAULT, "__init__"))


def packaged() -> tuple[str, ...]:
    """Return the names of the packaged suspensions.

    Examples
    --------
    >>> from kintrafo import starter
    >>> "reference_car" in starter.packaged()
    True
    """
    return tuple(data_sets())


def packaged_axles() -> tuple[str, ...]:
    """Return the names of the packaged axles with two sides.

    Examples
    --------
    >>> from kintrafo import starter
    >>> {"rear_axle", "reference_axle"} <= set(starter.packaged_axles())
    True
    """
    return tuple(data_sets(AXLES))


def manoeuvres() -> dict[str, Traversable]:
    """Return the files of the packaged manoeuvres by name.

    Examples
    --------
    >>> "step_steer" in manoeuvres()
    True
    """
    return data_sets(MANOEUVRES)


def whole_axles() -> tuple[str, ...]:
    """Return the kinds of axles described in one file with both wheels, such as a rigid axle.

    A kind is the top-level key of its files, the name of its packaged data set, and the name of
    the modules with its equations and its assembly.
    """
    return tuple(data_sets(WHOLE_AXLES))


def all_packaged() -> dict[str, Traversable]:
    """Return the files of all packaged suspensions, axles and cars by name."""
    return data_sets() | data_sets(AXLES) | data_sets(WHOLE_AXLES) | data_sets(CARS)


def whole_axle_in(data: Container[str]) -> str | None:
    """Return the kind in `whole_axles` whose key the data of a file have, or None."""
    return next((key for key in whole_axles() if key in data), None)


def words_of(key: str) -> str:
    """Return the name of the object with a top-level key in its file, with its article.

    Examples
    --------
    >>> words_of("rigid_axle"), words_of("axle")
    ('a rigid axle', 'an axle')
    """
    return f"{'an' if key[0] in 'aeiou' else 'a'} {key.replace('_', ' ')}"


def not_of_a_suspension(key: str) -> str:
    """Return the message for the file of such an axle in place of that of a suspension."""
    return (
        f"this is the file of {words_of(key)}, and that of a suspension is needed. The command "
        f"export --to points does not take {words_of(key)}; all others do. In Python: "
        "kintrafo.load."
    )


def write_starter(
    path: str | Path, *, template: str = "reference_car", force: bool = False
) -> Path:
    """Write an input file to begin with, and return its path: all keys, units, signs, comments.

    Parameters
    ----------
    path : str or pathlib.Path
        File name that ends in ``.toml``.
    template : str, optional
        Name of the packaged file to copy: that of a suspension, an axle, a car or a manoeuvre.
    force : bool, optional
        Whether to replace a file that kintrafo did not write; see `kintrafo.core.files`.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If the file must not or cannot be written, or there is no such packaged file.
    """
    known = all_packaged() | manoeuvres()
    if not isinstance(template, str) or template not in known:
        hint = suggestion(str(template), known)
        problem = f"no data set {template!r} comes with kintrafo. {hint}"
        raise InputError([problem], "template")
    refuse([path], force=force, endings=[_ENDING])
    text = _with_limits(known[template].read_text(encoding="utf-8"))
    return write_text(path, text, force=force)


def _with_limits(text: str) -> str:
    """Return the text with the limits of the suspension, such as stops, no longer commented out.

    The packaged data sets have them as comments.
    """
    lines, within = [], False
    for line in text.splitlines():
        within = line.startswith(_SECTIONS) or (within and line.startswith("# "))
        on = within or line.startswith(_KEYS)
        lines.append(line.removeprefix("# ") if on else line)
    return "\n".join(lines) + "\n"
