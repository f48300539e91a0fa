"""Writing suspensions, axles and cars as input files."""

from collections.abc import Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, Protocol

import tomlkit

from ...core.files import Paths, refuse, replacing
from ...core.legible import legible

_ENDING = ".toml"


class Written(Protocol):
    """An object with the sections of an input file."""

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries."""


def toml_text(suspension: Written, head: Sequence[str] = ()) -> str:
    """Return the TOML text of an input file with exactly these data, without default values.

    `head` are lines of the comment at its begin.

    Examples
    --------
    >>> from kintrafo import Suspension
    >>> car = Suspension.load("reference_car")
    >>> print(toml_text(car, ["My car."]).splitlines()[0])
    # My car.
    """
    document = tomlkit.document()
    for line in head:
        document.add(tomlkit.comment(legible(line)) if line else tomlkit.nl())
    sections = suspension.to_dict(exclude_defaults=True)
    # long, and rarely read: at the end
    last = {"bodies": sections.pop("bodies")} if "bodies" in sections else {}
    for name, value in (sections | last).items():
        document.add(tomlkit.nl())
        document.add(name, _table(value) if isinstance(value, dict) else value)
    return tomlkit.dumps(document).strip("\n") + "\n"


def write_toml(
    suspension: Written,
    path: str | Path,
    *,
    head: Sequence[str] = (),
    force: bool = False,
    inputs: Paths = (),
) -> Path:
    """Write an input file, and return its path.

    `path` ends in ``.toml``; `head` are lines of the comment at its begin; `force` and `inputs` are
    as in `kintrafo.core.files`. Raises `InputError` if the file exists already, or the name cannot
    be used.
    """
    write_several({path: (suspension, head)}, force=force, inputs=inputs)
    return Path(path)


def write_several(
    files: Mapping[Any, tuple[Written, Sequence[str]]],
    *,
    force: bool = False,
    inputs: Paths = (),
) -> list[Path]:
    """Write several input files: all of them, or none.

    `files` are the object and the lines of the comment of each file, by its path; see `write_toml`.
    Raises `InputError` if one of the files cannot be written.
    """
    read = inputs if isinstance(inputs, str) else list(inputs)  # a text is refused below
    rule: dict[str, Any] = {"force": force, "inputs": read}
    refuse(files, endings=[_ENDING], **rule)
    with ExitStack() as complete:
        for path, described in files.items():
            temporary = complete.enter_context(replacing(path, **rule))
            temporary.write_text(toml_text(*described), encoding="utf-8")
    return [Path(path) for path in files]


def _table(section: Mapping[str, Any]) -> Any:
    """Return a section, with its subsections after its keys."""
    table = tomlkit.table(is_super_table=all(isinstance(v, dict) for v in section.values()))
    for key, value in sorted(section.items(), key=lambda item: isinstance(item[1], dict)):
        if isinstance(value, dict):
            table.add(key, _table(value).add(tomlkit.nl()))
        else:
            table.add(key, value)
    return table
