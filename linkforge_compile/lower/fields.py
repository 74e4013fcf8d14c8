"""Read the fields of an object of the tree as values of the model; report what they do not accept."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from enum import StrEnum
from functools import cache
from typing import TypeVar

from linkforge_compile.core.models.geometry import Vector3
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT
from linkforge_compile.diagnostics.codes.model import UNKNOWN_CHOICE, WRONG_COUNT
from linkforge_compile.diagnostics.codes.names import INVALID_NAME, NAME_TWICE
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.diagnostics.entry_fixes import leave_out_item
from linkforge_compile.lower.numbers import (
    BARE,
    NumberType,
    Refusal,
    si_number,
    suggested_list,
    suspicion_facts,
    suspicious_unit,
)
from linkforge_compile.lower.object_context import ObjectContext
from linkforge_compile.source.characters import code_point
from linkforge_compile.syntax.nodes import (
    YAML_1_1_BOOLEANS,
    YamlEntry,
    YamlFault,
    YamlList,
    YamlMap,
    YamlNode,
    YamlScalar,
    is_null,
    xacro_facts,
)

T = TypeVar("T")
Choice = TypeVar("Choice", bound=StrEnum)


class Fields(ObjectContext):
    """A map of the tree with typed reads.

    Each returns None for an absent field, for one that could not be read (YamlFault, reported already), and for a
    value that the field does not accept, which it reports. With `required`, an example of what to write, an absent
    field is reported too, so that None always means: reported, leave the object out.
    """

    __slots__ = ()

    # Fields by key

    def get(self, key: str, required: str = "") -> YamlNode | None:
        """Return the node under a key, None for an absent or null one."""
        entry = self.node.entries.get(key)
        if entry and not (isinstance(entry.value, YamlScalar) and entry.value.value is None):
            return entry.value
        if required:
            self.report_missing(key, required)
        return None

    def number(self, key: str, accepted: NumberType = BARE, *, required: str = "") -> float | None:
        node = self.get(key, required)
        return None if node is None else self.number_at(node, key, accepted)

    def integer(self, key: str, accepted: NumberType = BARE, *, required: str = "") -> int | None:
        """Read a whole number without a unit; 3.0 is one."""
        node = self.get(key, required)
        value = None if node is None else self.number_at(node, key, accepted)
        if node is None or value is None:
            return None
        if not value.is_integer():
            self.report_wrong_kind(node, key, "a whole number")
            return None
        return int(value)

    def flag(self, key: str) -> bool | None:
        node = self.node.get(key)
        if isinstance(node, YamlScalar) and isinstance(node.value, bool):
            return node.value
        if isinstance(node, YamlScalar) and (truth := YAML_1_1_BOOLEANS.get(node.text.lower())):
            self.report(TRUTH_AS_TEXT, node, name=node.text, expected=truth)
        elif node is not None:
            self.report_wrong_kind(node, key, "true or false")
        return None

    def text(self, key: str, *, required: str = "") -> str | None:
        """Read a scalar as it was written: text, or a reference to a name."""
        node = self.get(key, required)
        return None if node is None else self.text_at(node, key)

    def name(self, key: str, kind: str) -> str | None:
        """Read the name of something of a kind, such as "joint"; report one that URDF readers do not accept."""
        node = self.get(key)
        text = None if node is None else self.text_at(node, key)
        return text if text is not None and self.name_is_valid(text, kind, node) else None

    def vector3(self, key: str, accepted: NumberType = BARE, *, required: str = "") -> Vector3 | None:
        """Read a list of three numbers in SI units."""
        node = self.get(key, required)
        return None if node is None else self.vector3_at(node, key, accepted)

    def choice(self, key: str, choices: type[Choice], *, required: str = "") -> Choice | None:
        text = self.text(key, required=required)
        if text is None:
            return None
        words = by_word(choices)
        if text not in words:
            node = self.node.entries[key].value
            self.report(UNKNOWN_CHOICE, node, near=words, field=key, choices=", ".join(words), name=text)
        return words.get(text)

    # Objects and lists inside

    def map(self, key: str, *, required: str = "") -> Fields | None:
        node = self.get(key, required)
        return None if node is None else self.map_at(node, key)

    def map_at(self, node: YamlNode, field: str) -> Fields | None:
        """Return the object at a node of this one, such as an item of a list."""
        if isinstance(node, YamlMap):
            path = f"{self.path}.{field}" if self.path else field
            return Fields(node, self.owner, self.sink, self.trail, None, path, self)
        self.report_wrong_kind(node, field, "a map")
        return None

    def each(self, key: str, kind: str, lower: Callable[[Fields, str], T | None]) -> Iterator[tuple[str, T | None]]:
        """Lower each entry of a map keyed by names, None for a faulty one; an entry without a value is an empty map."""
        section = self.map(key)
        for entry in section.node if section else ():
            node, name = entry.value, entry.name
            owner = f"{kind} '{name}'"
            if not isinstance(node, YamlMap) and is_null(node):
                node = YamlMap({}, entry.key.span)
            if isinstance(node, YamlMap):
                yield name, lower(Fields(node, owner, self.sink, self.trail, entry.key, "", section), name)
                continue
            self.report_wrong_kind(node, owner, "a map")
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

    def arranged(self, owner: str, key: YamlNode, *entries: YamlEntry, **nodes: YamlNode) -> Fields:
        """Return an object made of these entries and nodes of the tree, so that its `source` finds them by field.

        A node replaces an entry of the same name.
        """
        by_name = {entry.name: entry for entry in entries}
        by_name |= {name: YamlEntry(YamlScalar(name, name, node.span), node) for name, node in nodes.items()}
        return Fields(YamlMap(by_name, key.span), owner, self.sink, self.trail, key)

    def items(self, key: str) -> tuple[YamlNode, ...]:
        """Return the items of a list; a node that is no list is a list of one."""
        node = self.get(key)
        if node is None:
            return ()
        return node.items if isinstance(node, YamlList) else (node,)

    def names(self, key: str) -> tuple[str, ...]:
        """Read a list of references to names, without those that are faulty."""
        return tuple(name for name, _ in self.named_items(key))

    def named_items(self, key: str) -> Iterator[tuple[str, YamlNode]]:
        """Yield the names of a list, each with its node, without those that are faulty; report repeated ones."""
        seen: set[str] = set()
        for node in self.items(key):
            name = self.text_at(node, key)
            if name is None:
                continue
            if not name or is_null(node):
                self.report_wrong_kind(node, key, "names")
                continue
            if name in seen:
                fix = leave_out_item(node.span, f"remove '{name}'")
                self.report(NAME_TWICE, node, fixes=[fix], name=name, field=key, owner=self.title)
            seen.add(name)
            yield name, node

    # Values at a node

    def number_at(self, node: YamlNode, field: str, accepted: NumberType) -> float | None:
        """Read a number in SI units; warn of one that is probably in other units."""
        value = node.value if isinstance(node, YamlScalar) else None
        if (value.__class__ is float or value.__class__ is int) and accepted.least <= value <= accepted.most:
            return float(value)  # nine of ten numbers
        if isinstance(node, YamlFault):
            return None
        number = si_number(node, accepted)
        if isinstance(number, Refusal):
            self.report(number.code, node, near=number.near, fixes=(), field=field, **number.facts)
            return None
        if code := suspicious_unit(node, number, accepted):
            self.report(code, node, fixes=(), field=field, **suspicion_facts(node, number))
        return number

    def numbers_at(self, node: YamlNode, field: str, accepted: NumberType, *counts: int) -> tuple[float, ...] | None:
        """Read a list of numbers, as many as one of `counts`."""
        if not isinstance(node, YamlList):
            self.report_wrong_kind(node, field, suggested_list(node, counts) or f"a list of {_count_words(counts)}")
            return None
        if YamlFault in map(type, node.items):
            return None
        if len(node.items) not in counts:
            self.report(WRONG_COUNT, node, field=field, expected=_count_words(counts), count=len(node))
            return None
        numbers = [self.number_at(item, field, accepted) for item in node.items]
        return None if None in numbers else tuple(numbers)  # type: ignore[arg-type]  # none of them is None

    def vector3_at(self, node: YamlNode, field: str, accepted: NumberType) -> Vector3 | None:
        """Read a list of three numbers in SI units."""
        numbers = self.numbers_at(node, field, accepted, 3)
        return Vector3(*numbers) if numbers else None

    def text_at(self, node: YamlNode, field: str) -> str | None:
        if isinstance(node, YamlScalar):
            return node.text
        self.report_wrong_kind(node, field, "text")
        return None

    def name_is_valid(self, name: str, kind: str, where: YamlNode | None = None) -> bool:
        """Whether URDF readers accept a name; report it if not, without `where` at the object."""
        if is_valid_name(name):
            return True
        place = where or self.ref
        if facts := xacro_facts(name):
            for each in facts:
                self.report(XACRO_EXPRESSION, place, text=each["text"], ours=each["ours"])
            return False
        wrong = dict.fromkeys(character for character in name if not is_valid_name(character))
        shown = [repr(one) if one.isprintable() else code_point(one) for one in wrong]
        reason = f"it may not contain {' or '.join(shown)}" if wrong else "it is empty"
        what = kind if kind == "prefix" else f"name for a {kind}"
        self.report(INVALID_NAME, place, name=name, kind=what, reason=reason)
        return False


def _count_words(counts: tuple[int, ...]) -> str:
    return f"{' or '.join(map(str, counts))} numbers"


@cache
def by_word(choices: type[Choice]) -> Mapping[str, Choice]:
    """Return the members of an enumeration by the words that the language has for them."""
    return {str(choice): choice for choice in choices}
