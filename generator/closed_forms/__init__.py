"""The catalogue of closed forms, one file each.

A form solves one kind of closure for position, velocity and bias acceleration. Velocities are those
of the implicit equation, ``g_x x' = -g_u u'``, so the linear factor of the velocity level serves
the acceleration level again. Everything is written in the axes that the solution itself gives to
the body (line, steering arm, normal), in which most components vanish.

A file that is added to this folder is in the catalogue (`catalogue`).

The method of kinematic transformers: A. Kecskeméthy, M. Hiller and T. Krupp, Symbolic processing of
multiloop mechanism dynamics using closed-form kinematics solutions, Multibody System Dynamics 1
(1997), pp. 23-45.
"""
