"""Report what is wrong with an object of the tree: in its name, at its place, with how it got there."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from linkforge_compile.core.exceptions import RobotModelError
from linkforge_compile.diagnostics import Code, Diagnostics, Note, notes_of
from linkforge_compile.diagnostics.codes.model import MISSING_FIELD, REFUSED, WRONG_KIND
from linkforge_compile.diagnostics.codes.names import DUPLICATE_NAME
from linkforge_compile.diagnostics.fix import Fix
from linkforge_compile.lower.numbers import describe_node
from linkforge_compile.source import Located, ModuleUse, SourceRef, Span
from linkforge_compile.source.provenance import Kind, Link, Step, aliases_on, join_links, overrides_of, uses_in
from linkforge_compile.syntax import leaves_in
from linkforge_compile.syntax.nodes import YamlFault, YamlList, YamlMap, YamlNode

_REQUIRED_IN_XML = {
    "axis": """an <axis>; write '<axis xyz="0 0 1"/>'""",
    "limits": """a <limit>; write '<limit lower="-1" upper="1" effort="50" velocity="1"/>'""",
    "limits.effort": """an effort in its <limit>; write 'effort="50"'""",
    "limits.velocity": """a velocity in its <limit>; write 'velocity="1"'""",
}
"""How a URDF writes a required field, by the field."""

T = TypeVar("T")


def has_fault(node: YamlMap) -> bool:
    """Whether a field of an object could not be read; faults further inside do not count."""
    return YamlFault in [type(entry.value) for entry in node]


def report_duplicate(
    sink: Diagnostics, kind: str, name: str, second: SourceRef | None, first: SourceRef | None
) -> None:
    """Report two things of one name at the second, with the first and the files that use it as notes."""
    notes = []
    if first:
        notes = [Note("the first is here", first.span), *notes_of(uses_in(first.trail))]
    sink.report(DUPLICATE_NAME.at(second, kind=kind, name=name, notes=notes))


class ObjectContext:
    """A map of the tree that is lowered to an element, and what messages say about it.

    `owner` is the named thing that the map belongs to, as messages name it: "joint 'elbow'"; `key` is the node of the
    element's name, None for one without a name; `path` is the way from the owner to this map: "limits",
    "inertial.inertia", empty for the owner itself. `outer` is the map around this one, None for a file.
    """

    __slots__ = ("key", "node", "outer", "owner", "path", "sink", "trail")

    def __init__(  # noqa: PLR0917 made for every map of a spec, with several arguments that are the same for all
        self,
        node: YamlMap,
        owner: str,
        sink: Diagnostics,
        trail: tuple[ModuleUse, ...] = (),
        key: Located | None = None,
        path: str = "",
        outer: ObjectContext | None = None,
    ) -> None:
        self.node, self.owner, self.sink = node, owner, sink
        self.trail, self.key, self.path = trail, key, path
        self.outer = outer

    @property
    def ref(self) -> SourceRef:
        """The `source` of the element."""
        return SourceRef(self.node, self.key, self.trail)

    @property
    def title(self) -> str:
        """The name of this object in messages: "limits of joint 'elbow'"."""
        return f"{self.path} of {self.owner}" if self.path else self.owner

    @property
    def is_faulty(self) -> bool:
        """Whether a field of this object could not be read, which is reported: it may be the one that is missing."""
        return has_fault(self.node)

    def report(
        self,
        code: Code,
        where: YamlNode | SourceRef,
        *path: str | int,
        near: Iterable[str] = (),
        fixes: Iterable[Fix | None] = (),
        **facts: object,
    ) -> None:
        """Report a fault at a node of this object, or at what a path leads to from a reference."""
        if isinstance(where, SourceRef):
            fault = code.at(where, *path, near=near, notes=notes_of(join_links(self._aliases())), **facts)
            self.sink.report(fault.with_fix(*fixes))
            return
        overrides = overrides_of(self.node.span.changes, where.span) if where is not self.node else ()
        aliases = self._aliases((None, self.node.span), (self._key_of(where, str(facts.get("field"))), where.span))
        notes = notes_of(join_links((*aliases, *overrides)))
        fault = code.at(SourceRef(where, None, self.trail), near=near, notes=notes, **facts)
        self.sink.report(fault.with_fix(*fixes))

    def report_missing(self, key: str, example: str) -> None:
        """Report that a required field has no value, with an example of one."""
        field = f"{self.path}.{key}" if self.path else key
        element = _REQUIRED_IN_XML.get(field, f"a '{key}'")
        self.report_incomplete(MISSING_FIELD, owner=self.owner, field=field, key=key, example=example, element=element)

    def report_incomplete(self, code: Code, *, fixes: Iterable[Fix | None] = (), **facts: object) -> None:
        """Report that something is missing in this object, unless a faulty field may be what is missing."""
        if not self.is_faulty:
            self.report(code, self.ref, near=(), fixes=fixes, **facts)

    def report_wrong_kind(self, node: YamlNode, field: str, expected: str) -> None:
        """Report a node of another kind than its field accepts, unless it is a fault that is reported already."""
        if not isinstance(node, YamlFault):
            self.report(WRONG_KIND, node, field=field, expected=expected, found=describe_node(node))

    def build(self, make: Callable[[], T]) -> T | None:
        """Call a constructor and report what it refuses, at the field it names; return None then.

        It may refuse the substitute of something faulty, which is reported already.
        """
        try:
            return make()
        except RobotModelError as error:
            leaves = leaves_in(self.node)
            if not any(isinstance(leaf, YamlFault) or self.sink.has_error_in(leaf.span) for leaf in leaves):
                reason = error.message.removeprefix(f"{self.title} ")
                self.report(REFUSED, self.ref, *error.field, owner=self.title, reason=reason)
            return None

    def _aliases(self, *inside: Step) -> Iterator[Link]:
        """Yield the aliases and `<<` that insert this object, or what the steps lead to in it."""
        for place in aliases_on((*self._way(), *inside)):
            yield Kind.OUTER_ALIAS, place, self.title

    def _way(self) -> tuple[Step, ...]:
        """Return the places of all objects around this one, then of its name, or its own."""
        outer: tuple[Step, ...] = (*self.outer._way(), (None, self.outer.node.span)) if self.outer else ()
        if self.key:
            return (*outer, (self.key.span, None))
        field = self.path.rpartition(".")[2]
        return (*outer, (self.outer._key_of(self.node, field) if self.outer else None, self.node.span))

    def _key_of(self, node: YamlNode, field: str) -> Span | None:
        """Return the key of a field, else the one that has a node as its value, or in its list."""
        if field in self.node.entries:
            return self.node.key_span(field)
        for entry in self.node:
            if node is entry.value or (isinstance(entry.value, YamlList) and node in entry.value.items):
                return entry.key.span
        return None
