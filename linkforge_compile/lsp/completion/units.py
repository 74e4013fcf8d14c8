"""Complete the unit of a number."""

from __future__ import annotations

import re

from linkforge_compile.listing import ListedParameter
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.items import REQUIRED, Kind, Offer
from linkforge_compile.syntax import YamlScalar
from linkforge_compile.units import UNITS, Dimension, units_of

_NUMBER = re.compile(r"\s*[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?P<space>\s*)(?P<unit>[A-Za-zµμ°][^\s]*)?")
_SI_UNITS = re.compile(r"number \[([^]]+)\]")
"""The SI units of a bare number in the message of a schema: "kg", or "N*m or N"."""

_TURNING, _SLIDING = ("revolute", "continuous"), ("prismatic",)


def offer_units(context: Context, parameter: ListedParameter | None) -> list[Offer]:
    """Return the units of the dimensions that a number here may have; `parameter` is the one that it is a value of."""
    number = _NUMBER.fullmatch(context.cursor.before)
    if number is None:
        return []
    typed, gap = number["unit"] or "", "" if number["space"] or number["unit"] else " "
    begin = context.column - len(typed)
    return [
        Offer(unit, gap + unit, Kind.Unit, REQUIRED, dimension.replace("_", " "), begin=begin, sought=gap + unit)
        for dimension in _dimensions(context, parameter)
        for unit in units_of(dimension)
    ]


def _dimensions(context: Context, parameter: ListedParameter | None) -> list[Dimension]:
    path = context.cursor.path
    type_ = parameter.type if parameter else None
    if path[:1] == ("parameters",):
        type_ = context.text_around.get("type")
    if type_ in list(Dimension):
        return [Dimension(type_)]
    messages = (str(branch.schema.get("patternErrorMessage")) for branch in context.branches)
    units = next((found[1].split(" or ") for message in messages if (found := _SI_UNITS.search(message))), [])
    dimensions = [UNITS[unit].dimension for unit in units if unit in UNITS]
    if len(dimensions) <= 1:
        return dimensions
    # The schema names the dimension of a joint that turns first.
    moving = _type_of_joint(context)
    return dimensions[:1] if moving in _TURNING else dimensions[1:] if moving in _SLIDING else dimensions


def _type_of_joint(context: Context) -> str:
    path = context.cursor.path
    if path[:1] == ("joints",):
        type_ = context.node((*path[:2], "type"))
        return type_.text if isinstance(type_, YamlScalar) else ""
    joints = context.robot.joints if context.robot else ()
    named = (joint for joint in joints if joint.name in path)
    return next((str(joint.type) for joint in named), "")
