"""Load cards, read by their columns and commas: written from the manuals, not from our writer."""

import numpy as np


def nastran(path):
    """Return nodes, and by the number of a case the node, force and moment of each load.

    Wide fields: eight columns, four of sixteen, and eight of which nothing is used.
    """
    cards = []
    for line in path.read_bytes().decode("ascii").splitlines():
        if line.startswith("$"):
            continue
        assert len(line) <= 72, line
        fields = [line[begin : begin + 16].strip() for begin in range(8, 72, 16)]
        if line[:8].strip() == "*":
            cards[-1] += fields
        else:
            assert line[:8].strip().endswith("*")
            cards.append([line[:8].strip(" *"), *fields])
    nodes = {}
    loads = {}
    for name, *fields in cards:
        if name == "CORD2R":
            system, onto, *points = fields
            assert onto == "0"
            assert [*map(float, points[:9])] == [0.0] * 3 + [0.0, 0.0, 1.0] + [1.0, 0.0, 0.0]
        elif name == "GRID":
            assert fields[1] == fields[5] == system
            assert int(fields[0]) not in nodes
            nodes[int(fields[0])] = np.array(fields[2:5], dtype=float)
        else:
            case, node, axes, factor, *vector = fields
            assert axes == system
            found = np.zeros((2, 3))
            values = float(factor) * np.array(vector[:3], dtype=float)
            found[["FORCE", "MOMENT"].index(name)] = values
            loads.setdefault(case, []).append((int(node), *found))
    return nodes, loads


def abaqus(path):
    """Return the same of keywords, by the names of the steps."""
    nodes, sets, loads = {}, {}, {}
    step = keyword = label = ""
    for line in path.read_bytes().decode("ascii").splitlines():
        if line.startswith("**"):
            continue
        fields = [field.strip() for field in line.split(",")]
        if line.startswith("*"):
            keyword, label = fields[0].lower(), fields[-1].partition("=")[2].strip('"')
            if keyword == "*step":
                step = label
                assert step not in loads
                loads[step] = []
        elif keyword == "*node":
            assert label not in sets
            sets[label] = int(fields[0])
            nodes[int(fields[0])] = np.array(fields[1:], dtype=float)
        elif keyword == "*cload":
            found = np.zeros(6)
            found[int(fields[1]) - 1] = float(fields[2])
            loads[step].append((sets[fields[0].strip('"')], found[:3], found[3:]))
        else:  # axes: those of the model
            assert keyword in ("*system", "*transform")
            axes = [*map(float, fields)]
            assert axes in ([0, 0, 0, 1, 0, 0], [0, 1, 0], [1, 0, 0, 0, 1, 0])
    return nodes, loads


READERS = {".bdf": nastran, ".inp": abaqus}


def wrenches(path):
    """Return the sum of forces, and of moments about the origin, by cases, (6,)."""
    nodes, loads = READERS[path.suffix](path)
    return {
        case: sum(
            (
                np.concatenate([force, moment + np.cross(nodes[node], force)])
                for node, force, moment in own
            ),
            np.zeros(6),
        )
        for case, own in loads.items()
    }


def wrench(chosen):
    """Return the sums of forces, and of moments about the origin, of some loads: (..., 6)."""
    force, moment, at = (chosen[name].values for name in ("force", "moment", "at"))
    return np.concatenate([force.sum(-2), (moment + np.cross(at, force)).sum(-2)], axis=-1)
