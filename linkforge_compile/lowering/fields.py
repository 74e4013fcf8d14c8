"""Typed reads from one object of the tree: each gives a value of the IR's kind, or tells why not and gives None."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from enum import StrEnum
from typing import TypeVar

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.core.models.geometry import IDENTITY, Transform, Vector3
from linkforge_compile.core.naming import is_valid_name
from linkforge_compile.diagnostics import Code, Diagnostics, notes_of_changes
from linkforge_compile.diagnostics.codes.expressions import TRUTH_AS_TEXT
from linkforge_compile.diagnostics.codes.model import (
    MISSING_FIELD,
    REFUSED,
    UNKNOWN_CHOICE,
    WRONG_COUNT,
    WRONG_KIND,
)
from linkforge_compile.diagnostics.codes.names import INVALID_NAME, NAME_TWICE
from linkforge_compile.diagnostics.codes.syntax import XACRO_EXPRESSION
from linkforge_compile.frozen import dataclass
from linkforge_compile.lowering.extra import extras_of
from linkforge_compile.lowering.quantities import (
    Bound,
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
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax import leaves_in
from linkforge_compile.syntax.nodes import YamlEntry, YamlFault, YamlList, YamlMap, YamlNode, YamlScalar, is_null
from linkforge_compile.syntax.scalars import TRUTHS_OF_YAML_1_1
from linkforge_compile.syntax.xacro import xacro_facts
from linkforge_compile.units import Dimension

_NEEDED_IN_XML = {
    "axis": """an <axis>; write '<axis xyz="0 0 1"/>'""",
    "limits": """a <limit>; write '<limit lower="-1" upper="1" effort="50" velocity="1"/>'""",
    "limits.effort": """an effort in its <limit>; write 'effort="50"'""",
    "limits.velocity": """a velocity in its <limit>; write 'velocity="1"'""",
}
"""What a URDF lacks that has none of a required field, and how it says it; by the field."""

T = TypeVar("T")
Choice = TypeVar("Choice", bound=StrEnum)


@dataclass(frozen=True, slots=True)
class Fields:
    """One object of the tree, ready to be read.

    Every reader returns None where nothing is said, where the fault has been told already (YamlFault), and where
    it tells one itself. With `required`, an example of what to write, nothing said is a fault of the object.
    So None from a required read always means: told, drop the object.
    """

    node: YamlMap
    owner: str
    """The named thing whose fields these are, as messages say it: "joint 'elbow'"."""
    sink: Diagnostics
    trail: tuple[Span, ...] = ()
    key: Span | None = None
    """Where the object's name stands, None for one without a name."""
    path: str = ""
    """The way from the owner to this object: "limits", "inertial.inertia", empty for the owner itself."""

    @property
    def title(self) -> str:
        """How messages name this very object: "limits of joint 'elbow'"."""
        return f"{self.path} of {self.owner}" if self.path else self.owner

    @property
    def ref(self) -> SourceRef:
        """What the IR object made of these fields has as its `source`."""
        return SourceRef(self.node, self.key, self.trail)

    # Reading one field

    def number(self, key: str, *dimensions: Dimension, bound: Bound | None = None, required: str = "") -> float | None:
        """Read a number in SI units: bare, or a quantity of one of the dimensions."""
        node = self.said(key, required)
        if node is None:
            return None
        plain = plain_number(node, bound)
        return self.number_at(node, key, Measure(dimensions, bound)) if plain is None else plain

    def integer(self, key: str, *, bound: Bound | None = None, required: str = "") -> int | None:
        """Read a whole number without a unit; 3.0 is one."""
        node = self.said(key, required)
        value = None if node is None else self.number_at(node, key, Measure((), bound))
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
        node = self.said(key, required)
        return None if node is None else self.text_at(node, key)

    def name(self, key: str, kind: str, *, required: str = "") -> str | None:
        """Read the name that a thing of this kind takes; its characters are judged."""
        node = self.said(key, required)
        text = None if node is None else self.text_at(node, key)
        return text if node is not None and text is not None and self.name_is_valid(text, kind, node) else None

    def vector3(
        self, key: str, *dimensions: Dimension, bound: Bound | None = None, required: str = ""
    ) -> Vector3 | None:
        """Read a list of three numbers in SI units."""
        node = self.said(key, required)
        if node is None:
            return None
        plain = plain_numbers(node, bound)
        return Vector3(*plain) if len(plain) == 3 else self.vector3_at(node, key, Measure(dimensions, bound))

    def choice(self, key: str, choices: type[Choice], *, required: str = "") -> Choice | None:
        """Read one word of an enumeration."""
        text = self.text(key, required=required)
        node = self.node.get(key)
        if text is None or node is None:
            return None
        try:
            return choices(text)
        except ValueError:
            words = [str(choice) for choice in choices]
        self.tell(UNKNOWN_CHOICE, node, near=words, field=key, choices=", ".join(words), name=text)
        return None

    def origin(self) -> Transform:
        """Read `origin`, a pose in the parent's frame: `[x, y, z]` or `{xyz, rpy}`; what is unsaid or faulty is 0."""
        node = self.node.get("origin")
        if isinstance(node, YamlList):
            xyz = self.vector3_at(node, "origin", Measure((Dimension.LENGTH,)))
            ref = SourceRef(node, None, self.trail)
            return Transform(xyz, is_stated=True, source=ref) if xyz else IDENTITY
        pose = self.map("origin")
        if pose is None:
            return IDENTITY
        xyz, rpy = pose.vector3("xyz", Dimension.LENGTH), pose.vector3("rpy", Dimension.ANGLE)
        is_stated = pose.node.get("xyz") is not None or pose.node.get("rpy") is not None
        return Transform(
            xyz or IDENTITY.xyz, rpy or IDENTITY.rpy, is_stated=is_stated, source=pose.ref, **extras_of(pose)
        )

    # Opening what is nested

    def map(self, key: str, *, required: str = "") -> Fields | None:
        """Open the object under a key."""
        node = self.said(key, required)
        return None if node is None else self.map_at(node, key)

    def map_at(self, node: YamlNode, field: str) -> Fields | None:
        """Open an object that stands at a node, such as an item of a list."""
        if isinstance(node, YamlMap):
            path = f"{self.path}.{field}" if self.path else field
            return Fields(node, self.owner, self.sink, self.trail, path=path)
        self.tell_kind(node, field, "a map")
        return None

    def each(self, key: str, kind: str, lower: Callable[[Fields, str], T | None]) -> Iterator[tuple[str, T | None]]:
        """Lower each entry of a map keyed by names, None for a faulty one; an entry with no value is an empty one."""
        section = self.map(key)
        for entry in section.node if section else ():
            node, owner = entry.value, f"{kind} '{entry.name}'"
            if is_null(node):
                node = YamlMap({}, entry.key.span)
            if isinstance(node, YamlMap):
                yield entry.name, lower(Fields(node, owner, self.sink, self.trail, entry.key.span), entry.name)
                continue
            self.tell_kind(node, owner, "a map")
            yield entry.name, None

    def nested(self, key: str) -> Iterator[tuple[YamlScalar, YamlEntry]]:
        """Yield the outer key and the inner entry of every `{outer: {inner: value}}` under a key."""
        section = self.map(key)
        for outer in section.node if section else ():
            if is_null(outer.value):
                continue
            inner = self.map_at(outer.value, f"'{outer.name}' in {key}")
            for entry in inner.node if inner else ():
                yield outer.key, entry

    def arranged(self, owner: str, key: Span, *written: YamlEntry, **nodes: YamlNode) -> Fields:
        """Return an object whose fields stand in the tree as keys or apart: its `source` finds them by field.

        `written` are entries that stand in the tree as they are; `nodes` go before one of the same name.
        """
        entries = {entry.name: entry for entry in written}
        entries |= {name: YamlEntry(YamlScalar(name, name, node.span), node) for name, node in nodes.items()}
        return Fields(YamlMap(entries, key), owner, self.sink, self.trail, key)

    def items(self, key: str) -> tuple[YamlNode, ...]:
        """Return the items of a list; one thing that is no list is a list of one; () where nothing is said."""
        node = self.node.get(key)
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
        plain = plain_numbers(node, measure.bound)
        if len(plain) in counts:
            return plain
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
        numbers = self.numbers_at(node, field, measure, 3)
        return Vector3(*numbers) if numbers else None

    def text_at(self, node: YamlNode, field: str) -> str | None:
        if isinstance(node, YamlScalar):
            return node.text
        self.tell_kind(node, field, "text")
        return None

    def name_is_valid(self, name: str, kind: str, where: YamlNode | SourceRef) -> bool:
        """Tell of a name that URDF readers do not take; True where they do."""
        if is_valid_name(name):
            return True
        if facts := xacro_facts(name):
            for each in facts:
                self.tell(XACRO_EXPRESSION, where, text=each["text"], ours=each["ours"])
            return False
        wrong = next((character for character in name if not is_valid_name(character)), None)
        reason = "it is empty" if wrong is None else f"{wrong!r} may not stand in one"
        self.tell(INVALID_NAME, where, name=name, kind=kind, reason=reason)
        return False

    # Telling, and making the IR's objects

    def tell(self, code: Code, where: YamlNode | SourceRef, *, near: Iterable[str] = (), **facts: object) -> None:
        """Report a fault at a node of this object, or at what a reference points to."""
        if isinstance(where, SourceRef):
            self.sink.report(code.at(where, near=near, notes=(), **facts))
            return
        changed = notes_of_changes(self.node.span.changes, where.span) if where is not self.node else ()
        self.sink.report(code.at(SourceRef(where, None, self.trail), near=near, notes=changed, **facts))

    @property
    def is_faulty(self) -> bool:
        """Whether a fault in this object has been told: what it seems to lack may be that, misspelt."""
        return any(isinstance(entry.value, YamlFault) for entry in self.node)

    def tell_lack(self, code: Code, **facts: object) -> None:
        """Report what this object lacks; silent where something in it is faulty."""
        if not self.is_faulty:
            self.tell(code, self.ref, near=(), **facts)

    def build(self, make: Callable[[], T]) -> T | None:
        """Make an object of the IR; what its constructor refuses is told at the field it names.

        Where a fault in this object has been told, it may refuse what stands in for that, or its lack: silently.
        """
        try:
            return make()
        except RobotModelError as error:
            if not self._has_told_faults:
                reason = error.message.removeprefix(f"{self.title} ")
                self.sink.report(REFUSED.at(self.ref, *error.field, owner=self.title, reason=reason))
            return None

    @property
    def _has_told_faults(self) -> bool:
        """Whether something in this object, however deep, is known to be wrong."""
        return any(isinstance(node, YamlFault) or self.sink.has_error_in(node.span) for node in leaves_in(self.node))

    def said(self, key: str, required: str = "") -> YamlNode | None:
        """Return what is said under a key; with an example of what to write, nothing said is told."""
        node = self.node.get(key)
        if node is None and required:
            field = f"{self.path}.{key}" if self.path else key
            element = _NEEDED_IN_XML.get(field, f"a '{key}'")
            self.tell_lack(MISSING_FIELD, owner=self.owner, field=field, key=key, example=required, element=element)
        return node

    def tell_kind(self, node: YamlNode, field: str, expected: str) -> None:
        """Report a node of another kind than its field takes; silent where that has been done."""
        if not isinstance(node, YamlFault):
            self.tell(WRONG_KIND, node, field=field, expected=expected, found=found(node))


def or_default(said: T | None, default: T) -> T:
    """Return what a field said, the default where it said nothing."""
    return default if said is None else said
