"""Modes of a car, and its responses to the road, by the exact linearisation at rest.

With H_w the response of an output to the road under the wheel w, which reaches it with the delay
tau_w, the one-sided density of an output on a stationary rough road is ::

    G_y(f) = (|Y_L|^2 + |Y_R|^2 + 2 g Re(Y_L* Y_R)) G(n) / v,    n = f / v
    Y_side(f) = sum over its wheels of H_w(f) exp(-2 pi i f tau_w)

with g the normalised cross-spectrum of the two tracks (`kintrafo.road_profiles`).
"""

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from ....core.named_types import Array
from ....core.quantities import variable
from ....core.validator import Validator
from ....datasets.columns import AS_COLUMNS
from ....systems.linearisation import Linearisation, linearise
from ....systems.modes import Mode, modes_of_motions
from ...assembly.by_wheel import WHEEL, wheel_coordinate
from ...assembly.car import CarAssembly
from ...assembly.equilibrium import equilibrium
from ...roads.rough import isotropic_coherence, roughness_of, spectrum
from .outputs import OUTPUTS_OF_WHEELS, body_outputs, upward
from .rest import car_assembly
from .weighting import weighting

Complex = NDArray[np.complex128]
Responses = dict[str, Complex]
"""Responses of an output, (f,) or (wheels, f), by the wheel on the road."""

FREQUENCIES = np.arange(0.2, 50.0 + 1e-9, 0.02)
"""The usual frequencies of spectra [Hz]."""


def linear_at_rest(assembly: CarAssembly) -> Linearisation:
    """Return the linear equations at rest, without friction."""
    smooth = assembly.without_friction()
    return linearise(smooth.model, equilibrium(smooth.model))


def modes(subject: Any) -> xr.Dataset:
    """Return the modes of a car linearised at rest.

    Parameters
    ----------
    subject : Car or CarModel

    Returns
    -------
    xarray.Dataset
        Over ``mode``: ``frequency``, undamped [Hz], and ``damping_ratio``, without friction;
        ``energy``, the fraction of its kinetic energy in the motion of its name. Names are
        ``heave``, ``pitch`` and ``roll`` of the body; ``front_hop`` and ``rear_hop``, both wheels
        of an axle in the same direction, and ``front_tramp`` and ``rear_tramp``, in opposite ones;
        of a quarter car ``heave`` and ``hop``.

    Raises
    ------
    PositionError
        If the car does not rest on its wheels, or rests on a stop.

    Notes
    -----
    Modes are named by their kinetic energy: of the body in heave, pitch and roll, and of the wheels
    in their heights above the road, in the same direction and in opposite ones. The assignment of
    names has the greatest sum of these fractions. For fractions near one half, as of heave and
    pitch of a car with much damping, two modes share two motions, and small changes exchange the
    names.

    Examples
    --------
    >>> import kintrafo
    >>> found = kintrafo.ride.modes(kintrafo.load("quarter_car"))
    >>> dict(zip(found["mode"].values.tolist(), found["frequency"].values.round(2).tolist()))
    {'heave': 1.27, 'hop': 12.25}
    """
    assembly = car_assembly("modes", subject)
    found = named_modes(assembly, linear_at_rest(assembly))
    rows = [(mode.natural_frequency, mode.damping_ratio, part) for mode, part in found.values()]
    columns = zip(_OF_MODES.items(), np.array(rows).T, strict=True)
    return xr.Dataset(
        {name: variable("mode", column, *described) for (name, described), column in columns},
        {"mode": ("mode", [*found], {"long_name": "mode"})},
        {"title": "modes at rest"},
    )


_OF_MODES = {
    "frequency": ("undamped natural frequency", "Hz"),
    "damping_ratio": ("damping ratio", "1"),
    "energy": ("part of the kinetic energy of the mode in the motion of its name", "1"),
}


