"""Suspensions on bushes beside Exudyn: `make benchmark-bushes` fills docs/suspension/loads.md.

Exudyn is an independent program for flexible multibody systems. There every part is a body with six
coordinates, every joint a constraint, every bush a spring in three directions; it looks for the
static equilibrium by Newton's method. Nothing but hardpoints, rates and masses of the file is given
to it.

A link there is a body on springs at both ends. Nothing but its inner joint, a cross, keeps it from
turning about its own line: an axis of the chassis, upright, and one of the link stay at right
angles, which is one of the constraints of a generic joint.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

import exudyn as exu
import numpy as np
from exudyn.utilities import InertiaCuboid, ObjectGround
from kintrafo import Model, compliance
from numpy.typing import NDArray
from scipy.optimize import root_scalar

from .report import fill_page

Array = NDArray[np.float64]

PAGE = Path(__file__).parent.parent / "docs/suspension/compliance.md"
QUANTITIES = ("toe_change", "camber_change", "displacement")
SMALL = 40.0
AMOUNTS = (-4000.0, -1000.0, SMALL, 1000.0, 4000.0)
# In three directions of the chassis [N/m]: along x, the axis of an arm, and across it.
SOFT = {"front": (1.5e6, 8e6, 5e6), "rear": (0.4e6, 1.2e6, 2.5e6)}
# The same at the inner end of a link; at its outer end, which turns with the carrier, alike in all.
SOFT_INNER, SOFT_OUTER = (3e6, 9e6, 4e6), 12e6
# Of the point of contact in the wheel, and of the height of the contact [m].
_SAME_POINT, _SAME_HEIGHT = 1e-12, 1e-10
_STEPS = 30


@dataclass(frozen=True)
class Peer:
    """A suspension as Exudyn has it."""

    # for each arm its ball joint, and how the names of its bearings begin
    arms: Mapping[str, tuple[str, str]]
    seated_on: str  # part that carries the lower seat of the spring
    strut: bool = False  # whether a strut guides the knuckle
    links: tuple[str, ...] = ()  # rods with a bush at either end

    def origin(self, part: str) -> str:
        """Return the point at which a part's own axes begin, at design."""
        if part in self.arms:
            return self.arms[part][0]
        return f"{part}_inner" if part in self.links else "wheel_center"


PEERS = {
    "double_wishbone_car": Peer(
        {f"{arm}_arm": (f"{arm}_ball_joint", f"{arm}_arm") for arm in ("lower", "upper")},
        seated_on="lower_arm",
    ),
    "offset_strut_car": Peer(
        {"control_arm": ("ball_joint", "arm")}, seated_on="knuckle", strut=True
    ),
    "multi_link_car": Peer(
        {},
        seated_on="rear_lower_link",
        links=(
            "front_upper_link",
            "rear_upper_link",
            "front_lower_link",
            "rear_lower_link",
            "tie_rod",
        ),
    ),
}


