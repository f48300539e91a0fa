"""The plan of a model, with the catalogue of this project."""

from typing import ClassVar

from ..closed_forms.catalogue import CATALOGUE
from ..loops import planner
from ..loops.forms import Catalogue


class CataloguePlan(planner.Plan):
    """The order of solution of a model."""

    catalogue: ClassVar[Catalogue] = CATALOGUE
