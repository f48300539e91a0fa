"""No change of the code moves a number: every analysis of every subject, and all commands."""

import pytest
from golden.stored import COMMANDS, SUBJECTS, differences

# Results of another processor differ by up to 5e-12 of the largest value of their unit (differences
# over small steps; all others by less than 1e-12).
TOLERANCE = 1e-10


@pytest.mark.numbers
@pytest.mark.parametrize("subject", SUBJECTS)
def test_no_number_has_changed(subject):
    assert differences(subject, TOLERANCE) == [], "if on purpose: make golden ARGS=store"


def test_commands_have_the_same_exit_codes_columns_and_keys():
    assert differences(COMMANDS, TOLERANCE) == []
