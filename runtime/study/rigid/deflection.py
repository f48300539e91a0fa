"""How far a rigid axle gives way under loads of any size, beside first order."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ...core.arguments import Arguments
from ...core.named_types import ArrayLike
from ...core.quantities import variable
from ...suspension.rigid.axle import RigidAxle
from ..axles.deflection import deflected, of_both, parts_of, straight, words_of
from ..characteristics.datasets import DATA_SET
from ..loads.elastic.deflection import BY_NAME, LOAD, amounts_of, coordinates_of, under_amounts
from ..loads.elastic.held import HARDPOINTS, Hardpoints, at_height, gives_way
from ..loads.flexibility import HELD, Held, refuse_without_rate
from .compliance import OF_AXLE, compliance
from .on_bushes import axle_on, guided, parts_at, place_of, soft_of, torque_of_bar


def deflection(
    axle: RigidAxle,
    bushings: Mapping[str, Any] | None,
    under: str,
    amounts: ArrayLike,
    *,
    wheels: str | Sequence[float] = "parallel",
    travel: float = 0.0,
    held: Held = "height",
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return how far a rigid axle gives way under loads of any size.

    Parameters
    ----------
    axle : RigidAxle
    bushings : mapping or None
        As of `compliance`, with curves as of `kintrafo.loads.elastokinematics`; None: those of the
        file.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        As of `kintrafo.loads.deflection`.
    amounts : array_like, shape (n,)
        How great the load is, of either sign [N], [N m].
    wheels : {'parallel', 'opposed', 'left', 'right'} or two numbers, optional
        Which wheels have it, as of `kintrafo.axles.deflection`.
    travel : float, optional
        Where both wheels are before [m].
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        What holds each wheel; the anti-roll bar acts besides.
    hardpoints : {'loaded', 'relaxed'}, optional
        As of `kintrafo.loads.elastokinematics`.

    Returns
    -------
    xarray.Dataset
        As of `kintrafo.axles.deflection`; and ``axle_steer_change`` [rad], ``axle_lateral_change``
        and ``axle_longitudinal_change`` [m].

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the travel is out of reach, or there is no equilibrium.

    Examples
    --------
    >>> bushes = {"panhard_rod_chassis": {"axial_N_per_mm": 5000.0}}
    >>> found = deflection(RigidAxle.load("rigid_axle"), bushes, "lateral", [5000.0])
    >>> (1e3 * found["axle_lateral_change"][:, 0]).values.round(2).tolist()  # mm
    [1.92, 1.91]
    """
    with Arguments("deflection") as given:
        given.kind("axle", axle, RigidAxle, RigidAxle.NEEDED)
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        parts = parts_of(given, under, wheels)
        travel = given.number("travel", travel, "m")
        wanted = amounts_of(given, amounts)
        soft = soft_of(given, axle, bushings, hardpoints)
        if not given.refused:
            refuse_without_rate(given, held, axle.tyre)
    load, at = replace(BY_NAME[under], words=words_of(under, wheels, parts)), np.array([travel])
    suspension = axle_on(parts_at(guided(axle), at, at), soft)
    base = at_height(suspension, at)
    states = under_amounts(suspension, base, of_both(suspension, load, parts), held, load, wanted)
    linear = compliance(axle, bushings, at, held=held) if gives_way(soft) else None
    first_order = straight(linear, load, parts, wanted)
    amounts = np.multiply.outer(parts, wanted)
    data = deflected(suspension, base, states, load, amounts, first_order)
    before = place_of(suspension, base)
    after = [place_of(suspension, state) for state in states]
    for name, (unit, words, sign) in OF_AXLE.items():
        moved = np.concatenate([place[name] for place in after]) - before[name]
        both = np.stack([moved, first_order(name, "")])
        meaning = f"change of {words}, {sign}"
        data[f"{name}_change"] = variable((DATA_SET, LOAD), both, meaning, unit)
    if axle.anti_roll_bar is not None:
        data["bar_torque"] = torque_of_bar([suspension] * len(states), states, LOAD)
    how = {"held": HELD[held], "hardpoints": HARDPOINTS[hardpoints]}
    title = f"deflection under {load.words}"
    return xr.Dataset(data, coordinates_of(load, wanted), {"title": title} | how)
