"""What each kind of force does, for the report."""

from __future__ import annotations

from functools import singledispatch
from typing import TYPE_CHECKING, Any

import sympy as sp

from ...declare.forces.applied_force import AppliedForce
from ...declare.forces.applied_moment import AppliedMoment
from ...declare.forces.force_element import ForceElement
from ...declare.forces.joint_force import JointForce
from ...declare.forces.linear_tyre import LinearTyre
from ...declare.forces.weight import Weight
from ...declare.laws import LinearDamper, LinearSpring, Stretch

if TYPE_CHECKING:
    from ...declare.formulation import Formulation
    from ...declare.laws import Law

LENGTH, RATE, SLIDE = (sp.Symbol(name) for name in ("length", "velocity", "slide"))


def force_rows(formulation: Formulation) -> list[tuple[str, ...]]:
    """Return for each force that acts its name, what it does, its share of Q, the paper's place."""
    return [
        (*words(force), formulation.cites.get(force.identity[1], ""))
        for force in formulation.mechanism.forces
        if force.along not in formulation.prescribed
    ]


@singledispatch
def words(force: Any) -> tuple[str, str, str]:
    """Return name, what it does, and its share of Q."""
    kind, name = force.identity
    return f"{kind} {name}", (type(force).__doc__ or "").split("\n")[0], "its power by the rate"


@words.register
def _(force: Weight) -> tuple[str, str, str]:
    gravity = force.gravity.name
    up = r"\mathbf{e}_z" if force.upward.name == "up" else r"\mathbf{d}"
    share = rf"$`-\sum_b m_b\,g\,\mathbf{{V}}_b^T\,{up}`$"
    return "weight", f"g = `{gravity}` on every body with mass", share


@words.register
def _(force: ForceElement) -> tuple[str, str, str]:
    laws = "; ".join(_law(law) for law in force.laws)
    length = r"\vartheta" if force.turns else r"\ell"
    share = rf"$`\left(\partial {length}/\partial\mathbf{{q}}\right)^T F`$"
    return force.name, f"F, {force.path.words.sense}: {laws}", share


def _law(law: Law) -> str:
    """Return the formula of a law that has one, and of others what it is."""
    if isinstance(law, LinearSpring | LinearDamper):
        value = law.force(Stretch(None, "", LENGTH, RATE, SLIDE))  # type: ignore[arg-type]
        return f"{law.meaning} `{value}`"
    return law.meaning


@words.register
def _(force: LinearTyre) -> tuple[str, str, str]:
    load = f"{force.rate.name}*({force.free_height.name} + {force.road.name} - height)"
    more = ", with damping" if force.damper is not None else ""
    pull = r"\mathbf{w} = \frac{F}{1-a_z^2}\,(\mathbf{e}_z - a_z\,\mathbf{a})"
    return (
        f"tyre {force.name}",
        f"F = `{load}`{more}; at `{force.wheel.center.name}`, a the spin axis: $`{pull}`$",
        r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{w}`$",
    )


@words.register
def _(force: JointForce) -> tuple[str, str, str]:
    name = force.input.name
    return name, f"`{name}` along the coordinate of joint {force.joint.name}", "itself"


@words.register
def _(force: AppliedForce) -> tuple[str, str, str]:
    return (
        force.input.name,
        f"`{force.input.name}` on {force.body.name} at `{force.point.name}` along d",
        r"$`\left(\partial\mathbf{v}_P/\partial\dot{\mathbf{q}}\right)^T\mathbf{d}\,F`$",
    )


@words.register
def _(force: AppliedMoment) -> tuple[str, str, str]:
    return (
        force.input.name,
        f"`{force.input.name}` on {force.body.name} about d",
        r"$`\mathbf{W}_b^T\mathbf{d}\,F`$",
    )
