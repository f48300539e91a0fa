"""Groups of characteristics on a page of the report or in a figure."""

from collections.abc import Hashable

OTHER = "Further characteristics"

# In the order in which they are shown. The group of a name is that of its longest prefix here, so
# that quantities that are added later have a group.
_PREFIXES = {
    "Wheel angles": ("camber", "toe", "steer", "bump_steer", "spin_axis"),
    "Steering axis": (
        "caster", "kingpin", "trail", "hub_trail", "mechanical_trail", "scrub", "spindle",
        "steering_axis",
    ),
    "Wheel path": (
        "half_track", "track", "inclination", "wheelbase", "contact", "wheel_center", "wheel_path",
        "arm_",
    ),
    "Springs and rates": (
        "motion_ratio", "spring", "damper", "strut", "wheel_rate", "contact_rate", "ride_", "tyre",
        "wheel_force", "wheel_load", "bar_", "link_", "roll_stiffness", "roll_moment",
    ),
    "Steering": (
        "steer_", "steering_wheel", "rack", "ackermann", "turning", "steering_ratio",
        "steering_gradient",
    ),
    "Roll and pitch centres": (
        "roll_", "jacking", "swing_arm", "side_view", "instant", "anti_", "pitch",
    ),
}  # fmt: skip

ORDER = (*_PREFIXES, OTHER)


def group_of(name: Hashable) -> str:
    """Return the group of a characteristic over wheel travel, one of `ORDER`.

    Examples
    --------
    >>> group_of("caster_gradient"), group_of("lateral_something")
    ('Steering axis', 'Further characteristics')
    """
    fitting = [
        (len(prefix), group)
        for group, prefixes in _PREFIXES.items()
        for prefix in prefixes
        if str(name).startswith(prefix)
    ]
    return max(fitting, default=(0, OTHER))[1]
