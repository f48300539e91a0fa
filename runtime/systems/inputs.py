"""Inputs of equations that are time derivatives of other inputs."""

from collections.abc import Mapping
from typing import Any

Inputs = Mapping[str, Mapping[str, Any]]
"""The table ``INPUTS`` of some equations."""


def rates_of(name: str, inputs: Inputs) -> tuple[str, ...]:
    """Return the inputs that are the derivatives of an input, in order, of all `inputs`.

    Examples
    --------
    >>> from kintrafo.generated import macpherson
    >>> rates_of("rack_position", macpherson.INPUTS)
    ('rack_velocity', 'rack_acceleration')
    """
    rates = []
    while found := [n for n, entry in inputs.items() if entry["derivative_of"] == name]:
        (name,) = found
        rates.append(name)
    return tuple(rates)


def derived_inputs(inputs: Inputs) -> dict[str, str]:
    """Return the inputs that follow from another one, with the name of that input."""
    given = [name for name, entry in inputs.items() if entry["derivative_of"] is None]
    return {rate: name for name in given for rate in rates_of(name, inputs)}


def may_jump(rates: int) -> bool:
    """Return whether an input may jump, from the number of its derivatives that equations read.

    An input with an acceleration drives a mass. An input with a rate alone acts on a
    damper, on which a jump has no impulse.
    """
    return rates < 2
