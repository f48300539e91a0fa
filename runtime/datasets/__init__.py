"""Results as labelled datasets, and datasets as files.

`recording`   a simulation as a dataset over time, and its statistics
`export`      datasets as files: CSV, Excel, netCDF, Parquet
`workbook`    workbooks of Excel
"""
