"""Writing files: whole or not at all, through nobody's links, and never over somebody's work."""

import errno
import os
import stat
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from kintrafo import InputError, Model, Suspension, export, plots, report
from kintrafo.core import written
from kintrafo.core.files import refuse, replacing
from kintrafo.core.legible import legible
from kintrafo.systems.compile.build import compile_mechanism
from kintrafo.vehicle.analysis.measurement import measured
from kintrafo.vehicle.data.starter import write_starter
from kintrafo.vehicle.files.chrono import read
from kintrafo.vehicle.files.point_table import write_points
from kintrafo.vehicle.input.toml_writer import write_toml
from matplotlib.image import imread
from support.folders import DATA

LINE = xr.Dataset({"camber": ("wheel_travel", [0.0, 0.1])}, {"wheel_travel": [0.0, 0.01]})


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    """Every test knows of its own files only."""
    folder = tmp_path_factory.mktemp("cache")
    monkeypatch.setenv("KINTRAFO_CACHE", str(folder))
    return folder


def put(path, text, **rule):
    with replacing(path, **rule) as temporary:
        temporary.write_text(text, encoding="utf-8")


# -- replaced and kept files --------------------------------------------------------------------


def test_what_was_written_is_written_again(tmp_path):
    for text in ("one", "two"):
        put(tmp_path / "a.csv", text)
        assert (tmp_path / "a.csv").read_text() == text


@pytest.mark.parametrize("how", ["another's", "changed", "moved", "forgotten"])
def test_what_is_somebody_elses_is_kept(tmp_path, cache, how, refused):
    path = tmp_path / "a.csv"
    put(path, "results")
    if how == "another's":
        path = tmp_path / "b.csv"
        path.write_text("a year of work")
    elif how == "changed":
        path.write_text("results, and what I think of them")
    elif how == "moved":
        path = path.rename(tmp_path / "kept.csv")
    else:
        (cache / "written").unlink()
    before = path.read_bytes()
    refused(InputError, lambda: put(path, "new"))
    assert path.read_bytes() == before
    put(path, "new", force=True)
    assert path.read_text() == "new"
    put(path, "newer")  # which is now this program's own
    assert list(path.parent.glob(".*")) == []


def test_an_empty_file_holds_nothing_to_lose(tmp_path):
    (tmp_path / "a.csv").touch()
    put(tmp_path / "a.csv", "new")


@pytest.mark.parametrize("link", [False, True])
def test_what_is_read_is_never_written(tmp_path, link, refused):
    source = tmp_path / "source.py"
    source.write_text("mine")
    path = tmp_path / "link.py"
    path.symlink_to(source) if link else path.hardlink_to(source)
    for given in (source, path):
        with refused(InputError):
            put(given, "new", force=True, inputs=[source])
    assert source.read_text() == "mine"


def test_a_file_that_appears_meanwhile_is_kept(tmp_path, refused):
    path = tmp_path / "a.csv"

    def slowly():
        with replacing(path) as temporary:
            temporary.write_text("new")
            path.write_text("from another window")

    refused(InputError, slowly)
    assert path.read_text() == "from another window"


def test_several_are_refused_together(tmp_path):
    for name in "ab":
        (tmp_path / name).write_text("mine")
    with pytest.raises(InputError) as caught:
        refuse([tmp_path / name for name in "abc"])
    assert len(caught.value.problems) == 2


@pytest.mark.parametrize("name", ["a.csv", "a.nc", "a.parquet", "a.xlsx"])
def test_data_files(tmp_path, name, refused):
    path = tmp_path / name
    path.write_text("mine")
    refused(InputError, lambda: export.write(LINE, path))
    export.write(LINE, path, force=True)
    export.write(LINE, path)


def test_input_files_of_a_person(tmp_path, refused):
    chrono = DATA / "chrono/MacPhersonStrut.json"
    path = write_starter(tmp_path / "car.toml")
    write_starter(path)  # as it was written: nothing is lost
    path.write_text(path.read_text() + "# mine\n")
    for write in (write_starter, lambda p: write_toml(read(chrono).suspension, p)):
        with refused(InputError):
            write(path)
    refused(InputError, lambda: write_starter(tmp_path / "car.py", force=True))


def test_figures_are_refused_before_one_is_drawn(tmp_path, refused):
    (tmp_path / "camber.png").write_text("mine")
    refused(InputError, lambda: plots.write(LINE, tmp_path))
    assert [path.name for path in tmp_path.iterdir()] == ["camber.png"]


