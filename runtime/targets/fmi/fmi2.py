"""The model description of FMI 2.0."""

from collections.abc import Sequence
from importlib.metadata import version
from xml.etree import ElementTree as ET

from .description import ModelDescription, Variable
from .xml import described, element, log_categories, text_of, unit_definitions, values_of

VERSION = 2
FRONT = "fmi2.c"
FOLDERS = {"linux": "linux64", "windows": "win64"}
"""Folders of libraries."""


def model_description(known: ModelDescription, sources: Sequence[str]) -> str:
    """Return ``modelDescription.xml``, with the names of the C files."""
    root = ET.Element(
        "fmiModelDescription",
        {
            "fmiVersion": "2.0",
            "modelName": known.identifier,
            "guid": known.token(VERSION),
            "description": known.emitted.title,
            "generationTool": f"kintrafo {version('kintrafo')}",
            "variableNamingConvention": "structured",
            "numberOfEventIndicators": str(len(known.crossings)),
        },
    )
    both = {
        "modelIdentifier": known.identifier,
        "canNotUseMemoryManagementFunctions": "true",
        "canGetAndSetFMUstate": "true",
        "canSerializeFMUstate": "true",
        "providesDirectionalDerivative": "true",
    }
    steps = {"canHandleVariableCommunicationStepSize": "true", "canInterpolateInputs": "true"}
    for tag, more in (("ModelExchange", {}), ("CoSimulation", steps)):
        listed = ET.SubElement(element(root, tag, both | more), "SourceFiles")
        for name in sources:
            element(listed, "File", {"name": name})
    unit_definitions(root, known.variables)
    log_categories(root)
    element(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": "1.0", "tolerance": "1e-6"})
    variables = ET.SubElement(root, "ModelVariables")
    for variable in known.variables:
        _variable(variables, variable)
    _structure(root, known)
    return text_of(root)


def _variable(parent: ET.Element, variable: Variable) -> None:
    scalar = element(parent, "ScalarVariable", described(variable))
    source = variable.derivative_of
    derivative = None if source is None else source + 1
    element(scalar, "Real", {**values_of(variable), "derivative": derivative})


def _structure(root: ET.Element, known: ModelDescription) -> None:
    """Add the computed variables, by indices from 1."""
    structure = ET.SubElement(root, "ModelStructure")
    unknowns = sorted([*known.outputs, *known.rates], key=lambda v: v.reference)
    for tag, listed in (
        ("Outputs", known.outputs),
        ("Derivatives", known.rates),
        ("InitialUnknowns", unknowns),
    ):
        if listed:
            part = ET.SubElement(structure, tag)
            for variable in listed:
                element(part, "Unknown", {"index": variable.reference + 1})