def named_modes(assembly: CarAssembly, linear: Linearisation) -> dict[str, tuple[Mode, float]]:
    """Return the modes at rest by name, with the part of the energy in the motion of the name."""
    motions = assembly.mode_motions(linear.state)
    names = linear.state_names
    rows = np.array([[row.get(name, 0.0) for name in names] for _, row in motions.values()])
    weights = np.array([mass for mass, _ in motions.values()])
    return dict(zip(motions, modes_of_motions(linear.A, names, rows, weights), strict=True))


def response(
    subject: Any, speed: float, roughness: str | float = "B", *, frequency: ArrayLike | None = None
) -> xr.Dataset:
    """Return spectra of the response of a car to a rough road, by its linear equations.

    Parameters
    ----------
    subject : Car or CarModel
    speed : float
        Speed of the car, above zero [m/s].
    roughness : str or float, optional
        Of an isotropic road under both tracks: the class of ISO 8608, 'A' to 'H', or its spectral
        density G(n0) at n0 = 0.1 1/m [m^3].
    frequency : array_like, shape (n,), optional
        Frequencies, in increasing order [Hz]; by default 0.2 to 50 Hz in steps of 0.02 Hz.

    Returns
    -------
    xarray.Dataset
        Over ``frequency``: the one-sided power spectral density of each output, its name followed
        by ``_psd``, in the square of its unit per Hz; and over ``road_wheel`` the amplitude of its
        response to the road under that wheel alone, followed by ``_by_road``, in its unit per m.
        Outputs are those of `over`: ``body_acceleration``, that of each seat, ``load`` and
        ``travel`` of each wheel. Their RMS over these frequencies are attributes of the spectra,
        ``rms`` and, for accelerations, ``weighted_rms`` by W_k of ISO 2631-1. Lift-off, stops and
        friction are not linear: see `over`.

    Raises
    ------
    InputError
        If an argument cannot be used.
    PositionError
        If the car does not rest on its wheels, or rests on a stop.

    Examples
    --------
    >>> import kintrafo
    >>> found = kintrafo.ride.response(kintrafo.load("quarter_car"), 20.0)
    >>> round(found["body_acceleration_psd"].attrs["rms"], 2)
    0.68
    """
    assembly = car_assembly("response", subject)
    with Validator("response") as given:
        speed = given.number("speed", speed, "m/s", above=0.0)
        at_reference = roughness_of(given, roughness)
        chosen = FREQUENCIES if frequency is None else frequency
        frequencies = given.array("frequency", chosen, "Hz", dimensions=[1])
        if not given.failed and (frequencies <= 0.0).any():
            given.fail("frequency: more than 0 Hz is needed.")
        if not given.failed and (frequencies.size < 2 or (np.diff(frequencies) <= 0.0).any()):
            given.fail("frequency: two or more are needed, each above the one before it.")
    found = responses_by_wheel(assembly, linear_at_rest(assembly), frequencies)
    variables: dict[str, Any] = {}
    for name, (words, unit) in _described(assembly).items():
        rows = found[name]
        own = density(assembly, rows, frequencies, speed, at_reference)
        of_wheels = name in OUTPUTS_OF_WHEELS and len(assembly.wheels) > 1
        dims = (WHEEL, "frequency") if of_wheels else ("frequency",)
        whole = f"({unit})" if "/" in unit else unit
        spectrum_of = variable(dims, own, f"spectrum of {words}", f"{whole}^2/Hz")
        spectrum_of.attrs |= _rms(own, frequencies, accelerates=unit == "m/s^2")
        variables[f"{name}_psd"] = spectrum_of
        sizes = np.stack([np.abs(row) for row in rows.values()])
        by_road = f"amplitude of {words} by the height of the road under a wheel"
        variables[f"{name}_by_road"] = variable(("road_wheel", *dims), sizes, by_road, f"{whole}/m")
    of_road = {"long_name": "wheel on the road"} | AS_COLUMNS
    coordinates = {
        "frequency": ("frequency", frequencies, {"units": "Hz", "long_name": "frequency"}),
        "road_wheel": ("road_wheel", list(assembly.wheels), of_road),
        WHEEL: wheel_coordinate(assembly.wheels),
    }
    return xr.Dataset(variables, coordinates, {"title": "response to a rough road, linear"})


