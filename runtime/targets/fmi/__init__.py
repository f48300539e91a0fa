"""What a functional mock-up unit is made of.

`description`  its variables, for any version of FMI
`units`        SI units as powers of base units
`fmi2`, `fmi3` the model description and build description of a version
`crossings`    zero crossings that are events
`files`        the C files of any unit, and the mark of a library
`tables`       the C files of one model
`sources`      all C that it is compiled from
`binaries`     its shared libraries, for each platform
`core`         hand-written C: an instance, derivatives, steps, and a front for each version
`headers`      those of the FMI standard
"""
