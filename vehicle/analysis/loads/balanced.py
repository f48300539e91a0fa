"""All loads on the parts of a held assembly, in balance with inertia."""

from collections.abc import Mapping
from typing import NamedTuple, Self

import xarray as xr

from ....core.named_types import Array
from ....core.quantities import attributes
from ....datasets.recording import TIME
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import stacked
from ...assembly.load import Load
from ...assembly.part_poses import PartPoses
from .dataset import loads_of
from .reactions import BalanceEquations


class BalancedLoads(NamedTuple):
    """The loads in n states of equations of motion, in the axes of the assembly's file.

    Attributes
    ----------
    assembly : HeldAssembly
    poses : mapping of str to PartPoses
        By suffix.
    loads : dict of str to list of Load
        All loads on each group of parts, by suffix, those of the joints first.
    holding : list of ndarray
        Residual vertical force on each wheel, (n,) [N].
    """

    assembly: HeldAssembly
    poses: Mapping[str, PartPoses]
    loads: dict[str, list[Load]]
    holding: list[Array]

    @classmethod
    def of(
        cls, assembly: HeldAssembly, poses: Mapping[str, PartPoses], known: Mapping[str, list[Load]]
    ) -> Self:
        """Return the known loads by suffix, with inertia, and those of the joints."""
        loads: dict[str, list[Load]] = {}
        holding: list[Array] = []
        for suffix, group in poses.items():
            equations = BalanceEquations(group)
            unknowns = equations.solve(equations.applied(known[suffix]))
            loads[suffix] = [*equations.carried(unknowns), *known[suffix]]
            holding += [*unknowns[:, -len(group.wheels) :].T]
        return cls(assembly, poses, loads, holding)

    def dataset(self) -> xr.Dataset:
        """Return the loads over time, as in `kintrafo.loads.along`."""
        found = loads_of(TIME, self.assembly, self.poses, self.loads)
        meaning = "residual vertical force at the wheel"
        return found.assign(holding_force=stacked(TIME, self.holding, attributes(meaning, "N")))
