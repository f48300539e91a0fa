"""The same MacPherson suspension in other tools, shown to agree with the reference, then timed.

``python -m benchmarks.peers --out out/benchmark`` runs everything. A peer that is not installed is
skipped, a peer that disagrees is not timed.

Run by ``make benchmark-peers``, which puts ``tests`` on the path: the agreement of all tools is judged
by the independent reference there.
"""
