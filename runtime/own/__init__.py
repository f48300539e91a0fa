"""A user's own mechanism: derived, compiled and loaded outside of the source tree."""
