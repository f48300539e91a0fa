"""Subsystems of Adams/Car, written from suspensions of kintrafo: its axes, units and names."""

from kintrafo.vehicle.kinds import KINDS

# What the templates call the points, by kind and our names.
STRUT = {"arm_front": "lca_front", "arm_rear": "lca_rear", "ball_joint": "lca_outer",
         "strut_top": "top_mount", "strut_lower": "strut_lwr_mount",
         "spring_seat": "spring_lwr_seat", "tie_rod_outer": "tierod_outer",
         "tie_rod_inner": "tierod_inner"}  # fmt: skip
WISHBONES = {"lower_arm_front": "lca_front", "lower_arm_rear": "lca_rear",
             "lower_ball_joint": "lca_outer", "upper_arm_front": "uca_front",
             "upper_arm_rear": "uca_rear", "upper_ball_joint": "uca_outer",
             "tie_rod_outer": "tierod_outer", "tie_rod_inner": "tierod_inner"}  # fmt: skip
ROCKER = {
    "rocker_front": "bellcrank_pivot_orient",
    "rocker_rear": "bellcrank_pivot",
    "spring_top": "shock_to_chassis",
    "spring_seat": "shock_to_bellcrank",
}
NAMES = {
    "macpherson": STRUT,
    "double_wishbone": {**WISHBONES, "spring_top": "top_mount", "spring_seat": "lwr_strut_mount"},
    "push_rod": {**WISHBONES, **ROCKER, "push_rod_outer": "prod_outboard",
                 "push_rod_inner": "prod_to_bellcrank"},
    "pull_rod": {**WISHBONES, **ROCKER, "pull_rod_outer": "prod_outer",
                 "pull_rod_inner": "prod_inboard"},
    "multi_link": {"tie_rod_outer": "tierod_outer", "tie_rod_inner": "tierod_inner"},
    "trailing_arm": {},
}  # fmt: skip
MILLIMETRES = {"mm": 1.0, "meter": 1000.0, "inch": 25.4, "cm": 10.0}


def kind_of(car):
    return next(name for name, kind in KINDS.items() if type(car) is kind)


def rows_of(car, unit="mm", symmetry=None):
    """Return the rows of a car's hardpoints; those for both sides are of the left one."""
    named = NAMES[kind_of(car)]
    rows = []
    for ours in car.hardpoints.given():
        sides = symmetry(ours) if symmetry else "left/right"
        x, y, z = 1000.0 * car.hardpoints.metres(ours) / MILLIMETRES[unit]
        mirrored = sides == "left/right" and car.vehicle.side == "right"
        rows.append((named.get(ours, ours), sides, -x, y if mirrored else -y, z))
    return rows


def table(rows):
    return "".join(
        f" '{name:<24}'  '{sides:<10}'  {x!r}  {y!r}  {z!r}\n"
        for name, sides, x, y, z in ((n, s, float(x), float(y), float(z)) for n, s, x, y, z in rows)
    )


HEAD = """\
$---------------------------------------------------------------------MDI_HEADER
[MDI_HEADER]
 FILE_TYPE     =  'sub'
 FILE_VERSION  =  4.0
 FILE_FORMAT   =  'ASCII'
(COMMENTS)
{comment_string}
'a suspension of nobody'
$---------------------------------------------------------------SUBSYSTEM_HEADER
[SUBSYSTEM_HEADER]
 TEMPLATE_NAME  =  '<own>/templates.tbl/_own.tpl'
 MAJOR_ROLE     =  'suspension'
 MINOR_ROLE     =  'front'
"""


def subsystem(car, *, unit="mm", rows=None, more=""):
    """Return the text of a subsystem with the hardpoints, camber and toe of a car."""
    wheel = car.wheel
    return f"""\
{HEAD}$--------------------------------------------------------------------------UNITS
[UNITS]
 LENGTH  =  '{unit}'
 FORCE   =  'newton'
 ANGLE   =  'degrees'
 MASS    =  'kg'
 TIME    =  'second'
$----------------------------------------------------------------------HARDPOINT
[HARDPOINT]
{{hardpoint_name             symmetry       x_value    y_value    z_value}}
{table(rows_of(car, unit) if rows is None else rows)}\
$----------------------------------------------------------------------PARAMETER
[PARAMETER]
{{parameter_name             symmetry       type       value}}
 'camber_angle            '  'left/right'  'real'     {wheel.camber_deg!r}
 'toe_angle               '  'left/right'  'real'     {wheel.toe_deg!r}
 'kinematic_flag          '  'single    '  'integer'  0
{more}"""
