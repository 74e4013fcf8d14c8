"""Which fields of a part are compared, under which key, and in which form."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, fields, is_dataclass

from linkforge_compile.core.exceptions import RobotGeneratorError
from linkforge_compile.core.fields import Spec, field_specs
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Part
from linkforge_compile.formats.raw import elements_of, plain_text
from linkforge_compile.source.xml_tree import XmlElement

_KEYS = {
    "chains": "chain",
    "ros2_controls": "ros2_control",
    "gazebo_elements": "gazebo",
    "extra_elements": "extra",
}
"""Keys in paths where the spec of a field has none, or another."""
_STATED_FIELDS = frozenset({"stated", "interfaces_stated", "version_stated"})
"""Fields that name the fields written with their default; `stated_differences` compares them."""

_NO_FIELDS: Mapping[type, Collection[str]] = {}


@dataclass(frozen=True)
class RawElement:
    """An element of raw XML; `written` is all of it as text.

    `texts` are the texts before, between and after its child elements: at least one, and none after the last that is
    not blank.
    """

    tag: str
    attributes: Mapping[str, str]
    texts: tuple[str, ...]
    children: tuple[RawElement, ...]
    written: str = field(compare=False)

    @property
    def name(self) -> str | None:
        return self.attributes.get("name")


def raw_parts(texts: Iterable[str]) -> tuple[RawElement | str, ...]:
    """Parse texts of raw XML into elements; keep a text that is not well-formed as it is."""
    return tuple(part for text in texts for part in _parsed(text))


def _parsed(text: str) -> tuple[RawElement | str, ...]:
    try:
        return tuple(map(_raw_element, elements_of(text)))
    except RobotGeneratorError:
        return (text,)


def _raw_element(element: XmlElement) -> RawElement:
    children = tuple(map(_raw_element, element.children))
    return RawElement(element.tag, dict(element.values), _texts(element), children, plain_text(element))


def _texts(element: XmlElement) -> tuple[str, ...]:
    runs: list[list[str]] = [[]]
    for item in element.content:
        if isinstance(item, XmlElement):
            runs.append([])
        elif isinstance(item, str):
            runs[-1].append(item)
    texts = ["".join(run).strip() for run in runs]
    while len(texts) > 1 and not texts[-1]:
        texts.pop()
    return tuple(texts)


def specs_of(kind: type) -> Mapping[str, Spec]:
    """Return the specs of the class of an element or link; none for other classes."""
    return field_specs(kind) if issubclass(kind, Part | Link) else {}


def key_of_field(kind: type, name: str) -> str:
    """Return the key of the language for a field of a class."""
    spec = specs_of(kind).get(name)
    return _KEYS.get(name) or (spec.key if spec else "") or name


def is_part(value: object) -> bool:
    """Whether a value has fields to compare."""
    return isinstance(value, Interface) or (is_dataclass(value) and not isinstance(value, type))


def compared_fields(part: object) -> tuple[str, ...]:
    """Return the names of the fields of a part that are compared."""
    if isinstance(part, Interface):
        return "parameters", "extra_attributes", "extra_elements", "extra_inside"
    assert is_dataclass(part)
    own = (one.name for one in fields(part) if one.compare and not one.name.startswith("_"))
    return tuple(name for name in own if name not in _STATED_FIELDS)


def compared_value(part: object, name: str) -> object:
    """Return the value of a field in the form that is compared: raw XML parsed, attributes as a mapping."""
    value: object = getattr(part, name)
    convert = _CONVERT.get(name)
    return value if convert is None or value is None else convert(value)


def _to_interfaces(names: object) -> object:
    assert isinstance(names, Sequence)
    return tuple(map(Interface.of, names))


def _to_raw_parts(texts: object) -> object:
    assert isinstance(texts, Sequence)
    return raw_parts(texts)


def _to_mapping(pairs: object) -> object:
    assert isinstance(pairs, Sequence)
    return dict(pairs)


_CONVERT: Mapping[str, Callable[[object], object]] = {
    "command_interfaces": _to_interfaces,
    "state_interfaces": _to_interfaces,
    "extra_attributes": _to_mapping,
    "extra_elements": _to_raw_parts,
}


def match_key(value: object, without: Mapping[type, Collection[str]] = _NO_FIELDS) -> Hashable:
    """Return a hashable key that equal values share, ignoring the fields `without`, by class."""
    if isinstance(value, Mapping):
        return frozenset((name, match_key(item, without)) for name, item in value.items())
    if is_part(value):
        ignored = without.get(type(value), ())
        keys = (
            match_key(compared_value(value, name), without) for name in compared_fields(value) if name not in ignored
        )
        return type(value).__name__, str(value) if isinstance(value, Interface) else "", *keys
    if isinstance(value, Sequence) and not isinstance(value, str):
        return tuple(match_key(item, without) for item in value)
    if isinstance(value, bool):
        return "bool", value  # True == 1 in Python
    return value if isinstance(value, str | int | float | None) else repr(value)
