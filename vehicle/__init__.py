"""The application for vehicle engineers: suspensions, axles and cars from input files.

`data`      data sets of the project, and the file that a new project begins with
`tyres`     tyres from files, evaluated on arrays
`roads`     roads under both tracks, by the distance along them
`input`     the sections of an input file, each with its checks
`corner`    base of all kinds of suspension
`kinds`     a file for each kind of suspension
`models`    suspensions, axles and rigid axles with compiled equations, and their positions
`assembly`  one protocol for all assemblies with wheels: corner, axle and rigid axle
`files`     input files of any assembly, their schema, tables of points, files of other programs
`analysis`  characteristics, motions and linearizations of an assembly
`studies`   variation, tolerances, fits and optimization of values of the file
`plots`, `report`, `notebook`, `cli`    figures, pages, displays in notebooks, and commands
"""

from ..notebook import show

_PAGES = f"{__name__}.notebook"
show(
    {
        ("kintrafo.vehicle.corner.base", "Suspension"): (_PAGES, "suspension"),
        ("kintrafo.vehicle.models.model", "Model"): (_PAGES, "model"),
        ("kintrafo.vehicle.models.axle.axle", "Axle"): (_PAGES, "axle"),
        ("kintrafo.vehicle.models.whole_axle", "WholeAxle"): (_PAGES, "whole_axle"),
        ("kintrafo.simulation.result", "Simulation"): (_PAGES, "simulation"),
    }
)
