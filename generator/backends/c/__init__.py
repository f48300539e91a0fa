"""C99: header and sources."""