def _described(assembly: CarAssembly) -> dict[str, tuple[str, str]]:
    return body_outputs(assembly) | OUTPUTS_OF_WHEELS


def responses_by_wheel(
    assembly: CarAssembly, linear: Linearisation, frequencies: Array
) -> dict[str, Responses]:
    """Return the responses of all outputs to the road under each wheel."""
    roads = [assembly.names_of(wheel).road for wheel in assembly.wheels]
    states, signals = linear.responses(frequencies, roads)
    by_wheel = {
        wheel: _outputs(assembly, linear, frequencies, states[..., i], signals[..., i])
        for i, wheel in enumerate(assembly.wheels)
    }
    return {
        name: {wheel: found[name] for wheel, found in by_wheel.items()}
        for name in _described(assembly)
    }


def _outputs(
    assembly: CarAssembly,
    linear: Linearisation,
    frequencies: Array,
    states: Complex,
    outputs: Complex,
) -> dict[str, Complex]:
    """Return the responses of all outputs to the road under a wheel, (f,) or (wheels, f)."""
    signals = dict(zip(linear.output_names, np.moveaxis(outputs, -1, 0), strict=True))
    half = len(linear.state_names) // 2
    position = dict(
        zip(linear.state_names[:half], np.moveaxis(states[..., :half], -1, 0), strict=True)
    )
    s2 = (2j * np.pi * frequencies) ** 2
    body = assembly.car.coordinates
    at_rest = {k: linear.state[linear.state_names.index(k)] for k in body}
    found: dict[str, Complex] = {}
    for name, place in assembly.felt_at().items():
        arms = {
            k: upward({n: (at, 0.0, float(n == k)) for n, at in at_rest.items()}, place)
            for k in body
        }
        found[name] = sum((arms[k] * s2 * position[k] for k in body), np.zeros_like(s2))
    slopes = assembly.travel_slopes(linear.state)
    rows = {
        "load": [signals[f"{assembly.names_of(w).signals}tyre_force"] for w in assembly.wheels],
        "travel": [
            np.sum([slope * position[k] for k, slope in slopes[w].items()], axis=0)
            for w in assembly.wheels
        ],
    }
    single = len(assembly.wheels) == 1
    return found | {name: (row[0] if single else np.stack(row)) for name, row in rows.items()}


def density(
    assembly: CarAssembly, rows: Responses, frequencies: Array, speed: float, at_reference: float
) -> Array:
    """Return the spectral density of an output from its responses to the road under each wheel."""
    track, behind = assembly.track, assembly.behind()
    sides: dict[str, Complex] = {}
    for wheel, row in rows.items():
        side = wheel.rpartition("_")[2]
        late = np.exp(-2j * np.pi * frequencies * behind[wheel] / speed)
        sides[side] = sides.get(side, 0.0) + row * late
    total = sum(np.abs(each) ** 2 for each in sides.values())
    if len(sides) > 1:
        left, right = sides.values()
        total = total + 2.0 * isotropic_coherence(frequencies / speed, track) * np.real(
            np.conj(left) * right
        )
    return np.asarray(total * spectrum(at_reference, frequencies / speed) / speed)


def root_mean_square(density: Array, frequencies: Array) -> Array:
    """Return the root mean square of a spectral density over the last dimension."""
    return np.asarray(np.sqrt(np.trapezoid(density, frequencies, axis=-1)))


def weighted_root_mean_square(density: Array, frequencies: Array) -> Array:
    """Return the root mean square of a vertical acceleration, weighted by W_k of ISO 2631-1."""
    return root_mean_square(density * np.abs(weighting(frequencies)) ** 2, frequencies)


def _rms(density: Array, frequencies: Array, *, accelerates: bool) -> dict[str, Any]:
    found = {"rms": root_mean_square(density, frequencies).tolist()}
    if accelerates:
        found["weighted_rms"] = weighted_root_mean_square(density, frequencies).tolist()
    return found
