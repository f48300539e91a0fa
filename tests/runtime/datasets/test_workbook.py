"""Excel workbooks: what a spreadsheet reads back is what was computed."""

import csv
import zipfile

import numpy as np
import pytest
import xarray as xr
from kintrafo import InputError, Model, Suspension, export, loads
from kintrafo.core.quantities import variable
from kintrafo.datasets import workbook

openpyxl = pytest.importorskip("openpyxl")

# one that is carried and one that cannot be
CASES = "[cases.static]\ncontact_N = [0, 0, 4e3]\n[cases.brake]\ncontact_N = [-4e3, 0, 4e3]\n"
FAR = "[cases.far]\ncontact_N = [0, 0, 1e6]\n"


def cells(path, sheet="data"):
    return list(openpyxl.load_workbook(path)[sheet].iter_rows(values_only=True))


def test_loads_are_read_back(kintrafo, tmp_path):
    (tmp_path / "c.toml").write_text(CASES + FAR, encoding="utf-8")
    files = ["-o", "a.xlsx", "-o", "a.csv"]
    assert kintrafo("loads", "reference_car", "--cases", "c.toml", *files)[0] == 1
    book = openpyxl.load_workbook(tmp_path / "a.xlsx")
    assert book.sheetnames == ["loads", "envelope"]
    assert {sheet.freeze_panes for sheet in book} == {"A2"}
    heading, *rows = book["loads"].iter_rows(values_only=True)
    assert {"case", "point", "force_x [N]", "moment_z [N m]", "at_y [mm]"} < {*heading}
    # all digits, which nine of CSV agree with
    names, *lines = csv.reader((tmp_path / "a.csv").read_text(encoding="utf-8").splitlines())
    assert [*heading] == names
    for row, line in zip(rows, lines, strict=True):
        for value, text in zip(row, line, strict=True):
            if isinstance(value, str) or value is None:
                assert (value or "") == text
            else:
                assert value == pytest.approx(float(text), rel=1e-8)
    case = heading.index("case")
    assert any(row[case] == "far" and row[-1] and set(row[5:14]) == {None} for row in rows)


def test_the_envelope_has_the_cases(tmp_path):
    found = loads.static(
        Model(Suspension.load("offset_strut_car")),
        {name: {"contact_N": [x, 0.0, 4e3]} for name, x in (("static", 0.0), ("brake", -4e3))},
    )
    path = export.write(loads.table(found), tmp_path / "a.xlsx", sheets=loads.workbook(found))
    heading, *rows = cells(path, "envelope")
    (row,) = [row for row in rows if row[0] == "knuckle at ball_joint by control_arm"]
    columns = dict(zip(heading, row, strict=True))
    values = found["force"].sel(load=row[0])
    for axis in "xyz":
        along = values.sel(axis=axis)
        for end, which in (("min", along.values.argmin()), ("max", along.values.argmax())):
            # rounding is a zero in a file for people
            assert columns[f"force_{axis}_{end} [N]"] == pytest.approx(
                float(along[which]), abs=1e-8
            )
            assert columns[f"force_{axis}_{end}_case"] == str(found["case"][which].values)


def test_every_cell_is_what_it_is(tmp_path):
    data = {
        "number": variable("i", [1.5, np.nan, np.inf, -2.0], "a length", "m"),
        "whole": ("i", [1, 2, 3, 4]),
        "flag": ("i", [True, False, True, False]),
        "=text": ("i", ["=1+1", "#N/A", "two\nlines", ""]),
    }
    path = export.write(xr.Dataset(data), tmp_path / "a.xlsx")
    heading, *rows = cells(path)
    assert heading[1:] == ("number [mm]", "whole", "flag", "=text")
    assert [row[1] for row in rows] == [1500.0, None, "inf", -2000.0]
    assert [row[2:4] for row in rows] == [(1, True), (2, False), (3, True), (4, False)]
    assert [row[4] for row in rows] == ["=1+1", "#N/A", "two\\x0alines", None]
    kinds = {cell.data_type for cell in openpyxl.load_workbook(path)["data"]["E"][:4]}
    assert kinds == {"s"}  # texts, not formulas or errors


def test_the_time_of_writing_is_not_in_the_file(tmp_path):
    path = export.write(xr.Dataset({"a": ("i", [1.0, 2.0])}), tmp_path / "a.xlsx")
    with zipfile.ZipFile(path) as archive:
        assert {entry.date_time[:3] for entry in archive.infolist()} == {(1980, 1, 1)}
    properties = openpyxl.load_workbook(path).properties
    assert {properties.created.year, properties.modified.year} == {1980}


def test_what_no_sheet_holds_is_refused(tmp_path, monkeypatch, refused):
    data = xr.Dataset({"a": ("i", np.zeros(4))})
    monkeypatch.setattr(workbook, "ROWS", 4)
    refused(InputError, lambda: export.write(data, tmp_path / "a.xlsx"))
    for wrong in ({"a/b": data}, {"x" * 32: data}, {"a": 1.0}, {}):
        with refused(InputError):
            export.write(data, tmp_path / "a.xlsx", sheets=wrong)
    assert not list(tmp_path.iterdir())
