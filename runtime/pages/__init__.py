"""HTML pages of any mechanism."""
