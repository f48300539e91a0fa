"""Coordinates of a user's mechanism that can be independent."""

from typing import TYPE_CHECKING

from ...core.validator import Validator
from .build import require_generator
from .declaration import given_by, translated_errors

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from ...generator import Formulation, Mechanism
    from ...generator.planning.proposal import Proposal


def proposals(
    declared: "Formulation | Mechanism | str | Path",
    *,
    name: str | None = None,
    seconds: float | None = None,
) -> "Iterator[Proposal]":
    """Return the sets of joints whose coordinates can be independent, the preferred one first.

    A set has as many angles and slides of joints as there are degrees of freedom; joints on the
    ground are tried before others. Sets with which every loop closes in closed form come first,
    followed by those that need an iteration, which `Formulation.allow_iteration` permits. A trial
    takes milliseconds and compiles nothing; of many sets, take the first few.

    Parameters
    ----------
    declared : Formulation, Mechanism, str or Path
        A declaration, or a Python file with one at its top level. Coordinates that a model
        prescribes stay prescribed; its own choice of independent joints is ignored.
    name : str, optional
        Name of the model or mechanism, if the file has several.
    seconds : float, optional
        Time after which each of the two searches, without and with iteration, ends [s]; by default
        all sets are tried.

    Returns
    -------
    iterator of Proposal
        Each with ``independent``, the names of the joints, and ``iterates``. The next set is tried
        when the iterator is advanced.

    Raises
    ------
    InputError
        If the file cannot be run.
    MechanismError
        If the declaration contradicts itself.
    MissingPackageError
        If the packages of the extra "generator" are not installed.

    Examples
    --------
    >>> import kintrafo
    >>> from kintrafo.generator.mechanisms.slider_crank import SLIDER_CRANK
    >>> next(kintrafo.proposals(SLIDER_CRANK))
    Proposal(independent=('A',), iterates=False)
    """
    with Validator("proposals") as given:
        if seconds is not None:
            seconds = given.step("seconds", seconds, "s")
    require_generator()
    return _tried(given_by(declared, name), seconds)


def _tried(given: "Formulation | Mechanism", seconds: float | None) -> "Iterator[Proposal]":
    from ...generator.planning.proposal import proposals as found

    with translated_errors():
        yield from found(given, seconds)
