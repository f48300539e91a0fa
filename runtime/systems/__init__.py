"""Equations with numbers put to them.

`system`         compiled equations together with one set of parameters
`state`          a state, with the inputs that belong to it
`inputs`         which inputs are the derivatives of another one
`modes`          modes of a matrix
`linearisation`  the equations linearised about a state
`topology`       what the generator found out about a mechanism
`compile`        from a person's own declaration to compiled equations
"""
