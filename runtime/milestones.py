"""SciPy's solvers, made to step onto given times."""

from typing import Any

import numpy as np
import scipy.integrate
from numpy.typing import NDArray
from scipy.integrate import OdeSolver

Array = NDArray[np.float64]


def stopping_at(method: str, times: Array) -> str | type[OdeSolver]:
    """Return a method of ``solve_ivp`` whose steps do not pass over some times.

    Parameters
    ----------
    method : str
        Name of a method of SciPy.
    times : ndarray
        In the order of the integration, within its time [s].

    Returns
    -------
    str or class
        What ``solve_ivp`` takes for ``method``.
    """
    if not times.size:
        return method
    base: Any = getattr(scipy.integrate, method)

    class Stopping(base):  # type: ignore[misc]  # which class it is, is known when it runs
        """Ends its steps at the next of the times, as at the end of the integration."""

        status: str

        def __init__(self, *given: Any, **options: Any) -> None:
            super().__init__(*given, **options)
            self._ends = [*times.tolist(), self.t_bound]
            self._next = 0

        def step(self) -> str | None:
            while (
                self._next < times.size
                and self.direction * (self._ends[self._next] - self.t) <= 0.0
            ):
                self._next += 1
            self._aim(self._ends[self._next])
            message: str | None = super().step()
            self._aim(self._ends[-1])
            if self.status == "finished" and self.direction * (self.t - self.t_bound) < 0.0:
                self.status = "running"
            return message

        def _aim(self, time: float) -> None:
            self.t_bound = time
            if method == "LSODA":  # keeps its own copy of the bound, and has no interface to it
                self._lsoda_solver._integrator.rwork[0] = time  # noqa: SLF001

    return Stopping
