"""Compiled equations of motion of any mechanism: names, arrays, errors.

`equations`  everything that one manifest describes, ready to be called
`residuals`  closure residuals of given relative coordinates
`_calls`     calls of C functions by their addresses, for one state or arrays of them
`arrays`     the same for functions over NumPy arrays, where there is no compiler
`following`  how such functions follow loops that are solved by iteration
`status`     the bits of a status word
`errors`     what cannot be evaluated

What is emitted for a mechanism imports `Equations` from here. So this package is lower than all
that is emitted, and below the generator, which takes the status bits from it.
"""

from .equations import Equations

__all__ = ["Equations"]
