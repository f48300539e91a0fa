"""Chapters of axles without sides in their reports, and their player."""

import json
import re

import kintrafo
import numpy as np
import pytest
from kintrafo.vehicle.report import axle_chapter


@pytest.fixture(scope="module", params=["rigid_axle", "twist_beam", "steered_rigid_axle"])
def name(request):
    return request.param


@pytest.fixture(scope="module")
def chapter(name):
    return axle_chapter(kintrafo.load(name))


def test_the_chapter_has_all_of_it(chapter):
    look, wheels, *_ = chapter.tables
    rows = {"equilibrium", "wheel rate, left", "roll stiffness of the anti-roll bar or beam"}
    assert rows <= {*dict(look.rows)}
    assert {"camber", "toe angle", "wheel rate"} <= {row[0] for row in wheels.rows}
    assert "from above" in chapter.pictures[0].words


def test_wheels_move_as_on_a_rig(chapter, name):
    """Wheels rise equally in bump and oppositely in roll; in steering they turn."""
    (player,) = chapter.players
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
