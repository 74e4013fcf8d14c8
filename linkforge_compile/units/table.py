"""Units of the language, and parsing of quantities such as `90 deg`."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from linkforge_compile.units.quantity import Dimension, Quantity

_Ratio: TypeAlias = tuple[int, int]
"""Numerator and denominator; importing `fractions` would take longer than all the arithmetic here."""

_INCH: _Ratio = (254, 10_000)
_POUND: _Ratio = (45_359_237, 100_000_000)
_STANDARD_GRAVITY: _Ratio = (980_665, 100_000)


@dataclass(frozen=True)
class Unit:
    """A unit and its size in SI units: `numerator / denominator`, times pi where `per_pi` is set."""

    name: str
    dimension: Dimension
    numerator: int
    denominator: int
    per_pi: bool = False

    def to_si(self, digits: str) -> float:
        """Convert the number written as `digits` to SI units; infinite if it is beyond a double.

        Decimal units are converted exactly and rounded once, so `25 mm` is the double nearest to 0.025, not
        25 * 0.001. Angles use the same product as `radians()`, so `30 deg` equals `radians(30)`.
        """
        if self.per_pi:
            return float(digits) * (math.pi * self.numerator / self.denominator)
        significand, _, exponent = digits.lower().partition("e")
        whole, _, decimals = significand.partition(".")
        power = int(exponent or 0) - len(decimals)
        tens: int = 10 ** abs(power)
        over, under = int(whole + decimals) * self.numerator, self.denominator
        try:
            # Dividing integers gives the nearest double, however long they are.
            return over * tens / under if power > 0 else over / (under * tens)
        except OverflowError:
            return -math.inf if over < 0 else math.inf


def _unit(name: str, dimension: Dimension, *factors: int | _Ratio, per_pi: bool = False) -> Unit:
    ratios = [(factor, 1) if isinstance(factor, int) else factor for factor in factors]
    return Unit(name, dimension, math.prod(over for over, _ in ratios), math.prod(under for _, under in ratios), per_pi)


_D = Dimension
_TABLE = (
    _unit("m", _D.LENGTH),
    _unit("cm", _D.LENGTH, (1, 100)),
    _unit("mm", _D.LENGTH, (1, 1000)),
    _unit("um", _D.LENGTH, (1, 1_000_000)),
    _unit("km", _D.LENGTH, 1000),
    _unit("in", _D.LENGTH, _INCH),
    _unit("ft", _D.LENGTH, 12, _INCH),
    _unit("rad", _D.ANGLE),
    _unit("mrad", _D.ANGLE, (1, 1000)),
    _unit("deg", _D.ANGLE, (1, 180), per_pi=True),
    _unit("rev", _D.ANGLE, 2, per_pi=True),
    _unit("kg", _D.MASS),
    _unit("g", _D.MASS, (1, 1000)),
    _unit("mg", _D.MASS, (1, 1_000_000)),
    _unit("t", _D.MASS, 1000),
    _unit("lb", _D.MASS, _POUND),
    _unit("s", _D.TIME),
    _unit("ms", _D.TIME, (1, 1000)),
    _unit("us", _D.TIME, (1, 1_000_000)),
    _unit("min", _D.TIME, 60),
    _unit("Hz", _D.FREQUENCY),
    _unit("kHz", _D.FREQUENCY, 1000),
    _unit("MHz", _D.FREQUENCY, 1_000_000),
    _unit("N", _D.FORCE),
    _unit("mN", _D.FORCE, (1, 1000)),
    _unit("kN", _D.FORCE, 1000),
    _unit("kgf", _D.FORCE, _STANDARD_GRAVITY),
    _unit("lbf", _D.FORCE, _POUND, _STANDARD_GRAVITY),
    _unit("N*m", _D.TORQUE),
    _unit("mN*m", _D.TORQUE, (1, 1000)),
    _unit("N*mm", _D.TORQUE, (1, 1000)),
    _unit("N*cm", _D.TORQUE, (1, 100)),
    _unit("kN*m", _D.TORQUE, 1000),
    _unit("kgf*cm", _D.TORQUE, _STANDARD_GRAVITY, (1, 100)),
    _unit("kgf*m", _D.TORQUE, _STANDARD_GRAVITY),
    _unit("lbf*in", _D.TORQUE, _POUND, _STANDARD_GRAVITY, _INCH),
    _unit("lbf*ft", _D.TORQUE, _POUND, _STANDARD_GRAVITY, 12, _INCH),
    _unit("m/s", _D.VELOCITY),
    _unit("cm/s", _D.VELOCITY, (1, 100)),
    _unit("mm/s", _D.VELOCITY, (1, 1000)),
    _unit("km/h", _D.VELOCITY, (1000, 3600)),
    _unit("rad/s", _D.ANGULAR_VELOCITY),
    _unit("deg/s", _D.ANGULAR_VELOCITY, (1, 180), per_pi=True),
    _unit("rpm", _D.ANGULAR_VELOCITY, (1, 30), per_pi=True),
    _unit("rev/s", _D.ANGULAR_VELOCITY, 2, per_pi=True),
    _unit("kg/m^3", _D.DENSITY),
    _unit("g/cm^3", _D.DENSITY, 1000),
    _unit("kg*m^2", _D.INERTIA),
    _unit("kg*cm^2", _D.INERTIA, (1, 10_000)),
    _unit("g*cm^2", _D.INERTIA, (1, 10_000_000)),
    _unit("kg*mm^2", _D.INERTIA, (1, 1_000_000)),
    _unit("g*mm^2", _D.INERTIA, (1, 1_000_000_000)),
    _unit("m/s^2", _D.ACCELERATION),
    _unit("mm/s^2", _D.ACCELERATION, (1, 1000)),
    _unit("rad/s^2", _D.ANGULAR_ACCELERATION),
    _unit("deg/s^2", _D.ANGULAR_ACCELERATION, (1, 180), per_pi=True),
    _unit("m/s^3", _D.JERK),
    _unit("mm/s^3", _D.JERK, (1, 1000)),
    _unit("rad/s^3", _D.ANGULAR_JERK),
    _unit("deg/s^3", _D.ANGULAR_JERK, (1, 180), per_pi=True),
)

UNITS: dict[str, Unit] = {unit.name: unit for unit in _TABLE}
"""The units by the name that messages use."""

_SPELLINGS = {
    "Nm": "N*m",
    "mNm": "mN*m",
    "Nmm": "N*mm",
    "Ncm": "N*cm",
    "kNm": "kN*m",
    "µm": "um",
    "μm": "um",
    "°": "deg",
}
"""Other accepted spellings; products may also be written with a dot, powers as superscripts."""

_WORDS = {
    "deg": ("degree", "degrees", "degs", "\u00ba", "\u02da"),  # an ordinal indicator and a ring, which look like °
    "rad": ("radian", "radians"),
    "mrad": ("milliradian", "milliradians"),
    "rev": ("turn", "turns", "revolution", "revolutions"),
    "m": ("meter", "meters", "metre", "metres"),
    "cm": ("centimeter", "centimeters", "centimetre", "centimetres"),
    "mm": ("millimeter", "millimeters", "millimetre", "millimetres"),
    "um": ("micrometer", "micrometers", "micrometre", "micrometres", "micron", "microns"),
    "km": ("kilometer", "kilometers", "kilometre", "kilometres"),
    "in": ("inch", "inches"),
    "ft": ("foot", "feet"),
    "kg": ("kilogram", "kilograms", "kilogramme", "kilogrammes", "kilo", "kilos", "kgs", "Kg", "KG"),
    "g": ("gram", "grams", "gramme", "grammes", "gr"),
    "mg": ("milligram", "milligrams"),
    "t": ("tonne", "tonnes"),
    "lb": ("lbs", "pound", "pounds"),
    "s": ("sec", "secs", "second", "seconds"),
    "ms": ("msec", "millisecond", "milliseconds"),
    "us": ("usec", "microsecond", "microseconds"),
    "min": ("minute", "minutes"),
    "Hz": ("hz", "hertz", "Hertz", "HZ", "fps", "FPS"),
    "kHz": ("kilohertz",),
    "MHz": ("megahertz",),
    "N": ("newton", "newtons", "Newton", "Newtons"),
    "mN": ("millinewton", "millinewtons"),
    "kN": ("kilonewton", "kilonewtons"),
    "N*m": ("nm", "NM", "N-m", "Newton-meter", "newton-meter", "newton-metre"),
    "kgf*cm": ("kg*cm", "kg-cm", "kgcm"),
    "m/s": ("mps", "m/sec"),
    "rad/s": ("rad/sec", "radians/s", "radians/sec", "rads"),
    "deg/s": ("deg/sec", "degrees/s", "degrees/sec", "°/s", "°/sec", "dps"),
    "rpm": ("RPM", "rev/min"),
    "kg*m^2": ("kgm2", "kgm^2", "kg*m2"),
    "g*mm^2": ("gmm2", "gmm^2", "g*mm2"),
}
_UNITS_BY_WORD = {word: UNITS[name] for name, words in _WORDS.items() for word in words}
"""Words that are not accepted for a unit, but for which messages suggest it."""

_SHORTEST_MISSPELT = 5
_LONGEST_MISSPELT = 20
_LEAST_LIKENESS = 0.82
"""By difflib's ratio: `radain` is `radian`, but `grads` are not `grams`."""
_MOST_APART = 1.1
"""Letters of a word that differ: `degress` is `degrees`, but `milliampere` is not `millimeter`."""

