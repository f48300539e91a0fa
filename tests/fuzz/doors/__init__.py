"""One module for each door; `fuzz.attempts` describes its contents."""
