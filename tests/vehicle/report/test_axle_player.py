"""The player of axles without sides in their reports."""

import json
import re

import kintrafo
import numpy as np
import pytest
from kintrafo.vehicle.report import axle_chapter


@pytest.mark.parametrize("name", ["rigid_axle", "twist_beam", "steered_rigid_axle"])
def test_wheels_move_as_on_a_rig(name):
    """Wheels rise equally in bump and oppositely in roll; in steering they turn."""
    (player,) = axle_chapter(kintrafo.load(name)).players
    (text,) = re.findall(r'<script type="application/json">(.*?)</script>', str(player), re.DOTALL)
    data = json.loads(text)
    centers = np.array(data["centers"]).reshape(len(data["times"]), 2, 3)  # mm
    risen = centers[:, :, 2] - centers[0, :, 2]
    travels = [float(word.split()[-2]) for word in data["words"][:75]]
    np.testing.assert_allclose(risen[:75].T, [travels, travels], atol=1.0)  # whole millimetres
    assert max(travels) > 70.0
    # both sides of the packaged axles are mirror images
    np.testing.assert_allclose(risen[75:150].sum(axis=1), 0.0, atol=2.0)
    assert np.ptp(risen[75:150, 0]) > 80.0
    if name == "steered_rigid_axle":
        axes = np.array(data["axes"]).reshape(-1, 2, 3)
        assert np.degrees(np.ptp(np.arctan2(axes[150:, 0, 0], axes[150:, 0, 1]))) > 30.0
    assert not np.any(data["forces"])


def test_an_axle_of_two_suspensions_has_no_player():
    """The interactive view of its page shows one side."""
    assert axle_chapter(kintrafo.load("reference_axle")).players == ()
