"""``kintrafo export``: an error by name ends it, before a model is made."""

import pytest
from kintrafo.targets.export import TARGETS
from kintrafo.vehicle.cli import export

EVERY = (*TARGETS, "points")


@pytest.fixture
def nothing_is_made(monkeypatch):
    """No equations are looked for."""

    def described_by(*_):
        pytest.fail("a model was made")

    monkeypatch.setattr(export, "_described_by", described_by)


@pytest.mark.parametrize("to", EVERY)
def test_a_file_with_a_value_out_of_its_range(kintrafo, tmp_path, to, ends):
    """As a person leaves it who has edited it: key, value, unit and range are named."""
    kintrafo("new", "a.toml")
    file = tmp_path / "a.toml"
    text = file.read_text()
    assert text.count("spring_rate_N_per_m = 25000.0") == 1
    for value in ("-25000.0", "nan"):
        file.write_text(text.replace("rate_N_per_m = 25000.0", f"rate_N_per_m = {value}"))
        ends(2, "export", "a.toml", "--to", to)
        assert [path.name for path in tmp_path.iterdir()] == ["a.toml"]


@pytest.mark.usefixtures("nothing_is_made")
def test_bad_arguments_are_found_before_a_car_is_derived(ends, tmp_path):
    (tmp_path / "mine.fmu").write_text("a year of work")
    for line in (
        "--to matlab",
        "--to fmu --fmi 1",
        "--to fmu --platform mac",
        "--to fmu -o a.zip",
        "--to jax -o jax.py",
        "--to casadi -o a.txt",
        "--to fmu -o mine.fmu",
        "--to c -o mine.fmu",
        "--to c --fmi 2",
        "--to points --platform linux",
        "--to points",
    ):
        ends(2, "export", "driving_car", *line.split())
    assert [path.name for path in tmp_path.iterdir()] == ["mine.fmu"]


@pytest.mark.parametrize("name", ["andrews", "crane.py"])
def test_a_mechanism_has_no_table_of_hardpoints(tmp_path, name, ends):
    ends(2, "export", name, "--to", "points")
    assert not [*tmp_path.iterdir()]


def test_names_that_are_almost_right(ends):
    ends(2, "export", "four_bars", "--to", "c")


@pytest.mark.parametrize("to", ["casadi", "jax"])
def test_equations_that_iterate_are_refused_without_other_warnings(
    kintrafo, tmp_path, to, as_stored
):
    code, out, err = kintrafo("export", "rigid_axle", "--to", to)
    assert (code, out) == (2, "")
    as_stored(" ".join(err.split()))
    assert "XLA" not in err
    assert not [*tmp_path.iterdir()]
