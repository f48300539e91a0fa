"""What a file describes, and what suspensions, axles and cars have in common."""

from abc import abstractmethod
from collections.abc import Callable, Mapping
from functools import partial
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, Self

from ...core.errors import InputError
from ...core.validator import Validator, shown
from ..data import data_sets, find
from ..data.starter import AXLE, AXLES, CAR, CARS, all_packaged, whole_axle_in, whole_axles
from .messages import is_named
from .places import put
from .section import Section
from .toml_file import read_toml
from .toml_writer import write_toml


def described_by(path_or_name: str | Path) -> str:
    """Return the top-level key of what a file, or a packaged name, describes.

    'car', 'axle', or that of an axle without sides; empty for a suspension, and where there is no
    file or it cannot be read: its reader then says why.
    """
    for package, key in ((CARS, CAR), (AXLES, AXLE)):
        if path_or_name in data_sets(package):
            return key
    if path_or_name in whole_axles():
        return str(path_or_name)
    if path_or_name in data_sets() or not Path(path_or_name).is_file():
        return ""
    try:
        data = read_toml(Path(path_or_name))
    except InputError:
        return ""
    return CAR if CAR in data else whole_axle_in(data) or (AXLE if AXLE in data else "")


def check_keys(source: str, name: str, given: Any, words: str) -> None:
    """Refuse what is no mapping with texts as keys.

    Parameters
    ----------
    source : str
        What is read or changed.
    name : str
        Of the argument.
    given : Any
    words : str
        What it has to be: 'places and values'.
    """
    with Validator(source) as checked:
        for key in checked.mapping(name, given, words):
            checked.instance(f"key of {name}", key, str, "a text is needed")


def parts_of(
    described: Any, makers: Mapping[str, Callable[[Any, Path, str], Any]], folder: Path, source: str
) -> dict[str, Any]:
    """Return the parts that some keys of a file name, by key; missing ones are left out.

    Parameters
    ----------
    described : Section
        The file.
    makers : mapping of str to callable
        By key: the function that returns the part, from value, folder of the file and key.
    folder : Path
    source : str
        The file, for messages.

    Raises
    ------
    InputError
        With the problems of all of them.
    """
    found, problems = {}, list[str]()
    for key, make in makers.items():
        given = getattr(described, key)
        if given is None:
            continue
        try:
            found[key] = make(given, folder, key)
        except InputError as error:
            named = f"{key} = {shown(given)}" if isinstance(given, str) else key
            problems += [f"{named}: {problem}" for problem in error.problems]
    if problems:
        raise InputError(problems, source)
    return found


class Described:
    """What a file describes."""

    @classmethod
    @abstractmethod
    def packaged(cls) -> Mapping[str, Traversable]:
        """Return the files of those that come with kintrafo, by their names."""

    @classmethod
    @abstractmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        """Return what nested dictionaries with the keys of the file describe."""

    @abstractmethod
    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged."""

    @classmethod
    def load(cls, path_or_name: str | Path) -> Self:
        """Read it from a TOML file, and from those that the file names.

        Parameters
        ----------
        path_or_name : str or pathlib.Path
            The file; or, as a string, the name of one that comes with kintrafo, such as
            ``"reference_car"``, ``"reference_axle"``, ``"rigid_axle"`` or ``"quarter_car"``.

        Returns
        -------
        Suspension, Axle, RigidAxle or Car
            A suspension is of the kind that the file names.

        Raises
        ------
        InputError
            If a file cannot be read, or nothing can be like this; it lists everything that is
            wrong.
        """
        with Validator(cls.__name__) as given:
            given.path("path_or_name", path_or_name)
        # another kind of file is recognised by its content; names to suggest are of this kind
        others = all_packaged()
        file = find(path_or_name, others if path_or_name in others else cls.packaged())
        folder = file.parent if isinstance(file, Path) else Path()
        # a path inside the package would not help where a name was given
        return cls._of_file(read_toml(file), str(path_or_name), folder)

    @classmethod
    def _of_file(cls, data: Mapping[str, Any], source: str, folder: Path) -> Self:
        """Return what the content of a file in a folder describes."""
        del folder
        return cls.from_dict(data, source)

    def save(self, path: str | Path, *, force: bool = False) -> Path:
        """Write the input file that gives exactly this, with all that it names in it.

        Parameters
        ----------
        path : str or Path
            A name that ends in ``.toml``.
        force : bool, optional
            Whether a file that kintrafo did not write is replaced.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            If there is a file already, or the name cannot be used.
        """
        with Validator(type(self).__name__) as given:
            given.path("path", path)
            given.flag("force", force)
        return write_toml(self, path, force=force)


class DescribedSection(Described, Section):
    """What a file describes whose sections are its attributes."""

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        Parameters
        ----------
        exclude_defaults : bool, optional
            Whether values that are as by default are left out.

        Returns
        -------
        dict
            A copy of all values, with the keys and units of the input file; points are lists.
        """
        return self.model_dump(mode="json", exclude_none=True, exclude_defaults=exclude_defaults)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return one that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            For each place in the file, section and key with dots between them, the new value in
            the file's unit. A component of a point is a place too. None removes an optional key,
            or a section with a name of any choice.

        Returns
        -------
        Suspension, RigidAxle or another one
            Of the same class.

        Raises
        ------
        InputError
            If there is no such place, or nothing can be like this.

        Examples
        --------
        >>> from kintrafo import Suspension
        >>> car = Suspension.load("reference_car")
        >>> stiffer = car.with_changes(
        ...     {"strut.spring_rate_N_per_m": 30e3, "hardpoints.ball_joint.z": 185.0}
        ... )
        >>> stiffer.hardpoints.ball_joint
        (5.0, -710.0, 185.0)
        """
        said = self._called()
        check_keys(said, "changes", changes, "places and values")
        data = self.to_dict()
        source = f"{said} with changed {', '.join(changes)}"
        problems = [problem for place in changes if (problem := put(data, place, changes[place]))]
        if problems:
            raise InputError(problems, source)
        for section in filter(partial(is_named, type(self)), data):
            if isinstance(data[section], dict):
                data[section] = {n: v for n, v in data[section].items() if v is not None}
        return self.from_dict(data, source)

    @classmethod
    @abstractmethod
    def _called(cls) -> str:
        """Return what it is called in messages."""
