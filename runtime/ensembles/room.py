"""The memory that an ensemble needs, known before anything is simulated."""

from dataclasses import dataclass

from ..core.memory import refuse_beyond
from ..core.validator import Validator
from ..simulation.lanes.run import SAMPLES
from ..systems.system import System
from .series import TOGETHER
from .wanted import OutputSpec

_BYTES = 8
# Of a system: how it ended, when, why, by what; four times what it has of its own, which is read,
# checked and put into a table; its start and its end.
_OTHERS, _OF_COLUMN, _OF_STATE = 12, 4, 2


@dataclass(frozen=True)
class Room:
    """What fills the memory besides what the systems have of their own.

    Attributes
    ----------
    model : System
    asked : OutputSpec
    threads : int
        How many work at a time.
    width : int
        How many systems a vector holds, whose series are there at a time.
    """

    model: System
    asked: OutputSpec
    threads: int
    width: int

    def refuse_beyond(self, given: Validator, count: int, columns: int) -> None:
        """Refuse so many systems with so many columns of their own, if they need too much."""
        states = len(self.model.state_names)
        of_one = self.asked.numbers + _OTHERS + _OF_COLUMN * columns + _OF_STATE * states
        refuse_beyond(
            given,
            _BYTES * (count * of_one + self._of_series(count)),
            f"{count:,} systems with {self.asked.times.size:,} outputs, of which "
            f"{self.asked.numbers:,} numbers are kept,",
            "Take fewer systems at a time, or fewer signals or outputs (t_eval), or reductions "
            "such as 'max', which need no series.",
        )

    def _of_series(self, count: int) -> float:
        """Return the numbers of whole series that are there at a time, in all threads."""
        outputs, signals = self.asked.times.size, len(self.asked.sampled)
        some = max(SAMPLES / (_BYTES * max(1, outputs * signals)), self.width)
        # of those of one signal there is a copy, and of a spectrum what its transform needs
        copies = {"percentile": some, "psd": some + 4 * TOGETHER}
        beside = max((copies[r.kind] for r in self.asked.of_series), default=0.0)
        rows = min(self.threads * some, count) * signals + min(self.threads * beside, 5.0 * count)
        return rows * outputs
