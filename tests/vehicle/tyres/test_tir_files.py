"""Property files of tyres: units, comments, keys that are used and that are not, mistakes."""

import kintrafo
import numpy as np
import pytest
from cars.tyre_files import ELLIPSE, FILES, NEWER, OLDER, with_values, without
from kintrafo.formulas.coefficients import ODD
from kintrafo.vehicle.tyres import coefficients


@pytest.fixture
def load(tmp_path):
    def read(text, name="own.tir"):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return kintrafo.tyres.load(path)

    return read


def same(one, two):
    """Compare what two tyres do, to rounding."""
    states = ([1500.0, 4000.0], 0.05, -0.03, 0.02)
    for field, value in vars(one.evaluate(*states)).items():
        if field != "outside":
            np.testing.assert_allclose(vars(two.evaluate(*states))[field], value, rtol=1e-13)


def test_every_key_is_used_or_listed(load):
    for text in FILES.values():
        tyre = load(text)
        listed = " ".join(tyre.left_out)
        keys = {
            line.split("=")[0].strip()
            for line in text.splitlines()
            if "=" in line and not line.startswith("$")
        }
        keys -= {"LENGTH", "FORCE", "ANGLE", "TIME", "MASS"}
        keys -= {"FITTYP", "PROPERTY_FILE_FORMAT", "TYRESIDE"}
        for key in keys:
            assert (key in tyre.coefficients) != (f" {key}," in listed or f" {key}:" in listed), key


def test_a_key_that_is_used_does_something(load):
    """Of a file with all coefficients: each of them changes a force, a moment or a length."""
    usual = {"PHY3": 0.01, "PTX1": 1.0, "PTX2": 0.1, "PTX3": 0.1, "PTY1": 1.0, "PTY2": 2.0}
    newer = load(with_values(NEWER, LGAX=1.0, LSGKP=1.0, QSX12=0.1, QSX13=0.01, QSX14=0.1,
                             Q_FZ3=0.5, Q_FZ1=14.0))  # fmt: skip
    older = load(with_values(OLDER, **usual))
    states = ([1500.0, 5000.0], 0.05, 0.02, [0.03, -0.04])

    def results(tyre, pressure):
        found = tyre.evaluate(*states, speed=30.0, pressure=pressure)
        fields = {k: v for k, v in vars(found).items() if k != "outside"}
        return np.nan_to_num(np.array(list(fields.values())))

    inactive = {"VERTICAL_DAMPING", "VXLOW"}  # of equations of motion
    inactive |= {end for ends in coefficients.LIMITS.values() for end in ends}
    for key in coefficients.USED - inactive:
        changed = []
        for tyre, pressure in ((newer, 260e3), (older, None)):
            if key in tyre.coefficients and key not in {"LONGVL", "INFLPRES", "VERTICAL_STIFFNESS"}:
                more = tyre.with_changes({key: tyre.coefficients[key] * 1.03 + 1.1e-3})
                changed.append(not np.array_equal(results(tyre, pressure), results(more, pressure)))
        assert any(changed) or key in {"LONGVL", "INFLPRES", "VERTICAL_STIFFNESS"}, key


def test_units_are_converted(load):
    scales = {"UNLOADED_RADIUS": 1e3, "FNOMIN": 1e-3, "VERTICAL_STIFFNESS": 1e-6,
              "LONGITUDINAL_STIFFNESS": 1e-6, "LATERAL_STIFFNESS": 1e-6, "LONGVL": 1e3,
              "VXLOW": 1e3, "INFLPRES": 1e-5, "NOMPRES": 1e-5, "PRESMIN": 1e-5, "PRESMAX": 1e-5,
              "FZMIN": 1e-3, "FZMAX": 1e-3, "VERTICAL_DAMPING": 1e-6}  # fmt: skip
    plain = load(NEWER)
    values = {k: plain.coefficients[k] * v for k, v in scales.items()}
    values |= {k: np.degrees(plain.coefficients[k]) for k in ("ALPMIN", "ALPMAX", "CAMMIN",
                                                              "CAMMAX")}  # fmt: skip
    text = with_values(NEWER, **values)
    for old, new in (("'meter'", "'mm'"), ("'newton'", "'kN'"), ("'radians'", "'deg'")):
        text = text.replace(old, new)
    found = load(text.replace("TIME ", "PRESSURE = 'bar'\nTIME "))
    for key, value in plain.coefficients.items():
        assert found.coefficients[key] == pytest.approx(value, rel=1e-14), key
    same(plain, found)


def test_other_ways_to_write_the_same(load):
    plain = load(NEWER)
    same(plain, load(NEWER.replace("\n", "\r\n")))
    same(plain, load(NEWER.replace("= ", "=").lower().replace("fittyp", "FITTYP")))
    same(plain, load(NEWER.replace("$", "!")))
    same(plain, load(("\ufeff" + NEWER).encode()))
    same(plain, load(NEWER.replace("made up", "\xe9").encode("latin-1"), "own.TIR"))
    named = NEWER.replace("Q_V1 ", "QV1 ").replace("NOMPRES", "IP_NOM").replace("INFLPRES", "IP")
    same(plain, load(named))
    empty = NEWER.replace("[STRUCTURAL]", "[STRUCTURAL]\nYAW_STIFFNESS =\nQSX13 =  $ nothing")
    found = load(empty)
    same(plain, found)
    assert any("YAW_STIFFNESS" in line for line in found.left_out)


