"""The loads of load cases by name, as curves of design studies: joints, springs, rods.

The name of a force is that of its joint, spring or road, as in the table of `kintrafo loads`:
``ball_joint_force``, ``spring_force_left``. A rod has its force along it by its own name:
``tie_rod_force``.
"""

import re
from collections.abc import Iterator, Mapping

import numpy as np
import xarray as xr

from ....core.named_types import Array
from ...assembly.by_wheel import flat
from ...assembly.quantity import Quantity
from ...assembly.steering_linkage import IDLER
from ...corner.structure import GROUND
from ...models.sides import SIDES
from .dataset import AXIS, CASE
from .sheets import acts, once

_UNITS = {"force": "N", "moment": "N m"}
# Further results of load cases, with unit and words.
_FURTHER = {
    "travel": ("m", "wheel travel"),
    "wheel_load": ("N", "vertical force of the road"),
    "bar_torque": ("N m", "torque of the anti-roll bar"),
}
_ENDS = 2  # of a rod, with a load at each
_NAME = re.compile(r"(\w+?)_(force|moment)(?:_([xyz]))?(?:_(left|right))?")


def columns(found: xr.Dataset) -> dict[str, Array]:
    """Return the loads of a result of `static` by name, (cases,), SI units.

    ``NAME_force`` and ``NAME_moment`` are magnitudes, ``NAME_force_x`` and so on components on the
    part that `kintrafo loads --case` names, in chassis axes. ``ROD_force`` is positive in tension.
    Names end in the side of an axle.
    """
    found = flat(found)
    labels = [found[name].values.astype(str) for name in ("part", "point", "by")]
    loads = [*zip(*labels, strict=True)]
    named: dict[str, Array] = {}
    for row in once(found):
        _, point, by = loads[row]
        stem, side = _apart(by if acts(by) else point)
        for kind in _UNITS:
            values = found[kind].transpose(AXIS, CASE, ...).values[..., row]
            named[f"{stem}_{kind}{side}"] = np.linalg.norm(values, axis=0)
            named |= {f"{stem}_{kind}_{axis}{side}": values[i] for i, axis in enumerate("xyz")}
    for rod in dict.fromkeys(labels[0]):
        ends = [row for row, (part, _, by) in enumerate(loads) if part == rod and by != "gravity"]
        if len(ends) == _ENDS and rod not in (*GROUND, IDLER):
            stem, side = _apart(rod)
            named[f"{stem}_force{side}"] = _tension(found, *ends)
    others = {
        str(name): data.values
        for name, data in found.items()
        if data.dims == (CASE,) and name in LOADS and _apart(str(name))[0] != "holding_force"
    }
    return named | others


def _tension(found: xr.Dataset, end: int, other: int) -> Array:
    """Return the force along a rod by the rows of the loads at its ends, positive in tension."""
    force, at = (found[name].transpose("load", CASE, AXIS).values for name in ("force", "at"))
    along = at[end] - at[other]
    tension: Array = (force[end] * along).sum(axis=-1) / np.linalg.norm(along, axis=-1)
    return tension


def _apart(name: str) -> tuple[str, str]:
    """Return a name without a side at its end, and this side with its ``_``."""
    side = next((f"_{side}" for side in SIDES if name.endswith(f"_{side}")), "")
    return name.removesuffix(side), side


class _Loads(Mapping[str, Quantity]):
    """The quantities of all loads by name; those of a file depend on its joints and rods."""

    def __getitem__(self, name: str) -> Quantity:
        if _apart(name)[0] in _FURTHER:
            stem, side = _apart(name)
            found = Quantity(stem, *_FURTHER[stem], f"{_FURTHER[stem][1]} in a load case", "")
        elif of := _NAME.fullmatch(name):
            stem, kind, axis, side = of.groups("")
            words = f"{stem} {kind}".replace("_", " ") + (axis and f" along {axis}")
            what = f"component on a part, chassis axes, of the {kind}" if axis else f"{kind}"
            meaning = f"{what} at a joint, of a spring or of the road, or along a rod"
            sign = "" if axis or kind == "moment" else "along a rod positive in tension"
            stem = f"{stem}_{kind}{axis and f'_{axis}'}"
            found = Quantity(stem, _UNITS[kind], words, meaning, sign)
        else:
            raise KeyError(name)
        return found.of_wheel(side.strip("_"))

    def __iter__(self) -> Iterator[str]:
        """Yield the further results, and forms of the names of all others."""
        yield from ("NAME_force", "NAME_force_x", "NAME_moment", "NAME_moment_x", *_FURTHER)

    def __len__(self) -> int:
        return sum(1 for _ in self)


LOADS: Mapping[str, Quantity] = _Loads()
"""The quantities of the loads, by name."""
