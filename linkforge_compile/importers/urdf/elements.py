"""Read an XML element into an object of a spec, as the specs of its class describe it."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from types import MappingProxyType
from typing import TypeAlias

from linkforge_compile.core.fields import Child, Choice, Number, Pose, Reference, Spec, Text, field_specs, number_fields
from linkforge_compile.core.part import Element
from linkforge_compile.importers.element_reader import ElementReader, Read
from linkforge_compile.importers.spec_draft import CannotRepresentError, number_of
from linkforge_compile.importers.urdf.geometry import read_pose
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import Motion

Names: TypeAlias = Mapping[str, Collection[str]]
"""The names that references may have, by what they name: link, joint or group. Others are not checked."""

NO_NAMES: Names = MappingProxyType({})


def read_element(
    reader: ElementReader,
    kind: type[Element],
    motion: Motion = Motion.OTHER,
    /,
    *,
    names: Names = NO_NAMES,
    **readers: Read,
) -> YamlMap:
    """Read an element of a class; `readers` read the fields with their keys, and what else the language has.

    It cannot be represented without what its readers require, or with a reference to an unknown name.
    """
    require_numbers(reader, kind)
    entries: dict[str, YamlNode | None] = {}
    for name, spec in field_specs(kind).items():
        if spec.key and spec.key not in readers:
            entries[spec.key] = _read(reader, name, spec, motion, names)
        elif spec.key:
            entries[spec.key] = readers[spec.key](reader)
    others = {key: read(reader) for key, read in readers.items() if key not in entries}
    return reader.map(**entries, **others)


def _read(reader: ElementReader, name: str, spec: Spec, motion: Motion, names: Names) -> YamlNode | None:
    tag, _, attribute = (spec.xml or "").rpartition("@")
    match spec:
        case Number():
            return _read_number(reader, name, spec, motion)
        case Reference() if tag:
            return reader.required(tag.rstrip("/"), lambda child: _read_only_attribute(child, attribute))
        case Reference() if spec.example or reader.element.get(attribute):
            return read_reference(reader, attribute, spec.to, names)
        case Text() | Choice() if spec.example:
            return reader.required_text(attribute)
        case Pose():
            return reader.child(spec.xml or "", read_pose)
        case Child(kinds=(kind,)):
            return reader.child(spec.xml or "", lambda child: read_element(child, kind, motion, names=names))
    return None


def _read_only_attribute(reader: ElementReader, attribute: str) -> YamlNode:
    node = reader.required_text(attribute)
    reader.pass_rest_up()
    return node


def read_reference(reader: ElementReader, attribute: str, kind: str, names: Names) -> YamlScalar:
    """Take an attribute that names a link, joint or group; the element cannot be represented with an unknown name."""
    reference = reader.attribute(attribute)
    node = reader.draft.text(reference.value, reference)
    if node.text not in names.get(kind, (node.text,)):
        noun = "planning group" if kind == "group" else kind
        raise CannotRepresentError(f"there is no {noun} named '{node.text}'", reference.span)
    return node


def require_numbers(reader: ElementReader, kind: type[Element]) -> None:
    """Raise CannotRepresentError unless the element has the numbers that readers of URDF require."""
    required = [name for name, spec in number_fields(kind).items() if spec.is_required_in_urdf]
    if missing := [name for name in required if reader.element.get(name) is None]:
        raise reader.cannot_represent(f"it has no {' and no '.join(map(repr, missing))}")


def read_numbers(
    reader: ElementReader, kind: type[Element], motion: Motion, *, without: Collection[str] = ()
) -> dict[str, YamlNode | None]:
    """Read the numbers of a class; None for one that is missing or has its default."""
    specs = number_fields(kind).items()
    return {name: _read_number(reader, name, spec, motion) for name, spec in specs if name not in without}


def _read_number(reader: ElementReader, name: str, spec: Number, motion: Motion) -> YamlScalar | None:
    written = reader.element.get(name) or ""
    node = reader.number(name, spec.unit.dimension(motion), default=spec.implied)
    value = number_of(written)
    if spec.bound and value is not None and not spec.bound.holds(value):
        raise reader.cannot_represent(f"{name} must be {spec.bound.words}, found {written}")
    return node