@pytest.mark.parametrize(
    "rule",
    [{"path": None}, {"path": 3}, {"force": "no"}, {"inputs": "car.toml"}, {"inputs": [3]}],
    ids=str,
)
def test_every_writer_refuses_what_is_no_path(tmp_path, rule):
    """A text in place of a list would be one file for each of its letters."""
    car = Suspension.load("reference_car")
    writers = [
        (lambda path, **words: write_toml(car, path, **words), "a.toml"),
        (lambda path, **words: write_points(car, path, **words), "a.csv"),
        (lambda path, **words: report.write(Model(car), path, **words), "a.html"),
        (lambda path, **words: plots.write_overview(LINE, path, **words), "a.svg"),
        (lambda path, **words: export.write(LINE, path, **words), "a.csv"),
    ]
    for write, name in writers:
        with pytest.raises(InputError):
            write(**{"path": tmp_path / name, **rule})
    assert not list(tmp_path.iterdir())


def test_reports_have_a_name_of_their_own(tmp_path, refused):
    path = tmp_path / "other_car.toml"
    path.write_text("mine")
    refused(InputError, lambda: report.write(Model("reference_car"), path, force=True))
    assert path.read_text() == "mine"


def test_the_register_does_not_grow_without_end(tmp_path, cache, monkeypatch):
    monkeypatch.setattr(written, "_MOST_BYTES", 650)
    for index in range(100):
        put(tmp_path / f"{index}.csv", "x")
    assert (cache / "written").stat().st_size <= 650 + 65
    put(tmp_path / "99.csv", "y")


def test_without_a_register_nothing_is_lost(tmp_path, cache, refused):
    (cache / "written").mkdir()
    put(tmp_path / "a.csv", "x")
    refused(InputError, lambda: put(tmp_path / "a.csv", "y"))


# -- complete files, and links --------------------------------------------------------------------


def test_temporary_files_are_ours_alone(tmp_path):
    """Neither their place can be foreseen, nor can another user put a link there."""
    seen = set()
    for _ in range(3):
        with replacing(tmp_path / "a.csv") as temporary:
            seen.add(temporary.parent)
            assert temporary.parent.parent == tmp_path
            assert stat.S_IMODE(temporary.parent.stat().st_mode) == 0o700
            temporary.write_text("x")
    assert len(seen) == 3


def test_links_of_a_person_are_followed_those_beside_are_not(tmp_path):
    victim, real = tmp_path / "victim", tmp_path / "real.csv"
    victim.write_text("mine")
    (tmp_path / f".a-{os.getpid()}.csv").symlink_to(victim)  # where it once was written to
    (tmp_path / "a.csv").symlink_to(real)
    put(tmp_path / "a.csv", "x")
    assert (tmp_path / "a.csv").is_symlink()
    assert real.read_text() == "x"
    assert victim.read_text() == "mine"


def test_a_file_keeps_its_mode(tmp_path):
    put(tmp_path / "a.csv", "x")
    (tmp_path / "a.csv").chmod(0o640)
    put(tmp_path / "a.csv", "y")
    assert stat.S_IMODE((tmp_path / "a.csv").stat().st_mode) == 0o640


def test_threads_that_write_one_file(tmp_path):
    """Each file is complete, and no thread has an error."""
    path, texts = tmp_path / "a.csv", [str(i) * 50_000 for i in range(4)]
    together = threading.Barrier(len(texts))

    def work(text):
        for _ in range(10):
            together.wait()
            put(path, text)
            assert path.read_text() in texts

    with ThreadPoolExecutor(len(texts)) as pool:
        list(pool.map(work, texts))
    assert [p.name for p in tmp_path.iterdir()] == ["a.csv"]


# -- errors of the operating system ------------------------------------------------------------


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("x" * 300 + ".csv", "too long"),
        ("file/a.csv", "Not a directory|File exists"),
        ("circle.csv", "symbolic links"),
        ("folder.csv", "not a file"),
        ("zero\0.csv", "zero byte"),
    ],
)
def test_places_where_nothing_can_be_written(tmp_path, path, words):
    (tmp_path / "file").write_text("x")
    (tmp_path / "folder.csv").mkdir()
    (tmp_path / "circle.csv").symlink_to("circle.csv")
    with pytest.raises(InputError, match=words):
        export.write(LINE, tmp_path / path)


@pytest.mark.parametrize("name", ["x" * 300, "file/a", "circle", "missing"])
def test_places_where_nothing_can_be_read(tmp_path, name):
    (tmp_path / "file").write_text("x")
    (tmp_path / "circle").symlink_to("circle")
    for door in (Suspension.load, measured, read, compile_mechanism):
        with pytest.raises(InputError, match=r"cannot be read|no such file"):
            door(tmp_path / name)


