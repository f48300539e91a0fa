"""Bodies in motion: poses, twists, bias accelerations."""
