"""Small damage to bytes, texts and nested data, as slips of the hand and broken disks do it."""

from copy import deepcopy

NUMBERS = (
    0, -1, 1, 1e-300, 1e300, -1e300, float("nan"), float("inf"), 10**30, 10**400, True, 5e-324,
)  # fmt: skip
VALUES = (*NUMBERS, None, "", "x", "1", [], {}, [1.0], [1.0, 2.0, 3.0, 4.0], {"x": 1.0}, "\ud800")
PIECES = (
    b"\x00", b"\xff", b"\xef\xbb\xbf", b"\r", b"\n", b'"', b"'", b"\\", b"[", b"]", b"{", b"}",
    b"#", b"//", b"/*", b"*/", b",", b";", b"\t", b".", b"=", b"-", b"e9", b"1e999", b"nan", b"inf",
    b"9" * 5000, b"[" * 3000, b'{"a":' * 3000, b'"""', b"a." * 3000, b'\\"' * 3000, b"/*" * 3000,
    "é中\u2028".encode(), b"1_000", b"0x1F", b"1979-05-27",
)  # fmt: skip


def bytes_of(random, content):
    """Return bytes with one to three changes: cut, lost, doubled, changed, put in."""
    for _ in range(random.integers(1, 4)):
        start, end = sorted(random.integers(0, len(content) + 1, 2).tolist())
        end = min(end, start + int(random.integers(1, 40)))
        piece = content[start:end]
        new = {
            "cut off": content[:start],
            "lost": content[:start] + content[end:],
            "doubled": content[:end] + piece + content[end:],
            "changed": content[:start] + random.bytes(len(piece)) + content[end:],
            "put in": content[:start] + PIECES[random.integers(len(PIECES))] + content[start:],
            "instead": content[:start] + PIECES[random.integers(len(PIECES))] + content[end:],
        }
        content = new[str(random.choice(list(new), p=[0.04, 0.2, 0.16, 0.2, 0.2, 0.2]))]
    return content


def nested(random, data, extra=()):
    """Return nested data with one to three changes: values, keys that are lost, new or misspelt."""
    changed = deepcopy(data)
    for _ in range(random.integers(1, 4)):
        holder = changed
        while True:
            keys = list(holder) if isinstance(holder, dict) else list(range(len(holder)))
            if not keys:
                break
            key = keys[random.integers(len(keys))]
            inner = holder[key]
            if isinstance(inner, dict | list) and inner and random.random() < 0.85:
                holder = inner
                continue
            _change(random, holder, key, (*VALUES, *extra))
            break
    return changed


def _change(random, holder, key, values):
    """Change one entry of a table or a list."""
    value = holder[key]
    number = isinstance(value, int | float) and not isinstance(value, bool)
    how = random.random()
    if number and how < 0.5:
        try:
            holder[key] = value * float(random.normal(1.0, 0.3)) + float(random.normal(0.0, 0.01))
        except OverflowError:
            holder[key] = 0.0
    elif how < 0.75:
        holder[key] = deepcopy(values[random.integers(len(values))])
    elif how < 0.9:
        del holder[key]
    elif isinstance(holder, dict):
        holder[f"{key}_"] = holder.pop(key)
    else:
        holder.insert(int(key), value)