# The number of digits is bounded: the integer 1e999999999 would fill the memory.
_QUANTITY = re.compile(
    r"([+-]?(?:[0-9]{1,400}(?:\.[0-9]{0,400})?|\.[0-9]{1,400})(?:[eE][+-]?[0-9]{1,3})?)\s*([A-Za-zµμ°\u00ba\u02da][^\s]*)"
)
_PLAIN = str.maketrans({"·": "*", "⋅": "*", "²": "^2", "³": "^3"})


def unit_text(text: str) -> str | None:
    """Return the word after the number in text that looks like a quantity, whether or not it is a known unit."""
    match = _QUANTITY.fullmatch(text.strip())
    return match[2] if match else None


def parse_quantity(text: str) -> Quantity | None:
    """Parse a text that is a number and a known unit; None for any other text."""
    match = _QUANTITY.fullmatch(text.strip())
    if match is None:
        return None
    name = match[2].translate(_PLAIN).replace("**", "^")
    unit = UNITS.get(_SPELLINGS.get(name, name))
    return Quantity(unit.to_si(match[1]), unit.dimension, text.strip()) if unit else None


def suggested_unit(word: str) -> Unit | None:
    """Return the unit to suggest for a word that is not one: `deg` for `degrees` and `degress`; None for other words.

    A misspelt word keeps its first letter: `decimeter` is not `centimeter`.
    """
    name = word.translate(_PLAIN).replace("**", "^")
    if name in _UNITS_BY_WORD or name in UNITS or not _SHORTEST_MISSPELT <= len(name) <= _LONGEST_MISSPELT:
        return _UNITS_BY_WORD.get(name)
    # difflib costs 3 ms to import and most runs never need it.
    from difflib import get_close_matches

    lower = name.lower()
    like = [each for each in _UNITS_BY_WORD if each[0] == lower[0] and each.isalpha()]
    nearest = get_close_matches(lower, like, n=1, cutoff=max(_LEAST_LIKENESS, 1 - _MOST_APART / len(lower)))
    return _UNITS_BY_WORD[nearest[0]] if nearest else None


def spellings_of(unit: str) -> tuple[str, ...]:
    """Return the other accepted spellings of a unit."""
    return tuple(spelling for spelling, name in _SPELLINGS.items() if name == unit)


def units_of(dimension: Dimension) -> tuple[str, ...]:
    """Return the units of one dimension, SI first."""
    return tuple(unit.name for unit in _TABLE if unit.dimension is dimension)


def pattern_of(dimensions: Iterable[Dimension]) -> str:
    """Return a regular expression of all accepted spellings of the units of some dimensions, also for ECMAScript."""
    names = [name for dimension in dimensions for name in units_of(dimension)]
    spellings = [spelling for name in names for spelling in (name, *spellings_of(name))]
    return "|".join(_POWER.sub(_power_pattern, spelling.replace("*", "[*·⋅]")) for spelling in spellings)


_POWER = re.compile(r"\^([23])")
_SUPERSCRIPTS = {"2": "²", "3": "³"}


def _power_pattern(power: re.Match[str]) -> str:
    return rf"(?:(?:\^|\*\*){power[1]}|{_SUPERSCRIPTS[power[1]]})"
