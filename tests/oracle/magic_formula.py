"""The Magic Formula as its sources print it, in arithmetic of 40 digits: one state at a time.

Written from H. B. Pacejka, Tire and Vehicle Dynamics, 3rd edition, section 4.3.2, equation by
equation, with forces and not forces per load, signs of slips and small numbers where they are
printed. It reads property files by a regular expression of its own, and shares nothing with
`kintrafo.formulas`.
"""

import re

import mpmath as mp

mp.mp.dps = 40


def coefficients(text):
    """Return the numbers of a property file, those that are missing as zero, or one of a scale."""

    class Numbers(dict):
        def __missing__(self, key):
            return mp.mpf(1 if key.startswith("L") or key == "Q_RE0" else 0)

    found = re.findall(r"^(\w+)\s*=\s*([-+.\deE]+)", text, flags=re.MULTILINE)
    return Numbers({key: mp.mpf(value) for key, value in found})


def sgn(x):
    return mp.sign(x)


def magic(B, C, E, x, curve=mp.sin):
    return curve(C * mp.atan(B * x - E * (B * x - mp.atan(B * x))))


def evaluate(p, Fz, alpha, kappa, gamma, V, pi, pac2002=False):  # noqa: PLR0915 (as printed)
    """Return Fx, Fy, Mx, My, Mz, Kx, Ky and the trail of a state with a load."""
    Fz, alpha, kappa, gamma, V, pi = map(mp.mpf, (Fz, alpha, kappa, gamma, V, pi))
    Fz0, R0, V0 = p["FNOMIN"], p["UNLOADED_RADIUS"], p["LONGVL"]
    Fz0_ = p["LFZO"] * Fz0  # 4.E1
    dfz = (Fz - Fz0_) / Fz0_  # 4.E2a
    dpi = (pi - p["NOMPRES"]) / p["NOMPRES"] if p["NOMPRES"] else mp.mpf(0)  # 4.E2b
    g = mp.sin(gamma)  # 4.E4
    a = alpha if pac2002 else mp.tan(alpha)  # 4.E3
    tangent = mp.tan if pac2002 else (lambda x: x)
    back = mp.atan if pac2002 else (lambda x: x)
    cosine = mp.cos(alpha) * sgn(V)  # 4.E6
    degressive = (lambda x: x) if pac2002 else (lambda x: 10 * x / (1 + 9 * x))  # 4.E8

    # longitudinal force, pure slip
    gx = g * p["LGAX"]
    Cx = p["PCX1"] * p["LCX"]  # 4.E11
    mux = (p["PDX1"] + p["PDX2"] * dfz) * (1 + p["PPX3"] * dpi + p["PPX4"] * dpi**2)
    mux *= (1 - p["PDX3"] * gx**2) * p["LMUX"]  # 4.E13
    Dx = mux * Fz  # 4.E12
    Kx = Fz * (p["PKX1"] + p["PKX2"] * dfz) * mp.exp(p["PKX3"] * dfz)
    Kx *= (1 + p["PPX1"] * dpi + p["PPX2"] * dpi**2) * p["LKX"]  # 4.E15
    Bx = Kx / (Cx * Dx)  # 4.E16
    SHx = (p["PHX1"] + p["PHX2"] * dfz) * p["LHX"]  # 4.E17
    SVx = Fz * (p["PVX1"] + p["PVX2"] * dfz) * p["LVX"] * degressive(p["LMUX"])  # 4.E18
    kx = kappa + SHx  # 4.E10
    Ex = (p["PEX1"] + p["PEX2"] * dfz + p["PEX3"] * dfz**2) * (1 - p["PEX4"] * sgn(kx)) * p["LEX"]
    Ex = min(Ex, 1)  # 4.E14
    Fx0 = Dx * magic(Bx, Cx, Ex, kx) + SVx  # 4.E9

    def lateral(gamma_star):
        gy = gamma_star * p["LGAY"]
        Cy = p["PCY1"] * p["LCY"]  # 4.E21
        muy = (p["PDY1"] + p["PDY2"] * dfz) * (1 + p["PPY3"] * dpi + p["PPY4"] * dpi**2)
        muy *= (1 - p["PDY3"] * gy**2) * p["LMUY"]  # 4.E23
        Dy = muy * Fz  # 4.E22
        pky4 = p["PKY4"] or mp.mpf(2)
        inner = Fz / Fz0_ / ((p["PKY2"] + p["PKY5"] * gy**2) * (1 + p["PPY2"] * dpi))
        Ky = p["PKY1"] * Fz0_ * (1 + p["PPY1"] * dpi) * (1 - p["PKY3"] * abs(gy))
        Ky *= mp.sin(pky4 * mp.atan(inner)) * p["LKY"]  # 4.E25
        By = Ky / (Cy * Dy)  # 4.E26
        SVyg = Fz * (p["PVY3"] + p["PVY4"] * dfz) * gy * p["LKYC"] * degressive(p["LMUY"])  # 4.E28
        SVy = Fz * (p["PVY1"] + p["PVY2"] * dfz) * p["LVY"] * degressive(p["LMUY"]) + SVyg  # 4.E29
        SHy = (p["PHY1"] + p["PHY2"] * dfz) * p["LHY"]
        if pac2002:
            SHy += p["PHY3"] * gy
        else:
            Kg0 = Fz * (p["PKY6"] + p["PKY7"] * dfz) * (1 + p["PPY5"] * dpi) * p["LKYC"]  # 4.E30
            SHy += (Kg0 * gy - SVyg) / Ky  # 4.E27
        ay = a + SHy  # 4.E20
        Ey = (p["PEY1"] + p["PEY2"] * dfz) * p["LEY"]
        Ey *= 1 + p["PEY5"] * gy**2 - (p["PEY3"] + p["PEY4"] * gy) * sgn(ay)
        Ey = min(Ey, 1)  # 4.E24
        return Dy * magic(By, Cy, Ey, ay) + SVy, Ky, By, Cy, muy, SHy, SVy, ay  # 4.E19

    Fy0, Ky, By, Cy, muy, SHy, SVy, ay = lateral(g)

    # combined slip
    weighted = p["RBX1"] != 0 or p["RBY1"] != 0
    if weighted:
        Bxa = (p["RBX1"] + p["RBX3"] * g**2) * mp.cos(mp.atan(p["RBX2"] * kappa)) * p["LXAL"]
        Cxa, Exa, SHxa = p["RCX1"], min(p["REX1"] + p["REX2"] * dfz, 1), p["RHX1"]
        Gx = magic(Bxa, Cxa, Exa, a + SHxa, mp.cos) / magic(Bxa, Cxa, Exa, SHxa, mp.cos)  # 4.E51
        Byk = (p["RBY1"] + p["RBY4"] * g**2) * mp.cos(mp.atan(p["RBY2"] * (a - p["RBY3"])))
        Byk *= p["LYKA"]  # 4.E62
        Cyk, Eyk = p["RCY1"], min(p["REY1"] + p["REY2"] * dfz, 1)
        SHyk = p["RHY1"] + p["RHY2"] * dfz
        Gy = magic(Byk, Cyk, Eyk, kappa + SHyk, mp.cos) / magic(Byk, Cyk, Eyk, SHyk, mp.cos)
        DV = (
            muy
            * Fz
            * (p["RVY1"] + p["RVY2"] * dfz + p["RVY3"] * g)
            * mp.cos(mp.atan(p["RVY4"] * a))
        )
        SVyk = DV * mp.sin(p["RVY5"] * mp.atan(p["RVY6"] * kappa)) * p["LVYKA"]  # 4.E66
        ratio = Kx / Ky
    else:
        kc, ac = kx + SVx / Kx, ay + SVy / Ky
        ac = mp.sin(ac) if pac2002 else mp.sin(mp.atan(ac))
        over_x, over_y = abs((Fx0 - SVx) / Fz), abs((Fy0 - SVy) / Fz)
        beta = mp.atan2(abs(ac), abs(kc))
        t = mp.tan(beta)
        Gx = 1 / mp.sqrt(1 / over_x**2 + (t / muy) ** 2) / over_x
        Gy = t / mp.sqrt(1 / mux**2 + (t / over_y) ** 2) / over_y
        SVyk = ratio = mp.mpf(0)
    Fx, Fy = Gx * Fx0, Gy * Fy0 + SVyk  # 4.E50, 4.E58

    # moments
    gz = g * p["LGAZ"]
    SHt = p["QHZ1"] + p["QHZ2"] * dfz + (p["QHZ3"] + p["QHZ4"] * dfz) * gz  # 4.E35
    at, ar = a + SHt, a + SHy + SVy / Ky  # 4.E34, 4.E37
    Bt = (p["QBZ1"] + p["QBZ2"] * dfz + p["QBZ3"] * dfz**2) * p["LKY"] / p["LMUY"]
    Bt *= 1 + p["QBZ4"] * gz + p["QBZ5"] * abs(gz)  # A58
    Ct = p["QCZ1"]
    Dt = Fz * R0 / Fz0_ * (p["QDZ1"] + p["QDZ2"] * dfz) * (1 - p["PPZ1"] * dpi) * p["LTR"]
    Dt *= 1 + p["QDZ3"] * gz + p["QDZ4"] * gz**2  # A60
    Et = p["QEZ1"] + p["QEZ2"] * dfz + p["QEZ3"] * dfz**2
    Et *= 1 + (p["QEZ4"] + p["QEZ5"] * gz) * 2 / mp.pi * mp.atan(Bt * Ct * at)
    Et = min(Et, 1)  # 4.E44
    Br = p["QBZ9"] * p["LKY"] / p["LMUY"] + p["QBZ10"] * By * Cy  # 4.E45
    Dr = (p["QDZ6"] + p["QDZ7"] * dfz) * p["LRES"]
    Dr += (p["QDZ8"] + p["QDZ9"] * dfz) * (1 + p["PPZ2"] * dpi) * gz * p["LKZC"]
    Dr += (p["QDZ10"] + p["QDZ11"] * dfz) * abs(gz) * gz * p["LKZC"]
    Dr *= Fz * R0 * p["LMUY"] * sgn(V) * cosine  # 4.E47
    at_eq = back(mp.sqrt(tangent(at) ** 2 + (ratio * kappa) ** 2)) * sgn(at)  # 4.E77
    ar_eq = back(mp.sqrt(tangent(ar) ** 2 + (ratio * kappa) ** 2)) * sgn(ar)  # 4.E78
    t = Dt * magic(Bt, Ct, Et, at_eq, mp.cos) * cosine  # 4.E73
    Mzr = Dr * mp.cos(mp.atan(Br * ar_eq))  # 4.E75
    Fy_ = Fy - SVyk if pac2002 else Gy * lateral(mp.mpf(0))[0]  # 4.E74
    s = R0 * (p["SSZ1"] + p["SSZ2"] * Fy / Fz0_ + (p["SSZ3"] + p["SSZ4"] * dfz) * g) * p["LS"]
    Mz = -t * Fy_ + Mzr + s * Fx  # 4.E71
    Mx = p["QSX1"] * p["LVMX"] - p["QSX2"] * g * (1 + p["PPMX1"] * dpi) - p["QSX12"] * g * abs(g)
    Mx += p["QSX3"] * Fy / Fz0 + p["QSX10"] * mp.atan(p["QSX11"] * Fz / Fz0) * g
    Mx += (
        p["QSX4"]
        * mp.cos(p["QSX5"] * mp.atan((p["QSX6"] * Fz / Fz0) ** 2))
        * mp.sin(p["QSX7"] * g + p["QSX8"] * mp.atan(p["QSX9"] * Fy / Fz0))
    )
    Mx = R0 * p["LMX"] * (Fz * Mx + Fy * (p["QSX13"] + p["QSX14"] * abs(g)))  # 4.E69
    My = p["QSY1"] + p["QSY2"] * Fx / Fz0 + p["QSY3"] * abs(V / V0) + p["QSY4"] * (V / V0) ** 4
    My += (p["QSY5"] + p["QSY6"] * Fz / Fz0) * g**2
    My *= (Fz / Fz0) ** (p["QSY7"] or 1) * (1 + dpi) ** p["QSY8"]
    My *= -sgn(V) * R0 * Fz0 * p["LMY"]  # that of the paper of 2010, against the rolling
    return Fx, Fy, Mx, My, Mz, Kx, -Ky, t


