"""`kintrafo.load` returns what a file describes; anything else is refused as a suspension is."""

import kintrafo
import pytest
from kintrafo.vehicle.data.starter import packaged, packaged_axles
from support.folders import ROOT

DATA = ROOT / "vehicle/data"


@pytest.mark.parametrize(
    ("names", "kind"),
    [
        (packaged(), kintrafo.Suspension),
        (packaged_axles(), kintrafo.Axle),
        (("rigid_axle",), kintrafo.RigidAxle),
    ],
)
def test_a_name_and_its_file_are_the_same(names, kind):
    for name in names:
        found = kintrafo.load(name)
        assert isinstance(found, kind)
        (file,) = DATA.rglob(f"{name}.toml")
        assert kintrafo.load(file) == found == kintrafo.load(str(file))


def test_what_describes_nothing_is_refused(tmp_path, refused):
    refused(kintrafo.InputError, lambda: kintrafo.load(3), lambda: kintrafo.load("no_such_car"))
    file = tmp_path / "empty.toml"
    file.write_text("", encoding="utf-8")
    refused(kintrafo.InputError, lambda: kintrafo.load(file))


@pytest.mark.parametrize(
    "name",
    ["double_wishbone_car", "rear_axle", "rigid_axle", "twist_beam", "quarter_car", "driving_car"],
)
def test_what_is_saved_is_loaded_again(tmp_path, name, refused):
    """An axle and a car have in their own file what is in those that they name."""
    subject = kintrafo.load(name)
    refused(kintrafo.InputError, lambda: type(subject).from_dict(subject.to_dict(), 3))
    file = subject.save(tmp_path / "saved.toml")
    assert kintrafo.load(file).to_dict() == subject.to_dict()
    file.write_text("# mine", encoding="utf-8")
    refused(kintrafo.InputError, lambda: subject.save(file))
