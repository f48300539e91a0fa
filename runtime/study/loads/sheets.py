"""Loads and compliance as tables that a person reads."""

from collections.abc import Iterable, Sequence

import numpy as np
import xarray as xr

from ...core.quantities import bracketed, display_of, displayed, long_name
from ...core.tabulated import Tabulated, significant, whole
from .mounts import ALL, CHASSIS, with_totals

# What stands in tables of deflections, and what the other curve is called there.
_IN_TABLES = (
    "toe", "toe_change", "camber", "camber_change", "displacement", "patch_displacement",
    "contact_rate", "roll_stiffness_at_contacts", "bar_torque", "axle_steer", "axle_lateral",
    "axle_steer_change", "axle_lateral_change", "axle_longitudinal_change",
)  # fmt: skip
_WORDS = {"patch_displacement": "contact patch"}
_COMPLIANCES = {
    "toe": "toe-in [deg]",
    "camber": "camber [deg]",
    "displacement": "inward, rearward [mm]",
    "patch_displacement": "contact patch [mm]",
}
_OF_AXLES = {
    "axle_steer": "steer [deg]",
    "axle_lateral": "to the left [mm]",
    "axle_longitudinal": "forward [mm]",
}
_BESIDE = {"elastokinematic": "on bushes", "linear": "linear"}

_ACTING = ("spring", "damper", "road", "drive", "steering", "bar")


def acts(by: str) -> bool:
    """Tell whether something acts by itself, not between parts at a joint."""
    return without_side(by) in _ACTING


def without_side(name: str) -> str:
    """Return a name of an axle without its side."""
    return name.removesuffix("_left").removesuffix("_right")


def overview(found: xr.Dataset, title: str, parts: Sequence[str] = ()) -> Tabulated:
    """Return the size of every force in every case.

    Parameters
    ----------
    found : xarray.Dataset
        From `static`.
    title : str
    parts : sequence of str, optional
        Loads on these parts, with all that act on them; by default each joint once.
    """
    rows = [
        (_words(n), *(whole(float(load)) for load in found[n].values))
        for n in _named(found, "wheel_load")
    ]
    for name in _named(found, "travel"):
        travels = (f"{1e3 * travel:.1f}" for travel in found[name].values)
        texts = (text.replace("-0.0", "0.0").replace("nan", "-") for text in travels)
        rows.append((f"wheel {_words(name)} [mm]", *texts))
    if "bar_torque" in found:
        rows.append(("bar torque [N m]", *(whole(float(m)) for m in found["bar_torque"].values)))
    rods = [] if parts or "rod_force" not in found else [str(name) for name in found["rod"].values]
    for rod in rods:
        pulls = found["rod_force"].sel(rod=rod).values
        rows.append((f"{rod}, pull", *(whole(float(pull)) for pull in pulls)))
    found = with_totals(found, several=True)
    sizes = np.linalg.norm(found["force"].values, axis=-1)
    for i in shown_rows(found, parts):
        part, point, by = (str(found[name].values[i]) for name in ("part", "point", "by"))
        # a rod has its row, and the torque of a bar
        if part not in rods and by not in rods and np.nan_to_num(sizes[:, i]).any():
            name = by if acts(by) else point
            name = f"{point}, total" if part == ALL else name
            rows.append((name, *(whole(float(size)) for size in sizes[:, i])))
    return Tabulated(title, ("at", *map(str, found["case"].values)), tuple(rows))


def _named(found: xr.Dataset, stem: str) -> list[str]:
    """Return what there is of a wheel, or of both of an axle."""
    return [name for name in map(str, found) if without_side(name) == stem]


def _words(name: str) -> str:
    return name.replace("_", " ")


def shown_rows(found: xr.Dataset, parts: Sequence[str] = ()) -> list[int]:
    """Return the loads that are shown: of what two parts exert on each other one, if not asked.

    Totals at mounts go with the loads on the chassis.
    """
    given = [CHASSIS if part == ALL and parts else part for part in found["part"].values]
    sizes = np.abs(found["force"].values) + np.abs(found["moment"].values)
    strong = np.nan_to_num(sizes).max(axis=(0, 2)) > 0.0
    if parts:
        return [i for i, name in enumerate(given) if name in parts and strong[i]]
    seen: set[frozenset[str]] = set()
    rows = []
    for i, (name, point, by) in enumerate(
        zip(given, found["point"].values, found["by"].values, strict=True)
    ):
        pair = frozenset((by,) if acts(by) else (f"{name} {point}", f"{by} {point}"))
        if strong[i] and pair not in seen and by != "gravity":
            rows.append(i)
            seen.add(pair)
    return rows


