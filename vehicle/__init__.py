"""The application: what a vehicle engineer asks of a suspension, an axle, a car.

`data`      data sets that come with the project, and the file that a new project begins with
`tyres`     tyres from files, evaluated on arrays
`roads`     roads under both tracks, by the distance along them
`input`     the sections of an input file, each with its checks
`corner`    what every kind of suspension has
`kinds`     a file for each kind of suspension
`models`    suspensions, axles and rigid axles with compiled equations, and their positions
`assembly`  what has wheels: one protocol for corner, axle and rigid axle
`files`     input files of any assembly, their schema, tables of points, files of other programs
`analysis`  what is asked of an assembly
`studies`   what becomes of the answers where values of the file change
`plots`, `report`, `notebook`, `cli`    what a person sees
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
