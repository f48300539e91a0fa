"""Tools of tests: compiled models, changed declarations, emitted text, messages, browsers."""
