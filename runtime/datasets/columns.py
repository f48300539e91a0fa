"""Tables of datasets: dimensions of names that become columns.

A coordinate whose attribute ``in_tables`` is ``columns`` has names, such as those of wheels, which
end the names of columns in a flat table.
"""

import xarray as xr

AS_COLUMNS = {"in_tables": "columns"}
"""The attribute of such a coordinate."""


def flat(dataset: xr.Dataset) -> xr.Dataset:
    """Return a dataset without its dimensions of names, see `with_columns`."""
    marked = [n for n, c in dataset.coords.items() if AS_COLUMNS.items() <= c.attrs.items()]
    for name in marked:
        dataset = with_columns(dataset, str(name))
    return dataset


def with_columns(dataset: xr.Dataset, dimension: str) -> xr.Dataset:
    """Return a dataset without a dimension of names.

    ``camber`` over a dimension of ``left`` and ``right`` becomes ``camber_left`` and
    ``camber_right``; other variables are unchanged. A single name, which is a coordinate without a
    dimension, is left out.
    """
    if dimension not in dataset.dims:
        return dataset.drop_vars(dimension, errors="ignore")
    found: dict[str, xr.Variable] = {}
    for name, data in dataset.items():
        if dimension not in data.dims:
            found[str(name)] = data.variable
            continue
        for label in map(str, dataset[dimension].values):
            own = data.sel({dimension: label}, drop=True).variable
            words = f"{data.attrs.get('long_name', name)}, {label.replace('_', ' ')}"
            attributes = own.attrs | {"long_name": words}
            found[f"{name}_{label}"] = xr.Variable(own.dims, own.data, attributes)
    others = dataset.drop_vars(dimension).coords
    order = [*(str(dim) for dim in dataset.sizes if dim in others), *map(str, others)]
    coords = {name: others[name].variable for name in dict.fromkeys(order)}
    return xr.Dataset(found, coords, dataset.attrs)
