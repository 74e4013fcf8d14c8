"""Quantities: numbers that know their dimension, the units people write them in, and numbers as text."""

from linkforge_compile.units.numbers import double_text, is_in_full, number_text
from linkforge_compile.units.quantity import WIDEST_ANGLE, Dimension, Quantity
from linkforge_compile.units.table import UNITS, Unit, parse_quantity, spellings_of, unit_meant, unit_text, units_of

__all__ = [
    "UNITS",
    "WIDEST_ANGLE",
    "Dimension",
    "Quantity",
    "Unit",
    "double_text",
    "is_in_full",
    "number_text",
    "parse_quantity",
    "spellings_of",
    "unit_meant",
    "unit_text",
    "units_of",
]
