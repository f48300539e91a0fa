"""Pages, links and names of the documentation, without building it (`make docs` does that)."""

import importlib
import inspect
import pydoc
import re
import runpy
import tomllib
from collections import Counter
from functools import cache, cached_property

import kintrafo
import pytest
from kintrafo import generator
from kintrafo.vehicle import cli
from support.folders import ROOT

DOCS = ROOT / "docs"
PAGES = sorted(DOCS.rglob("*.md"))
OTHERS = [ROOT / "README.md", ROOT / "CHANGELOG.md"]


def text_of(page):
    return page.read_text(encoding="utf-8")


def without_code(text):
    """Return a page without its blocks of code, whose comments look like headings."""
    return re.sub(r"^ *```.*?^ *```$", "", text, flags=re.DOTALL | re.MULTILINE)


def slug(heading):
    """Return the anchor that code hosts give a heading."""
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-")


@cache
def anchors_of(page):
    """Return all anchors; of headings that are alike the later ones have a number."""
    headings = re.findall(r"^#+ (.*)$", without_code(text_of(page)), flags=re.MULTILINE)
    seen, found = Counter(), set()
    for name in map(slug, headings):
        found.add(f"{name}-{seen[name]}" if seen[name] else name)
        seen[name] += 1
    return found


def listed_by(page):
    """Return the pages in a page's table of contents."""
    for block in re.findall(r"```\{toctree\}\n(.*?)```", text_of(page), flags=re.DOTALL):
        lines = [line for line in block.splitlines() if line and not line.startswith(":")]
        names = [re.sub(r"^.*<(.*)>$", r"\1", line) for line in lines]
        named = [page.parent / f"{name}.md" for name in names if "*" not in name]
        # a pattern is for the pages that have no line of their own
        others = [p for name in names if "*" in name for p in page.parent.glob(f"{name}.md")]
        yield from [*named, *(p for p in others if p not in (page, *named))]


@pytest.mark.parametrize("page", [*OTHERS, *PAGES], ids=lambda page: page.stem)
def test_links_lead_somewhere(page):
    """A link that is called after a file leads to this file."""
    for name, link in re.findall(r"([^\[\]]*)\]\(([^)\s]+)\)", without_code(text_of(page))):
        if "://" in link:
            continue
        path, _, anchor = link.partition("#")
        if re.fullmatch(r"[\w/]+\.(py|c|h|json|toml|md)", name):
            assert path.endswith(name.rpartition("/")[2]), link
        target = page.parent / path if path else page
        assert target.exists(), link
        if anchor:
            assert anchor in anchors_of(target), link


def test_contributing_names_files_that_there_are():
    """Each step of its walks names files and folders of the sources, or of what tools make."""
    text = without_code(text_of(DOCS / "contributing.md"))
    named = set(
        re.findall(r"`((?:generator|runtime|vehicle|docs|tests|benchmarks)/[\w./-]*)`", text)
    )
    assert len(named) > 10
    assert not [name for name in sorted(named) if not (ROOT / name).exists()]


def test_every_page_is_in_the_table_of_contents_once():
    listed = Counter(target for page in PAGES for target in listed_by(page))
    assert set(listed) == set(PAGES) - {DOCS / "index.md"}
    assert set(listed.values()) == {1}


def documented_names():
    text = "".join(text_of(page) for page in (DOCS / "reference/api").glob("*.md"))
    return set(re.findall(r"^\.\. (?:auto\w+|py:data):: (\S+)$", text, flags=re.MULTILINE))


def test_every_public_name_is_documented():
    documented = documented_names()
    named = {f"kintrafo.{name}" for name in kintrafo.__all__}
    named |= {f"kintrafo.generator.{name}" for name in generator.__all__}
    for module in kintrafo._INTERFACES:
        names = getattr(getattr(kintrafo, module), "__all__", ())
        named |= {f"kintrafo.{module}.{name}" for name in names if not name.isupper()}
        assert any(name.startswith(f"kintrafo.{module}.") for name in documented), module
    assert named <= documented
    for name in documented:
        assert pydoc.locate(name) is not None, name


