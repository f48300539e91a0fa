"""Many systems of one model at once, in the lanes of vectors and on all cores.

`vectors.h`, `model.c`    the emitted equations, read as ones about vectors
`follow.h`    loops that iterate, in all lanes at a time
`integrate.c`, with the headers that it includes, below ``ensemble.h``    the solver
`directions.c`, `directions`    directions in which one system moves, along the steps of its motion
`solver.h`    what both solvers in C share
`options`    the options of compilers for each width
`own`        equations that were compiled here, in lanes
`library`    the compiled libraries, and which lanes the processor has
`problem`    what is to be integrated, as C takes it
`run`        on all cores
"""
