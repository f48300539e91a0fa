"""Deflections of the wheels on bushes under loads of any size, and to first order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ....core.named_types import Array, ArrayLike
from ....core.quantities import variable
from ....core.validator import Validator
from ...assembly import wheel
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.part_poses import CONTACT
from ...assembly.quantity import Quantity
from ..characteristics.datasets import DATA_SET
from .equilibrium import ElasticEquilibrium, ElasticState
from .flexibility import WheelSupport
from .linear import OF_BEAM, linear
from .on_bushes import WHEEL_LOAD, Hardpoints, gives_way, on_bushes, place_of_beam
from .rig_loads import RigLoad, give_of_tyre, loadings, sense_of
from .under_load import LOAD, WheelsUnderLoad, load_coordinate

_QUANTITIES = {
    "toe": Quantity("toe_change", "rad", "change of toe angle", "of the wheel", "positive toe-in"),
    "camber": Quantity(
        "camber_change", "rad", "change of camber", "of the wheel", "positive with the top outboard"
    ),
    "displacement": Quantity(
        "displacement", "m", "displacement", "of the contact or the wheel centre",
        "positive in the direction of a positive force",
    ),
    "patch_displacement": Quantity(
        "patch_displacement", "m", "displacement of the contact patch", "on the stationary tyre",
        "positive in the direction of a positive force",
    ),
}  # fmt: skip


def nonlinear(
    subject: Any,
    bushings: Mapping[str, Any] | None,
    under: str,
    amounts: ArrayLike,
    *,
    wheels: str | Sequence[float] | None = None,
    travel: float = 0.0,
    rack_position: float = 0.0,
    held: WheelSupport = "height",
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return the deflections of the wheels on bushes under loads of any size.

    Parameters
    ----------
    subject : Suspension, Model, Axle or RigidAxle
    bushings : mapping or None
        As in `elastokinematics`; None for those of the file.
    under : {'lateral', 'braking', 'recession', 'aligning'}
        A lateral force inward or a braking force at the contact, a rearward force at the wheel
        centre, or a torque about the vertical towards toe-out.
    amounts : array_like, shape (n,)
        Amounts of the load, of either sign: forces [N], or torques for 'aligning' [N m].
    wheels : {'parallel', 'opposed', 'left', 'right'} or two numbers, optional
        Of an axle, the loaded wheels: as in `linear`, by default 'parallel', or one of them. Or
        factors of the load on the left and the right wheel, with the sign of one corner: ``[1.0,
        0.5]`` under ``lateral`` pushes both inward, the right one with half the force.
    travel, rack_position : float, optional
        Wheel travel and rack displacement without the load [m], see `elastokinematics`.
    held : {'height', 'tyre', 'spring', 'locked'}, optional
        Support of each wheel, see `linear`, besides an anti-roll bar; 'tyre': on a road at the
        height at which the tyre carries the wheel without the load.
    hardpoints : {'loaded', 'relaxed'}, optional
        See `elastokinematics`.

    Returns
    -------
    xarray.Dataset
        Over ``wheel``, ``data_set`` ('equilibrium', 'linear') and ``load``: ``toe_change`` and
        ``camber_change`` [rad], and ``displacement`` in the direction of a positive force on this
        wheel [m], all relative to the position without the load; ``patch_displacement`` on the
        stationary tyre where the file has its rate, see `linear`; and ``wheel_load`` [N]. The data
        set 'linear' is that of `linear`. With an anti-roll bar ``bar_torque`` [N m], positive with
        the left half turned farther about the axis to the left. Of a rigid axle ``bar_torque`` is
        positive with the left wheel up, and there are ``axle_steer_change`` [rad],
        ``axle_lateral_change`` and ``axle_longitudinal_change`` [m].

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the travel is out of reach, or there is no equilibrium, or only one with damper or strut
        beyond a limit of the file, or with a deflection of more than 100 mm of a bush or 200 mm of
        a tyre.

    Notes
    -----
    The method is that of `elastokinematics`, with all parts in one equilibrium: an elastic rack is
    a further part, and an anti-roll bar has the energy of its twist, which follows from the feet of
    its drop links in closed form. Forces act at the lowest point of the moving wheel, in constant
    directions: those of the tyre with rigid joints, without the load. The displacement is that of
    the point of the wheel that was lowest without the load, or of its centre.

    `linear` leaves out that the forces of bushes turn under the static load. With relaxed bushes
    and no static load both results agree as the load goes to zero; their relative difference is
    proportional to the load.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import compliance
    >>> import kintrafo
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> car = kintrafo.load("reference_car")
    >>> found = compliance.nonlinear(car, bushes, "lateral", [0.0, 1000.0, 5000.0])
    >>> np.rad2deg(found["toe_change"]).sel(data_set="equilibrium").values.round(3).tolist()
    [0.0, 0.066, 0.333]

    Opposed forces do not move a soft rack:

    >>> soft, axle = {"rack": {"axial_N_per_mm": 2500.0}}, kintrafo.load("reference_axle")
    >>> for wheels in ("parallel", "opposed"):
    ...     found = compliance.nonlinear(axle, soft, "lateral", [5000.0], wheels=wheels)
    ...     toe = found["toe_change"].sel(wheel="right", data_set="equilibrium")
    ...     print(abs(round(float(np.rad2deg(toe[0])), 3)))
    0.188
    0.0
    """
    with Validator("deflection") as given:
        travel = given.number("travel", travel, "m")
        loaded = WheelsUnderLoad.given(
            given, subject, bushings, under, amounts,
            wheels=wheels, rack_position=rack_position, held=held, hardpoints=hardpoints,
        )  # fmt: skip
    assembly, wanted = loaded.assembly, loaded.amounts
    load, parts, at = loaded.load, loaded.parts, np.array([travel])
    suspension, base, states = loaded.equilibria(at)
    to_first_order = None
    if gives_way(loaded.softs):
        to_first_order = linear(subject, bushings, at, rack_position=rack_position, held=held)
    straight = _straight(to_first_order, load, parts, wanted)
    data = _changes_of_wheels(
        suspension, base, states, load, np.multiply.outer(parts, wanted), straight
    )
    if assembly.on_a_beam:
        data |= _changes_of_beam(suspension, base, states, straight)
    if assembly.bar is not None:
        torque = np.concatenate([suspension.torque_of_bar(state) for state in states])
        words = f"torque of the anti-roll bar, {assembly.BAR_SIGN}"
        data["bar_torque"] = variable(LOAD, torque, words, "N m")
    coordinates = {
        DATA_SET: ["equilibrium", "linear"],
        LOAD: load_coordinate(load, wanted),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    title = {"title": f"deflection under {load.words}"}
    return xr.Dataset(data, coordinates, title | loaded.described)


def _straight(
    first_order: xr.Dataset | None, load: RigLoad, parts: Sequence[float], wanted: Array
) -> Callable[[str, int | None], Array]:
    """Return a function of a kind, and a wheel or None for a beam: first-order deflections.

    On two wheels they are the sum of those by parallel and by opposed loads.
    """
    ways = loadings(load, parts)
    shares = np.linalg.solve(np.transpose([how.parts for how in ways]), parts)

    def found(kind: str, which: int | None) -> Array:
        if first_order is None:
            return np.zeros_like(wanted)
        rates = [first_order[how.key(kind, load)].values[..., 0] for how in ways]
        return wanted * float(
            shares @ [rate if which is None else np.atleast_1d(rate)[which] for rate in rates]
        )

    return found


def _changes_of_wheels(
    suspension: ElasticEquilibrium,
    base: ElasticState,
    states: list[ElasticState],
    load: RigLoad,
    amounts: Array,
    straight: Callable[[str, int | None], Array],
) -> dict[str, xr.Variable]:
    """Return deflections and loads of the wheels under amounts of a load, (wheels, n)."""
    of_each = [
        _changes_of_wheel(suspension, base, states, load, amounts[which], which)
        for which in range(len(suspension.wheels))
    ]
    data = {
        quantity.name: of_wheels(
            quantity,
            (DATA_SET, LOAD),
            [np.stack([own[kind], straight(kind, which)]) for which, own in enumerate(of_each)],
        )
        for kind, quantity in _QUANTITIES.items()
        if all(kind in own for own in of_each)
    }
    road = np.concatenate([state.road for state in states]).T
    data[WHEEL_LOAD.name] = of_wheels(WHEEL_LOAD, LOAD, [*road])
    return data


def _changes_of_wheel(
    suspension: ElasticEquilibrium,
    base: ElasticState,
    states: list[ElasticState],
    load: RigLoad,
    amounts: Array,
    which: int,
) -> dict[str, Array]:
    """Return the deflections of a wheel under some amounts of a load, by their kind."""
    before = on_bushes(suspension, base, which)
    point = suspension.contact(base.places, which) if load.at == CONTACT else before.center
    along = sense_of(load, suspension.wheels[which])
    found: dict[str, list[Array]] = {"toe": [], "camber": [], "displacement": []}
    for state in states:
        after = replace(before, axis=suspension.axis(state.places, which))
        found["toe"].append(wheel.toe(after) - wheel.toe(before))
        found["camber"].append(wheel.camber(after) - wheel.camber(before))
        shift = suspension.moved(point, base.places, state.places, which)
        found["displacement"].append((along * shift).sum(axis=-1))
    if not load.where:
        del found["displacement"]
    changed = {kind: np.concatenate(values) for kind, values in found.items()}
    if soft := give_of_tyre(load, suspension.wheels[which]):
        changed["patch_displacement"] = changed["displacement"] + amounts * soft
    return changed


def _changes_of_beam(
    suspension: ElasticEquilibrium,
    base: ElasticState,
    states: list[ElasticState],
    straight: Callable[[str, int | None], Array],
) -> dict[str, xr.Variable]:
    """Return the motions of the line through the wheel centres of a beam under a load."""
    before = place_of_beam(suspension, base)
    after = [place_of_beam(suspension, state) for state in states]
    data = {}
    for kind, (unit, words, sign) in OF_BEAM.items():
        moved = np.concatenate([place[kind] for place in after]) - before[kind]
        both = np.stack([moved, straight(kind, None)])
        data[f"{kind}_change"] = variable(
            (DATA_SET, LOAD), both, f"change of {words}, {sign}", unit
        )
    return data
