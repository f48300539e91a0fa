"""How much SymPy remembers of its own results.

By default the last thousand. A derivation comes back to far more of them, and takes half as long
again without; what it keeps in all is some 100 MB. SymPy reads the number when it is imported, so
that this comes first; where a program has imported SymPy before, its own choice stays.
"""

import os

os.environ.setdefault("SYMPY_CACHE_SIZE", "None")