@pytest.fixture
def full(tmp_path, monkeypatch):
    """A folder on a disk that is full: what is written in it ends with the system's error."""
    device = Path("/dev/full")
    if not device.exists():
        pytest.skip("no /dev/full on this system")

    def leading_nowhere(prefix, dir):  # noqa: A002 (the name of tempfile's argument)
        folder = Path(dir) / f"{prefix}nowhere"
        folder.mkdir()
        for name in NAMES:
            (folder / name).symlink_to(device)
        return str(folder)

    monkeypatch.setattr("kintrafo.core.files.tempfile.mkdtemp", leading_nowhere)
    return tmp_path


NAMES = ("a.csv", "a.nc", "a.parquet", "a.xlsx", "a.pdf", "a.png", "a.svg", "a.html", "a.toml")


def fill(path):
    if path.suffix in (".csv", ".nc", ".parquet", ".xlsx"):
        # more than the buffers of all the writers
        many = np.arange(100_000.0)
        export.write(xr.Dataset({"camber": ("wheel_travel", many)}), path)
    elif path.suffix == ".html":
        put(path, "x" * 100_000)
    elif path.suffix == ".toml":
        write_starter(path)
    else:
        plots.write_overview(LINE, path)


@pytest.mark.parametrize("name", NAMES)
def test_a_full_disk_is_reported_and_nothing_is_left(full, name):
    with pytest.raises(InputError, match=r"No space left on device\. Make room"):
        fill(full / name)
    assert list(full.iterdir()) == []


def test_the_register_on_a_full_disk(tmp_path, monkeypatch):
    def no_space(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(written.os, "write", no_space)
    put(tmp_path / "a.csv", "x")
    assert (tmp_path / "a.csv").read_text() == "x"


# -- names that are hard to show ----------------------------------------------------------------


STRANGE = [
    "$^$",
    "caf\udce9",
    "two\nlines",
    "tab\there",
    "\x1b[31m",
    "\ud800",
    "%s {x} \\frac",
    "日本",
]


def test_legible_texts_stay_what_they_are():
    assert legible("Größe $x$ 日本") == "Größe $x$ 日本"
    for text in STRANGE:
        legible(text).encode("utf-8")
        assert legible(text).isprintable()


@pytest.mark.filterwarnings("ignore:Glyph")  # the font of the figures has no Japanese
@pytest.mark.parametrize("ending", [*plots.FORMATS, "csv", "nc", "parquet", "xlsx"])
def test_strange_names_in_every_format(tmp_path, ending):
    values = np.arange(2.0 * len(STRANGE)).reshape(len(STRANGE), 2)
    family = xr.Dataset(
        {"camber": (("data_set", "wheel_travel"), values)},
        {"data_set": STRANGE, "wheel_travel": [0.0, 0.01]},
    )
    path = tmp_path / os.fsdecode(f"caf\xe9.{ending}".encode("latin-1"))
    if ending in plots.FORMATS:
        plots.write_overview(family, path, title=" and ".join(STRANGE))
    else:
        export.write(family, path)
    assert path.stat().st_size > 0
    if ending == "png":
        assert imread(path).std() > 0.01


@pytest.mark.parametrize("text", ["=1+1", "+cmd", "-cmd|' /C calc'!A0", "@SUM(A1)", "\tx", "\rx"])
def test_no_cell_is_a_formula(tmp_path, text):
    named = LINE.expand_dims(data_set=[text, "-3.5", "plain"])
    rows = export.write(named, tmp_path / "a.csv").read_text().splitlines()
    cells = [row.split(",")[0].strip('"') for row in rows[1:]]
    assert cells[0].startswith(("'", "\\x0"))
    assert cells[2::2] == ["-3.5", "plain"]


def test_a_formula_of_a_declaration_in_the_heading(tmp_path):
    data = LINE.rename(camber="=x")
    assert export.write(data, tmp_path / "a.csv").read_text().splitlines()[0].endswith(",'=x")


@pytest.mark.parametrize("strange", [3, None, "read.csv", b"x", [3], [None]])
def test_what_is_no_list_of_files_that_are_read_is_refused(tmp_path, strange, refused):
    """The letters of a name would be files that nobody reads, and the file would be written."""
    path = tmp_path / "read.csv"
    refused(InputError, lambda: refuse([path], inputs=strange))
    with (
        refused(InputError),
        replacing(path, inputs=strange) as temporary,
    ):
        temporary.write_text("")
    assert not list(tmp_path.iterdir())


def test_a_text_is_no_list_of_files_to_be_written(refused):
    refused(InputError, lambda: refuse("curves.csv"))


def test_files_that_are_read_may_come_one_by_one(tmp_path):
    """They are looked at before something is written and after that."""
    path = tmp_path / "read.csv"

    def write():
        with replacing(path, force=True, inputs=(each for each in [path])) as temporary:
            temporary.write_text("new", encoding="utf-8")
            path.write_text("appeared", encoding="utf-8")

    with pytest.raises(InputError, match="read"):
        write()
    assert path.read_text(encoding="utf-8") == "appeared"
