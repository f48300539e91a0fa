"""A golden set: the numbers of every analysis of every packaged vehicle part, stored.

It is for changes that move code and must not change a number. `analyses` computes, `values` holds
one file a subject, and ``make golden`` stores or compares.
"""
