"""Elements of the parts of a robot: attributes by the specs of their fields, parameters, then what no field covers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import cache
from operator import attrgetter
from typing import Protocol

from linkforge_compile.core.exceptions import FieldPath, RobotGeneratorError
from linkforge_compile.core.fields import field_specs, number_fields
from linkforge_compile.core.part import Element, Inside, SourcedText, attribute_pairs
from linkforge_compile.formats.source_map import active_origins, origin_of
from linkforge_compile.formats.xml_document import inside_text
from linkforge_compile.formats.xml_text import (
    KEEPS_SPACE,
    NOTHING,
    Spellable,
    Xml,
    element_text,
    escaped,
    is_of_numpy,
    is_writable,
    is_xml_blank,
    is_xml_name,
    raw_text,
    spelled,
)
from linkforge_compile.source import SourceRef
from linkforge_compile.units import double_text


class Extended(Protocol):
    """A part of the robot that may hold attributes and elements in addition to its fields."""

    @property
    def extra_attributes(self) -> Sequence[tuple[str, str]] | Mapping[str, str]: ...
    @property
    def extra_elements(self) -> Sequence[str]: ...
    @property
    def source(self) -> SourceRef | None: ...


class RestatedAttributeError(RobotGeneratorError):
    """An extra attribute `name` that a field of its part writes as well; `source` is where the part was written."""

    def __init__(self, name: str, source: SourceRef | None) -> None:
        self.name = name
        self.source = source
        super().__init__(f"the attribute '{name}' is stated twice")


def attributes(part: Extended | None = None, /, **stated: Spellable | None) -> Xml:
    """Return ` name="value"` for each attribute that is given, then for the extra attributes of the part.

    Raises:
        RobotGeneratorError: for an extra attribute that is given as well, or whose name is no XML name.

    """
    if part is None or not (part.extra_attributes or active_origins()):
        return Xml(_stated_alone(stated))
    extra = attribute_pairs(part.extra_attributes)
    _require_attributes(part, stated, extra)
    if active_origins():
        return _attributes_with_origins(part, stated, extra)
    return Xml(_stated_alone(stated) + "".join([f' {name}="{escaped(value)}"' for name, value in extra]))


def _stated_alone(stated: Mapping[str, Spellable | None]) -> str:
    text = ""
    for name, value in stated.items():
        if value is not None:
            quoted = double_text(value) if value.__class__ is float else _quotable(value)  # a short cut for most
            text = f'{text} {name}="{quoted}"'
    return text


def attributes_at(source: SourceRef | None, *path: str, **stated: Spellable | None) -> Xml:
    """Return ` name="value"` for attributes that are written under a path of a part."""
    return Xml(origin_of(source, *path) + _stated_alone(stated))


def _attributes_with_origins(
    part: Extended, stated: Mapping[str, Spellable | None], extra: Iterable[tuple[str, str]]
) -> Xml:
    own = (
        f'{_origin_of_attribute(part, name)} {name}="{_quotable(value)}"'
        for name, value in stated.items()
        if value is not None
    )
    raw = (
        f'{origin_of(*place_of_attribute(name, part.source), name, of=name)} {name}="{escaped(value)}"'
        for name, value in extra
    )
    return Xml("".join((origin_of(part.source), *own, *raw)))


def _origin_of_attribute(part: Extended, name: str) -> str:
    """Return the origin of an attribute: under its own name in a URDF, in a spec under the key of its field."""
    source, key, kind = part.source, name, type(part)
    if source is not None and source.node.child(name) is None and isinstance(part, Element):
        key = _keys_by_attribute(kind).get(name) or name
    return origin_of(source, key, of=name)


@cache
def _keys_by_attribute(kind: type) -> Mapping[str, str | None]:
    return {spec.xml[1:]: spec.key for spec in field_specs(kind).values() if spec.xml and spec.xml[0] == "@"}


class PlacedText(str):
    """Text for a template whose filter `place` writes `place`, an attribute that says where the text was written."""

    place = NOTHING


def placed(text: str, source: SourceRef | None, *path: str | int) -> str:
    """Return text for a template, with where it was written, under a path of an object, while a map is made."""
    if not text or active_origins() is None:
        return text
    result = PlacedText(text)
    result.place = Xml(origin_of(source, *path, of="value"))
    return result


def place_of_attribute(name: str, where: SourceRef | None) -> tuple[SourceRef | None, *tuple[str, ...]]:
    """Return the place of an extra attribute, without its name, of a part that was written at `where`.

    Extra attributes of a robot may come from the files of its modules: such a name has a place of its own.
    """
    return (name.source,) if isinstance(name, SourcedText) else (where, "extra_attributes")


def _quotable(value: Spellable) -> str:
    return escaped(value) if isinstance(value, str) else spelled(value)


def _require_attributes(part: Extended, stated: Mapping[str, object], extra: Iterable[tuple[str, str]]) -> None:
    seen = {name for name, value in stated.items() if value is not None}
    for name, _ in extra:
        require_attribute_name(name)
        if name in seen:
            raise RestatedAttributeError(name, part.source)
        seen.add(name)


def require_attribute_name(name: str) -> None:
    """Raise RobotGeneratorError for what cannot be the name of an attribute."""
    if not is_xml_name(name):
        raise RobotGeneratorError(f"'{name}' cannot be the name of an XML attribute")


def elements(part: Extended) -> Xml:
    """Return the extra elements of a part, each well-formed by itself; templates place them last.

    The additions of `extra_inside` are among them; the writer moves them to their elements.

    Raises:
        RobotGeneratorError: for raw XML that is not well-formed.

    """
    inside = inside_of(part)
    if not inside:
        return raw(part) if part.extra_elements else NOTHING
    return Xml("".join([*map(_inside, inside), raw(part)]))


def _inside(one: Inside) -> str:
    numbered, number = _NUMBERED.get(), 0
    if numbered is not None:
        number = len(numbered)
        numbered.append(one)
    return inside_text(number, one.key, attributes(one), elements(one))


_NUMBERED: ContextVar[list[Inside] | None] = ContextVar("_NUMBERED", default=None)


@contextmanager
def numbering_insides() -> Iterator[list[Inside]]:
    """Number each `Inside` that is rendered within by its index in the list, for an `InsideError` to name it."""
    numbered: list[Inside] = []
    token = _NUMBERED.set(numbered)
    try:
        yield numbered
    finally:
        _NUMBERED.reset(token)


def inside_of(part: Extended) -> Sequence[Inside]:
    """Return the additions of a part to elements inside it; a link and a robot have none."""
    insides: Sequence[Inside] = getattr(part, "extra_inside", ())
    return insides


def raw(part: Extended) -> Xml:
    """Return the raw XML of a part.

    Raises:
        RobotGeneratorError: for raw XML that is not well-formed.

    """
    if not part.extra_elements:
        return NOTHING
    from linkforge_compile.formats.raw import raw_elements

    return Xml("".join(raw_elements(text, source, *path) for text, source, path in raw_texts(part, part.source)))


def raw_texts(part: Extended, where: SourceRef | None) -> Iterator[tuple[str, SourceRef | None, FieldPath]]:
    """Yield each text of raw XML of a part that was written at `where`, with the object and path of its place.

    Raw XML of a robot may come from the files of its modules: such a text has a place of its own.
    """
    for number, text in enumerate(part.extra_elements):
        yield (text, text.source, ()) if isinstance(text, SourcedText) else (text, where, ("extra", number))


def leaf_at(tag: str, source: SourceRef | None, *path: str, **stated: Spellable | None) -> Xml:
    """Return an element of attributes that are written under a path of a part."""
    return Xml(f"<{tag}{attributes_at(source, *path, **stated)}/>")


def leaf(part: Element, tag: str = "", /, **changes: Spellable | None) -> Xml:
    """Return an element whose fields are all attributes; `changes` as for `attributes_of`."""
    tag = tag or part.TAG
    if part.extra_attributes or part.extra_elements or part.extra_inside or active_origins():
        start, inner = f"<{tag}{attributes_of(part, **changes)}", elements(part)
        return Xml(f"{start}>{inner}</{tag}>" if inner else f"{start}/>")
    return Xml(f"<{tag}{_stated_alone(_attribute_values(part, changes))}/>")


def attributes_of(part: Element, /, **changes: Spellable | None) -> Xml:
    """Return the attributes of a part, by the specs of its fields; `changes` are values by attribute, None for none."""
    values = _attribute_values(part, changes)
    if part.extra_attributes or active_origins():
        return attributes(part, **values)
    return Xml(_stated_alone(values)) if values else NOTHING


def _attribute_values(part: object, changes: Mapping[str, Spellable | None]) -> dict[str, Spellable | None]:
    kind: type = type(part)
    getters, implied = _attribute_getters(kind)
    values = {name: get(part) for name, get in getters}
    if not (implied or changes):
        return values  # most parts
    for name, field, value in implied:  # not written, unless the author did
        if values[name] == value and field not in part.stated:  # type: ignore[attr-defined]  # of classes that have it
            values[name] = None
    values.update(changes)
    return values


@cache
def _attribute_getters(
    kind: type,
) -> tuple[tuple[tuple[str, Callable[[object], Spellable | None]], ...], tuple[tuple[str, str, object], ...]]:
    """Return what gets each attribute of a class, and those that may be left out, with their fields and defaults."""
    fields: dict[str, list[str]] = {}
    for field, spec in field_specs(kind).items():
        if spec.xml and spec.xml[0] == "@":
            fields.setdefault(spec.xml[1:], []).append(field)
    names = getattr(kind, "ATTRIBUTE_ORDER", ()) or tuple(fields)
    optional = number_fields(kind).items() if hasattr(kind, "stated") else ()
    implied = tuple((spec.xml[1:], field, spec.implied) for field, spec in optional if spec.xml and spec.xml[0] == "@")
    return tuple((name, attrgetter(*fields[name])) for name in names), implied


def parameter_elements(parameters: Mapping[str, object], source: SourceRef | None = None, *path: str | int) -> Xml:
    """Return the parameters of a free part as child elements.

    A mapping is an element with children, where a key `_x` is its attribute `x` and `_text` its text; a list
    repeats its tag; anything else is text. They were written under `path` of what `source` points to.

    Raises:
        RobotGeneratorError: for a key that cannot be a tag.

    """
    return Xml(_elements(parameters, source, path))


def is_surely_writable(part: object) -> bool:
    """Whether a free part is texts and maps of texts that XML can hold; False means that it has to be tried."""
    if isinstance(part, str):
        return is_writable(part)
    if not isinstance(part, dict):
        return False
    return all(key[:1] != "_" and is_xml_name(key) and is_surely_writable(inner) for key, inner in part.items())


def _elements(parameters: Mapping[str, object], source: SourceRef | None, path: FieldPath) -> str:
    elements: list[str] = []
    for tag, value in parameters.items():
        if not isinstance(value, str) and isinstance(value, Sequence):
            elements += [_element(tag, item, source, (*path, tag, number)) for number, item in enumerate(value)]
        else:
            elements.append(_element(tag, value, source, (*path, tag)))
    return "".join(elements)


def _element(tag: str, value: object, source: SourceRef | None, path: FieldPath) -> str:
    _require_name(tag)
    if isinstance(value, str) or not isinstance(value, Mapping):
        return element_text(tag, (), raw_text(_text(value)), origin_of(source, *path))
    attributes = [(key[1:], _text(item)) for key, item in value.items() if key.startswith("_") and key != "_text"]
    for name, _ in attributes:
        _require_name(name)
    children = _elements({key: item for key, item in value.items() if not key.startswith("_")}, source, path)
    text, origin = raw_text(_text(value.get("_text", ""))), origin_of(source, *path)
    return element_text(
        tag, attributes, text + children, origin + KEEPS_SPACE if text and is_xml_blank(text) else origin
    )


def _text(value: object) -> str:
    return spelled(value) if isinstance(value, float | int) or is_of_numpy(value) else str(value)


def _require_name(name: str) -> None:
    if not is_xml_name(name):
        raise RobotGeneratorError(f"'{name}' cannot be the name of an XML element or attribute")
