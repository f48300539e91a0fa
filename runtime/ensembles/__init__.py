"""Many cars at once, each with parameters, start and inputs of its own.

`ensemble`    the function that a person calls
`variants`    what each system has of its own
`drives`      what inputs do over time
`wanted`      signals and reductions that are kept, and the bounds that are watched
`series`      percentiles and spectra of whole series
`again`       systems that an explicit method cannot do
`collected`   what stays of systems as soon as they are done
`pieces`      some thousand at a time, by workers elsewhere, and kept
`results`     a labelled dataset of what came of it
"""

from .ensemble import ensemble

__all__ = ["ensemble"]
