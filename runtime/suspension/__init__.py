"""A suspension: what a person writes about it, its equations, and where it can go.

`input`         the sections of an input file, each with its checks
`kinds`         a file for each kind of suspension
`schema`        the input file's JSON Schema and its reference page
`starter`       the file that a new project begins with; `data` has what is packaged
`chrono`        suspensions of Project Chrono
`model`         a suspension together with its compiled equations
`points`        where the hardpoints are in a position
`corner`, `strokes`    what characteristics are computed from
`swing`, `reach`, `positions`    how far the wheel travels, and its positions at rest
`plausibility`  what no suspension of a car looks like
"""
