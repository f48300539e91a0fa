"""Suspensions whose bushes give way by any amount.

`places`        bodies that move freely, and what is measured between them
`laws`          forces over displacements
`connections`   what joints, bushes, springs and stops measure
`equilibrium`   where loads leave the parts
"""
