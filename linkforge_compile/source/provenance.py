"""Who wrote a value: links from its place to the files that include and use it, and their words in messages."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum, auto
from typing import NamedTuple, TypeAlias

from linkforge_compile.source.source_ref import Key, Located, SourceRef
from linkforge_compile.source.span import Change, Span


class Kind(Enum):
    """What happened to a value at the place of a link."""

    WRITTEN = auto()
    DEFAULT = auto()
    """It is written in the `defaults` of its file."""
    EXPRESSION = auto()
    """`name` is the expression that computes it."""
    ALIAS = auto()
    """An alias or `<<` inserts it."""
    OUTER_ALIAS = auto()
    """An alias or `<<` inserts the object around it, which `name` describes."""
    VALUE = auto()
    """It is written there and used where the chain starts."""
    TEXT_VALUE = auto()
    """As VALUE, for a text that looks as if it should be the expression `name`."""
    VALUE_USE = auto()
    """It is used there and written where the chain starts."""
    REPLACED = auto()
    """The value that an override replaced."""
    REPLACED_DEFAULT = auto()
    """The default that the entry's own value replaced."""
    OVERRIDE = auto()
    """An override sets the key `name` of it, or of an object around it."""
    INCLUDE = auto()
    USE = auto()
    COMMAND_LINE = auto()
    """The command line, of which `name` is the argument, sets a name of expressions."""
    PYTHON = auto()
    """Python or another program sets it."""
    WITH = auto()
    """The `with` of a module sets it."""
    VARIANT = auto()
    """The variant `name` sets it."""
    PARAMETER_DEFAULT = auto()
    VARIABLE = auto()
    REPETITION = auto()
    """It is a name of a `for`."""
    DATA = auto()
    """The file `name` of `data` holds its value."""


class Words(NamedTuple):
    """How a kind of link is worded; an empty text means that it is not shown there."""

    note: str = ""
    """In a note of a diagnostic."""
    sentence: str = ""
    """In the output of `explain`."""
    key: str = ""
    """In source maps, the output of `where`, and the comments of `expand --origins`."""


WORDS = {
    Kind.WRITTEN: Words(sentence="written"),
    Kind.DEFAULT: Words(sentence="written as a default"),
    Kind.EXPRESSION: Words(sentence="computed: {name}"),
    Kind.ALIAS: Words("inserted here"),
    Kind.OUTER_ALIAS: Words("inserted here, for {name}"),
    Kind.VALUE: Words("the value is written here", "the value itself is written"),
    Kind.TEXT_VALUE: Words("the value is written here; write '{name}'"),
    Kind.VALUE_USE: Words("the value is used here"),
    Kind.REPLACED: Words(sentence="instead of what is written"),
    Kind.REPLACED_DEFAULT: Words(sentence="instead of the default"),
    Kind.OVERRIDE: Words("'{name}' is changed by this override", "'{name}' is overridden", "overridden"),
    Kind.INCLUDE: Words("included here", "included", "included"),
    Kind.USE: Words("used here", "used", "used"),
    Kind.COMMAND_LINE: Words(sentence="from the command line: {name}"),
    Kind.PYTHON: Words(sentence="Python"),
    Kind.WITH: Words(sentence="'with'"),
    Kind.VARIANT: Words(sentence="variant '{name}'"),
    Kind.PARAMETER_DEFAULT: Words(sentence="the default"),
    Kind.VARIABLE: Words(sentence="the variable"),
    Kind.REPETITION: Words(sentence="one of 'for'"),
    Kind.DATA: Words(sentence="the content of {name}, named"),
}


@dataclass(frozen=True)
class Provenance:
    """One link of a chain, which iterates from the inside out; `name` is described at its kind."""

    kind: Kind
    span: Span
    name: str = ""
    outer: Provenance | None = None

    def __iter__(self) -> Iterator[Provenance]:
        link: Provenance | None = self
        while link:
            yield link
            link = link.outer

    @property
    def note(self) -> str:
        """The note of a diagnostic; "" for a link that diagnostics do not show."""
        return WORDS[self.kind].note.format(name=self.name)

    @property
    def sentence(self) -> str:
        """The words of `explain` before the place; "" for a link that it does not show."""
        return WORDS[self.kind].sentence.format(name=self.name)

    @property
    def key(self) -> str:
        """The key of a source map; "" for a link that it does not hold."""
        return WORDS[self.kind].key

    def spans(self, kind: Kind) -> tuple[Span, ...]:
        """Return the places of the links of one kind, from the inside out."""
        return tuple(link.span for link in self if link.kind is kind)


class Location(Enum):
    """Where a diagnostic points if an expression gets the value from elsewhere."""

    USE = auto()
    """At the expression."""
    DATA = auto()
    """At the value if it is read from a file of data, else at the expression."""
    VALUE = auto()
    """At the value."""


