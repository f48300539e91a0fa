"""Which inputs of some equations are the time derivatives of another one.

The equations do not say it themselves, so that it is read from the names: here, and nowhere else.
"""

from functools import cache

# What follows by differentiation in time from an input that ends so, where the equations take it.
_RATES = {
    "_position": ("_velocity", "_acceleration"),
    "_height": ("_velocity",),
}
# A jump of a road passes the tyre's damper without a blow; nothing else may jump whose rate counts.
_MAY_JUMP = "_height"


@cache
def rates_of(name: str, names: tuple[str, ...]) -> tuple[str, ...]:
    """Return the inputs that are the derivatives of another one, in order.

    Parameters
    ----------
    name : str
        The other one.
    names : tuple of str
        All inputs of the equations.

    Examples
    --------
    >>> rates_of("rack_position", ("rack_position", "rack_velocity", "road_height"))
    ('rack_velocity',)
    """
    stem, rates = _split(name)
    return tuple(stem + rate for rate in rates if stem + rate in names)


def derived_inputs(names: tuple[str, ...]) -> dict[str, str]:
    """Return the inputs that follow from another one, and from which.

    Parameters
    ----------
    names : tuple of str
        All inputs of the equations.
    """
    return {rate: name for name in names for rate in rates_of(name, names)}


def may_jump(name: str) -> bool:
    """Return whether an input may jump although the equations take its rate."""
    return name.endswith(_MAY_JUMP)


def what_moves(name: str) -> str:
    """Return what an input moves, as the subject of a sentence: "rack" of "rack_position"."""
    return _split(name)[0]


def _split(name: str) -> tuple[str, tuple[str, ...]]:
    """Return the name without its ending, and how the names of its derivatives end."""
    for ending, rates in _RATES.items():
        if name.endswith(ending):
            return name.removesuffix(ending), rates
    return name, ()
