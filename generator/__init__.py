"""Derive the equations of motion of mechanisms with kinematic loops, and emit them as C.

The layers, the lowest first; a file imports only from lower ones (`make lint`):

``program``
    the straight-line program: steps, constants, derivatives, sharing, operation counts;
``declare``, and ``mechanisms`` that come with the project
    declarations of mechanisms, each part checked where it is written, and the whole;
``kinematics``
    bodies in motion: poses, twists, bias accelerations;
``loops``
    joint graph, minimal cycle basis, mobility, and the order in which the loops are solved;
``closed_forms``
    the catalogue of closed forms, one file each;
``planning``
    the planner with that catalogue, and proposals of coordinates;
``equations``
    dynamics, and the functions that are emitted;
``backends``
    printers, a folder for each: C, Cython, NumPy, Python, the derivation report.

All classes of declarations can be imported from here.
"""

from . import memory  # noqa: F401 (before SymPy is imported)
from .declare import *  # noqa: F403 (the vocabulary, listed there)
from .declare import __all__  # noqa: F401 (the same list)
