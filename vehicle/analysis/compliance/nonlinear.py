"""Deflections of the wheels on bushes under loads of any size, and to first order."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray as xr

from ....core.memory import positions_given
from ....core.named_types import Array, ArrayLike
from ....core.quantities import attributes, variable
from ....core.validator import Validator
from ...assembly import wheel
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.of import given_assembly
from ...assembly.part_poses import CENTER, CONTACT
from ...assembly.quantity import Quantity
from ...corner.corner import RoadWheel
from ...models.reach import PositionError
from ..characteristics.datasets import DATA_SET
from .equilibrium import ElasticEquilibrium, ElasticState
from .flexibility import HELD, WheelSupport, refuse_without_rate
from .linear import OF_BEAM, linear
from .on_bushes import (
    HARDPOINTS,
    WHEEL_LOAD,
    Hardpoints,
    at_height,
    gives_way,
    on_bushes,
    on_joints,
    place_of_beam,
    softs_of,
)
from .rig_loads import BY_NAME, RigLoad, give_of_tyre, load_at_contact, loadings, sense_of

LOAD = "load"
"""Dimension of the amounts of the load."""

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
WHEELS = {
    "parallel": "both wheels, in one direction",
    "opposed": "both wheels, oppositely",
    "left": "the left wheel",
    "right": "the right wheel",
}
"""Loaded wheels of an axle."""

_PARALLEL = "parallel"
_GREATEST = 1e6
# A tyre slides before it deflects this far [m].
_FARTHEST_TYRE = 0.2
# The smallest step of a load, as a part of it.
_LEAST_STEP = 1e-3


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
        the left half turned the farther; of a rigid axle with the left wheel up, and
        ``axle_steer_change`` [rad], ``axle_lateral_change`` and ``axle_longitudinal_change`` [m].

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
        assembly = given_assembly(given, subject)
        given.among("under", under, BY_NAME)
        given.among("held", held, HELD)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        wanted = amounts_of(given, amounts)
        if not given.failed:
            assembly.refuse_holding(given, assembly.usual_motion, 0.0, rack_position)
            parts = parts_of(given, assembly, under, wheels)
        softs = softs_of(given, assembly, bushings, hardpoints)
        if not given.failed:
            refuse_without_rate(given, held, *assembly.tyres)
    load = replace(BY_NAME[under], words=words_of(under, wheels, parts))
    at = np.array([travel])
    suspension = on_joints(assembly, assembly.poses(assembly.at_travel(at, rack_position)), softs)
    base = at_height(suspension, at)
    of_each = zip(parts, suspension.wheels, strict=True)
    unit = np.stack([part * unit_load(load, wheel) for part, wheel in of_each], axis=1)
    states = under_amounts(suspension, base, unit, held, load, wanted)
    to_first_order = None
    if gives_way(softs):
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
    how = {"held": HELD[held], "hardpoints": HARDPOINTS[hardpoints]}
    coordinates = {
        DATA_SET: ["equilibrium", "linear"],
        LOAD: load_coordinate(load, wanted),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    return xr.Dataset(data, coordinates, {"title": f"deflection under {load.words}"} | how)


def parts_of(
    given: Validator, assembly: HeldAssembly, under: str, wheels: Any
) -> tuple[float, ...]:
    """Return the factors of a load on the wheels."""
    ways = {how.name: how.parts for how in loadings(BY_NAME[under], assembly.wheels)}
    if len(assembly.wheels) == 1:
        if wheels is not None:
            given.fail("wheels: a corner has one wheel. Leave it out, or give an axle.")
        return ways[""]
    if wheels is None or isinstance(wheels, str):
        for which, wheel in enumerate(assembly.wheels):
            ways[wheel] = tuple(np.eye(len(assembly.wheels))[which].tolist())
        given.among("wheels", wheels or _PARALLEL, WHEELS)
        return ways.get(wheels or _PARALLEL, ())
    both = given.array("wheels", wheels, "1", dimensions=[1])
    if both.shape != (len(assembly.wheels),) or not (np.abs(both) <= 1.0).all():
        given.fail("wheels: two numbers from -1 to 1 are needed, of the left and right wheel.")
    return tuple(both.tolist())


def words_of(under: str, wheels: str | Sequence[float] | None, parts: Sequence[float]) -> str:
    """Return a load on some wheels in words."""
    load = BY_NAME[under]
    for how in loadings(load, parts):
        if how.name == (wheels or _PARALLEL) or not how.name:
            return how.title(load)
    if isinstance(wheels, str):
        return f"{load.words} of {WHEELS[wheels]}"
    left, right = parts
    return f"{how.title(load).rpartition(', ')[0]}, {left:g} of it left and {right:g} right"


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


def amounts_of(given: Validator, amounts: ArrayLike) -> Array:
    """Return the amounts of a load, or add an error."""
    wanted = positions_given(given, "amounts", amounts, "N or N m")
    if not (np.abs(wanted) <= _GREATEST).all():
        given.fail(f"amounts: numbers of {_GREATEST:g} N or N m or less are needed.")
    return wanted


def unit_load(load: RigLoad, on_road: RoadWheel) -> Array:
    """Return a load of 1 N or 1 N m for `ElasticEquilibrium.under`, (n, 9)."""
    at_contact = load_at_contact(load, on_road)
    force, still = at_contact[:, :3], np.zeros((len(at_contact), 3))
    if load.at == CENTER:
        return np.concatenate([still, still, force], axis=1)
    return np.concatenate([at_contact, still], axis=1)


def under_amounts(
    suspension: ElasticEquilibrium,
    base: ElasticState,
    unit: Array,
    held: WheelSupport,
    load: RigLoad,
    wanted: Array,
) -> list[ElasticState]:
    """Return the equilibria under some amounts of a load, each found from a smaller one."""
    _refuse_on_tyres(suspension, load, wanted)
    found: dict[float, ElasticState] = {}
    for sense in (1.0, -1.0):
        state, at = base, 0.0
        for amount in sorted({a for a in wanted.tolist() if sense * a >= 0.0}, key=abs):
            state = _towards(suspension, base, state, (at, amount), unit, held, load)
            at, found[amount] = amount, state
    states = [found[amount] for amount in wanted.tolist()]
    _refuse_beyond(suspension, states, load, wanted)
    return states


def _towards(
    suspension: ElasticEquilibrium,
    base: ElasticState,
    state: ElasticState,
    amounts: tuple[float, float],
    unit: Array,
    held: WheelSupport,
    load: RigLoad,
) -> ElasticState:
    """Return the equilibrium under one amount of a load from that under another, in steps."""
    at, end = amounts
    step = end - at
    while at != end:
        to = end if abs(step) >= abs(end - at) else at + step
        there = suspension.under(to * unit, held, state, base)
        if there.found.all():
            state, at, step = there, to, 2.0 * step
            continue
        step *= 0.5
        if abs(step) <= _LEAST_STEP * abs(end):
            raise PositionError(
                f"no stable equilibrium was found under {load.words} of more than {at:.4g} "
                f"{load.unit}: the bushes do not hold the linkage. Use smaller loads or "
                "stiffer bushes."
            )
    return state


def _refuse_on_tyres(suspension: ElasticEquilibrium, load: RigLoad, wanted: Array) -> None:
    """Raise an error for loads with an impossible deflection of the stationary tyre."""
    soft = max(float(give_of_tyre(load, wheel) or 0.0) for wheel in suspension.wheels)
    worst = float(wanted[np.abs(wanted).argmax()]) if wanted.size else 0.0
    if abs(worst) * soft > _FARTHEST_TYRE:
        raise PositionError(
            f"under {load.words} of {worst:.4g} {load.unit} the stationary tyre deflects by "
            f"{1e3 * abs(worst) * soft:.4g} mm, more than any tyre can: "
            f"{1e3 * _FARTHEST_TYRE:g} mm: it slides before. Leave greater loads out, or correct "
            "its rates in [tyre]."
        )


def _refuse_beyond(
    suspension: ElasticEquilibrium, states: list[ElasticState], load: RigLoad, wanted: Array
) -> None:
    """Raise an error for loads with an impossible deflection of a bush, or damper or strut."""
    for which in np.argsort(np.abs(wanted), kind="stable"):
        if strained := suspension.overstretched(states[which]):
            raise PositionError(
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {strained}. Leave greater "
                "loads out, or make it stiffer."
            )
        if words := suspension.beyond(states[which]):
            raise PositionError(
                f"under {load.words} of {wanted[which]:.4g} {load.unit} {words[0]}. Leave greater "
                "ones out, or give the file stops that hold it before."
            )


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


def load_coordinate(load: RigLoad, amounts: Array) -> xr.Variable:
    """Return the coordinate of results over a load."""
    words = load.words.partition(" ")[2]
    shown = {"display_units": "kN", "display_factor": 1e-3} if load.unit == "N" else {}
    return xr.Variable(LOAD, amounts, attributes(words, load.unit) | shown)