@pytest.mark.parametrize("name", sorted(documented_names()))
def test_functions_of_two_arguments_say_what_these_are(name):
    found = pydoc.locate(name)
    functions = [found] if inspect.isroutine(found) else []
    if inspect.isclass(found):
        public = (member for key, member in vars(found).items() if not key.startswith("_"))
        functions = [each for each in public if inspect.isfunction(each)]
    for function in functions:
        arguments = set(inspect.signature(function).parameters) - {"self", "cls"}
        assert len(arguments) < 2 or "Parameters\n" in (inspect.getdoc(function) or ""), function


def modules():
    """Yield the modules of the package; those of the runtime are its top."""
    for above, top in ((ROOT / "runtime", ""), (ROOT, "generator"), (ROOT, "vehicle")):
        for path in sorted((above / top).rglob("*.py")):
            parts = path.relative_to(above).with_suffix("").parts
            if parts[-1] not in ("__init__", "__main__"):
                yield importlib.import_module(".".join(["kintrafo", *parts]))


def test_every_public_method_is_described():
    """It has the description of its base class where it has none of its own."""
    kinds = {
        kind
        for module in modules()
        for name, kind in vars(module).items()
        if inspect.isclass(kind) and kind.__module__.startswith("kintrafo") and name[0] != "_"
    }
    methods = (property, cached_property, classmethod, staticmethod, type(modules))
    missing = [
        f"{kind.__module__}.{kind.__name__}.{name}"
        for kind in kinds
        for name, member in vars(kind).items()
        if isinstance(member, methods) and name[0] != "_"
        if getattr(member, "__name__", "") != "<lambda>"  # the default of a field
        if not any(getattr(vars(base).get(name), "__doc__", None) for base in kind.__mro__)
    ]
    assert len(kinds) > 500
    assert missing == []


@pytest.mark.parametrize("name", sorted(kintrafo.__all__))
def test_signatures_call_types_by_their_names(name):
    """Signatures show `array_like`, not the union of twelve classes for which it stands."""
    shown = getattr(kintrafo, name)
    if inspect.isfunction(shown):
        assert "_NestedSequence" not in str(inspect.signature(shown))
        assert shown.__doc__[:1].isupper()


def test_changelog_and_citation_are_of_this_version():
    project = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]
    citation = text_of(ROOT / "CITATION.cff")
    assert f"\nversion: {project['version']}\n" in citation
    assert f"\nlicense: {project['license']}\n" in citation
    newest = re.search(r"^## ([\d.]+)", text_of(ROOT / "CHANGELOG.md"), flags=re.MULTILINE)
    assert newest.group(1) == project["version"]


def test_links_of_the_readme_are_addresses_on_an_index(monkeypatch):
    """Each path is that of a file, behind the place of the sources; the rest of the text stays."""
    readme = runpy.run_path(str(ROOT / ".ci/long_description.py"))
    before = text_of(ROOT / "README.md")
    monkeypatch.delenv("KINTRAFO_REPOSITORY", raising=False)
    assert readme["long_description"](ROOT) == before, "the address of the sources is not known"
    monkeypatch.setenv("KINTRAFO_REPOSITORY", "https://forge.example/someone/kintrafo")
    monkeypatch.setenv("KINTRAFO_REVISION", "v1.2.3")
    after = readme["long_description"](ROOT)
    links = re.findall(r"(!?)\[[^\]]*\]\(([^)]+)\)", without_code(after))
    assert len(links) > 15
    for image, link in links:
        what = "raw" if image else "blob"
        place = f"https://forge.example/someone/kintrafo/{what}/v1.2.3/"
        assert link.startswith(place)
        assert (ROOT / link.removeprefix(place).partition("#")[0]).exists(), link
    stripped = re.sub(r"https://forge\.example/someone/kintrafo/(raw|blob)/v1\.2\.3/", "", after)
    assert stripped == before


def test_every_command_has_an_output_on_a_page():
    """The page of the commands shows it below the help of each (test_examples.py compares it)."""
    outputs = runpy.run_path(str(DOCS / "site/shown.py"))["outputs"]
    found = outputs(DOCS, [*cli.COMMANDS])
    assert set(found) == set(cli.COMMANDS)
    drawing = {"characteristics", "compliance", "compare", "simulate", "loads", "tolerance", "ride",
               "sweep", "sensitivity", "optimise", "pareto", "fit", "drive", "tyre"}  # fmt: skip
    assert drawing <= {name for name, shown in found.items() if shown.picture}
