"""HTML pages of any mechanism.

`mechanism`  its position and motion, in a page
`animation`  a motion as a page, or as an animated picture
`embedded`   data in a page
"""
