"""Cars that come with the project."""
