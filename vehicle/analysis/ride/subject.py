"""The car that a function of this folder is given."""

from typing import Any

from ....core.validator import Validator
from ...assembly.car import CarAssembly
from ...assembly.of import assembly_of
from ...models.car import Car
from ...models.car.equations import CarModel


def car_assembly(source: str, subject: Any, *, riding: bool = True) -> CarAssembly:
    """Return a car, or its equations, as an assembly; refuse what has a body that is held.

    Parameters
    ----------
    source : str
        What asks.
    subject : Any
    riding : bool, optional
        Whether a car that drives is refused, too: its body travels.

    Raises
    ------
    InputError
    """
    with Validator(source) as given:
        given.instance("subject", subject, (Car, CarModel, CarAssembly), _NEEDED)
    found = assembly_of(subject)
    assert isinstance(found, CarAssembly)
    if riding:
        found.require_riding()
    return found


_NEEDED = (
    'a kintrafo.Car, such as kintrafo.load("quarter_car"), is needed; the body of a suspension or '
    "an axle by itself is held"
)
