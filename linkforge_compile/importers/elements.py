"""Read an XML element into an object of a spec, as the specs of its class describe it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.core.fields import (
    ZERO_TO_ONE,
    Child,
    Children,
    Choice,
    Colour,
    Flag,
    Number,
    Parameters,
    Pose,
    Reference,
    Spec,
    Text,
    Vector,
    field_specs,
    number_fields,
)
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Element
from linkforge_compile.importers.element_reader import ElementReader, Read
from linkforge_compile.importers.pose import read_pose
from linkforge_compile.importers.spec_draft import CannotRepresentError, is_same, number_of
from linkforge_compile.importers.texts import is_empty, is_normal, read_text, read_word, take_texts
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Motion

Names: TypeAlias = Mapping[str, Collection[str]]
"""The names that references may have, by what they name: link, joint or group. Others are not checked."""

_RESERVED = frozenset(("extra", "extra_attributes"))
"""Keys of an interface, which its parameters cannot have."""

NO_NAMES: Names = MappingProxyType({})
Entries: TypeAlias = Mapping[str, YamlNode | None]


def read_element(
    reader: ElementReader,
    kind: type[Element],
    motion: Motion = Motion.OTHER,
    /,
    *,
    names: Names = NO_NAMES,
    first: Entries = MappingProxyType({}),
    **readers: Read,
) -> YamlMap:
    """Read an element of a class. `first` has entries that are read and come first, `readers` read other fields by key.

    It cannot be represented without what URDF readers or the language require, or with a reference to an unknown
    name.
    """
    require_parts(reader, kind, without=first)
    entries = {**first}
    for spec in field_specs(kind).values():
        if not spec.key or spec.key in entries:
            continue
        if spec.key in readers:
            entries[spec.key] = readers[spec.key](reader)
        elif spec.xml:
            entries[spec.key] = _read(reader, spec, motion, names)
    others = {key: read(reader) for key, read in readers.items() if key not in entries}
    return reader.map(**entries, **others)


def read_field(reader: ElementReader, kind: type[Element], name: str) -> YamlNode | None:
    """Read one field of a class, for a reader that changes what it gives."""
    return _read(reader, field_specs(kind)[name], Motion.OTHER, NO_NAMES)


def _read(reader: ElementReader, spec: Spec, motion: Motion, names: Names) -> YamlNode | None:
    """Read a field; TypeError for one of a kind, or in a place, that only a reader of its own can read."""
    if isinstance(spec, Child):
        return _read_child(reader, spec, motion, names)
    if isinstance(spec, Parameters):
        return _read_parameters(reader, spec)
    tag, attribute = place_of(spec)
    if not attribute:
        return _read_text(reader, tag, spec)
    if not tag:
        return _read_attribute(reader, attribute, spec, motion, names)

    def read_only_attribute(child: ElementReader) -> YamlNode | None:
        child.require_attributes([attribute])
        node = _read_attribute(child, attribute, spec, motion, names)
        child.pass_rest_up()
        return node

    return reader.child(tag, read_only_attribute, is_required=is_required(spec))


def _read_child(reader: ElementReader, spec: Child, motion: Motion, names: Names) -> YamlNode | None:
    # The class itself, because kinds of children are subclasses of Child that have other forms.
    tag, required = spec.xml or "", is_required(spec)
    if type(spec) is Pose:
        return reader.child(tag, read_pose)
    if type(spec) is Colour:
        return reader.child(tag, _read_colour, is_required=True)
    [kind] = spec.kinds if len(spec.kinds) == 1 else [None]
    if kind and type(spec) is Child:
        return reader.child(tag, lambda child: read_element(child, kind, motion, names=names), is_required=required)
    if kind is Interface:
        return _read_interfaces(reader, tag)
    if kind and type(spec) is Children:
        return read_children(reader, tag, lambda child: read_element(child, kind, motion, names=names))
    raise _unreadable(spec)


def read_children(owner: ElementReader, tag: str, read: Callable[[ElementReader], YamlNode]) -> YamlMap | None:
    """Take the children of a tag by name, None for none; one whose name is missing or taken stays raw."""
    nodes: dict[str, YamlNode | None] = {}

    def read_one(child: ElementReader) -> YamlNode:
        name = child.attribute("name")
        if not name.value or name.value in nodes:
            raise CannotRepresentError(f"there is a <{tag}> '{name.value}' already", name.span)
        nodes[name.value] = node = read(child)
        return node

    for child in owner.remaining(tag):
        owner.try_read(child, read_one)
    return owner.draft.map_of(nodes, owner.span) if nodes else None


def _read_interfaces(component: ElementReader, tag: str) -> YamlNode | None:
    """Read interfaces of ros2_control: a list of their names, or a map where one has parameters or extras."""
    interfaces = read_children(component, tag, _read_interface)
    if interfaces is None or not all(is_empty(entry.value) for entry in interfaces):
        return interfaces
    draft, names = component.draft, []
    for entry in interfaces:
        names.append(draft.text(entry.name, entry.value.span))
        draft.note_same_source(names[-1], entry.value)
    return draft.list_of(names, component.span)


def _read_interface(interface: ElementReader) -> YamlMap:
    """Read the parameters of an interface, which are its own entries."""
    parameters = read_children(interface, "param", read_text)
    entries = {entry.name: entry.value for entry in parameters} if parameters else {}
    if not _RESERVED.isdisjoint(entries):
        raise interface.cannot_represent("a parameter of it is named as a key of the language")
    return interface.map(**entries)


def place_of(spec: Spec) -> tuple[str, str]:
    """Return the tag of the child that has a field, empty for the element itself, and the attribute, empty for text."""
    tag, at, attribute = (spec.xml or "").rpartition("@")
    if not at and attribute.endswith("/text()"):
        tag, attribute = attribute.removesuffix("/text()"), ""
    elif not at or spec.container:
        raise _unreadable(spec)
    if "/" in tag.rstrip("/"):
        raise _unreadable(spec)
    return tag.rstrip("/"), attribute


def is_required(spec: Spec) -> bool:
    """Whether an element without a field cannot be represented."""
    return bool(spec.example) or spec.is_required_in_urdf


def _unreadable(spec: Spec) -> TypeError:
    return TypeError(f"'{spec.key}' is a {type(spec).__name__} at '{spec.xml}', which needs a reader of its own")


# Attributes


def require_parts(reader: ElementReader, kind: type[Element], without: Collection[str] = ()) -> None:
    """Raise CannotRepresentError unless the element has what its class requires, but for the keys `without`."""
    specs = field_specs(kind).values()
    paths = [spec.xml for spec in specs if spec.xml and is_required(spec) and spec.key not in without]
    for tag in [path.partition("/")[0] for path in paths if not path.startswith("@")]:
        if not reader.has_child(tag):
            raise reader.cannot_represent(f"it has no <{tag}>")
    reader.require_attributes([path[1:] for path in paths if path.startswith("@")])


def _read_attribute(reader: ElementReader, name: str, spec: Spec, motion: Motion, names: Names) -> YamlNode | None:
    match spec:
        case Number():
            return _read_number(reader, name, spec, motion)
        case Vector():
            return _read_vector(reader, name, spec, motion)
        case Flag():
            return reader.flag(name, default=spec.implied)
        case Reference():
            is_given = spec.example or reader.element.get(name)
            return read_reference(reader, name, spec.to, names) if is_given else None
        case Text() | Choice():
            return _read_words(reader, name, spec)
    raise _unreadable(spec)


def _read_words(reader: ElementReader, name: str, spec: Text | Choice) -> YamlScalar | None:
    written = reader.element.get(name)
    if isinstance(spec, Choice) and written is not None and written not in tuple(spec.words):
        reason = f"{name} is one of {', '.join(spec.words)}, found '{written}'"
        raise CannotRepresentError(reason, reader.element.attributes[name].span)
    if spec.example and written is not None and not written.strip():
        raise reader.cannot_represent(f"its {name} is empty")
    node = reader.text(name)
    return None if written == spec.implied else node


def read_reference(reader: ElementReader, attribute: str, kind: str, names: Names) -> YamlScalar:
    """Take an attribute that names a link, joint or group; the element cannot be represented with an unknown name."""
    reference = reader.attribute(attribute)
    node = reader.draft.text(reference.value, reference)
    if node.text not in names.get(kind, (node.text,)):
        noun = "planning group" if kind == "group" else kind
        raise CannotRepresentError(f"there is no {noun} named '{node.text}'", reference.span)
    return node


def read_numbers(
    reader: ElementReader, kind: type[Element], motion: Motion, *, without: Collection[str] = ()
) -> dict[str, YamlNode | None]:
    """Read the numbers of a class by key, except the fields `without`; None for one missing or at its default."""
    specs = number_fields(kind).items()
    return {spec.key or name: _read(reader, spec, motion, NO_NAMES) for name, spec in specs if name not in without}


def _read_number(reader: ElementReader, name: str, spec: Number, motion: Motion) -> YamlScalar | None:
    written = reader.element.get(name) or ""
    node = reader.number(name, spec.unit.dimension(motion), default=spec.implied)
    _require_bound(reader, name, spec, written)
    return node


def _read_vector(reader: ElementReader, name: str, spec: Vector, motion: Motion) -> YamlList | None:
    written = (reader.element.get(name) or "").split()
    node = reader.numbers(name, 3, spec.unit.dimension(motion))
    for number in written:
        _require_bound(reader, name, spec, number)
    default = spec.implied and tuple(spec.implied)
    return None if tuple(map(number_of, written)) == default else node


def _require_bound(reader: ElementReader, name: str, spec: Number | Vector, written: str) -> None:
    value = number_of(written)
    if spec.bound and value is not None and not spec.bound.holds(value):
        reason = f"{name} must be {spec.bound.words}, found {written}"
        raise CannotRepresentError(reason, reader.element.attributes[name].span)


def _read_colour(colour: ElementReader) -> YamlNode:
    """Read the four numbers of a colour, of which an opacity of 1 is omitted."""
    colour.require_attributes(["rgba"])
    rgba = colour.numbers("rgba", 4)
    assert rgba
    written = colour.element.get("rgba") or ""
    if any(not ZERO_TO_ONE.holds(float(part)) for part in written.split()):
        raise colour.cannot_represent(f"its components must be {ZERO_TO_ONE.words}, found '{written}'")
    colour.pass_rest_up()
    *rgb, opacity = rgba
    return colour.draft.list_of(rgb, rgba) if is_same(opacity, colour.draft.number("1", rgba)) else rgba


# Texts of children


def _read_text(reader: ElementReader, tag: str, spec: Spec) -> YamlNode | None:
    """Read a field that is the text of a child, or of several; what is not in normal form stays raw."""
    children = reader.remaining(tag)
    if spec.container:
        words = [reader.read(child, read_word) for child in children]
        is_default = tuple(word.text for word in words) == spec.implied
        return None if is_default else reader.draft.list_of(words, reader.span)
    if spec.example:
        return reader.child(tag, read_word, is_required=True)
    if len(children) != 1 or not is_normal(children[0], spec):
        return None
    return reader.read(children[0], ElementReader.text_number if isinstance(spec, Number) else read_word)


def _read_parameters(reader: ElementReader, spec: Parameters) -> YamlNode | None:
    """Read texts by tag, or by the names of children of one tag."""
    if spec.xml != "*":
        return read_children(reader, spec.xml or "", read_text)
    texts = take_texts(reader)
    return reader.draft.map_of(texts, reader.span) if texts else None
