"""Suspensions and axles whose bushes give way by any amount.

`places`        bodies that move freely, and what is measured between them
`bars`          how far drop links twist an anti-roll bar
`laws`          forces over displacements
`connections`   what joints, bushes, springs and stops measure
`equilibrium`   where loads leave the parts
"""
