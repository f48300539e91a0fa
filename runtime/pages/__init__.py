"""HTML pages of any mechanism.

`mechanism`  how it stands and moves, in a page
`animation`  a motion as a page, or as an animated picture
`embedded`   data in a page
"""
