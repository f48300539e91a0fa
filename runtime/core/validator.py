"""Checks of arguments, the same for every public function.

One error lists all wrong arguments of a call::

    with Validator("equilibrium") as given:
        given.instance("model", model, Model, Model.NEEDED)
        road_height = given.number("road_height", road_height, "m")
"""

import math
from collections.abc import Iterable, Mapping, Sequence
from pathlib import PurePath
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from .errors import InputError
from .named_types import Array
from .suggestions import suggestion

if TYPE_CHECKING:
    from types import TracebackType


_LONGEST = 60
_MOST_PROBLEMS = 200
_NOT_A_NUMBER = bool, np.bool_, str, bytes  # although `float` accepts them


def shown(value: Any) -> str:
    """Return a value as a message shows it, cut to 60 characters."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # noqa: BLE001 (errors of a foreign __repr__ are not the problem)
        text = f"a {type(value).__name__}"
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


class Validator:
    """The arguments of one call of the function `source`; raises one `InputError` for all mistakes.

    Each check returns the argument as it is used, or a harmless value where it is wrong:
    computations between the checks do not fail because of it, and their results are never seen.
    """

    def __init__(self, source: str) -> None:
        self._source = source
        self._problems: list[str] = []

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: "TracebackType | None",
    ) -> None:
        if self._problems:
            raise InputError(self._problems, self._source) from None

    def fail(self, problem: str) -> None:
        """Add a problem."""
        # the numbers of one section may all have the same problem
        if len(self._problems) <= _MOST_PROBLEMS and problem not in self._problems:
            self._problems.append(problem)

    @property
    def failed(self) -> bool:
        """Whether an argument is wrong."""
        return bool(self._problems)

    # -- numbers --------------------------------------------------------------------------------

    def number(
        self,
        name: str,
        value: Any,
        unit: str = "",
        *,
        least: float = -math.inf,
        above: float = -math.inf,
        below: float = math.inf,
        advice: str = "",
    ) -> float:
        """Return a finite number within a range."""
        number = _as_float(value)
        if math.isfinite(number) and least <= number and above < number < below:
            return number
        unit = f" {unit}" if unit else ""
        allowed = [f"of {least:g}{unit} or more"] if least > -math.inf else []
        allowed += [f"above {above:g}{unit}"] if above > -math.inf else []
        allowed += [f"below {below:g}{unit}"] if below < math.inf else []
        text = shown(value) if isinstance(value, str | bytes) else f"{_plain(value)}{unit}"
        words = " ".join(["a finite number", " and ".join(allowed)]).strip()
        self.fail(f"{name} = {text}: {words} is needed. {advice}".strip())
        return max(least, 1.0) if math.isinf(below) else below / 2.0

    def step(self, name: str, value: Any, unit: str = "") -> float:
        """Return a number above zero; infinity is allowed."""
        number = _as_float(value)
        if not number > 0.0:
            unit = f" {unit}" if unit else ""
            self.fail(f"{name} = {_plain(value)}{unit}: a number above 0{unit} is needed.")
            return math.inf
        return number

    def count(self, name: str, value: Any, *, most: int) -> int:
        """Return an integer from 1 to `most`, which infinity represents."""
        return most if _as_float(value) == math.inf else self.whole(name, value, most=most)

    def whole(self, name: str, value: Any, *, least: int = 1, most: float = math.inf) -> int:
        """Return an integer within a range."""
        number = _as_float(value)
        if math.isfinite(number) and number == int(number) and least <= number <= most:
            return int(number)
        up_to = "or more" if math.isinf(most) else f"to {most:g}"
        self.fail(f"{name} = {_plain(value)}: a whole number, {least} {up_to}, is needed.")
        return least

    def array(
        self,
        name: str,
        values: Any,
        unit: str = "",
        *,
        dimensions: Sequence[int] | None = None,
        last: int | None = None,
        empty: bool = False,
        finite: bool = True,
    ) -> Array:
        """Return numbers as an array.

        Refused are other numbers of dimensions than `dimensions`, another length than `last` of the
        last one, no elements without `empty`, and NaN and infinity with `finite`.
        """
        array = _as_array(values)
        in_unit = f", in {unit}," if unit else ""
        if array is None:
            self.fail(f"{name} = {shown(values)}: numbers{in_unit} are needed.")
        elif dimensions is not None and array.ndim not in dimensions:
            shapes = "one number", "a row of numbers", "a table"
            wanted = " or ".join(shapes[d] for d in dimensions)
            hint = f" Write [{float(array):g}] for one." if array.ndim == 0 else ""
            self.fail(f"{name} has the shape {array.shape}: {wanted}{in_unit} is needed.{hint}")
        elif last is not None and array.shape[-1:] != (last,):
            self.fail(f"{name} has the shape {array.shape}: its last dimension must be {last}.")
        elif not empty and array.size == 0:
            self.fail(f"{name} is empty: one number{in_unit} or more is needed.")
        elif finite and not np.isfinite(array).all():
            bad = array[~np.isfinite(array)].flat[0]
            self.fail(f"{name} = {bad:g}{f' {unit}' if unit else ''}: a finite number is needed.")
        else:
            return array
        return np.ones((1,) if last is None else (last,))

    def broadcast(self, what: str, shapes: Iterable[tuple[int, ...]]) -> None:
        """Refuse leading dimensions that are neither equal nor broadcast."""
        listed = list(shapes)
        try:
            np.broadcast_shapes(*listed)
        except ValueError:
            text = ", ".join(map(str, listed))
            self.fail(f"{what}: the leading dimensions {text} must be equal, or broadcast.")

    # -- names and kinds ------------------------------------------------------------------------

    def among(self, name: str, value: Any, known: Iterable[str]) -> Any:
        """Return one of several names."""
        names = list(known)
        if isinstance(value, str) and value in names:
            return value
        hint = f"{suggestion(value, names)} " if isinstance(value, str) else ""
        there = "" if hint.startswith("Known are") else f"Known are: {', '.join(names)}."
        self.fail(f"{name} {shown(value)} is not known. {hint}{there}".strip())
        return next(iter(names), "")

    def names(self, name: str, values: Any, known: Iterable[str]) -> tuple[str, ...]:
        """Return a sequence of known names."""
        if isinstance(values, str) or not np.iterable(values):
            self.fail(f"{name} = {shown(values)}: a list of names is needed.")
            return ()
        every = tuple(known)
        return tuple(self.among(name, value, every) for value in values)

    def labels(self, name: str, labels: Iterable[Any]) -> None:
        """Refuse labels that are the same in an array of texts or of numbers."""
        known: dict[Any, Any] = {}
        for label in labels:
            number = _as_float(label)
            # an array of texts drops zero bytes at the end
            for form in {str(label).rstrip("\0"), *([] if math.isnan(number) else [number])}:
                other = known.setdefault(form, label)
                if other is not label:
                    self.fail(
                        f"{name} has the labels {shown(other)} and {shown(label)}, which are the "
                        "same in an array of labels: rename one of them."
                    )
                    break

    def flag(self, name: str, value: Any) -> bool:
        """Return True or False."""
        if not isinstance(value, bool | np.bool_):
            self.fail(f"{name} = {shown(value)}: True or False is needed.")
        return bool(isinstance(value, bool | np.bool_) and value)

    def text(self, name: str, value: Any) -> None:
        """Refuse an argument that is not a text."""
        self.instance(name, value, str, "a text is needed")

    def paths(self, name: str, values: Any) -> None:
        """Refuse an argument that is not a list of paths."""
        if not isinstance(values, list | tuple):
            self.fail(f"{name} = {shown(values)}: a list of paths is needed.")
            return
        for value in values:
            self.path(name, value)

    def mapping(self, name: str, value: Any, of: str) -> Mapping[Any, Any]:
        """Return a dict."""
        if not isinstance(value, Mapping):
            self.fail(f"{name} = {shown(value)}: a dict of {of} is needed.")
            return {}
        return value

    def instance(self, name: str, value: Any, kinds: type | tuple[type, ...], needed: str) -> Any:
        """Return an instance of a class; `needed` ends the message otherwise."""
        if not isinstance(value, kinds):
            given = "a class, not one of its instances" if isinstance(value, type) else shown(value)
            self.fail(f"{name} = {given}: {needed}.")
        return value

    def path(self, name: str, value: Any) -> None:
        """Refuse an argument that is not the path of a file or folder."""
        self.instance(name, value, (str, PurePath), "the path of a file or folder is needed")

    def dataset(self, value: Any, *, over: str = "") -> None:
        """Refuse an argument that is not a dataset, or has no coordinate `over`."""
        from xarray import Dataset  # noqa: PLC0415 (slow to import)

        self.instance("dataset", value, Dataset, "an xarray.Dataset is needed")
        if over and isinstance(value, Dataset) and over not in value.coords:
            self.fail(f"dataset: it has no coordinate {over!r}, over which its variables must be.")

    def function(self, name: str, value: Any) -> None:
        """Refuse an argument that is neither a function nor None."""
        if not (value is None or callable(value)):
            self.fail(f"{name} = {shown(value)}: a function, or None, is needed.")


def _as_float(value: Any) -> float:
    """Return a number; NaN for anything else."""
    if isinstance(value, _NOT_A_NUMBER):
        return math.nan
    try:
        return float(value)
    except (TypeError, ValueError, OverflowError):
        return math.nan


def _as_array(values: Any) -> Array | None:
    """Return an array of numbers; None for anything else."""
    try:
        array = np.asarray(values)
        if array.dtype.kind == "O":
            array = np.array([_as_float(v) if v is not None else "" for v in array.flat])
            array = array.reshape(np.shape(values))
        if array.dtype.kind not in "iuf" and array.size:
            return None
        return array.astype(np.float64, copy=False)
    except (TypeError, ValueError, OverflowError):
        return None


def _plain(value: Any) -> str:
    """Return a number in few digits, and any other value as `shown`."""
    number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
    try:
        return f"{value:g}" if number else shown(value)
    except (TypeError, ValueError, OverflowError):
        return shown(value)