def test_what_it_is_called(load):
    assert load(NEWER).name == "MF 6.1"
    assert load(NEWER.replace("= 61", "= 62")).name == "MF 6.2"
    assert load(NEWER.replace("= 61", "= 6")).name == "MF 5"
    named = "= 5\nPROPERTY_FILE_FORMAT = 'MF_05'"
    assert load(NEWER.replace("= 61", named)).name == "MF 5"
    older = load(OLDER)
    assert (older.name, older.form.newer, older.form.angle) == ("PAC2002", False, True)
    assert load(ELLIPSE).form.weighted is False
    assert "friction ellipse" in load(ELLIPSE).assumed[0]
    assert load(NEWER).side == "left"


def test_a_negative_peak_is_the_same_tyre(load, refused):
    """As in files of MF-Tyre 5.0 by some; what slip induces has the sign of the peak."""
    turned = with_values(ELLIPSE, PDY1=-0.98, PDY2=0.12, FITTYP=5)
    same(load(ELLIPSE), load(turned))
    assert "PDY1 and PDY2" in " ".join(load(turned).assumed)
    refused(kintrafo.InputError, lambda: load(with_values(NEWER, PDY1=-0.98, PDY2=0.12)))


def test_the_friction_ellipse_may_be_asked_for(load):
    """By a key of Project Chrono's files."""
    asked = OLDER.replace("[DIMENSION]", "FE_METHOD = 'YES'\n[DIMENSION]")
    assert load(asked).form == load(ELLIPSE).form
    assert load(OLDER).form.weighted


def test_what_is_left_open_is_reported(load):
    text = with_values(without(NEWER, "LONGVL", "VXLOW", "QSX.*", "QSY.*", "Q_V1", "Q_V2"))
    assert load(text).assumed == (
        "the overturning moment is zero, since its coefficients are missing or zero",
        "rolling resistance is zero, since its coefficients are missing or zero",
        "LONGVL: 16.7 m/s, since it is missing",
        "VXLOW: 1 m/s, since it is missing",
    )
    none = dict.fromkeys(ODD, 0.0)
    for wrong in (NEWER.replace("'LEFT'", "'LEFFT'"), without(NEWER, "TYRESIDE")):
        assert "not mirrored, though it is not symmetric" in load(wrong).assumed[0]
    assert load(without(with_values(NEWER, **none), "TYRESIDE")).assumed == ()
    found = load(with_values(NEWER, QSY7=0))
    assert found.coefficients["QSY7"] == 1.0
    assert "QSY7: 1 and not 0" in found.assumed[0]


@pytest.mark.parametrize(
    "changed",
    [
        lambda t: t.replace("= 61", "= 60"),
        lambda t: t.replace("FITTYP ", "FIT "),
        lambda t: t.replace("= 61", "= 6\nPROPERTY_FILE_FORMAT = 'FTIRE'"),
        lambda t: t.replace("[UNITS]", "[UNIT]"),
        lambda t: t.replace("'meter'", "'ell'"),
        lambda t: t.replace("TIME ", "TIMES "),
        lambda t: t[: t.index("[LATERAL_C")] + t[t.index("[ROLLING") :],
        lambda t: without(t, "PKY1"),
        lambda t: without(t, "VERTICAL_STIFFNESS"),
        lambda t: without(t, "NOMPRES"),
        lambda t: without(t, "LONGVL"),
        lambda t: with_values(t, PCX1="much"),
        lambda t: with_values(t, PCX1="1e999"),
        lambda t: t + "PCX1 = 3.0\n",
        lambda t: t.replace("PKX2 ", "PKX_2 "),
        lambda t: t.replace("UNLOADED_RADIUS", "UNLOADED_RADUIS"),
        lambda t: with_values(t, LMUV=0.2),
        lambda t: with_values(t, PKY1=21.0),
        lambda t: with_values(t, FNOMIN=-1.0),
        lambda t: with_values(t, PDX2=-3.0),
        lambda t: with_values(t, PKX2=-30.0),
        lambda t: with_values(t, PKY4=8.0),
        lambda t: with_values(t, Q_FZ2=500.0),
        lambda t: with_values(t, FZMIN=9500.0),
        lambda t: t.replace("[", "("),
        lambda t: t.encode() + b"\0",
        lambda t: with_values(t, LKX=-0.9, LKY=-0.9),
    ],
)
def test_mistakes_are_refused_by_name(load, changed, refused):
    refused(kintrafo.InputError, lambda: load(changed(NEWER)))


def test_other_files_are_refused(load, tmp_path, refused):
    refused(kintrafo.InputError, lambda: load(NEWER, "own.txt"))
    with pytest.raises(kintrafo.InputError, match="cannot be read"):
        kintrafo.tyres.load(tmp_path / "none.tir")
    refused(kintrafo.InputError, lambda: kintrafo.tyres.load(3))


def test_changes_are_checked(load, refused):
    tyre = load(NEWER)
    assert tyre.with_changes({"LMUY": 0.5}).evaluate(4000.0, 0.2).fy > -2100.0
    refused(
        kintrafo.InputError,
        lambda: tyre.with_changes({"LMUQ": 0.5}),
        lambda: tyre.with_changes({"LMUY": -1.0}),
    )
