"""What a declaration is, as far as anything that is derived from it can depend on it."""

import hashlib
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ...generator import Formulation
    from ...generator.equations.outputs import Derivation

_PLAIN = (str, int, float, bool, type(None))
# When something was written, counted in this process: lists of the mechanism have that order.
_COUNTED = ("order",)


class _UnknownError(Exception):
    """Something is in a declaration of which not all is known."""


def identity(model: "Formulation") -> str | None:
    """Return a hash of a declaration; None where not all that counts can be read from it.

    All fields count, also those that its text leaves out. The code of the generator's own classes
    is hashed with the generator (`cache.fingerprint`). A force, a law or a path of a user's own
    class may call any code, so only the derived equations identify it.

    Parameters
    ----------
    model : Formulation

    Returns
    -------
    str or None
    """
    try:
        return _Reader().read(model).hex()
    except _UnknownError:
        return None


class _Reader:
    """Reads values, each object once: a point is referred to by many."""

    def __init__(self) -> None:
        # the object beside its hash: it must not end, or another one may get its id
        self._known: dict[int, tuple[Any, bytes]] = {}

    def read(self, value: Any) -> bytes:
        """Return a hash of a value and of all that is in it."""
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
            yield _written(value)
        else:
            raise _UnknownError(kind)


def _written(expression: Any) -> bytes:
    from sympy import srepr

    text: str = srepr(expression)
    return text.encode()


def identity_of_derived(derived: "Derivation") -> str:
    """Return a hash of all that is emitted of a model.

    Parameters
    ----------
    derived : Derivation
    """
    from ...generator.backends.files import own_files

    digest = hashlib.sha256()
    for name, text in sorted(own_files(derived, None).items()):
        digest.update(f"{name}\0{text}\0".encode())
    return digest.hexdigest()
