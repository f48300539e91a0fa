"""The car of an analysis of its ride."""

from typing import Any

from ...assembly.car import CarAssembly
from ...assembly.of import car_assembly_of


def car_assembly(source: str, subject: Any, *, riding: bool = True) -> CarAssembly:
    """Return a car as an assembly, or raise an `InputError`; for `riding` if its body travels."""
    found = car_assembly_of(source, subject, _NEEDED)
    if riding:
        found.require_riding()
    return found


_NEEDED = (
    'a kintrafo.Car, such as kintrafo.load("quarter_car"), is needed; the body of a suspension or '
    "an axle alone is held"
)
