"""A user's own mechanism: derived, emitted, compiled and loaded outside of the source tree.

`build`        from a declaration to a module, by way of the cache
`declaration`  what a person wrote: a file, a mechanism or a model
`derivation`   how the equations were derived, to be printed
`choices`      which coordinates can be independent
`identity`     what a declaration is, as far as equations can depend on it
`cache`        where compiled mechanisms are kept, and under which name
`compiler`     the C compiler of this machine
`loader`       a folder of the cache as a Python module
`on_terminal`  what is being done, on the screen
`shipped`      what was compiled, on its way to another process
"""

from .build import compile_mechanism
from .choices import proposals
from .compiler import CompilerError
from .declaration import MechanismError
from .derivation import write_derivation

__all__ = ["CompilerError", "MechanismError", "compile_mechanism", "proposals", "write_derivation"]
