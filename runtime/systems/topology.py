"""The structure of a compiled mechanism: bodies, joints, loops, transformers.

It is read from the model's manifest, so nothing is derived and SymPy is not needed.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib import import_module
from pkgutil import iter_modules
from types import ModuleType
from typing import Any

from .. import generated
from ..core.validator import Validator


@dataclass(frozen=True)
class Topology:
    """The structure of a mechanism.

    Attributes
    ----------
    title : str
        Title of the mechanism and of its model.
    bodies : tuple of str
        The moving bodies.
    joints : tuple of dict
        Name, type, the two bodies, number of degrees of freedom, and the geometry that both bodies
        share.
    mobility : int
        Number of independent coordinates (Grübler).
    numbers : tuple of int
        The numbers of all bodies, the ground among them.
    paths : tuple of tuple of tuple of str
        All shortest paths from each body to each, as the numbers of the bodies along them; the
        length of a joint is its number of degrees of freedom.
    candidates : dict
        Counts in Horton's construction: ``pairs`` of a body and a joint that do not touch, those
        that are ``closing``, and their ``cycles``, with repetitions.
    cycles : tuple of tuple
        The bodies of each simple cycle that may be chosen, and its length.
    loops : tuple of tuple of str
        The bodies of each independent loop, in the order in which the loops are solved.
    pairs : tuple of tuple of dict
        For each loop, the pairs of joints that were tried, and which one was chosen.
    transformers : tuple of dict
        For each loop ``inputs`` and ``outputs``, the ``equation`` that closes it, and its
        ``solution``.
    """

    title: str
    bodies: tuple[str, ...]
    joints: tuple[dict[str, str], ...]
    mobility: int
    numbers: tuple[int, ...]
    paths: tuple[tuple[tuple[str, ...], ...], ...]
    candidates: dict[str, int]
    cycles: tuple[tuple[str, int], ...]
    loops: tuple[tuple[str, ...], ...]
    pairs: tuple[tuple[dict[str, str], ...], ...]
    transformers: tuple[dict[str, Any], ...]


def topology(model: str | ModuleType = "macpherson") -> Topology:
    """Return the structure of a compiled mechanism.

    Parameters
    ----------
    model : str or module, optional
        Name of a module of `kintrafo.generated`, or the result of `kintrafo.compile`.

    Returns
    -------
    Topology

    Examples
    --------
    >>> from kintrafo import topology
    >>> found = topology.topology()
    >>> found.mobility, [len(loop) for loop in found.loops]
    (3, [4, 5])
    >>> [pair[0]["pair with a common distance"] for pair in found.pairs]
    ['B, C', 'D, E']
    """
    equations = model
    if not isinstance(equations, ModuleType):
        with Validator("topology") as given:
            named = {module.name for module in iter_modules(generated.__path__)}
            needed = "a name, or a result of kintrafo.compile, is needed"
            given.instance("model", model, str, needed)
            if not given.failed:
                given.among("model", model, sorted(n for n in named if not n.startswith("_")))
        equations = import_module(f".{model}", generated.__name__)
    manifest = equations.equations.manifest
    numbers = manifest["numbers"]
    transformers = manifest["transformers"]
    return Topology(
        title=manifest["title"],
        bodies=tuple(manifest["bodies"]),
        joints=tuple(_joint(joint, numbers) for joint in manifest["joints"]),
        mobility=manifest["mobility"],
        numbers=tuple(numbers.values()),
        paths=tuple(tuple(map(tuple, row)) for row in manifest["paths"]),
        candidates=manifest["candidates"],
        cycles=tuple(
            (" - ".join(f"{numbers[body]} {body}" for body in cycle["bodies"]), cycle["length"])
            for cycle in manifest["cycles"]
        ),
        loops=tuple(tuple(t["bodies"]) for t in transformers),
        pairs=tuple(tuple(map(_pair, t["pairs"])) for t in transformers),
        transformers=tuple(transformers),
    )


def _joint(joint: Mapping[str, Any], numbers: Mapping[str, int]) -> dict[str, str]:
    first, second = joint["bodies"]
    return {
        "joint": joint["name"],
        "type": joint["type"],
        "first body": f"{numbers[first]} {first}",
        "second body": f"{numbers[second]} {second}",
        "degrees of freedom": str(joint["freedoms"]),
        "leaves in common": joint["common"],
    }


def _pair(pair: Mapping[str, Any]) -> dict[str, str]:
    return {
        "pair with a common distance": ", ".join(pair["joints"]),
        "unknowns eliminated": str(pair["eliminated"]),
        "equations left": str(pair["equations"]),
        "": "chosen" if pair["chosen"] else "",
    }
