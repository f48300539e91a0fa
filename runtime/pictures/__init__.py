"""Pictures of any mechanism.

`figures`    how all figures look, and how they are written
`curves`     variables of a dataset, each in a panel
`labels`     names of curves beside them
`animation`  a motion as an animated picture
"""
