"""Forces on single joints, points and bodies, compared with maximal coordinates."""

from dataclasses import replace

import pytest
from kintrafo import generator as g
from mechanisms.every_force import loaded_bar, loaded_crank
from oracle.random_states import check_with_the_oracle
from support.changes import changed

TILTED = g.Weight(upward=g.Direction("uphill", (0.5, -0.4, 2.0)))


CRANK, MARK = (
    g.Body("crank", 1.0, (0.1, 0.0, 0.0), (1e-3, 1e-3, 1e-3)),
    g.Point("mark", (0.2, 0.0, 0.1)),
)
LINE = g.AlongLine((g.Ground("base"), g.Point("seat", (0.0, 0.0, 0.0))), (CRANK, MARK))
RATE = g.SpringRate("rate", 100.0, "rate")
FREE = g.LinearSpring(RATE, free_length=g.Displacement("free", -0.1, "length without force"))
TURN = g.Input("turn", "N m", "turn")


def touched(name):
    """Return a stop of the bump side."""
    length = g.Length(f"{name}_length", 0.1, "length at which it is touched")
    return g.Stop(
        side="bump", length=length, rate=RATE, progression=g.Progression("cubic", 0.0, "cubic")
    )


def under_a_slope(model):
    """Return a model on which gravity does not pull downward."""
    (weight,) = (f for f in model.mechanism.forces if isinstance(f, g.Weight))
    return changed(model, (weight, TILTED))


@pytest.mark.parametrize(
    "model", [under_a_slope(loaded_crank()), loaded_bar()], ids=lambda m: m.name
)
def test_accelerations_are_those_of_maximal_coordinates(model, tmp_path):
    check_with_the_oracle(model, tmp_path, reach=0.2)


def test_only_the_direction_of_fixed_components_counts(tmp_path):
    """A guide along (1.0, 0.3, -0.2), which is no unit vector, slides by metres."""
    model = loaded_crank("fixed_way")
    way = model.mechanism.joint("way")
    fixed = replace(way, direction=g.Direction("fixed_way", fixed=(1.0, 0.3, -0.2)))
    check_with_the_oracle(changed(model, (way, fixed)), tmp_path, reach=0.1, count=3)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: g.AppliedForce(CRANK, MARK, g.UP, g.Input("push", "N m", "push")),
        lambda: g.AppliedMoment(CRANK, g.UP, g.Input("turn", "N", "turn")),
        lambda: g.AppliedForce(g.Ground("base"), MARK, g.UP, g.Input("push", "N", "push")),
        lambda: g.ForceElement("coil", LINE, (touched("a"), touched("b"))),
        lambda: g.ForceElement("coil", LINE, (FREE,)),
        lambda: g.ForceElement("coil", LINE, (g.Actuator(TURN),)),
    ],
)
def test_what_cannot_act_is_refused(wrong, refused):
    refused(g.DeclarationError, wrong)
