"""The same MacPherson suspension in other tools, shown to agree with the reference, then timed.

``make benchmark-peers`` runs everything, with ``tests`` on the path: the independent reference
there judges the agreement. A peer that is not installed is skipped, a peer that disagrees is not
timed.
"""

import sys

# Exudyn reads this at its import: the module without range checks.
sys.exudynFast = True
