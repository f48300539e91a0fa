"""A suspension: what a person writes about it, its equations, and where it can go.

`input`         the sections of an input file, each with its checks
`base`, `kinds`  what every suspension has, and a file for each kind
`schema`        the input file's JSON Schema and its reference page
`starter`       the file that a new project begins with; `data` has what is packaged
`chrono`, `adams_car`    suspensions of Project Chrono and of Adams/Car
`fitting`       another car's hardpoints in a file
`facts`, `drawing`    what a kind says of its equations, and how it is drawn
`geometry`      what the geometry of any suspension must fulfil
`typical`       where cars usually lie
`places`, `toml_writer`    changed values, and a suspension as a file
`model`         a suspension together with its compiled equations
`points`        where the hardpoints are in a position
`corner`, `strokes`    what characteristics are computed from
`swing`, `reach`, `positions`    how far the wheel travels, and its positions at rest
`plausibility`  what no suspension of a car looks like
"""