Link: TypeAlias = tuple[Kind, Span, str]
Step: TypeAlias = tuple[Span | None, Span | None]
"""The places of a key and of the value under it, None for one that does not exist."""


def join_links(links: Iterable[Link], outer: Provenance | None = None) -> Provenance | None:
    """Return the chain of links, given from the inside out, that goes on with `outer`."""
    for kind, span, name in reversed(tuple(links)):
        outer = Provenance(kind, span, name, outer)
    return outer


def provenance_of(where: Span | SourceRef, *path: str | int, location: Location = Location.USE) -> Provenance:
    """Return the chain of the deepest node on a path; it starts at the place that a diagnostic points at."""
    if isinstance(where, Span):
        start, *values = _located(where, location)
        return Provenance(*start, join_links(values, outward(start[1])))
    span = where.at(*path)
    start, *values = _located(span, location)
    links = (*aliases_of(where, *path), *values, *overrides_of(_changes(where, path), span))
    return Provenance(*start, join_links(links, outward(start[1], uses_of(where, span))))


def written_at(span: Span, source: SourceRef) -> Provenance:
    """Return the chain of a place in an object: what overrides changed right there, includes and uses."""
    changes = ((Kind.OVERRIDE, change.span, change.key) for change in span.changes)
    return Provenance(Kind.WRITTEN, span, "", join_links(changes, outward(span, uses_of(source, span))))


def outward(span: Span, uses: tuple[Span, ...] = ()) -> Provenance | None:
    """Return the includes of the file of a place, then the uses that led to it."""
    return join_links(((Kind.INCLUDE, include, "") for include in span.file.includes), uses_in(uses))


def uses_in(trail: Iterable[Span]) -> Provenance | None:
    """Return the chain of uses that brought a file in."""
    return join_links((Kind.USE, use, "") for use in trail)


def uses_of(source: SourceRef, place: Span) -> tuple[Span, ...]:
    """Return the uses that led to a place: to the object's own file or, from an override, to one that uses it."""
    files = [use.file for use in source.trail]
    return source.trail[files.index(place.file) + 1 :] if place.file in files else source.trail


def overrides_of(changes: Iterable[Change], place: Span) -> tuple[Link, ...]:
    """Return a link for each change by an override; () if the place itself lies in one."""
    known = tuple(changes)
    if any(place.lies_in(change.span) for change in known):
        return ()
    return tuple((Kind.OVERRIDE, change.span, change.key) for change in known)


def aliases_of(source: SourceRef, *path: str | int) -> tuple[Link, ...]:
    """Return a link for each alias and `<<` that inserts what is on a path."""
    return tuple((Kind.ALIAS, place, "") for place in aliases_on(_steps(source, path)))


def aliases_on(steps: Iterable[Step]) -> Iterator[Span]:
    """Yield the aliases and `<<` on the way to a node: an anchor is above the place that uses it.

    A URDF has none, and its attributes and elements in any order.
    """
    place: Span | None = None
    for key, value in steps:
        if key == value:
            continue  # the key is generated: it has the place of what was put under it
        for inner in (key, value):
            if inner and place and inner.file is place.file and inner.start < place.start and not inner.file.is_xml:
                yield place
            place = inner or place


def _located(used: Span, location: Location) -> tuple[Link, ...]:
    """Return the link to point at and, for a value that an expression takes from elsewhere, its other place."""
    origin = used.origin
    if origin is None:
        return ((Kind.WRITTEN, used, ""),)
    if location is Location.VALUE or (location is Location.DATA and origin.is_data):
        return (Kind.WRITTEN, origin.span, ""), (Kind.VALUE_USE, used, "")
    expression = used.forgotten_expression if location is Location.DATA else None
    return (Kind.WRITTEN, used, ""), (Kind.TEXT_VALUE if expression else Kind.VALUE, origin.span, expression or "")


def _steps(source: SourceRef, path: Iterable[str | int]) -> Iterator[Step]:
    node = source.node
    # The name of a robot is inside of its node, not above it.
    if not source.span.lies_in(node.span):
        yield None, source.span
    for key in path:
        inner, place = node.child(key), node.key_span(str(key))
        if inner or place:
            yield None, node.span
            yield place, inner.span if inner and not isinstance(key, Key) else None
        if inner is None:
            return
        node = inner


def _changes(source: SourceRef, path: Iterable[str | int]) -> Iterator[Change]:
    """Yield what overrides changed in the object and in those on the path."""
    node: Located | None = source.node
    yield from source.node.span.changes
    for key in path:
        node = node.child(key) if node else None
        yield from node.span.changes if node else ()