def loaded_radius(p, Fz, Fx, Fy, kappa, V, pi):
    """Return the loaded radius by bisection of the load over deflection (A3.1, A3.3, A3.4)."""
    R0, Fz0, V0 = p["UNLOADED_RADIUS"], p["FNOMIN"], p["LONGVL"]
    dpi = (mp.mpf(pi) - p["NOMPRES"]) / p["NOMPRES"] if p["NOMPRES"] else mp.mpf(0)
    omega = mp.mpf(V) * (1 + mp.mpf(kappa)) / R0
    free = R0 * (p["Q_RE0"] + p["Q_V1"] * (omega * R0 / V0) ** 2)
    first = p["Q_FZ1"] or mp.sqrt((p["VERTICAL_STIFFNESS"] * R0 / Fz0) ** 2 - 4 * p["Q_FZ2"])

    def load(rho):
        moved = 1 + p["Q_V2"] * abs(omega) * R0 / V0
        moved -= (p["Q_FCX"] * Fx / Fz0) ** 2 + (p["Q_FCY"] * Fy / Fz0) ** 2
        shape = first * rho / R0 + p["Q_FZ2"] * (rho / R0) ** 2
        return moved * shape * (1 + p["PFZ1"] * dpi) * Fz0

    low, high = mp.mpf(0), R0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if load(middle) < Fz else (low, middle)
    return free - low
