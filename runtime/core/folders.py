"""Where this program keeps things between two runs."""

import os
from pathlib import Path

from platformdirs import user_cache_path

VARIABLE = "KINTRAFO_CACHE"
"""Environment variable that names another folder."""


def cache_folder() -> Path:
    """Return the folder of what is kept, which need not exist.

    Compiled mechanisms are in it, and `kintrafo.core.written` notes there which files were written.
    """
    named = os.environ.get(VARIABLE)
    return Path(named) if named else user_cache_path("kintrafo")
