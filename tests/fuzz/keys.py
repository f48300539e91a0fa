"""Keys of files as people misspell them, and nested data with one key more or another."""

from copy import deepcopy


def places(data, above=()):
    """Yield the places of all keys, of parts too."""
    for key, value in data.items():
        yield (*above, key)
        if isinstance(value, dict):
            yield from places(value, (*above, key))


def respelt(random, key):
    """Return another spelling of a key: in capitals or not, a letter less or more, a mark."""
    at = int(random.integers(len(key)))
    other = {
        "case": key.swapcase(),
        "lower": key.lower(),
        "lost": key[:at] + key[at + 1 :] if len(key) > 3 else key.upper(),
        "doubled": key[:at] + key[at] + key[at:],
        "mark": key.replace(" ", "_") if " " in key else f"{key}_",
        "blank": f"{key} ",
    }
    found = other[str(random.choice(list(other)))]
    return found if found != key else f"{key}:"


def without(data, place):
    """Return data without a key, and the value that it had."""
    found = deepcopy(data)
    return found, holder_of(found, place).pop(place[-1])


def holder_of(data, place):
    """Return the part that a key stands in."""
    for key in place[:-1]:
        data = data[key]
    return data
