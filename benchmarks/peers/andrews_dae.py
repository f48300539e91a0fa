"""Andrews' squeezer as a differential-algebraic equation, in CasADi: what other codes integrate.

The equations are those of Hairer & Wanner, *Solving Ordinary Differential Equations II*, section
VII.7: seven angles, seven rates, seven accelerations and six multipliers. They share nothing with
this project's model but the data.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ANGLES = ("beta", "theta", "gamma", "phi", "delta", "omega", "epsilon")
START = (
    -0.0617138900142764496358948458001,
    0.0,
    0.455279819163070380255912382449,
    0.222668390165885884674473185609,
    0.487364979543842550225598953530,
    -0.222668390165885884674473185609,
    1.23054744454982119249735015568,
)
END = 0.03
TORQUE = 0.033

_M = (0.04325, 0.00365, 0.02373, 0.00706, 0.07050, 0.00706, 0.05498)
_I = (2.194e-6, 4.410e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
_A, _B, _C = (-0.06934, -0.00227), (-0.03635, 0.03273), (0.014, 0.072)
_D, _DA, _E, _EA, _RR, _RA = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092
_SS, _SA, _SB, _SC, _SD = 0.035, 0.01874, 0.01043, 0.018, 0.02
_TA, _TB, _U, _UA, _UB = 0.02308, 0.00916, 0.04, 0.01228, 0.00449
_ZF, _ZT, _FA = 0.02, 0.04, 0.01421
_RATE, _FREE = 4530.0, 0.07785


@dataclass(frozen=True)
class Squeezer:
    """Unknowns and equations as symbols."""

    # vectors of 7, 7, 7 and 6 symbols
    angles: Any
    rates: Any
    accelerations: Any
    multipliers: Any

    @classmethod
    def of_symbols(cls) -> "Squeezer":
        """Name the unknowns."""
        sizes = {"p": 7, "v": 7, "w": 7, "l": 6}
        return cls(*(ca.SX.sym(name, size) for name, size in sizes.items()))

    @cached_property
    def constraints(self) -> Any:
        """The loops closed: six lengths that must vanish."""
        be, th, ga, ph, de, om, ep = ca.vertsplit(self.angles)
        knee = (
            _RR * ca.cos(be) - _D * ca.cos(be + th),
            _RR * ca.sin(be) - _D * ca.sin(be + th),
        )
        return ca.vertcat(
            knee[0] - _SS * ca.sin(ga) - _B[0],
            knee[1] + _SS * ca.cos(ga) - _B[1],
            knee[0] - _E * ca.sin(ph + de) - _ZT * ca.cos(de) - _A[0],
            knee[1] + _E * ca.cos(ph + de) - _ZT * ca.sin(de) - _A[1],
            knee[0] - _ZF * ca.cos(om + ep) - _U * ca.sin(ep) - _A[0],
            knee[1] - _ZF * ca.sin(om + ep) + _U * ca.cos(ep) - _A[1],
        )

    @cached_property
    def constraint_accelerations(self) -> Any:
        """The second derivatives of the constraints in time."""
        first = ca.jtimes(self.constraints, self.angles, self.rates)
        gradient = ca.jacobian(self.constraints, self.angles)
        return gradient @ self.accelerations + ca.jtimes(first, self.angles, self.rates)

    @cached_property
    def balance(self) -> Any:
        """Mass times acceleration, less forces, plus the forces of the joints."""
        gradient = ca.jacobian(self.constraints, self.angles)
        return self._mass @ self.accelerations - self._forces + gradient.T @ self.multipliers

    @property
    def _mass(self) -> Any:
        _, th, _, ph, _, om, _ = ca.vertsplit(self.angles)
        m, i = _M, _I
        short, lever = _E - _EA, _ZF - _FA
        mass = ca.SX.zeros(7, 7)
        cross = _DA * _RR * ca.cos(th)
        mass[0, 0] = m[0] * _RA**2 + m[1] * (_RR**2 - 2 * cross + _DA**2) + i[0] + i[1]
        mass[0, 1] = mass[1, 0] = m[1] * (_DA**2 - cross) + i[1]
        mass[1, 1] = m[1] * _DA**2 + i[1]
        mass[2, 2] = m[2] * (_SA**2 + _SB**2) + i[2]
        bent = _ZT * short * ca.sin(ph)
        mass[3, 3] = m[3] * short**2 + i[3]
        mass[3, 4] = mass[4, 3] = m[3] * (short**2 + bent) + i[3]
        mass[4, 4] = m[3] * (_ZT**2 + 2 * bent + short**2) + m[4] * (_TA**2 + _TB**2) + i[3] + i[4]
        bent = _U * lever * ca.sin(om)
        mass[5, 5] = m[5] * lever**2 + i[5]
        mass[5, 6] = mass[6, 5] = m[5] * (lever**2 - bent) + i[5]
        mass[6, 6] = m[5] * (lever**2 - 2 * bent + _U**2) + m[6] * (_UA**2 + _UB**2) + i[5] + i[6]
        return mass

    @property
    def _forces(self) -> Any:
        _, th, ga, ph, _, om, _ = ca.vertsplit(self.angles)
        vbe, vth, _, vph, vde, vom, vep = ca.vertsplit(self.rates)
        arm = (_SD * ca.cos(ga) + _SC * ca.sin(ga), _SD * ca.sin(ga) - _SC * ca.cos(ga))
        span = (_B[0] + arm[0] - _C[0], _B[1] + arm[1] - _C[1])
        length = ca.sqrt(span[0] ** 2 + span[1] ** 2)
        pull = -_RATE * (length - _FREE) / length
        swing = _M[1] * _DA * _RR * ca.sin(th)
        twist = _M[3] * _ZT * (_E - _EA) * ca.cos(ph)
        turn = _M[5] * _U * (_ZF - _FA) * ca.cos(om)
        return ca.vertcat(
            TORQUE - swing * vth * (vth + 2 * vbe),
            swing * vbe**2,
            pull * (span[1] * arm[0] - span[0] * arm[1]),
            twist * vde**2,
            -twist * vph * (vph + 2 * vde),
            -turn * vep**2,
            turn * vom * (vom + 2 * vep),
        )

    def start(self) -> tuple[Array, Array]:
        """Return accelerations and multipliers at rest, which the equations determine."""
        unknown = ca.vertcat(self.accelerations, self.multipliers)
        equations = ca.vertcat(self.balance, self.constraint_accelerations)
        given = [self.angles, self.rates, unknown]
        residual = ca.Function("r", given, [equations, ca.jacobian(equations, unknown)])
        right, matrix = residual(START, np.zeros(7), np.zeros(13))
        found = -np.linalg.solve(np.array(matrix), np.array(right)).ravel()
        return found[:7], found[7:]
