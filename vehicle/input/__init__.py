"""Input data: what a person writes about a suspension, and the checks that it passes."""
