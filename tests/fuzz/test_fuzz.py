"""A short run at every door; ``make fuzz`` is the long one."""

import pytest

from fuzz.attempts import OUTCOMES, names, short
from fuzz.campaign import campaign, table


@pytest.mark.parametrize("name", names())
def test_nothing_wrong_raw_or_hung(name):
    found = campaign(name, short(name))
    assert not found.defects, "\n".join(
        f"seed {one.seed}: {one.outcome}: {one.text}" for one in found.defects
    )


def test_what_goes_wrong_is_reported():
    """Hanging and dying cost their own seed only, and both are seen."""
    found = campaign("_broken", short("_broken"))
    assert [found.counts[outcome] for outcome in OUTCOMES] == [2, 1, 1, 1, 2, 1]
    assert [(one.seed, one.outcome) for one in found.defects] == [
        (2, "wrong"),
        (3, "raw"),
        (4, "hung"),
        (5, "raw"),
    ]
    assert "exit code 7" in found.defects[-1].text
    counts = table([found]).splitlines()[-1].split("|")[2:-1]
    assert [int(count) for count in counts] == [8, 2, 1, 1, 1, 2, 1]
