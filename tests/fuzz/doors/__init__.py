"""One module for each door; `fuzz.attempts` says what is in it."""
