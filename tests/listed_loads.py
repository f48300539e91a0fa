"""Loads on parts as a dataset lists them."""

import numpy as np
import xarray as xr


def wrench(chosen: xr.Dataset) -> np.ndarray:
    """Return the sums of forces, and of moments about the origin, of some loads: (..., 6)."""
    force, moment, at = (chosen[name].values for name in ("force", "moment", "at"))
    return np.concatenate([force.sum(-2), (moment + np.cross(at, force)).sum(-2)], axis=-1)
