"""The mechanisms that come with the project, each declared on a page of its own."""

from . import macpherson

MODELS = macpherson.MODELS
