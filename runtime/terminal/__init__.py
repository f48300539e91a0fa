"""What any command line prints, and how it ends.

`console`  results on stdout, everything else on stderr
`exits`    messages and exit codes
`usage`    mistakes in the arguments of a command
"""
