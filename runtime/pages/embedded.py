"""Data inside of a page."""

import json
from typing import Any


def embedded(data: Any) -> str:
    r"""Return data as JSON that is safe in an element of a page, for any texts.

    ``</script>`` in a text would end the element that holds the data, and ``<!--`` with
    ``<script`` would keep its own end from being one. So no ``<`` is left.

    Examples
    --------
    >>> print(embedded({"meaning": "<!-- <script>"}))
    {"meaning": "\u003c!-- \u003cscript>"}
    """
    return json.dumps(data, ensure_ascii=False, allow_nan=False).replace("<", "\\u003c")
