"""Motion of the wheels over the motions of a rig, on bushes and with rigid joints."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from ....core.memory import positions_given
from ....core.named_types import Array, ArrayLike
from ....core.quantities import Display, variable
from ....core.validator import Validator
from ...assembly import wheel
from ...assembly.assembly import HeldAssembly
from ...assembly.by_wheel import WHEEL, of_wheels, wheel_coordinate
from ...assembly.of import given_assembly
from ...assembly.quantity import RACK, STEERING_WHEEL, Quantity
from ...assembly.rig import SweepRange
from ..characteristics.datasets import DATA_SET, KNOWN
from .equilibrium import LOADS, ElasticEquilibrium, ElasticState
from .linear import OF_BEAM
from .on_bushes import (
    CURVES,
    HARDPOINTS,
    WHEEL_LOAD,
    Hardpoints,
    at_height,
    on_bushes,
    on_joints,
    place_of_beam,
    softs_of,
)

# Positions of a corner at a time: their matrices take 50 MB, and grow with the square of wheels.
_TOGETHER = 200
_KINDS = ("kinematic", "elastokinematic")
CONTACT_RATE = Quantity(
    "contact_rate",
    "N/m",
    "rate at the contact",
    "derivative of the vertical force of the road with respect to the height of the contact, "
    "other wheels held: "
    "of springs, stops, bar and bushes, weights included; the wheel rate of the characteristics is "
    "that of spring and stops by the height of the wheel centre",
    "positive when the force grows with the height",
)
_IN_ROLL = Quantity(
    "roll_stiffness_at_contacts",
    "N m/rad",
    "roll stiffness at the contacts",
    "y' K y: levers y of the contacts, held, and rates K at the contacts of bushes, springs, stops "
    "and bar, weights included; the roll stiffness of the characteristics has those of springs, "
    "stops and bar by the heights of the wheel centres",
    "positive when it resists roll",
    display=Display.of("N m/deg"),
)
_STEERED = {KNOWN["rack"]["steer"]: wheel.steer}


def elastokinematics(
    subject: Any,
    bushings: Mapping[str, Any] | None = None,
    motion: str | None = None,
    along: ArrayLike | None = None,
    *,
    extent: SweepRange | None = None,
    travel: float = 0.0,
    rack_position: float = 0.0,
    hardpoints: Hardpoints = "loaded",
) -> xr.Dataset:
    """Return toe, camber and other curves over a motion, with rigid joints and on bushes.

    Parameters
    ----------
    subject : Suspension, Model, Axle or RigidAxle
    bushings : mapping, optional
        Bushes instead of those of the file, as in `linear`; ``axial_curve`` and ``radial_curve``
        are allowed instead of stiffnesses, ``{"mm": [...], "N": [...]}``.
    motion : str, optional
        Of the rig: 'travel' of a corner, or its 'rack'; 'bump', 'roll', 'left', 'right' or 'steer'
        of an axle; by default the first of these.
    along : array_like, shape (n,), optional
        Wheel travels [m] or roll angles [rad]; for 'steer' angles of the steering wheel [rad], or
        displacements of the rack [m] if the file has no steering ratio. By default the usual range.
        All positions are those with rigid joints; the road holds the contacts at the heights of
        these positions.
    extent : SweepRange, optional
        Ends of the motion that differ from the usual range.
    travel : float, optional
        Height of the wheel centres above design in motions of the rack [m].
    rack_position : float, optional
        Displacement of the rack in other motions [m].
    hardpoints : {'loaded', 'relaxed'}, optional
        'loaded': the joints are at the hardpoints under the static load at design. 'relaxed': they
        are at the hardpoints with unloaded bushes. A twisted anti-roll bar loads the bushes at
        design, too.

    Returns
    -------
    xarray.Dataset
        Over ``wheel``, ``data_set`` ('kinematic', 'elastokinematic') and ``wheel_travel``,
        ``roll_angle``, ``steering_wheel_angle`` or ``rack_position``: toe and camber [rad],
        half-track and wheelbase change [m], in motions of the rack ``steer`` [rad]; ``wheel_load``,
        the vertical force of the road [N], and ``contact_rate``, its derivative with respect to the
        height of the contact with the other wheel held [N/m]. The ``wheel_rate`` of the
        characteristics is that of spring and stops, by the height of the centre. Of two wheels
        ``roll_stiffness_at_contacts`` [N m/rad], y' K y with the levers y of the contacts and the
        rates K at them, and ``bar_torque`` [N m]. Of a rigid axle ``axle_steer`` [rad],
        ``axle_lateral`` and ``axle_longitudinal`` [m] of the line through the wheel centres; on
        five rods the curves on the bushes alone. ``over`` among the attributes is the motion.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If a position is out of reach, or there is no equilibrium.

    Notes
    -----
    The equilibrium of all parts is found by Newton's method in six coordinates of each part;
    displacements may be of any size. The axes of a bush turn with the part nearer to the chassis,
    those of a bush of a rod at a rigid axle with the axle. Torsion and tilting stiffnesses are
    relaxed at design.

    Examples
    --------
    >>> import numpy as np
    >>> from kintrafo import compliance
    >>> import kintrafo
    >>> bushes = {"arm_rear": {"axial_N_per_mm": 500.0, "radial_N_per_mm": 2000.0}}
    >>> car = kintrafo.load("reference_car")
    >>> found = compliance.elastokinematics(car, bushes, along=[-0.04, 0.0, 0.04])
    >>> toe = np.rad2deg(found["toe"].sel(data_set="elastokinematic") - found["toe"][0])
    >>> (toe.values.round(3) + 0.0).tolist()
    [0.023, 0.0, -0.023]
    >>> axle = kintrafo.load("reference_axle")
    >>> found = compliance.elastokinematics(axle, bushes, "roll", np.deg2rad([0.0, 2.0]))
    >>> (found["roll_stiffness_at_contacts"].values * np.pi / 180.0).round(1).tolist()  # N m/deg
    [[851.2, 856.2], [850.8, 856.0]]
    """
    with Validator("elastokinematics") as given:
        assembly = given_assembly(given, subject)
        if not given.failed:
            name = assembly.usual_motion if motion is None else motion
            if isinstance(name, str):
                assembly.refuse_motion(name)
            given.among("motion", name, assembly.motions)
        given.among("hardpoints", hardpoints, HARDPOINTS)
        far = (
            SweepRange()
            if extent is None
            else given.instance("extent", extent, SweepRange, "a SweepRange")
        )
        travel = given.number("travel", travel, "m")
        rack_position = given.number("rack_position", rack_position, "m")
        if not given.failed:
            over = assembly.motions[name].along
            if along is not None:
                along = positions_given(given, "along", along, over.units)
            assembly.refuse_holding(given, name, travel, rack_position)
        softs = softs_of(given, assembly, bushings, hardpoints)
    if along is None:
        along = assembly.usual(name, far, travel=travel, rack=rack_position)
    values = np.asarray(along)
    held = {"travel": travel, "rack": rack_position}
    together = max(1, _TOGETHER // len(assembly.wheels) ** 2)
    found = []
    for begin in range(0, values.size, together):
        some = values[begin : begin + together]
        poses = assembly.poses(assembly.position(name, some, **held))
        # an axle on five rigid rods does not move
        both = [on_joints(assembly, poses)] if assembly.moves_rigidly else []
        both.append(on_joints(assembly, poses, softs))
        states = [at_height(suspension, some, over) for suspension in both]
        found.append(_over_motion(assembly, both, states, over, some))
    whole = xr.concat(found, over.name, join="override", combine_attrs="override")
    whole = whole.assign_coords(
        {
            quantity.name: xr.Variable((), value, quantity.attributes())
            for quantity, value in assembly.held_in(name, **held).items()
        }
    )
    title = f"elastokinematics: {assembly.motions[name].words}"
    return whole.assign_attrs(title=title, over=name, hardpoints=HARDPOINTS[hardpoints])


def _over_motion(
    assembly: HeldAssembly,
    both: Sequence[ElasticEquilibrium],
    states: Sequence[ElasticState],
    over: Quantity,
    along: Array,
) -> xr.Dataset:
    """Return the curves on bushes, and with rigid joints if the wheels can move on these."""
    dims = (DATA_SET, over.name)
    data: dict[str, xr.Variable] = {}
    wheels = [
        [*(one.wheels[which] for one in both[:-1]), on_bushes(both[-1], states[-1], which)]
        for which in range(len(assembly.wheels))
    ]
    curves = {**CURVES, **(_STEERED if over.name in (RACK.name, STEERING_WHEEL.name) else {})}
    for quantity, formula in curves.items():
        values = [np.stack([formula(state) for state in own]) for own in wheels]
        data[quantity.name] = of_wheels(quantity, dims, values)
    data |= _forces(both, states, dims)
    if assembly.on_a_beam:
        places = [place_of_beam(one, state) for one, state in zip(both, states, strict=True)]
        for name, (unit, words, sign) in OF_BEAM.items():
            each = np.stack([place[name] for place in places])
            data[name] = xr.Variable(dims, each, Quantity(name, unit, words, "", sign).attributes())
    if assembly.bar is not None:
        torque = [one.torque_of_bar(state) for one, state in zip(both, states, strict=True)]
        words = f"torque of the anti-roll bar, {assembly.BAR_SIGN}"
        data["bar_torque"] = variable(dims, np.stack(torque), words, "N m")
    coordinates = {
        DATA_SET: list(_KINDS[-len(both) :]),
        WHEEL: wheel_coordinate(assembly.wheels),
        over.name: xr.Variable(over.name, along, over.attributes()),
    }
    return xr.Dataset(data, coordinates)


def _forces(
    both: Sequence[ElasticEquilibrium], states: Sequence[ElasticState], dims: tuple[str, str]
) -> dict[str, xr.Variable]:
    """Return the wheel loads [N] and the rates at the contacts in some equilibria."""
    rates, stiffness = [], []
    for one, state in zip(both, states, strict=True):
        rate = one.rate(state, np.zeros((*state.road.shape, LOADS)))
        y = np.stack([one.contact(state.places, i)[:, 1] for i in range(len(one.wheels))], axis=1)
        rates.append(np.diagonal(rate, axis1=1, axis2=2))
        stiffness.append(np.einsum("ni,nij,nj->n", y, rate, y))
    wheels = range(len(both[-1].wheels))
    loads = [np.stack([state.road[:, which] for state in states]) for which in wheels]
    own = [np.stack([rate[:, which] for rate in rates]) for which in wheels]
    data = {
        WHEEL_LOAD.name: of_wheels(WHEEL_LOAD, dims, loads),
        CONTACT_RATE.name: of_wheels(CONTACT_RATE, dims, own),
    }
    if len(wheels) > 1:
        data[_IN_ROLL.name] = xr.Variable(dims, np.stack(stiffness), _IN_ROLL.attributes())
    return data
