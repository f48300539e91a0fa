"""The first file of a new project: an annotated copy of a packaged data set."""

from collections.abc import Container
from importlib import resources
from importlib.resources.abc import Traversable
from pathlib import Path

from ...core.errors import InputError
from ...core.files import refuse, replacing
from ...core.suggestions import suggestion
from . import data_sets

_ENDING = ".toml"
AXLES = f"{__package__}.axles"
"""Where the axles are that come with kintrafo."""

WHOLE_AXLES = f"{__package__}.whole_axles"
"""Where the axles are that come with kintrafo and have no sides, such as rigid ones."""

CARS = f"{__package__}.cars"
"""Where the cars are that come with kintrafo."""

MANOEUVRES = f"{__package__}.manoeuvres"
"""Where the manoeuvres are that come with kintrafo."""

AXLE = "axle"
"""The top-level key that says that a file describes an axle."""

CAR = "car"
"""The top-level key that says that a file describes a car."""

DEFAULT = "macpherson"
"""The kind of a file that does not say it."""

# Sections and keys that a first file has, and that the data sets keep in a comment.
_SECTIONS = ("# [bump_stop]", "# [rebound_stop]")
_KEYS = ("# lifts_off = ", "# length_min_mm = ", "# length_max_mm = ")


def kinds() -> tuple[str, ...]:
    """Return the names of the kinds of suspension, without loading any; the default first.

    Examples
    --------
    >>> kinds()
    ('macpherson', 'double_wishbone', 'multi_link', 'pull_rod', 'push_rod', 'trailing_arm')
    """
    files = resources.files("kintrafo.vehicle").joinpath("kinds").iterdir()
    names = sorted(f.name.removesuffix(".py") for f in files if f.name.endswith(".py"))
    return DEFAULT, *(name for name in names if name not in (DEFAULT, "__init__"))


def packaged() -> tuple[str, ...]:
    """Return the names of the data sets that come with kintrafo.

    Examples
    --------
    >>> "reference_car" in packaged()
    True
    """
    return tuple(data_sets())


def packaged_axles() -> tuple[str, ...]:
    """Return the names of the axles that come with kintrafo.

    Examples
    --------
    >>> {"rear_axle", "reference_axle"} <= set(packaged_axles())
    True
    """
    return tuple(data_sets(AXLES))


def packaged_cars() -> tuple[str, ...]:
    """Return the names of the cars that come with kintrafo.

    Examples
    --------
    >>> {"driving_car", "quarter_car", "reference_vehicle"} <= set(packaged_cars())
    True
    """
    return tuple(data_sets(CARS))


def manoeuvres() -> dict[str, Traversable]:
    """Return the files of the manoeuvres that come with kintrafo, by their names.

    Examples
    --------
    >>> "step_steer" in manoeuvres()
    True
    """
    return data_sets(MANOEUVRES)


def whole_axles() -> tuple[str, ...]:
    """Return what axles there are that one file describes with both wheels, such as a rigid axle.

    Each is the top-level key that says so in a file, the name of the data set that comes with
    kintrafo, and that of the modules with its equations and its assembly.

    Examples
    --------
    >>> "rigid_axle" in whole_axles()
    True
    """
    return tuple(data_sets(WHOLE_AXLES))


def all_packaged() -> dict[str, Traversable]:
    """Return the files of all that comes with kintrafo, suspensions, axles and cars, by names.

    Examples
    --------
    >>> {"reference_car", "rigid_axle", "quarter_car"} <= set(all_packaged())
    True
    """
    return data_sets() | data_sets(AXLES) | data_sets(WHOLE_AXLES) | data_sets(CARS)


def whole_axle_in(data: Container[str]) -> str | None:
    """Return which of these axles the top-level keys of a file are of; None for other files."""
    return next((key for key in whole_axles() if key in data), None)


def words_of(key: str) -> str:
    """Return what such an axle is called.

    Examples
    --------
    >>> words_of("rigid_axle")
    'a rigid axle'
    """
    return f"a {key.replace('_', ' ')}"


def not_of_a_suspension(key: str) -> str:
    """Return what is said of the file of such an axle where that of a suspension is needed."""
    return (
        f"this is the file of {words_of(key)}, and that of a suspension is needed. The command "
        f"export --to points does not take {words_of(key)}; all others do. In Python: "
        "kintrafo.load."
    )


def write_starter(
    path: str | Path, *, template: str = "reference_car", force: bool = False
) -> Path:
    """Write an input file to begin with: all keys, with units, signs and comments.

    Parameters
    ----------
    path : str or pathlib.Path
        A name that ends in ``.toml``.
    template : str, optional
        Name of the packaged data set that is copied, of any of them.
    force : bool, optional
        Whether a file that kintrafo did not write is replaced, see `kintrafo.core.files`.

    Returns
    -------
    pathlib.Path

    Raises
    ------
    InputError
        If there is a file already, or the name cannot be used.
    """
    known = all_packaged() | manoeuvres()
    if not isinstance(template, str) or template not in known:
        hint = suggestion(str(template), known)
        problem = f"no data set {template!r} comes with kintrafo. {hint}"
        raise InputError([problem], "template")
    refuse([path], force=force, endings=[_ENDING])
    text = _with_limits(known[template].read_text(encoding="utf-8"))
    with replacing(path, force=force) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
    return Path(path)


def _with_limits(text: str) -> str:
    """Switch on what keeps a motion within what a suspension can do, where a data set has it.

    The packaged data are those of the paper, without it.
    """
    lines, within = [], False
    for line in text.splitlines():
        within = line.startswith(_SECTIONS) or (within and line.startswith("# "))
        on = within or line.startswith(_KEYS)
        lines.append(line.removeprefix("# ") if on else line)
    return "\n".join(lines) + "\n"
