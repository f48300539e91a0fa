"""What every floor above needs: errors, arguments, files, words.

`errors`       the errors of this package
`arguments`    what a person passes to a function: checked, with a message for each error
`suggestions`  what was probably meant
`optional`     packages of an extra, and what to say where they are missing
`quantities`   names, units and signs of what is shown
`legible`      texts of others, made harmless before they are shown
`physical`     what the parameters of a mechanism can be
`memory`       how much there is, before it is taken
`interrupts`   Ctrl-C: none is lost, and nothing is left half done
`files`        writing a file as a whole, and replacing only those of this program
`folders`      where things are kept between two runs
`written`      which files this program wrote
"""
