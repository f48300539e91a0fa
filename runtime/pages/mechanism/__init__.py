"""Pages of any mechanism: a report to move by hand, and a motion to play."""
