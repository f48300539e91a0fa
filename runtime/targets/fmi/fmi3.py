"""The model description and the build description of FMI 3.0."""

from collections.abc import Sequence
from importlib.metadata import version
from xml.etree import ElementTree as ET

from .description import ModelDescription, Variable
from .xml import described, element, log_categories, text_of, unit_definitions, values_of

VERSION = 3
FRONT = "fmi3.c"
FOLDERS = {"linux": "x86_64-linux", "windows": "x86_64-windows"}
"""Folders of libraries."""


def model_description(known: ModelDescription, sources: Sequence[str]) -> str:
    """Return ``modelDescription.xml``; the build description has the `sources`."""
    del sources
    root = ET.Element(
        "fmiModelDescription",
        {
            "fmiVersion": "3.0",
            "modelName": known.identifier,
            "instantiationToken": known.token(VERSION),
            "description": known.emitted.title,
            "generationTool": f"kintrafo {version('kintrafo')}",
            "variableNamingConvention": "structured",
        },
    )
    both = {
        "modelIdentifier": known.identifier,
        "canGetAndSetFMUState": "true",
        "canSerializeFMUState": "true",
        "providesDirectionalDerivatives": "true",
        "providesAdjointDerivatives": "true",
    }
    element(root, "ModelExchange", {**both, "needsCompletedIntegratorStep": "true"})
    element(root, "CoSimulation", both | {"canHandleVariableCommunicationStepSize": "true"})
    unit_definitions(root, known.variables)
    log_categories(root)
    element(root, "DefaultExperiment", {"startTime": "0.0", "stopTime": "1.0", "tolerance": "1e-6"})
    variables = ET.SubElement(root, "ModelVariables")
    for variable in known.variables:
        _variable(variables, variable)
    _structure(root, known)
    return text_of(root)


def _variable(parent: ET.Element, variable: Variable) -> None:
    derivative = {"derivative": variable.derivative_of}
    element(parent, "Float64", {**described(variable), **values_of(variable), **derivative})


def _structure(root: ET.Element, known: ModelDescription) -> None:
    """Add the computed variables with their dependencies, which some importers require."""
    structure = ET.SubElement(root, "ModelStructure")
    moving = " ".join(str(v.reference) for v in (*known.states, *known.inputs))
    fixed = " ".join(str(v.reference) for v in known.parameters)
    for tag, listed in (
        ("Output", known.outputs),
        ("ContinuousStateDerivative", known.rates),
        ("InitialUnknown", [*known.outputs, *known.rates]),
        ("EventIndicator", known.events),
    ):
        text = f"{moving} {fixed}" if tag == "InitialUnknown" else moving
        for variable in listed:
            row = element(structure, tag, {"valueReference": variable.reference})
            row.set("dependencies", text.strip())


def build_description(known: ModelDescription, sources: Sequence[str]) -> str:
    """Return ``sources/buildDescription.xml``, with the names of the C files."""
    root = ET.Element("fmiBuildDescription", {"fmiVersion": "3.0"})
    made = element(root, "BuildConfiguration", {"modelIdentifier": known.identifier})
    files = element(made, "SourceFileSet", {"language": "C11"})
    for name in sources:
        element(files, "SourceFile", {"name": name})
    element(made, "Library", {"name": "m"})
    return text_of(root)
