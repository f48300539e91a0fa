"""Derive the equations of motion of mechanisms with kinematic loops, and emit them as C.

The rooms, in the order in which a mechanism passes through them:

``mechanism``, ``joints``, ``forces``
    what a person declares;
``topology``
    mobility, joint graph, shortest paths, minimal cycle basis;
``transformer``
    which loop is cut at which pair of joints, and in which order the loops are solved;
``solutions``
    the catalogue of closed forms;
``kinematics``, ``dynamics``, ``outputs``
    the straight-line program from the coordinates to accelerations and everything else;
``program``
    named steps, stages, derivatives, common subexpressions, operation counts;
``emit``
    printers: C, Cython, the derivation report.
"""
