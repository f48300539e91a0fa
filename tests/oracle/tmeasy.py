"""TMeasy by the pieces of its curves, with branches: one state at a time.

After G. Rill, Road Vehicle Dynamics (2012), chapter 3. Shares nothing with `kintrafo.formulas`.
"""

from math import atan2, cos, hypot, sin, sqrt, tan


def at_load(pair, load, nominal, kind):
    once, twice = pair
    if kind == "force":
        return load / nominal * (2 * once - twice / 2 - (once - twice / 2) * load / nominal)
    return once + (twice - once) * (load / nominal - 1)


def curve(s, df0, sm, fm, ss, fs):
    """Return the force of a slip that is not negative."""
    df0 = max(df0, 2 * fm / sm)
    if s <= sm:
        part = s / sm
        return df0 * s / (1 + part * (part + df0 * sm / fm - 2))
    if s >= ss:
        return fs
    bend = (fm / sm) ** 2 / (df0 * sm)
    star = sm + (fm - fs) / (bend * (ss - sm))
    if star > ss:
        part = (s - sm) / (ss - sm)
        return fm - (fm - fs) * part**2 * (3 - 2 * part)
    if s <= star:
        return fm - bend * (s - sm) ** 2
    return fs + bend * (star - sm) / (ss - star) * (ss - s) ** 2


def trail(sy, n0, s0, se):
    se, sy = max(se, s0), abs(sy)
    weight = s0 / se
    if sy >= se:
        return 0.0
    if sy <= s0:
        part = sy / s0
        return n0 * ((1 - weight) * (1 - part) + weight * (1 - (3 - 2 * part) * part**2))
    return -n0 * (1 - weight) * (sy - s0) / s0 * ((se - sy) / (se - s0)) ** 2


def evaluate(data, load, angle, slip, camber, friction):
    """Return Fx, Fy and Mz of a wheel that rolls forward."""
    parameters = data["Parameters"]
    nominal = parameters["Tire Load"]["Nominal Vertical Force [N]"]
    mu = friction / data["Coefficient of Friction"]
    radius = data["Design"]["Unloaded Radius [m]"]
    tread = sqrt((1 + slip) ** 2 + 1e-6)
    sx, sy = slip / tread, -tan(angle) / tread

    def of(section):
        slope, maximum, sliding, first, last = parameters[section].values()
        return (
            at_load(slope, load, nominal, "force"),
            mu * at_load(first, load, nominal, "slip"),
            mu * at_load(maximum, load, nominal, "force"),
            mu * at_load(last, load, nominal, "slip"),
            mu * at_load(sliding, load, nominal, "force"),
        )

    (dx, sxm, fxm, sxs, fxs), (dy, sym, fym, sys, fys) = of("Longitudinal"), of("Lateral")
    hx = sxm / (sxm + sym) + fxm / dx / (fxm / dx + fym / dy)
    hy = sym / (sxm + sym) + fym / dy / (fxm / dx + fym / dy)
    phi = atan2(sy / hy, sx / hx)
    c, s = cos(phi), sin(phi)
    size = hypot(sx / hx, sy / hy)
    force = curve(
        size,
        hypot(dx * hx * c, dy * hy * s),
        hypot(sxm / hx * c, sym / hy * s),
        hypot(fxm * c, fym * s),
        hypot(sxs / hx * c, sys / hy * s),
        hypot(fxs * c, fys * s),
    )
    once, twice = parameters["Tire Stiffness"]["Vertical [N/m]"]
    a1, a2 = sqrt(2 * once**2 - twice**2), (twice**2 - once**2) / (4 * nominal)
    deflection = (-a1 + sqrt(a1 * a1 + 4 * a2 * load)) / (2 * a2)
    length = 2 * sqrt(radius * deflection)
    induced = force / size / 3 * (-length / 2 * sin(camber)) / hy
    fx, fy = force * c, force * s + induced
    n0, s0, se = parameters["Aligning"].values()
    n = trail(
        sy,
        at_load(n0, load, nominal, "slip"),
        mu * at_load(s0, load, nominal, "slip"),
        mu * at_load(se, load, nominal, "slip"),
    )
    return fx, fy, -length * n * fy
