"""Files of suspensions and axles, and of other programs.

`loading`    files of any assembly
`schema`     the input file's JSON Schema and its reference page
`point_table`        hardpoints as a table
`chrono`, `adams_car`    suspensions of Project Chrono and of Adams/Car
`fitting`    hardpoints of another car in a file
"""
