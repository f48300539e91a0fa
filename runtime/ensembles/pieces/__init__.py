"""An ensemble in pieces of thousands of systems: on other machines, and kept until all are done.

`piece`      some of the systems, and what was found of them
`cutting`    which systems go together
`whole`      all pieces: by threads of this process, or by workers
`workers`    where the workers are: processes of this machine, or those of a scheduler
`queue`      pieces that are handed to workers, and what comes back
`kept`       a folder with what was found
`identity`   what an ensemble is known by
`versions`   what numbers depend on besides its arguments
"""
