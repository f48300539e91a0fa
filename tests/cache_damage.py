"""Every kind of damage to the folder of a compiled mechanism."""

import json
import shutil


def cut(path):
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])


def flip(path):
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)


def empty(path):
    path.write_bytes(b"")


def remove(path):
    path.unlink()


def no_folder_inside(path):
    """A link in the place of a file has no target."""
    path.unlink()
    path.symlink_to("nowhere")


WAYS = (cut, flip, empty, remove, no_folder_inside)


def library_of(folder):
    """Return what computes: the shared library, or the NumPy functions where there is none."""
    return next(iter(folder.glob("lib*.so")), *folder.glob("_*[!_].py"))


def empty_folder(folder):
    shutil.rmtree(folder)
    folder.mkdir()


def manifest_of_another(folder):
    path = folder / "manifest.json"
    found = json.loads(path.read_text())
    path.write_text(json.dumps({**found, "folder": "slider_crank-0123456789abcdef"}))


def manifest_without_sense(folder):
    (folder / "manifest.json").write_text('{"files": {"a": 3}, "folder": [')
