"""``kintrafo mechanism topology``: bodies, joints, mobility, loops and their solutions."""

from itertools import islice
from types import ModuleType
from typing import TYPE_CHECKING, Annotated, Any

from rich.table import Table

from ....terminal.console import console, print_json, say
from ..loading import model_of
from ..options import Json, Which, argument, option, refuse_which

if TYPE_CHECKING:
    from ....systems.topology import Topology

EXAMPLES = (
    "kintrafo mechanism topology",
    "kintrafo mechanism topology my_car.toml --json",
    "kintrafo mechanism topology my_mechanism.py",
)

# Headings of the table of joints that differ from the keys of the result.
_HEADINGS = {"leaves in common": "in common"}
_SECONDS = 3.0  # of search for joints that can be independent
_MOST_CHOICES = 6

_FREE_RACK = "macpherson_free_rack"


def command(
    file: Annotated[
        str | None,
        argument(
            "File of a suspension, an axle or a car, or Python file with a mechanism of your own. "
            "Default: the suspension of the paper.",
            "FILE",
        ),
    ] = None,
    *,
    model: Which = None,
    free_rack: Annotated[bool, option("The mechanism with the rack as a coordinate.")] = False,
    json: Json = False,
) -> None:
    """Show bodies, joints, mobility, loops and characteristic pairs of the mechanism.

    For a mechanism of your own, the joints that can be independent are listed, too.
    """
    from ....systems.topology import topology

    refuse_which(file, model)
    found = topology(
        _FREE_RACK if free_rack else "macpherson" if file is None else _equations(file, model)
    )
    choices = _choices(file, model) if file is not None and file.endswith(".py") else None
    if json:
        kept = ("title", "bodies", "joints", "mobility", "paths", "candidates", "loops", "pairs")
        facts = {key: getattr(found, key) for key in kept}
        print_json(facts if choices is None else facts | {"choices": choices})
        return
    joints = Table(title=f"{found.title}: joints")
    for column in found.joints[0]:
        joints.add_column(_HEADINGS.get(column, column))
    for joint in found.joints:
        joints.add_row(*joint.values())
    console.print(joints)
    say(f"Mobility {found.mobility}; {len(found.loops)} independent loops, solved in this order.")
    for choice in choices or ():
        needs = ", if loops may be solved by iteration" if choice["iterates"] else ""
        say(f"Can be independent: {', '.join(choice['independent'])}{needs}")
    _show_paths(found)
    _show_loops(found)


def _show_paths(found: "Topology") -> None:
    paths = Table("", *map(str, found.numbers), title="Shortest paths between bodies")
    for number, row in zip(found.numbers, found.paths, strict=True):
        paths.add_row(str(number), *(" or ".join(cell) for cell in row))
    console.print(paths)
    tried = found.candidates
    say(
        f"{tried['pairs']} pairs of a body and a joint that do not touch; {tried['closing']} of "
        f"them close, to {tried['cycles']} cycles if paths of equal length are counted separately, "
        f"of which {len(found.cycles)} are distinct."
    )


def _show_loops(found: "Topology") -> None:
    cycles = Table("bodies", "length", title="Cycles")
    for bodies, length in found.cycles:
        cycles.add_row(bodies, str(length))
    console.print(cycles)
    for number, (loop, pairs) in enumerate(zip(found.transformers, found.pairs, strict=True), 1):
        say(f"\nTransformer {number}: {' - '.join(loop['bodies'])} (length {loop['length']})")
        say(f"  from      {', '.join(loop['inputs'])}")
        say(f"  to        {', '.join(loop['outputs'])}")
        say(f"  equation  {loop['equation']}")
        say(f"  solution  {loop['solution']}")
        tried = Table(*(pairs[0] if pairs else ()))
        for pair in pairs:
            tried.add_row(*pair.values())
        if pairs:
            console.print(tried)


def _equations(file: str, model: str | None) -> ModuleType:
    """Return the compiled equations of a file."""
    if not file.endswith(".py"):
        return model_of(file).equations
    from ....systems.compile.build import compile_mechanism

    return compile_mechanism(file, name=model)


def _choices(file: str, model: str | None) -> list[dict[str, Any]]:
    """Return some sets of joints that can be independent."""
    from ....systems.compile.choices import proposals

    first = islice(proposals(file, name=model, seconds=_SECONDS), _MOST_CHOICES)
    return [{"independent": p.independent, "iterates": p.iterates} for p in first]