def compliances(found: xr.Dataset, title: str, at: float = 0.0) -> Tabulated:
    """Return the sheet of a compliance: a row for each load, as a rig's summary has it.

    Parameters
    ----------
    found : xarray.Dataset
        From `compliance`, of a wheel or of both of an axle.
    title : str
    at : float, optional
        Wheel travel [m].
    """
    here = found.sel(wheel_travel=at, method="nearest")
    names = [str(name) for name in here.data_vars]
    on_axle = any(without_side(name) != name for name in names)
    told = [kind for kind in _COMPLIANCES if _by(names, [kind])]
    rows = []
    for load in _by(names, told):
        cells, name = _cells(here, told, load)
        words = long_name(here[name]).partition(" by ")[2].removeprefix("a ")
        by, wheel = words.rsplit(", ", 1) if on_axle else (words, "")
        rows.append((by, *[wheel][: int(on_axle)], _per(here[name]), *cells))
    first = ("by", "wheel", "per") if on_axle else ("by", "per")
    columns = (*first, *(_COMPLIANCES[kind] for kind in told))
    return Tabulated(title, columns, tuple(rows), frozenset(range(len(first))))


def _by(names: Sequence[str], kinds: Iterable[str]) -> list[str]:
    """Return the loads of which some kinds of compliance are there, each once."""
    heads = [f"{kind}_by_" for kind in kinds]
    loads = (n.removeprefix(head) for n in names for head in heads if n.startswith(head))
    return list(dict.fromkeys(loads))


def _cells(here: xr.Dataset, kinds: Sequence[str], load: str) -> tuple[list[str], str]:
    """Return the compliances of some kinds under a load, and the name of one that is there."""
    keys = [f"{kind}_by_{load}" for kind in kinds]
    cells = [significant(float(displayed(here[k]))) if k in here else "-" for k in keys]
    return cells, next(key for key in keys if key in here)


def _per(data: xr.DataArray) -> str:
    return display_of(data.attrs).units.partition("/")[2]


def compliances_of_axle(found: xr.Dataset, title: str, at: float = 0.0) -> list[Tabulated]:
    """Return what loads do to a rigid axle itself, as a table; none of others.

    Parameters
    ----------
    found : xarray.Dataset
        From `kintrafo.rigid_axles.compliance`, or of another kind.
    title : str
    at : float, optional
        Wheel travel [m].
    """
    here = found.sel(wheel_travel=at, method="nearest")
    names = [str(name) for name in here.data_vars]
    told = [kind for kind in _OF_AXLES if _by(names, [kind])]
    rows = []
    for load in _by(names, told):
        cells, name = _cells(here, told, load)
        rows.append((long_name(here[name]).partition(" by ")[2], _per(here[name]), *cells))
    columns = ("by", "per, each wheel", *(_OF_AXLES[kind] for kind in told))
    return [Tabulated(title, columns, tuple(rows), frozenset({0, 1}))] if rows else []


def deflections(found: xr.Dataset, title: str, most: int = 11) -> Tabulated:
    """Return curves of bushes beside those that leave them out, or leave out how far they give way.

    Parameters
    ----------
    found : xarray.Dataset
        From `elastokinematics` or `deflection`.
    title : str
    most : int, optional
        How many positions are told.
    """
    over = next(str(name) for name in found.sizes if name != "data_set")
    count = found.sizes[over]
    which = sorted({round(i) for i in np.linspace(0, count - 1, min(count, most))})
    here = found.isel({over: which})
    _, *others = map(str, here["data_set"].values)
    columns = [_heading(over.replace("_", " "), here[over])]
    cells = [[f"{value:g}" for value in displayed(here[over])]]
    for name in (name for name in _IN_TABLES if name in here and here[name].ndim > 1):
        word = _WORDS.get(name) or name.removesuffix("_change").replace("_", " ")
        columns += [_heading(word, here[name]), *(_BESIDE[other] for other in others)]
        cells += [[_number(value) for value in row] for row in displayed(here[name])]
    return Tabulated(title, tuple(columns), tuple(zip(*cells, strict=True)), frozenset())


def deflections_of_axle(found: xr.Dataset, title: str) -> list[Tabulated]:
    """Return those of each wheel of an axle, and of what both have together.

    Parameters
    ----------
    found : xarray.Dataset
        From `kintrafo.axles.elastokinematics` or `kintrafo.axles.deflection`.
    title : str
    """
    sheets = []
    for side in ("left", "right"):
        end = f"_{side}"
        own = {name: name.removesuffix(end) for name in map(str, found) if name.endswith(end)}
        sheets.append(deflections(found[list(own)].rename(own), f"{title}, {side} wheel"))
    both = [name for name in map(str, found) if without_side(name) == name]
    shared = [name for name in both if name in _IN_TABLES and found[name].ndim > 1]
    return [*sheets, deflections(found[shared], f"{title}, both")] if shared else sheets


def _heading(words: str, data: xr.DataArray) -> str:
    return bracketed(words, data.attrs)


def _number(value: float) -> str:
    """Return a number of a table with as many decimals as all others, without a sign of zero."""
    text = f"{value:.4f}"
    return text.removeprefix("-") if float(text) == 0.0 else text
