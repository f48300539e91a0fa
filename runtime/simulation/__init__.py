"""A system in motion: what moves it, who integrates it, what comes of it.

`simulate`       the one function of this folder that a person calls
`signals`        what an input does over time, cut where it jumps
`courses`, `fitting`, `interpolation`, `turning`    curves over time, and where they turn
`events`         at which level of a signal something happens; `levels` reads what forces declare
`solvers`        the integration methods; `native` has those of SUNDIALS
`dead_points`, `watched`    how near a motion is to a dead point, for the methods of SciPy
`result`         what a simulation gives; `validity` says where it has no meaning
"""