def main() -> None:
    """Compare, print, and fill the page."""
    columns = ("toe, deg", "camber, deg", "displacement along the load, mm")
    heads = (f"{name}: Exudyn | kintrafo" for name in columns)
    rows = [
        f"| | load | {' | '.join(heads)} |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    worst, at_small = dict.fromkeys(QUANTITIES, 0.0), dict.fromkeys(QUANTITIES, 0.0)
    for name, peer in PEERS.items():
        model = Model(name)
        for under in ("lateral", "recession"):
            for held in ("height", "spring"):
                ours = _ours(model, peer, under, held)
                theirs = _theirs(model, peer, under, held)
                for quantity in worst:
                    off = np.abs(ours[quantity] - theirs[quantity])
                    off /= np.abs(theirs[quantity]).max()
                    worst[quantity] = max(worst[quantity], float(off.max()))
                    small = float(off[AMOUNTS.index(SMALL)]) * AMOUNTS[-1] / SMALL
                    at_small[quantity] = max(at_small[quantity], small)
                if held == "height":
                    rows.append(_row(model, under, ours, theirs))
    amounts = ", ".join(f"{amount / 1e3:g}" for amount in AMOUNTS)
    rows += ["", f"Under {amounts} kN, the wheel held by its height or by its vertical force, the"]
    rows[-1] += (
        f" largest difference divided by the largest value under all loads is {_words(worst)};"
    )
    part = f"1/{AMOUNTS[-1] / SMALL:g}"
    rows[-1] += f" under {SMALL:g} N, divided by {part} of that value, since {SMALL:g} N is {part}"
    rows[-1] += f" of {AMOUNTS[-1] / 1e3:g} kN, {_words(at_small)}."
    rows[-1] += f" Exudyn {version('exudyn')}."
    print("\n".join(rows))
    fill_page(PAGE, {"bushes": "\n".join(rows)})


def _words(differences: Mapping[str, float]) -> str:
    parts = (f"{value:.0e} of {name.replace('_', ' ')}" for name, value in differences.items())
    return ", ".join(parts)


def _row(model: Model, under: str, ours: dict[str, Array], theirs: dict[str, Array]) -> str:
    units = (180.0 / np.pi, 180.0 / np.pi, 1e3)
    cells = [
        f"{factor * found[quantity][-1]:.5f}"
        for quantity, factor in zip(QUANTITIES, units, strict=True)
        for found in (theirs, ours)
    ]
    title = model.suspension.TITLE
    words = {"lateral": "inward at the contact", "recession": "rearward at the wheel centre"}
    return f"| {title} | {AMOUNTS[-1] / 1e3:g} kN {words[under]} | {' | '.join(cells)} |"


def _bushes(peer: Peer) -> dict[str, dict[str, Any]]:
    """Return the bushes of the arms and links."""
    rates = {
        f"{bearing}_{end}": rates
        for _, bearing in peer.arms.values()
        for end, rates in SOFT.items()
    }
    rates |= {f"{link}_inner": SOFT_INNER for link in peer.links}
    rates |= {f"{link}_outer": 3 * (SOFT_OUTER,) for link in peer.links}
    return {
        point: {
            "axis": [1.0, 0.0, 0.0],
            "radial_axis": [0.0, 1.0, 0.0],
            "axial_N_per_mm": along / 1e3,
            "radial_N_per_mm": [across / 1e3, upright / 1e3],
        }
        for point, (along, across, upright) in rates.items()
    }


def _ours(model: Model, peer: Peer, under: str, held: str) -> dict[str, Array]:
    found = compliance.nonlinear(
        model, _bushes(peer), under, AMOUNTS, held=held, hardpoints="relaxed"
    ).sel(data_set="equilibrium")
    return {name: found[name].values for name in QUANTITIES}


# -- Exudyn -------------------------------------------------------------------------------------


class System:
    """One suspension in Exudyn, under a force at a point of its knuckle and another one."""

    def __init__(self, model: Model, peer: Peer) -> None:
        self.model, self.peer = model, peer
        points = model.suspension.hardpoints
        self.at = {name: points.metres(name) for name in (*points.names(), *points.STAND_INS)}
        self.radius = float(model.suspension.tyre_radius() or np.nan)
        side = model.suspension.vehicle.sign
        self.axis = np.asarray(model.suspension.wheel.spin_axis(side))  # points to the left
        self.side = side

    def pose(self, applied: list[tuple[Array, Array]]) -> tuple[Array, Array]:
        """Return place [m] and rotation of the knuckle under forces at points fixed in it.

        Parameters
        ----------
        applied
            Force [N] and place at design [m].
        """
        container = exu.SystemContainer()
        system = container.AddSystem()
        ground = system.AddObject(ObjectGround())
        bodies = {"knuckle": self._body(system, self.at["wheel_center"])}
        for arm, (ball, bearing) in self.peer.arms.items():
            bodies[arm] = self._body(system, self.at[ball])
            for end, rates in SOFT.items():
                at = self.at[f"{bearing}_{end}"]
                system.CreateCartesianSpringDamper(
                    itemNumbers=[ground, bodies[arm]],
                    localPosition0=at,
                    localPosition1=at - self.at[ball],
                    stiffness=list(rates),
                    damping=[0.0, 0.0, 0.0],
                )
            system.CreateSphericalJoint(
                itemNumbers=[bodies[arm], bodies["knuckle"]], position=self.at[ball]
            )
        if self.peer.strut:
            self._guide(system, ground, bodies)
        for link in self.peer.links:
            self._link(system, ground, bodies, link)
        if "tie_rod" not in self.peer.links:
            inner, outer = self.at["tie_rod_inner"], self.at["tie_rod_outer"]
            system.CreateDistanceConstraint(
                itemNumbers=[ground, bodies["knuckle"]],
                localPosition0=inner,
                localPosition1=outer - self.at["wheel_center"],
                distance=float(np.linalg.norm(outer - inner)),
            )
        self._spring(system, ground, bodies)
        self._weights(system, bodies)
        for force, place in applied:
            system.CreateForce(
                itemNumber=bodies["knuckle"],
                loadVector=force,
                localPosition=place - self.at["wheel_center"],
            )
        system.Assemble()
        settings = exu.SimulationSettings()
        settings.staticSolver.newton.relativeTolerance = 1e-10
        settings.staticSolver.newton.absoluteTolerance = 1e-10
        settings.staticSolver.numberOfLoadSteps = 2
        settings.staticSolver.verboseMode = 0
        settings.solution.file.write = False
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        system.SolveStatic(settings, updateInitialValues=False)
        body = bodies["knuckle"]
        place = system.GetObjectOutputBody(body, exu.OutputVariableType.Position, [0.0, 0.0, 0.0])
        turned = system.GetObjectOutputBody(body, exu.OutputVariableType.RotationMatrix)
        return np.asarray(place), np.asarray(turned).reshape(3, 3)

    def _body(self, system: Any, at: Array) -> int:
        inertia = InertiaCuboid(density=1e4, sideLengths=[0.1, 0.1, 0.1])
        made = system.CreateRigidBody(
            inertia=inertia, referencePosition=at, nodeType=exu.NodeType.RotationRxyz
        )
        return int(made)

    def _guide(self, system: Any, ground: int, bodies: dict[str, int]) -> None:
        """Add a piston rod that slides in the knuckle, its top held by a ball joint."""
        lower, top = self.at["strut_lower"], self.at["strut_top"]
        bodies["upper_strut"] = self._body(system, top)
        along = (top - lower) / np.linalg.norm(top - lower)
        across = np.linalg.svd(along[None])[2][1]
        axes = np.stack([across, np.cross(along, across), along], axis=1)
        system.CreateGenericJoint(
            itemNumbers=[bodies["knuckle"], bodies["upper_strut"]],
            position=top,
            rotationMatrixAxes=axes,
            constrainedAxes=[1, 1, 0, 1, 1, 1],  # its turn about itself moves nothing else
        )
        system.CreateSphericalJoint(itemNumbers=[ground, bodies["upper_strut"]], position=top)

    def _link(self, system: Any, ground: int, bodies: dict[str, int], link: str) -> None:
        """Add a rod on springs at both ends, kept from turning about its own line."""
        inner, outer = self.at[f"{link}_inner"], self.at[f"{link}_outer"]
        bodies[link] = self._body(system, inner)
        for items, places, rates in (
            ((ground, bodies[link]), (inner, np.zeros(3)), SOFT_INNER),
            (
                (bodies[link], bodies["knuckle"]),
                (outer - inner, outer - self.at["wheel_center"]),
                3 * (SOFT_OUTER,),
            ),
        ):
            system.CreateCartesianSpringDamper(
                itemNumbers=list(items),
                localPosition0=places[0],
                localPosition1=places[1],
                stiffness=list(rates),
                damping=[0.0, 0.0, 0.0],
            )
        upright = np.array([0.0, 0.0, 1.0])
        across = np.cross(outer - inner, upright)
        across /= np.linalg.norm(across)
        system.CreateGenericJoint(
            itemNumbers=[ground, bodies[link]],
            position=inner,
            rotationMatrixAxes=np.stack([np.cross(upright, across), upright, across], axis=1),
            constrainedAxes=[0, 0, 0, 1, 0, 0],  # the second axis there, the third one here
        )

    def _spring(self, system: Any, ground: int, bodies: dict[str, int]) -> None:
        on, values = self.peer.seated_on, self.model.parameters
        system.CreateSpringDamper(
            itemNumbers=[ground, bodies[on]],
            localPosition0=self.at["spring_top"],
            localPosition1=self.at["spring_seat"] - self.at[self.peer.origin(on)],
            referenceLength=values["spring_free_length"],
            stiffness=values["spring_rate"],
            damping=0.0,
        )

    def _weights(self, system: Any, bodies: dict[str, int]) -> None:
        values = self.model.parameters
        for part in (*self.peer.arms, *self.peer.links, "knuckle", "wheel"):
            body = "knuckle" if part == "wheel" else part
            center = (
                self.at["wheel_center"]
                if part == "wheel"
                else np.array([values[f"{part}_com_{axis}"] for axis in "xyz"])
            )
            weight = values[f"{part}_mass"] * values["gravity"]
            system.CreateForce(
                itemNumber=bodies[body],
                loadVector=[0.0, 0.0, -weight],
                localPosition=center - self.at[self.peer.origin(body)],
            )

    # -- the wheel on the road ------------------------------------------------------------------

    def lowest(self, place: Array, turned: Array) -> tuple[Array, Array]:
        """Return the lowest point of the wheel [m], and what it was at design."""
        axis = turned @ self.axis
        down = -np.array([0.0, 0.0, 1.0]) + axis * axis[2]
        point = place + self.radius * down / np.linalg.norm(down)
        return point, self.at["wheel_center"] + turned.T @ (point - place)

    def under(self, vertical: float, at_contact: Array, at_center: Array) -> tuple[Array, Array]:
        """Return the pose with forces at the lowest point of the wheel, wherever it goes."""
        at = self.lowest(self.at["wheel_center"], np.eye(3))[1]
        for _ in range(_STEPS):
            force = at_contact + vertical * np.array([0.0, 0.0, 1.0])
            found = self.pose([(force, at), (at_center, self.at["wheel_center"])])
            new = self.lowest(*found)[1]
            if np.abs(new - at).max() < _SAME_POINT:
                return found
            at = new
        message = "the point of contact does not come to rest"
        raise RuntimeError(message)

    def at_height(self, at_contact: Array, at_center: Array) -> tuple[float, Array, Array]:
        """Return the vertical force that holds the contact at its design height, and the pose."""
        level = self.lowest(self.at["wheel_center"], np.eye(3))[0][2]

        def above(vertical: float) -> float:
            return float(self.lowest(*self.under(vertical, at_contact, at_center))[0][2] - level)

        found = root_scalar(above, x0=3500.0, x1=3600.0, xtol=1e-9, rtol=1e-13)
        assert abs(above(found.root)) < _SAME_HEIGHT
        return (found.root, *self.under(found.root, at_contact, at_center))

    def angles(self, turned: Array) -> tuple[float, float]:
        """Return toe and camber [rad]."""
        x, y, z = turned @ self.axis
        return float(np.arctan2(self.side * x, y)), float(np.arctan2(-self.side * z, y))


def _theirs(model: Model, peer: Peer, under: str, held: str) -> dict[str, Array]:
    system = System(model, peer)
    nothing = np.zeros(3)
    vertical, place, turned = system.at_height(nothing, nothing)
    x, y, _ = system.axis  # the tyre's directions are those with rigid joints
    forward = np.array([y, -x, 0.0]) / np.hypot(x, y)
    left = np.array([-forward[1], forward[0], 0.0])
    unit = {"lateral": -system.side * left, "recession": -forward}[under]
    toe, camber = system.angles(turned)
    at_contact = under == "lateral"
    start = system.lowest(place, turned)[1] if at_contact else system.at["wheel_center"]

    def followed(place: Array, turned: Array) -> Array:
        return place + turned @ (start - system.at["wheel_center"])

    found: dict[str, list[float]] = {n: [] for n in QUANTITIES}
    for amount in AMOUNTS:
        force = amount * unit
        forces = (force, nothing) if at_contact else (nothing, force)
        loaded = (
            system.at_height(*forces)[1:] if held == "height" else system.under(vertical, *forces)
        )
        toes = system.angles(loaded[1])
        found["toe_change"].append(toes[0] - toe)
        found["camber_change"].append(toes[1] - camber)
        moved = followed(*loaded) - followed(place, turned)
        found["displacement"].append(float(moved @ unit))
    return {name: np.array(values) for name, values in found.items()}


if __name__ == "__main__":
    main()
