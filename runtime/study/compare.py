"""Several suspensions side by side: their characteristics, and by how much they differ."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from ..assembly.usual import usual_rack, usual_travel
from ..core.arguments import Arguments
from ..core.errors import InputError
from ..core.memory import positions_given
from ..suspension.model import Model
from . import characteristics
from .characteristics.datasets import DATA_SET
from .compliance.flexibility import HELD, Held
from .compliance.linear import COMPLIANCES, linear
from .sweep import RACK

Array = NDArray[np.float64]
Over = Literal["travel", "rack"]

# A position so near to zero is that of design, of a rig as well [m].
_AT_DESIGN = 5e-4


def compare(
    models: Mapping[str, Model],
    positions: Array | None = None,
    *,
    over: Over = "travel",
    held: Held | None = None,
    progress: Callable[[float], None] | None = None,
) -> xr.Dataset:
    """Return the characteristics of several suspensions over the same positions.

    Parameters
    ----------
    models : mapping of str to Model
        Two or more, by the names that stand beside their curves.
    positions : ndarray, optional
        Wheel travel, or displacement of the rack [m]; by default the usual range, as far as all of
        the suspensions reach it.
    over : {'travel', 'rack'}, optional
        What varies.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        With it, their compliance on the bushes of their files comes too, over wheel travel: what
        holds the wheel under loads, see `kintrafo.compliance.linear`.
    progress : callable, optional
        Called with the part that is done, up to 1.

    Returns
    -------
    xarray.Dataset
        As that of `kintrafo.characteristics`, with the further dimension ``data_set``. Beside a
        suspension that nothing steers, only what all of them have.
    """
    with Arguments("compare") as given:
        given.by_name("models", models, "models", Model, Model.NEEDED)
        given.among("over", over, ("travel", "rack"))
        given.function("progress", progress)
        if positions is not None:
            positions = positions_given(given, "positions", positions, "m")
        if held is not None and not given.refused:
            given.among("held", held, HELD)
            _refuse_rigid(given, models, over)
    if len(models) < 2:
        problem = f"{len(models)} data set; two or more are needed for a comparison."
        raise InputError([problem], "compare")
    if positions is None:
        positions = common_positions(models, over=over)
    curves = characteristics.travel if over == "travel" else characteristics.steering
    datasets = []
    for index, model in enumerate(models.values()):
        found = curves(model, positions)
        datasets.append(found if held is None else on_bushes(found, model, positions, held))
        if progress is not None:
            progress((index + 1) / len(models))
    # what belongs to steering, a suspension that nothing steers has not: no gaps in the others
    steered = [model.suspension.steered() for model in models.values()]
    if not all(steered):
        common = set.intersection(*(set(dataset) for dataset in datasets))
        datasets = [dataset[[n for n in dataset if n in common]] for dataset in datasets]
        datasets = [dataset.drop_vars(RACK, errors="ignore") for dataset in datasets]
    names = xr.Variable(DATA_SET, list(models), {"long_name": "data set"})
    return xr.concat(datasets, names, coords="minimal", compat="override", combine_attrs="override")


def _refuse_rigid(given: Arguments, models: Mapping[str, Model], over: Over) -> None:
    """Refuse compliance over the rack, and that of suspensions on rigid joints."""
    if over != "travel":
        given.refuse("held: compliance is over wheel travel. Leave it out over the rack.")
    for name, model in models.items():
        if not model.suspension.bushings:
            given.refuse(f"held: {name} has no [bushings], and nothing in it gives way.")


def on_bushes(
    found: xr.Dataset, model: Model, travels: Array, held: Held, rack_position: float = 0.0
) -> xr.Dataset:
    """Return characteristics over wheel travel with compliance beside them.

    Parameters
    ----------
    found : xarray.Dataset
        Characteristics at the same travels.
    model : Model
        Its file has bushes.
    travels : ndarray
        Wheel travel [m].
    held : {'height', 'tyre', 'spring', 'locked'}
        What holds the wheel under loads.
    rack_position : float, optional
        [m]
    """
    soft = linear(model, None, travels, rack_position=rack_position, held=held)
    return found.assign({name: soft[name].variable for name in COMPLIANCES if name in soft})


def common_positions(models: Mapping[str, Model], *, over: Over = "travel") -> Array:
    """Return the usual positions that all suspensions can take [m].

    Parameters
    ----------
    models : mapping of str to Model
    over : {'travel', 'rack'}, optional
        What varies.

    Returns
    -------
    ndarray
        Zero included.
    """
    with Arguments("compare") as given:
        for model in given.mapping("models", models, "names and models").values():
            given.kind("model", model, Model, Model.NEEDED)
        if not models:
            given.refuse("models is empty: one or more are needed.")
        given.among("over", over, ("travel", "rack"))
    grids = [
        usual_travel(model) if over == "travel" else usual_rack(model) for model in models.values()
    ]
    lowest, highest = max(g[0] for g in grids), min(g[-1] for g in grids)
    if over == "travel":
        return usual_travel(next(iter(models.values())), rebound=-lowest, bump=highest)
    return usual_rack(next(iter(models.values())), extent=min(-lowest, highest))


@dataclass(frozen=True)
class Difference:
    """By how much one characteristic of a suspension differs from the first one's, SI units.

    Attributes
    ----------
    name, data_set : str
        Characteristic, and the suspension that is compared with the first.
    first, other : float
        Both values at the design position; NaN where they are not defined.
    largest : float
        The difference, other minus first, where it is largest; NaN where there is none.
    where : float
        Position of the largest difference [m].
    """

    name: str
    data_set: str
    first: float
    other: float
    largest: float
    where: float

    @property
    def at_design(self) -> float:
        """The difference at the design position."""
        return self.other - self.first


def differences(dataset: xr.Dataset) -> list[Difference]:
    """Return how the suspensions of a comparison differ from the first one.

    Parameters
    ----------
    dataset : xarray.Dataset
        From `compare`.

    Returns
    -------
    list of Difference
        In the order of the characteristics, then of the suspensions.

    Examples
    --------
    >>> angles = (("data_set", "wheel_travel"), [[0.0, 1.0], [0.5, 3.0]])
    >>> places = {"data_set": ["a", "b"], "wheel_travel": [0.0, 0.1]}
    >>> [found] = differences(xr.Dataset({"camber": angles}, places))
    >>> found.at_design, found.largest, found.where
    (0.5, 2.0, 0.1)
    """
    with Arguments("differences") as given:
        given.dataset(dataset, over=DATA_SET)
    curves = {str(n): data for n, data in dataset.items() if DATA_SET in data.dims}
    return [
        _difference(name, data, label)
        for name, data in curves.items()
        for label in map(str, dataset[DATA_SET].values[1:])
    ]


def _difference(name: str, data: xr.DataArray, label: str) -> Difference:
    along = next(d for d in data.dims if d != DATA_SET)
    positions = np.asarray(data[along].values, dtype=np.float64)
    first = np.asarray(data.isel({DATA_SET: 0}).values, dtype=np.float64)
    other = np.asarray(data.sel({DATA_SET: label}).values, dtype=np.float64)
    both = np.isfinite(first) & np.isfinite(other)
    change = np.subtract(other, first, out=np.full(first.shape, np.nan), where=both)
    design = int(np.argmin(np.where(both, np.abs(positions), np.inf)))
    worst = int(np.nanargmax(np.abs(change))) if both.any() else design
    if not abs(positions[design]) <= _AT_DESIGN:
        first, other = np.full((2, positions.size), np.nan)
    return Difference(
        name=name,
        data_set=label,
        first=float(first[design]),
        other=float(other[design]),
        largest=float(change[worst]),
        where=float(positions[worst]),
    )
