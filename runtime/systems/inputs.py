"""Which inputs of some equations are the time derivatives of another one, as the equations say."""

from collections.abc import Mapping
from typing import Any

Inputs = Mapping[str, Mapping[str, Any]]
"""The table ``INPUTS`` of some equations."""


def rates_of(name: str, inputs: Inputs) -> tuple[str, ...]:
    """Return the inputs that are the derivatives of another one, in order.

    Parameters
    ----------
    name : str
        The other one.
    inputs : mapping
        All inputs of the equations, with what each is the derivative of.

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
    """Return the inputs that follow from another one, and from which: none that follows itself.

    Parameters
    ----------
    inputs : mapping
        All inputs of the equations, with what each is the derivative of.
    """
    given = [name for name, entry in inputs.items() if entry["derivative_of"] is None]
    return {rate: name for name in given for rate in rates_of(name, inputs)}


def may_jump(rates: int) -> bool:
    """Return whether an input may jump of which the equations take so many derivatives.

    Where they take an acceleration, something with mass follows the input. A rate alone is what a
    damper takes, which a jump of a road passes without a blow.
    """
    return rates < 2
