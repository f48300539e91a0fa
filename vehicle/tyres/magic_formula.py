"""Tyres of the Magic Formula: PAC2002, MF 6.1 and MF 6.2, from property files."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, ClassVar, Self

import numpy as np

from ...core.errors import InputError
from ...formulas import magic_formula, vertical
from ...formulas.arithmetic import ARRAYS
from ...formulas.coefficients import IN_EQUATIONS, NEUTRAL
from ...formulas.magic_formula import Contact, Forces, Form
from . import coefficients as known
from .tir_file import read
from .tyre import LOWEST_SPEED, USUAL_SPEED, ContactTerms, States, Tyre

# Scales that stay in the equations although they are 1, since studies vary them.
_ALWAYS = ("LMUX", "LMUY")
_OTHER_SIDE = {"left": "right", "right": "left", "": ""}


@dataclass(frozen=True)
class MagicFormula(Tyre):
    """A tyre of the Magic Formula.

    Attributes
    ----------
    coefficients : dict of str to float
        By their names in property files, in SI units; missing ones have values without effect.
    form : Form
        Version of the formulas.
    """

    law: ClassVar[str] = "magic_formula"
    coefficients: Mapping[str, float]
    form: Form
    name: str = "MF 6.1"
    side: str = ""
    left_out: tuple[str, ...] = ()
    assumed: tuple[str, ...] = ()
    source: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        filled = {**known.DEFAULTS, "VERTICAL_STIFFNESS": 0.0, **self.coefficients}
        object.__setattr__(self, "coefficients", filled)
        problems = [*self._impossible()] or [*self._implausible()]
        if problems:
            raise InputError(problems, self.source or self.name)

    @classmethod
    def load(cls, path: str | Path) -> Self:
        """Return the tyre of a property file (.tir).

        Parameters
        ----------
        path : str or pathlib.Path

        Raises
        ------
        InputError
            If the file cannot be read, a key is missing, or values are impossible.
        """
        found = read(path)
        return cls(
            found.numbers,
            found.form,
            found.name,
            found.side,
            found.left_out,
            found.assumed,
            str(path),
        )

    @property
    def nominal_load(self) -> float:  # type: ignore[override] # read only
        """Reference load of the coefficients [N]."""
        return self.coefficients["FNOMIN"] * self.coefficients["LFZO"]

    @property
    def radius(self) -> float:  # type: ignore[override] # read only
        """Unloaded radius [m]."""
        return self.coefficients["UNLOADED_RADIUS"]

    @property
    def ranges(self) -> dict[str, tuple[float, float]]:  # type: ignore[override] # read only
        """Ranges of validity by argument of `evaluate`."""
        return {
            name: (self.coefficients.get(low, -np.inf), self.coefficients.get(high, np.inf))
            for name, (low, high) in known.LIMITS.items()
            if low in self.coefficients or high in self.coefficients
        }

    @property
    def usual_speed(self) -> float:  # type: ignore[override] # read only
        """Speed of the measurement [m/s]."""
        return self.coefficients.get("LONGVL", USUAL_SPEED)

    @property
    def lowest_speed(self) -> float:  # type: ignore[override] # read only
        """Speed below which slips are smoothed in equations of motion [m/s]."""
        return self.coefficients.get("VXLOW", LOWEST_SPEED)

    @property
    def vertical_damping(self) -> float:  # type: ignore[override] # read only
        """Damping along the normal in equations of motion [N s/m]."""
        return self.coefficients.get("VERTICAL_DAMPING", 0.0)

    @property
    def usual_pressure(self) -> float:  # type: ignore[override] # read only
        """Inflation pressure [Pa]; 0 if the tyre does not depend on it."""
        return self.coefficients.get("INFLPRES", self._nominal_pressure)

    @property
    def _nominal_pressure(self) -> float:
        return self.coefficients.get("NOMPRES", 0.0)

    def with_changes(self, changes: Mapping[str, float]) -> Self:
        """Return the tyre with other coefficients.

        Parameters
        ----------
        changes : mapping of str to float
            By name, such as ``{"LMUY": 0.8}``.

        Raises
        ------
        InputError
            If a name is not known, or values are impossible.
        """
        unknown = [k for k in changes if k not in known.USED]
        if unknown:
            raise InputError([f"{k} is not a coefficient in use." for k in unknown], self.name)
        return replace(self, coefficients={**self.coefficients, **changes})

    @property
    def free_radius(self) -> float:
        """Unloaded radius in equations of motion [m]: that of the file times ``Q_RE0``."""
        return float(vertical.free_radius(self.coefficients, 0.0))

    def mirrored(self) -> Self:
        return replace(
            self, coefficients=known.mirrored(self.coefficients), side=_OTHER_SIDE[self.side]
        )

    @property
    def contact(self) -> ContactTerms:
        """The law `kintrafo.generator.MagicFormulaContact`.

        Terms that have no effect in this tyre are left out, except the scales of the friction.
        """
        own = self.parameters()
        idle = (k for k in IN_EQUATIONS if own[f"tyre_{k.lower()}"] == NEUTRAL[k])
        options = {
            "newer": self.form.newer,
            "weighted": self.form.weighted,
            "angle": self.form.angle,
            "without": tuple(k for k in idle if k not in _ALWAYS),
        }
        return ContactTerms("MagicFormulaContact", tuple(options.items()))

    def parameters(
        self, name: str = "tyre", *, relaxing: bool = False, without: Iterable[str] = ()
    ) -> dict[str, float]:
        """Return the values of the parameters of `contact_law`.

        Parameters
        ----------
        name : str, optional
            Prefix of their names.
        relaxing : bool, optional
            Whether the equations have deflections as states, so that relaxation lengths are needed.
        without : iterable of str, optional
            Coefficients left out of the equations, as in `MagicFormulaContact.without`.

        Returns
        -------
        dict of str to float
            By name, such as ``"tyre_pcx1"``, in SI units.

        Raises
        ------
        InputError
            If relaxation lengths are needed and the file does not give them; or if a coefficient in
            ``without`` has an effect in this tyre.
        """
        lengths = self.evaluate(self.nominal_load)
        if relaxing and not np.isfinite([lengths.relaxation_x, lengths.relaxation_y]).all():
            newer = "LONGITUDINAL_STIFFNESS and LATERAL_STIFFNESS"
            missing = newer if self.form.newer else "PTX1, PTY1 and PTY2"
            problem = f"relaxation lengths are not known. Add {missing}, or leave deflections out."
            raise InputError([problem], self.source or self.name)
        first, second = vertical.rates(ARRAYS, self.coefficients)
        found = {key: self.coefficients[key] for key in IN_EQUATIONS}
        found |= {
            "UNLOADED_RADIUS": self.radius,
            "FNOMIN": self.coefficients["FNOMIN"],
            "LONGVL": self.usual_speed,
            "LONGITUDINAL_STIFFNESS": self.coefficients.get("LONGITUDINAL_STIFFNESS", 1.0),
            "LATERAL_STIFFNESS": self.coefficients.get("LATERAL_STIFFNESS", 1.0),
            "VXLOW": self.lowest_speed,
            "INFLPRES": self.usual_pressure or 1.0,
            "NOMPRES": self._nominal_pressure or 1.0,
            "PTY2": self.coefficients["PTY2"] or 1.0,
            "Q_FZ1": float(first),
            "Q_FZ2": float(second),
        }
        left = frozenset(without)
        lost = [k for k in left if found.get(k) != NEUTRAL.get(k)]
        if lost:
            problems = (f"{k} = {found.get(k)}: the equations leave it out." for k in lost)
            raise InputError(sorted(problems), self.source or self.name)
        return {f"{name}_{k.lower()}": value for k, value in found.items() if k not in left}

    def _contact(self, at: States) -> Contact:
        """Return the contact, with speed and pressure relative to those of the measurement."""
        contact, nominal = at.contact(), self._nominal_pressure
        return replace(
            contact,
            lateral=at.slip_angle if self.form.angle else contact.lateral,
            speed=at.speed / self.usual_speed,
            pressure=at.pressure / nominal - 1.0 if nominal else np.zeros(()),
        )

    def _state(self, at: States) -> tuple[Forces, dict[str, Any]]:
        p, c = self.coefficients, self._contact(at)
        found = magic_formula.forces(ARRAYS, p, c, self.form)
        spin = (at.speed + at.slip * np.abs(at.speed)) / self.usual_speed
        moved = vertical.factor(ARRAYS, p, found.fx, found.fy, spin, c.pressure)
        deflection, stiffness = vertical.deflection(ARRAYS, p, at.load, c.inclination, moved)
        nominal = vertical.factor(ARRAYS, p, 0.0, 0.0, 0.0, c.pressure)
        _, at_nominal = vertical.deflection(ARRAYS, p, p["FNOMIN"], 0.0, nominal)
        free = vertical.free_radius(p, spin)
        along, across = self._relaxation(at, c, found)
        return found, {
            "relaxation_x": along,
            "relaxation_y": across,
            "loaded_radius": free - deflection,
            "effective_radius": vertical.effective_radius(ARRAYS, p, at.load, at_nominal, free),
            "vertical_stiffness": stiffness,
        }

    def _relaxation(self, at: States, c: Contact, found: Forces) -> tuple[Any, Any]:
        """Return both relaxation lengths [m]; NaN if the file does not give them."""
        p, dfz = self.coefficients, at.load / self.nominal_load - 1.0
        unknown = np.full(at.load.shape, np.nan)
        along = across = unknown
        if p["PTX1"]:
            along, _ = vertical.relaxation_by_load(ARRAYS, {**p, "PTY2": 1.0}, at.load, dfz, 0.0)
        if p["PTY1"] and p["PTY2"]:
            _, across = vertical.relaxation_by_load(ARRAYS, p, at.load, dfz, c.inclination)
        stiff = {"LONGITUDINAL_STIFFNESS": 1.0, "LATERAL_STIFFNESS": 1.0, **p}
        by_stiffness = vertical.relaxation_by_stiffness(
            stiff, dfz, c.pressure, found.slip_stiffness, found.cornering_stiffness
        )
        if self.form.newer and "LONGITUDINAL_STIFFNESS" in p:
            along = by_stiffness[0]
        if self.form.newer and "LATERAL_STIFFNESS" in p:
            across = by_stiffness[1]
        return along, across

    def _impossible(self) -> list[str]:
        """Return a problem for each impossible value."""
        p = self.coefficients
        positive = ("UNLOADED_RADIUS", "FNOMIN", "LFZO", "PCX1", "PCY1", "LCX", "LCY", "LMUX",
                    "LMUY", "LKX", "LKY", "LCZ", "PKY2", "Q_RE0", "LONGVL", "VXLOW", "NOMPRES",
                    "INFLPRES", "LONGITUDINAL_STIFFNESS", "LATERAL_STIFFNESS")  # fmt: skip
        problems = [
            f"{key} = {p[key]:g}: more than zero is needed."
            for key in positive
            if key in p and not p[key] > 0.0
        ]
        if not (p["Q_FZ1"] > 0.0 or p["VERTICAL_STIFFNESS"] > 0.0):
            problems.append("VERTICAL_STIFFNESS or Q_FZ1: more than zero is needed.")
        for name, (low, high) in self.ranges.items():
            if not low < high:
                ends = " and ".join(known.LIMITS[name])
                problems.append(f"{ends} are {low:g} and {high:g}: the second must be greater.")
        return problems

    def _implausible(self) -> list[str]:
        """Return problems of the curves within the range of load, at zero slip and camber."""
        p = self.coefficients
        low, high = self.ranges.get("load", (0.0, np.inf))
        ends = (max(low, 0.0), self.nominal_load, min(high, 2.0 * self.nominal_load))
        problems = []
        for load in dict.fromkeys(ends):
            dfz = load / self.nominal_load - 1.0
            for axis in "XY":
                peak = p[f"PD{axis}1"] + p[f"PD{axis}2"] * dfz
                if not peak > 0.0:
                    problems.append(
                        f"the friction PD{axis}1 + PD{axis}2 dfz is {peak:g} at {load:g} N: more "
                        "than zero is needed. Correct them, or the range FZMIN to FZMAX."
                    )
            slope = p["PKX1"] + p["PKX2"] * dfz
            if not slope > 0.0:
                problems.append(
                    f"the slip stiffness PKX1 + PKX2 dfz is {slope:g} at {load:g} N: more than "
                    "zero is needed."
                )
        turned = p["PKY4"] * np.arctan(ends[-1] / (p["PKY2"] * self.nominal_load))
        if not 0.0 < turned < np.pi:
            problems.append(
                f"the cornering stiffness vanishes within {ends[-1]:g} N. Correct PKY4 and PKY2."
            )
        if not p["PKY1"] < 0.0:
            problems.append(
                f"PKY1 = {p['PKY1']:g}: it is negative in the axes of property files (ISO 8855: y "
                "to the left). Convert a tyre of other axes."
            )
        stiff = p["VERTICAL_STIFFNESS"] * p["UNLOADED_RADIUS"] / p["FNOMIN"]
        if not p["Q_FZ1"] and stiff * stiff <= 4.0 * p["Q_FZ2"]:
            problems.append(
                f"Q_FZ2 = {p['Q_FZ2']:g} is too great for the vertical stiffness: less than "
                f"{0.25 * stiff * stiff:g} is needed."
            )
        return problems
