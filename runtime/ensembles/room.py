"""The memory that an ensemble needs, computed before anything is simulated."""

from dataclasses import dataclass

from ..core.memory import refuse_beyond
from ..core.validator import Validator
from ..simulation.lanes.run import SAMPLES
from ..systems.system import System
from .output_spec import OutputSpec
from .series import TOGETHER

_BYTES = 8
# Numbers of a system: its end (kind, time, reason, solver); four copies of its own values, which
# are read, checked and put into a table; its initial and final states.
_OTHERS, _OF_COLUMN, _OF_STATE = 12, 4, 2


@dataclass(frozen=True)
class Room:
    """The memory of results, in addition to that of the variants."""

    model: System
    asked: OutputSpec
    threads: int
    width: int  # number of systems in a vector, whose series are in memory together

    def refuse_beyond(self, given: Validator, count: int, columns: int) -> None:
        """Refuse a number of systems, with columns of their own, that needs too much memory."""
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
        """Return the numbers of whole series that are in memory together, in all threads."""
        outputs, signals = self.asked.times.size, len(self.asked.sampled)
        some = max(SAMPLES / (_BYTES * max(1, outputs * signals)), self.width)
        # a copy of the series of one signal; for a spectrum also the data of its transform
        copies = {"percentile": some, "psd": some + 4 * TOGETHER}
        beside = max((copies[r.kind] for r in self.asked.of_series), default=0.0)
        rows = min(self.threads * some, count) * signals + min(self.threads * beside, 5.0 * count)
        return rows * outputs
