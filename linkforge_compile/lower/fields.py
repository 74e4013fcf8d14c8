"""Typed reads from one object of the tree: each gives a value of the IR's kind, or tells why not and gives None."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from enum import StrEnum
from functools import cache
from typing import TypeVar

from linkforge_compile.core.models.geometry import IDENTITY, Transform, Vector3
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT
from linkforge_compile.diagnostics.codes.model import (
    UNKNOWN_CHOICE,
    WRONG_COUNT,
    WRONG_KIND,
)
from linkforge_compile.diagnostics.codes.names import INVALID_NAME, NAME_TWICE
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.lower.extra import with_extras
from linkforge_compile.lower.quantities import (
    ANGLE,
    BARE,
    LENGTH,
    Measure,
    Refusal,
    doubt,
    doubted,
    found,
    list_meant,
    plain_number,
    plain_numbers,
    si_number,
)
from linkforge_compile.lower.spec_object import SpecObject
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.characters import code_point
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1
from linkforge_compile.syntax.xacro import xacro_facts

T = TypeVar("T")
Choice = TypeVar("Choice", bound=StrEnum)


class Fields(SpecObject):
    """One object of the tree, ready to be read.

    Every reader returns None where nothing is said, where the fault has been told already (YamlFault), and where
    it tells one itself. With `required`, an example of what to write, nothing said is a fault of the object.
    So None from a required read always means: told, drop the object.
    """

    __slots__ = ()

    # Reading one field

    def said(self, key: str, required: str = "") -> YamlNode | None:
        """Return what is said under a key; with an example of what to write, nothing said is told."""
        entry = self.node.entries.get(key)
        if entry is not None:
            node = entry.value
            if node.__class__ is not YamlScalar or node.value is not None:
                return node
        if required:
            self.tell_missing(key, required)
        return None

    def number(self, key: str, measure: Measure = BARE, *, required: str = "") -> float | None:
        """Read a number in SI units."""
        node = self.said(key, required)
        if node is None:
            return None
        plain = plain_number(node, measure)
        return self.number_at(node, key, measure) if plain is None else plain

    def numbers(self, *asked: tuple[str, Measure, str]) -> list[float | None]:
        """Read several numbers, each by its key, its measure and, where it is required, an example of it."""
        entries = self.node.entries
        numbers: list[float | None] = []
        for key, measure, required in asked:
            entry = entries.get(key)
            number = plain_number(entry.value, measure) if entry else None
            if number is None and (entry or required):
                number = self.number(key, measure, required=required)
            numbers.append(number)
        return numbers

    def integer(self, key: str, measure: Measure = BARE, *, required: str = "") -> int | None:
        """Read a whole number without a unit; 3.0 is one."""
        node = self.said(key, required)
        value = None if node is None else self.number_at(node, key, measure)
        if node is None or value is None:
            return None
        if not value.is_integer():
            self.tell(WRONG_KIND, node, field=key, expected="a whole number", found=found(node))
            return None
        return int(value)

    def flag(self, key: str) -> bool | None:
        """Read true or false."""
        node = self.node.get(key)
        if node is None or isinstance(node, YamlFault):
            return None
        if isinstance(node, YamlScalar) and isinstance(node.value, bool):
            return node.value
        if isinstance(node, YamlScalar) and (meant := TRUTHS_OF_YAML_1_1.get(node.text.lower())):
            self.tell(TRUTH_AS_TEXT, node, name=node.text, meant=meant)
        else:
            self.tell(WRONG_KIND, node, field=key, expected="true or false", found=found(node))
        return None

    def text(self, key: str, *, required: str = "") -> str | None:
        """Read a scalar as it was written: text, or a reference to a name."""
        # Most of what may be said is not, or is a scalar, and is asked for by the thousand.
        entry = self.node.entries.get(key)
        if entry is None and not required:
            return None
        if entry is not None:
            node = entry.value
            if node.__class__ is YamlScalar and node.value is not None:
                return node.text
        said = self.said(key, required)
        return None if said is None else self.text_at(said, key)

    def name(self, key: str, kind: str, *, required: str = "") -> str | None:
        """Read the name that a thing of this kind takes; its characters are judged."""
        node = self.said(key, required)
        text = None if node is None else self.text_at(node, key)
        return text if node is not None and text is not None and self.name_is_valid(text, kind, node) else None

    def vector3(self, key: str, measure: Measure = BARE, *, required: str = "") -> Vector3 | None:
        """Read a list of three numbers in SI units."""
        if key not in self.node.entries and not required:
            return None
        node = self.said(key, required)
        return None if node is None else self.vector3_at(node, key, measure)

    def choice(self, key: str, choices: type[Choice], *, required: str = "") -> Choice | None:
        """Read one word of an enumeration."""
        text = self.text(key, required=required)
        if text is None:
            return None
        by_word = _by_word(choices)
        if text not in by_word:
            node = self.node.entries[key].value
            self.tell(UNKNOWN_CHOICE, node, near=by_word, field=key, choices=", ".join(by_word), name=text)
        return by_word.get(text)

    def origin(self) -> Transform:
        """Read `origin`, a pose in the parent's frame: `[x, y, z]` or `{xyz, rpy}`; what is unsaid or faulty is 0."""
        node = self.said("origin")
        if node is None:
            return IDENTITY
        if plain := _plain_pose(node, self.trail):
            return plain
        if isinstance(node, YamlList):
            xyz = self.vector3_at(node, "origin", LENGTH)
            return Transform(xyz, is_stated=True, source=SourceRef(node, None, self.trail)) if xyz else IDENTITY
        pose = self.map_at(node, "origin")
        if pose is None:
            return IDENTITY
        xyz, rpy = pose.vector3("xyz", LENGTH), pose.vector3("rpy", ANGLE)
        is_stated = bool(xyz or rpy) or pose.said("xyz") is not None or pose.said("rpy") is not None
        made = Transform(xyz or IDENTITY.xyz, rpy or IDENTITY.rpy, is_stated=is_stated, source=pose.ref)
        return with_extras(made, pose)

    # Opening what is nested

    def map(self, key: str, *, required: str = "") -> Fields | None:
        """Open the object under a key."""
        # As for `text`.
        entry = self.node.entries.get(key)
        if entry is None and not required:
            return None
        node = entry.value if entry is not None and entry.value.__class__ is YamlMap else self.said(key, required)
        return None if node is None else self.map_at(node, key)

    def map_at(self, node: YamlNode, field: str) -> Fields | None:
        """Open an object that stands at a node, such as an item of a list."""
        if node.__class__ is YamlMap:
            path = f"{self.path}.{field}" if self.path else field
            return Fields(node, self.owner, self.sink, self.trail, None, path, self)
        self.tell_kind(node, field, "a map")
        return None

    def each(self, key: str, kind: str, lower: Callable[[Fields, str], T | None]) -> Iterator[tuple[str, T | None]]:
        """Lower each entry of a map keyed by names, None for a faulty one; an entry with no value is an empty one."""
        section = self.map(key)
        for entry in section.node if section else ():
            node, name = entry.value, entry.name
            owner = f"{kind} '{name}'"
            if not isinstance(node, YamlMap) and is_null(node):
                node = YamlMap({}, entry.key.span)
            if isinstance(node, YamlMap):
                yield name, lower(Fields(node, owner, self.sink, self.trail, entry.key, "", section), name)
                continue
            self.tell_kind(node, owner, "a map")
            yield name, None

    def nested(self, key: str) -> Iterator[tuple[YamlScalar, YamlEntry]]:
        """Yield the outer key and the inner entry of every `{outer: {inner: value}}` under a key."""
        section = self.map(key)
        for outer in section.node if section else ():
            if is_null(outer.value):
                continue
            inner = self.map_at(outer.value, f"'{outer.name}' in {key}")
            for entry in inner.node if inner else ():
                yield outer.key, entry

    def arranged(self, owner: str, key: YamlNode, *written: YamlEntry, **nodes: YamlNode) -> Fields:
        """Return an object whose fields stand in the tree as keys or apart: its `source` finds them by field.

        `written` are entries that stand in the tree as they are; `nodes` go before one of the same name.
        """
        entries = {entry.name: entry for entry in written}
        entries |= {name: YamlEntry(YamlScalar(name, name, node.span), node) for name, node in nodes.items()}
        return Fields(YamlMap(entries, key.span), owner, self.sink, self.trail, key)

    def items(self, key: str) -> tuple[YamlNode, ...]:
        """Return the items of a list; one thing that is no list is a list of one; () where nothing is said."""
        node = self.said(key)
        if node is None:
            return ()
        return node.items if isinstance(node, YamlList) else (node,)

    def names(self, key: str) -> tuple[str, ...]:
        """Read a list of references to names, without those that are faulty."""
        return tuple(name for name, _ in self.named_items(key))

    def named_items(self, key: str) -> Iterator[tuple[str, YamlNode]]:
        """Yield the names of a list, each with its node, without those that are faulty; one that repeats is told."""
        seen: set[str] = set()
        for node in self.items(key):
            name = self.text_at(node, key)
            if name is None:
                continue
            if not name or is_null(node):
                self.tell(WRONG_KIND, node, field=key, expected="names", found=found(node))
                continue
            if name in seen:
                self.tell(NAME_TWICE, node, name=name, field=key, owner=self.title)
            seen.add(name)
            yield name, node

    # Reading a node that is at hand

    def number_at(self, node: YamlNode, field: str, measure: Measure) -> float | None:
        if isinstance(node, YamlFault):
            return None
        number = si_number(node, measure)
        if isinstance(number, Refusal):
            self.tell(number.code, node, near=number.near, field=field, **number.facts)
            return None
        if code := doubt(node, number, measure):
            self.tell(code, node, field=field, **doubted(node, number))
        return number

    def numbers_at(self, node: YamlNode, field: str, measure: Measure, *counts: int) -> tuple[float, ...] | None:
        """Read a list of as many numbers as one of `counts` says."""
        expected = f"{' or '.join(map(str, counts))} numbers"
        if not isinstance(node, YamlList):
            self.tell_kind(node, field, list_meant(node, counts) or f"a list of {expected}")
            return None
        if any(isinstance(item, YamlFault) for item in node):
            return None
        if len(node) not in counts:
            self.tell(WRONG_COUNT, node, field=field, expected=expected, count=len(node))
            return None
        numbers = [self.number_at(item, field, measure) for item in node]
        return None if None in numbers else tuple(number for number in numbers if number is not None)

    def vector3_at(self, node: YamlNode, field: str, measure: Measure) -> Vector3 | None:
        plain = plain_numbers(node, measure)
        numbers = plain if len(plain) == 3 else self.numbers_at(node, field, measure, 3)
        return Vector3(*numbers) if numbers else None

    def text_at(self, node: YamlNode, field: str) -> str | None:
        if isinstance(node, YamlScalar):
            return node.text
        self.tell_kind(node, field, "text")
        return None

    def name_is_valid(self, name: str, kind: str, where: YamlNode | None = None) -> bool:
        """Tell of a name that URDF readers do not take, without `where` at the object; True where they do."""
        return is_valid_name(name) or self._tell_invalid(name, kind, where or self.ref)

    def _tell_invalid(self, name: str, kind: str, where: YamlNode | SourceRef) -> bool:
        if facts := xacro_facts(name):
            for each in facts:
                self.tell(XACRO_EXPRESSION, where, text=each["text"], ours=each["ours"])
            return False
        wrong = next((character for character in name if not is_valid_name(character)), None)
        shown = repr(wrong) if wrong is None or wrong.isprintable() else code_point(wrong)
        reason = "it is empty" if wrong is None else f"{shown} is not allowed"
        self.tell(INVALID_NAME, where, name=name, kind=kind, reason=reason)
        return False


def _plain_pose(node: YamlNode, trail: tuple[Span, ...]) -> Transform | None:
    """Return the pose of a map of plain vectors, without opening it; None for what has to be looked at."""
    vectors: dict[str, Vector3] = {}
    for key, entry in node.entries.items() if isinstance(node, YamlMap) else ():
        measure = _OF_A_POSE.get(key)
        numbers = plain_numbers(entry.value, measure) if measure else ()
        if len(numbers) != 3:
            return None
        vectors[key] = Vector3(*numbers)
    if not vectors:
        return None
    xyz, rpy = vectors.get("xyz", IDENTITY.xyz), vectors.get("rpy", IDENTITY.rpy)
    return Transform(xyz, rpy, is_stated=True, source=SourceRef(node, None, trail))


_OF_A_POSE = {"xyz": LENGTH, "rpy": ANGLE}


@cache
def _by_word(choices: type[Choice]) -> Mapping[str, Choice]:
    return {str(choice): choice for choice in choices}


def or_default(said: T | None, default: T) -> T:
    """Return what a field said, the default where it said nothing."""
    return default if said is None else said
