"""The base of objects that a file describes: suspensions, axles and cars."""

from abc import abstractmethod
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any, ClassVar, Self

from pydantic import ValidationError

from ...core.errors import InputError
from ...core.validator import Validator, shown
from ..data import data_sets, find
from ..data.starter import (
    AXLE,
    AXLES,
    CAR,
    CARS,
    all_packaged,
    whole_axle_in,
    whole_axles,
    words_of,
)
from .messages import is_named, messages_of
from .places import put
from .section import Section
from .toml_file import problems_in, read_toml
from .toml_writer import write_toml


def described_by(path_or_name: str | Path) -> str:
    """Return the top-level key of a file, or of a packaged data set, that names its object.

    It is 'car', 'axle', or the key of an axle without sides; empty for a suspension, and for a file
    that is missing or cannot be read, which its reader reports.
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
    """Refuse any object but a mapping with texts as keys.

    `source` and `name`, of the argument, begin the message; `words` is the expected content:
    'places and values'.
    """
    with Validator("input data") as checked:
        checked.instance("source", source, str, "a text is needed")
    with Validator(source) as checked:
        for key in checked.mapping(name, given, words):
            checked.instance(f"key of {name}", key, str, "a text is needed")


def parts_of(
    described: Any, makers: Mapping[str, Callable[[Any, Path, str], Any]], folder: Path, source: str
) -> dict[str, Any]:
    """Return the parts that are named in a file, by key.

    `makers` return a part from value, folder of the file and key. Raises `InputError` with the
    problems of all of them.
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
    """An object that a file describes."""

    whole_car: ClassVar[bool] = False  # whether it is a car, of which axles or a corner are parts

    @property
    def parts_named(self) -> list[str]:
        """The file names of the parts of a car, except those that are tables."""
        return []

    @classmethod
    @abstractmethod
    def packaged(cls) -> Mapping[str, Traversable]:
        """Return the packaged files, by name."""

    @classmethod
    @abstractmethod
    def from_dict(cls, data: Mapping[str, Any], source: str = "input data") -> Self:
        """Return an object from nested dictionaries with the keys of the file.

        Parameters
        ----------
        data : mapping
            The sections, with their keys and units as in the file.
        source : str, optional
            Origin of the data, for error messages.

        Returns
        -------
        Suspension, Axle, RigidAxle or Car
            A suspension is of the kind that the data name.

        Raises
        ------
        InputError
            If the data are not valid; it lists all problems.
        """

    @abstractmethod
    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged."""

    @classmethod
    def load(cls, path_or_name: str | Path) -> Self:
        """Return the object that a TOML file describes, with the files that it names.

        Parameters
        ----------
        path_or_name : str or pathlib.Path
            The file; or, as a string, the name of a packaged one, such as ``"reference_car"``,
            ``"reference_axle"``, ``"rigid_axle"`` or ``"quarter_car"``.

        Returns
        -------
        Suspension, Axle, RigidAxle or Car
            A suspension is of the kind that the file names.

        Raises
        ------
        InputError
            If a file cannot be read, or its data are not valid; it lists all problems.
        """
        with Validator(cls.__name__) as given:
            given.path("path_or_name", path_or_name)
        # another kind of file is recognised by its content; names to suggest are of this kind
        others = all_packaged()
        file = find(path_or_name, others if path_or_name in others else cls.packaged())
        folder = file.parent if isinstance(file, Path) else Path()
        data = read_toml(file)
        # the path of a packaged file would not help a caller who gave a name
        source = str(path_or_name)
        with problems_in(file, source):
            return cls._of_file(data, source, folder)

    @classmethod
    def _of_file(cls, data: Mapping[str, Any], source: str, folder: Path) -> Self:
        """Return an object from the content of a file in a folder."""
        return cls.from_dict(data, source)

    def save(self, path: str | Path, *, force: bool = False) -> Path:
        """Write an input file with exactly these data, those of named files included.

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
            If the file exists already, or the name cannot be used; or if a tyre of a car was made
            in Python and has no file.
        """
        with Validator(type(self).__name__) as given:
            given.path("path", path)
            given.flag("force", force)
        return write_toml(self, path, force=force)

    @classmethod
    @abstractmethod
    def _called(cls) -> str:
        """Return the name of the object in messages."""

    def _changed_data(
        self, changes: Mapping[str, Any], parts: Iterable[str] = ()
    ) -> tuple[dict[str, Any], dict[str, dict[str, Any]], str]:
        """Return the sections with changes, the changes of each part, and words for messages."""
        check_keys(self._called(), "changes", changes, "places and values")
        data, problems = self.to_dict(), list[str]()
        of_part: dict[str, dict[str, Any]] = {name: {} for name in parts}
        for place, value in changes.items():
            section, _, key = place.partition(".")
            if section in of_part and key:
                of_part[section][key] = value
            elif problem := put(data, place, value):
                problems.append(problem)
        source = f"{self._called()} with changed {', '.join(changes)}"
        if problems:
            raise InputError(problems, source)
        return data, of_part, source


class DescribedParts(Described):
    """An object whose file names the files of its parts."""

    KEY: ClassVar[str]  # top-level key of such a file
    FILE: ClassVar[type[Section]]  # section of the file itself
    PACKAGE: ClassVar[str]  # package of the packaged files

    @classmethod
    def packaged(cls) -> Mapping[str, Traversable]:
        return data_sets(cls.PACKAGE)

    @classmethod
    def _called(cls) -> str:
        return cls.KEY

    @classmethod
    def _of_file(cls, data: Mapping[str, Any], source: str, folder: Path) -> Self:
        return cls.from_dict(data, source, folder=folder)

    @classmethod
    def from_dict(
        cls, data: Mapping[str, Any], source: str = "input data", *, folder: str | Path = "."
    ) -> Self:
        """Return an object from nested dictionaries with the keys of the file.

        Parameters
        ----------
        data : mapping
            The sections, with their keys and units as in the file. A part is the name of a file, an
            object such as a `Suspension`, or the nested dictionaries of one.
        source : str, optional
            Origin of the data, for error messages.
        folder : str or pathlib.Path, optional
            The folder to which paths are relative.

        Raises
        ------
        InputError
            If the data are not valid; it lists all problems.
        """
        check_keys(source, "data", data, f"keys and values of {words_of(cls.KEY)}'s file")
        with Validator(source) as checked:
            checked.path("folder", folder)
        if cls.KEY not in data:
            raise InputError([cls._without_key(data)], source)
        try:
            described = cls.FILE(**data)
        except ValidationError as error:
            raise InputError(messages_of(error, cls.FILE, data), source) from None
        return cls._of_parts(described, Path(folder), source)

    @classmethod
    @abstractmethod
    def _without_key(cls, data: Mapping[str, Any]) -> str:
        """Return the problem of data without the top-level key."""

    @classmethod
    @abstractmethod
    def _of_parts(cls, described: Any, folder: Path, source: str) -> Self:
        """Return an object from its own file, whose parts are in a folder."""


class DescribedSection(Described, Section):
    """An object whose attributes are the sections of a file."""

    def to_dict(self, *, exclude_defaults: bool = False) -> dict[str, Any]:
        """Return the sections as nested dictionaries, which `from_dict` takes back unchanged.

        Parameters
        ----------
        exclude_defaults : bool, optional
            Whether default values are left out.

        Returns
        -------
        dict
            A copy of all values, with the keys and units of the input file; points are lists.
        """
        return self.model_dump(mode="json", exclude_none=True, exclude_defaults=exclude_defaults)

    def with_changes(self, changes: Mapping[str, Any]) -> Self:
        """Return an object that differs in some values; all checks are made again.

        Parameters
        ----------
        changes : mapping of str to Any
            New values in the file's units by place, section and key with dots between them. A
            component of a point is a place, too. None removes an optional key, or a section with a
            free name.

        Returns
        -------
        Suspension, RigidAxle or another one
            Of the same class.

        Raises
        ------
        InputError
            If there is no such place, or the data are not valid.

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
        data, _, source = self._changed_data(changes)
        for section in filter(partial(is_named, type(self)), data):
            if isinstance(data[section], dict):
                data[section] = {n: v for n, v in data[section].items() if v is not None}
        return self.from_dict(data, source)
