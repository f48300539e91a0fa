"""Which coordinates of a user's mechanism can be independent."""

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
    """Find the sets of joints whose coordinates can be independent, the preferred one first.

    Sets of reported angles and slides are tried, as many at a time as there are degrees of freedom,
    joints on the ground before others. Those from which every loop closes in closed form come
    first, and behind them those that need an iteration, which `Formulation.allow_iteration`
    permits. A trial takes milliseconds and compiles nothing; where there are many sets, take the
    first few.

    Parameters
    ----------
    declared : Formulation, Mechanism, str or Path
        A declaration, or a Python file with one at its top level. What a model prescribes stays
        prescribed; its own choice of independent joints does not count.
    name : str, optional
        Name of the model or mechanism, if the file has several.
    seconds : float, optional
        Each of the two searches, without and with iteration, ends after this time [s]; left out,
        when all sets have been tried.

    Returns
    -------
    iterator of Proposal
        Each with ``independent``, the names of the joints, and ``iterates``; tried one by one, as
        they are asked for.

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
