"""What an engineer asks of a suspension.

`checkup`          a first look
`characteristics`  kinematic characteristics over wheel travel and rack travel
`sweep`            positions over wheel travel and rack travel
`compare`          several suspensions beside each other
`measurement`, `excitation`    roads, racks and forces from a file, and from formulas besides
`scenario`         a motion that is described by data
`ensembles`        many cars at once
`variation`        what becomes of the characteristics where values of the file change
`recording`        a simulation as a labelled dataset
`export`           datasets as files
`paper`            what the paper shows of its suspension
"""
