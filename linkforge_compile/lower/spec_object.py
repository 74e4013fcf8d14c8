"""One object of the tree: where it stands, how messages name it, and what there is to tell of it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.diagnostics import Code, Diagnostics, notes_of
from linkforge_compile.diagnostics.codes.model import MISSING_FIELD, REFUSED, WRONG_KIND
from linkforge_compile.lower.quantities import found
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.source.provenance import Kind, Link, Step, aliases_on, join_links, overrides_of
from linkforge_compile.source.ref import Located
from linkforge_compile.syntax import leaves_in
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode

_NEEDED_IN_XML = {
    "axis": """an <axis>; write '<axis xyz="0 0 1"/>'""",
    "limits": """a <limit>; write '<limit lower="-1" upper="1" effort="50" velocity="1"/>'""",
    "limits.effort": """an effort in its <limit>; write 'effort="50"'""",
    "limits.velocity": """a velocity in its <limit>; write 'velocity="1"'""",
}
"""What a URDF lacks that has none of a required field, and how it says it; by the field."""

T = TypeVar("T")

"""Makes one of the many that a robot has; those for a message take the constructor."""


def has_fault(node: YamlMap) -> bool:
    """Whether a field of an object is at fault; not whether something in a field is."""
    # All objects are asked: to begin a generator takes longer than to look at their few fields.
    return YamlFault in [entry.value.__class__ for entry in node.entries.values()]


class SpecObject:
    """A map of the tree that an object of the IR is made of.

    `owner` is the named thing whose fields these are, as messages say it: "joint 'elbow'"; `key` is the node of the
    object's name, None for one without a name; `path` is the way from the owner to this object: "limits",
    "inertial.inertia", empty for the owner itself. `outer` is the object that this one was opened in, None for a file
    and for what stands apart.
    """

    # There is one for every map of a spec: to make a frozen one takes four times as long.
    __slots__ = ("key", "node", "outer", "owner", "path", "sink", "trail")

    def __init__(  # noqa: PLR0917 as above: arguments by name take longer
        self,
        node: YamlMap,
        owner: str,
        sink: Diagnostics,
        trail: tuple[Span, ...] = (),
        key: Located | None = None,
        path: str = "",
        outer: SpecObject | None = None,
    ) -> None:
        self.node, self.owner, self.sink = node, owner, sink
        self.trail, self.key, self.path = trail, key, path
        self.outer = outer

    @property
    def ref(self) -> SourceRef:
        """What the object of the IR has as its `source`."""
        return SourceRef(self.node, self.key, self.trail)

    @property
    def title(self) -> str:
        """How messages name this very object: "limits of joint 'elbow'"."""
        return f"{self.path} of {self.owner}" if self.path else self.owner

    def tell(
        self, code: Code, where: YamlNode | SourceRef, *path: str | int, near: Iterable[str] = (), **facts: object
    ) -> None:
        """Report a fault at a node of this object, or at what a path leads to from a reference."""
        if isinstance(where, SourceRef):
            self.sink.report(code.at(where, *path, near=near, notes=notes_of(join_links(self._aliases())), **facts))
            return
        overrides = overrides_of(self.node.span.changes, where.span) if where is not self.node else ()
        aliases = self._aliases((None, self.node.span), (self._key_of(where, str(facts.get("field"))), where.span))
        notes = notes_of(join_links((*aliases, *overrides)))
        self.sink.report(code.at(SourceRef(where, None, self.trail), near=near, notes=notes, **facts))

    def _aliases(self, *inside: Step) -> Iterator[Link]:
        """Yield the aliases and `<<` that insert this object, or what the steps lead to in it."""
        for place in aliases_on((*self._way(), *inside)):
            yield Kind.OUTER_ALIAS, place, self.title

    def _way(self) -> tuple[Step, ...]:
        """The places of all objects that this one stands in, then of its name, or its own."""
        above: tuple[Step, ...] = (*self.outer._way(), (None, self.outer.node.span)) if self.outer else ()
        if self.key:
            return (*above, (self.key.span, None))
        field = self.path.rpartition(".")[2]
        return (*above, (self.outer._key_of(self.node, field) if self.outer else None, self.node.span))

    def _key_of(self, node: YamlNode, field: str) -> Span | None:
        """Return the key of a field, else the one that a node stands under, alone or in a list."""
        if field in self.node.entries:
            return self.node.key_span(field)
        for entry in self.node:
            if node is entry.value or (isinstance(entry.value, YamlList) and node in entry.value.items):
                return entry.key.span
        return None

    @property
    def is_faulty(self) -> bool:
        """Whether a fault in this object has been told: what it seems to lack may be that, misspelt."""
        return has_fault(self.node)

    def tell_lack(self, code: Code, **facts: object) -> None:
        """Report what this object lacks; silent where something in it is faulty."""
        if not self.is_faulty:
            self.tell(code, self.ref, near=(), **facts)

    def tell_missing(self, key: str, example: str) -> None:
        """Report that a required field says nothing, with an example of what to write."""
        field = f"{self.path}.{key}" if self.path else key
        element = _NEEDED_IN_XML.get(field, f"a '{key}'")
        self.tell_lack(MISSING_FIELD, owner=self.owner, field=field, key=key, example=example, element=element)

    def build(self, make: Callable[[], T]) -> T | None:
        """Make an object of the IR; what its constructor refuses is told at the field it names.

        Where a fault in this object has been told, it may refuse what stands in for that, or its lack: silently.
        """
        try:
            return make()
        except RobotModelError as error:
            if not self._has_told_faults:
                reason = error.message.removeprefix(f"{self.title} ")
                self.tell(REFUSED, self.ref, *error.field, owner=self.title, reason=reason)
            return None

    @property
    def _has_told_faults(self) -> bool:
        """Whether something in this object, however deep, is known to be wrong."""
        return any(isinstance(node, YamlFault) or self.sink.has_error_in(node.span) for node in leaves_in(self.node))

    def tell_kind(self, node: YamlNode, field: str, expected: str) -> None:
        """Report a node of another kind than its field takes; silent where that has been done."""
        if not isinstance(node, YamlFault):
            self.tell(WRONG_KIND, node, field=field, expected=expected, found=found(node))
