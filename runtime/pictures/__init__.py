"""Pictures of any mechanism."""
