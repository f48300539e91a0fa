"""Errors of a mechanism that cannot be solved."""


class TopologyError(ValueError):
    """The joint graph is not that of a mechanism that can be analysed."""


class NoClosedFormError(ValueError):
    """A loop has no solution in the catalogue of closed forms.

    Attributes
    ----------
    solved
        Number of loops that were solved before.
    """

    def __init__(self, message: str, solved: int = 0) -> None:
        super().__init__(message)
        self.solved = solved
