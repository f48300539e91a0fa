"""Identity of a declaration: a hash of everything on which derived equations can depend."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ...generator import Formulation
    from ...generator.equations.outputs import Derivation

_PLAIN = (str, int, float, bool, type(None))
# The order of declaration in this process: lists of the mechanism have it, too.
_COUNTED = ("order",)


class _UnknownError(Exception):
    """A declaration has an object whose contents are not all known."""


def identity(model: "Formulation") -> str | None:
    """Return a hash of a declaration; None if it has an object whose contents are not all known.

    All fields count, also those that its text leaves out. The code of the generator's own classes
    is hashed with the generator (`cache.fingerprint`). A force, a law or a path of a user's own
    class may call any code, so only the derived equations identify it.
    """
    try:
        return _Hashes().read(model).hex()
    except _UnknownError:
        return None


class _Hashes:
    """Hashes values, each object once: many others refer to a point."""

    def __init__(self) -> None:
        # with the object, since another one may get the id of a deleted object
        self._known: dict[int, tuple[Any, bytes]] = {}

    def read(self, value: Any) -> bytes:
        """Return a hash of a value and its contents."""
        if id(value) not in self._known:
            digest = hashlib.sha256()
            for part in self._parts(value):
                digest.update(len(part).to_bytes(8) + part)
            self._known[id(value)] = value, digest.digest()
        return self._known[id(value)][1]

    def _parts(self, value: Any) -> Iterator[bytes]:
        from ...generator.declare.declared import is_own

        kind = type(value)
        yield f"{kind.__module__}.{kind.__qualname__}".encode()
        if kind in _PLAIN:
            yield repr(value).encode("utf-8", "surrogatepass")
        elif kind in (tuple, list):
            yield from map(self.read, value)
        elif isinstance(value, Mapping) and kind.__module__ in ("builtins", "types"):
            for item in value.items():
                yield from map(self.read, item)
        elif is_dataclass(value) and not is_own(kind):
            for entry in fields(value):
                if entry.name not in _COUNTED:
                    yield entry.name.encode()
                    yield self.read(getattr(value, entry.name))
        elif kind.__module__.partition(".")[0] == "sympy":
            from sympy import srepr

            yield srepr(value).encode()
        else:
            raise _UnknownError(kind)


def identity_of_derived(derived: "Derivation") -> str:
    """Return a hash of all emitted files of a model."""
    from ...generator.backends.files import own_files

    digest = hashlib.sha256()
    for name, text in sorted(own_files(derived, None).items()):
        digest.update(f"{name}\0{text}\0".encode())
    return digest.hexdigest()
