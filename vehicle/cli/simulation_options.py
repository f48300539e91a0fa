"""The arguments of ``kintrafo simulate``, with the units of the command line."""

from pathlib import Path
from typing import Annotated, Literal

import typer

Height = Annotated[
    float | None,
    typer.Option(
        metavar="MM",
        help="Wheel centre at the start. Default: at rest.",
        rich_help_panel="Start",
    ),
]
Spin = Annotated[
    float,
    typer.Option(
        metavar="REV/S", help="Wheel spin, positive rolling forward.", rich_help_panel="Start"
    ),
]
RoadStep = Annotated[
    float | None,
    typer.Option(metavar="MM", help="The road rises by this at once.", rich_help_panel="Road"),
]
RoadStepAt = Annotated[
    float, typer.Option(metavar="S", help="When it does.", rich_help_panel="Road")
]
RoadSine = Annotated[
    float | None,
    typer.Option(metavar="MM", help="Amplitude of a harmonic road.", rich_help_panel="Road"),
]
RoadFrequency = Annotated[
    float, typer.Option(metavar="HZ", help="Its frequency.", rich_help_panel="Road")
]
Measured = Annotated[
    Path | None,
    typer.Option(
        metavar="CSV",
        help="Measured road, rack, loads on the wheel: time_s or distance_m, road_height_mm, "
        "rack_position_mm, contact_force_x_N, ...",
        rich_help_panel="Road",
    ),
]
Speed = Annotated[
    float | None,
    typer.Option(
        metavar="KM/H", help="Speed on a road given over distance_m.", rich_help_panel="Road"
    ),
]
Wheels = Annotated[
    Literal["both", "left", "right"] | None,
    typer.Option(
        help="Of an axle: under which wheels the road is. Default: both.", rich_help_panel="Road"
    ),
]
Rack = Annotated[
    float | None, typer.Option(metavar="MM", help="Rack held there.", rich_help_panel="Rack")
]
RackSine = Annotated[
    float | None,
    typer.Option(metavar="MM", help="Amplitude of a harmonic rack motion.", rich_help_panel="Rack"),
]
RackFrequency = Annotated[
    float, typer.Option(metavar="HZ", help="Its frequency.", rich_help_panel="Rack")
]
Duration = Annotated[
    float | None,
    typer.Option(
        metavar="S", help="Default: 1, or as long as what was measured.", rich_help_panel="Time"
    ),
]
OutputStep = Annotated[
    float, typer.Option(metavar="MS", help="Time between outputs.", rich_help_panel="Time")
]
Method = Annotated[
    str,
    typer.Option(
        help="BDF, Adams, Verner, DormandPrince, RK4, Tsitouras, Radau, LSODA, RK45, DOP853.",
        rich_help_panel="Solver",
    ),
]
Step = Annotated[
    float | None,
    typer.Option(metavar="MS", help="Length of all steps of RK4.", rich_help_panel="Solver"),
]
Rtol = Annotated[
    float | None,
    typer.Option(
        help="Relative tolerance. Default: 1e-8 for BDF, else 1e-6.", rich_help_panel="Solver"
    ),
]
Atol = Annotated[
    float | None,
    typer.Option(
        help="Absolute tolerance, SI units. Default: 1e-10 for BDF, else 1e-9.",
        rich_help_panel="Solver",
    ),
]
MaxStep = Annotated[
    float | None,
    typer.Option(metavar="MS", help="Longest step. Default: no limit.", rich_help_panel="Solver"),
]
MaxSteps = Annotated[
    int, typer.Option(help="More steps than these end with an error.", rich_help_panel="Solver")
]
