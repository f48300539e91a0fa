"""Levels of signals, as a manifest gives them: a number, or a parameter with its sign."""

from ..systems.system import System


def parameter_of(model: System, level: float | str) -> float:
    """Return the value of a level in SI units.

    Parameters
    ----------
    model : System or Model
    level : float or str
        A number, or the name of a parameter, with a minus before it or without.

    Examples
    --------
    >>> from kintrafo import Model
    >>> parameter_of(Model("reference_car"), "-strut_length_max")
    -0.85
    """
    if not isinstance(level, str):
        return level
    value = model.parameters[level.removeprefix("-")]
    return -value if level.startswith("-") else value
