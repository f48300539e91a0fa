"""Archives whose bytes depend on their content alone, not on the time of writing."""

from zipfile import ZipInfo

EARLIEST = (1980, 1, 1)
"""Year, month and day: the earliest date in an archive."""


def undated(name: str, method: int) -> ZipInfo:
    """Return a member of an archive with the earliest date, and a compression of `zipfile`."""
    member = ZipInfo(name, (*EARLIEST, 0, 0, 0))
    member.compress_type = method
    return member
