r"""The inertia that bodies on a base add to it: the corner of a car on its body.

With r the position of a mass point relative to the centre of mass O of the base, r' its velocity on
the base and r'' its acceleration there, all in the axes of the base, a corner is sums over its
bodies:

    M = ∫ dm,   C = ∫ r dm,   S = ∫ r r^T dm                       mass,
    P_k = ∫ r_k' dm,   h_k = ∫ r x r_k' dm,   S_k = dS/dq_k        flow with a coordinate,
    P'' = ∫ r'' dm,    h'' = ∫ r x r'' dm                          inertia of its own motion.

The inertia of the base is ``J = tr S - S``. With a and alpha the accelerations of O and of the
base, w its angular velocity, and P, h and S' those of all rates, force and couple on it are

    M a + alpha x C + w x (w x C) + 2 w x P + P'' + sum P_k q_k'',
    J alpha + w x J w + C x a + (tr S' - S') w + w x h + h'' + sum h_k q_k'',

and along a coordinate

    P_k . a + h_k . alpha + 1/2 (w . S_k w - w^2 tr S_k) + 2 w . X_k + b_k + sum M_kl q_l''

is needed, with ``X_k = ∫ r' x r_k' dm`` and ``b_k = ∫ r_k' . r'' dm``. So the motion of the base
enters here, and in no body of the corner; and the motion of the corner enters the base by these
sums.

The sums follow from Newton's and Euler's equations of all mass points in accelerated axes; for the
inertia of several bodies as that of one, see R. Featherstone, Rigid Body Dynamics Algorithms,
Springer, 2008, chapter 6.
"""
