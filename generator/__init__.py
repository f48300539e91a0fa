"""Derive the equations of motion of mechanisms with kinematic loops, and emit them as C.

The floors, the lowest first; a file imports only what is on a lower one (`make lint`):

``program``
    the straight-line program: steps, constants, derivatives, what is shared, operation counts;
``declare``, and ``mechanisms`` that come with the project
    what a person declares, each part checked where it is written, and the whole;
``kinematics``
    bodies in motion: poses, twists, bias accelerations;
``loops``
    joint graph, minimal cycle basis, mobility, and the order in which the loops are solved;
``closed_forms``
    the catalogue, a file for each form with all that there is to say about it;
``planning``
    the planner with that catalogue in its hands, and proposals of coordinates;
``equations``
    dynamics, and the functions that are emitted;
``backends``
    printers, a folder for each: C, Cython, NumPy, Python, the derivation report.

What a declaration is made of can be imported from here.
"""

from . import memory  # noqa: F401 (before SymPy is imported)
from .declare import *  # noqa: F403 (the vocabulary, listed there)
from .declare import __all__  # noqa: F401 (the same list)
