"""Explain a value of a robot: what it is, where it was written or what it was computed from."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from linkforge_compile.core.models.link import Collision, Visual
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.expand.values import NameOrigin, find_name_origins
from linkforge_compile.export_spec.builder import SpecBuilder
from linkforge_compile.export_spec.provenance import is_default, written_at
from linkforge_compile.export_spec.robot import spec_of
from linkforge_compile.source import Located, SourceRef, Span
from linkforge_compile.source.provenance import Kind, Link, Provenance, join_links, outward, uses_of
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar
from linkforge_compile.syntax.writer import write

_SHORT_FORMS = {"origin": "xyz", "box": "size", "sphere": "radius", "mesh": "file", "color": "rgba"}
"""What an object means of which only one value is written: `origin: [x, y, z]` is its `xyz`."""


class UnknownPathError(LookupError):
    """A path leads nowhere: `owner` is as far as it leads, "" for the robot itself, and `names` is what is there.

    `paths` has the path of each named part, by its name.
    """

    def __init__(self, owner: str, name: str, names: Sequence[str], paths: Mapping[str, str]) -> None:
        self.owner = owner
        self.name = name
        self.names = tuple(names)
        self.paths = paths
        place = f"'{owner}'" if owner else "the robot"
        super().__init__(f"there is no '{name}' in {place}")


@dataclass(frozen=True)
class Explanation:
    """A value of a finished robot.

    `text` is what a spec writes for it, after its path, with the unit of a number. `provenance` starts where the value
    was written; if `is_written` is False, at the nearest thing around it that was; None for a robot that was built in
    Python. `names` lists how the names in its expression got their values. `computed_from` is what a link's inertial
    was computed from, None for all else.
    """

    text: str
    is_written: bool = False
    provenance: Provenance | None = None
    names: tuple[NameOrigin, ...] = ()
    computed_from: ComputedFrom | None = None


class _Step(NamedTuple):
    """A key, or a position in a list, and the node at it."""

    key: str
    node: YamlNode


def explain(robot: Robot, path: str) -> Explanation:
    """Explain the value at a path of the language's keys and the robot's final names: `links/base/inertial/mass`.

    Every object has its long form: `links/base/visual/0/origin/xyz/2`; of one visual the 0 may be left out. Names
    may hold slashes, and the longest is taken with which the rest of the path leads somewhere.

    Raises:
        UnknownPathError: where the path leads nowhere.
        RobotGeneratorError: for two parts of one name.

    """
    builder = SpecBuilder(full=True)
    whole = spec_of(robot, builder)
    steps = (_Step("", whole), *_steps(whole, path.strip("/"), ""))
    keys_of_path = [step.key for step in steps[1:]]
    text = _text("/".join(keys_of_path), _without_defaults(robot, keys_of_path, steps[-1].node), builder)
    last = max((place for place, step in enumerate(steps) if step.node in builder.written), default=None)
    if last is None:
        return Explanation(text)
    source, field = builder.written[steps[last].node]
    keys = (*field, *(step.key for step in steps[last + 1 :]))
    node, is_written = _deepest(source.node, steps[last].key, keys)
    computed = computed_from(robot, keys_of_path)
    if not is_written:
        place = source.span if node is source.node else node.span
        return Explanation(text, False, _chain(place, source), (), computed)
    return _written(source, node, text, _replaced(source.node, steps[last].key, keys), computed)


def parts_at(robot: Robot, path: str) -> dict[str, bool]:
    """Return what is at a path that `explain` accepts, "" for the robot, by key, name or position.

    True is for what has parts of its own, False for a value.

    Raises:
        UnknownPathError: where the path leads nowhere.
        RobotGeneratorError: for two parts of one name.

    """
    whole = spec_of(robot, SpecBuilder(full=True))
    (*_, last) = (_Step("", whole), *_steps(whole, path.strip("/"), ""))
    match last.node:
        case YamlMap():
            return {name: bool(_names(entry.value)) for name, entry in last.node.entries.items()}
        case YamlList():
            return {str(place): bool(_names(item)) for place, item in enumerate(last.node)}
    return {}


def _without_defaults(robot: Robot, path: Sequence[str], node: YamlNode) -> YamlNode:
    """Return a map without its defaults, in short forms; the node itself where a spec without them has no such map."""
    if not path or not isinstance(node, YamlMap):
        return node
    found: YamlNode | None = spec_of(robot, SpecBuilder())
    for key in path:
        found = found.get(key) if isinstance(found, YamlMap) else None
    return found if isinstance(found, YamlMap) else node


def _written(
    source: SourceRef, node: Located, text: str, replaced: Sequence[Link], computed: ComputedFrom | None
) -> Explanation:
    """Explain a value that a node of an object writes."""
    place = source.span if node is source.node else node.span
    links: list[Link] = []
    names: tuple[NameOrigin, ...] = ()
    if (expression := _expression(place)) is not None:
        links.append((Kind.EXPRESSION, place, expression))
        names = find_name_origins(node) if isinstance(node, YamlNode) else ()
        origin = node.span.origin
        if origin and isinstance(node, YamlNode) and origin.span not in _places(names):
            links.append((Kind.VALUE, origin.span, ""))
    links += replaced
    links += _overridden(node, "")
    return Explanation(text, True, _chain(place, source, links), names, computed)


def _chain(place: Span, source: SourceRef, links: Iterable[Link] = ()) -> Provenance:
    return replace(written_at(place), outer=join_links(links, outward(place, uses_of(source, place))))


def _places(names: Iterable[NameOrigin]) -> Iterator[Span]:
    for name in names:
        yield name.setting.node.span
        yield from _places(name.names)


def _steps(node: YamlNode, path: str, before: str) -> tuple[_Step, ...]:
    """Return the steps of a path from a node, which lies at `before`."""
    if not path:
        return ()
    fault: UnknownPathError | None = None
    for step, rest in _ways(node, path, before.rpartition("/")[2]):
        here = f"{before}/{step.key}".strip("/")
        try:
            return (step, *_steps(step.node, rest, here))
        except UnknownPathError as error:
            fault = fault or error
    paths = {} if before else _paths(node)
    raise fault or UnknownPathError(before, path.partition("/")[0], _names(node), paths)


def _ways(node: YamlNode, path: str, key: str) -> Iterator[tuple[_Step, str]]:
    """Yield the first steps that a path may begin with and what remains of it, longest names first.

    `key` is that of the node: of an object with a short form, `box/0` is `box/size/0`.
    """
    if isinstance(node, YamlMap):
        for name in sorted(node.entries, key=len, reverse=True):
            if f"{path}/".startswith(f"{name}/"):
                yield _Step(name, node.entries[name].value), path[len(name) + 1 :]
        short = _SHORT_FORMS.get(key, "")
        if isinstance(inner := node.get(short), YamlList) and path.partition("/")[0].isdecimal():
            yield _Step(short, inner), path
    elif isinstance(node, YamlList):
        first, _, rest = path.partition("/")
        if first.isdecimal() and int(first) < len(node):
            yield _Step(first, node.items[int(first)]), rest
        elif len(node) == 1:
            yield _Step("0", node.items[0]), path


def _names(node: YamlNode) -> Sequence[str]:
    if isinstance(node, YamlMap):
        return tuple(node.entries)
    return tuple(map(str, range(len(node)))) if isinstance(node, YamlList) else ()


def _paths(robot: YamlNode) -> Mapping[str, str]:
    """Return the path of every entry of a robot's sections by its name, that of the first of a name."""
    paths: dict[str, str] = {}
    for section in robot if isinstance(robot, YamlMap) else ():
        for name in section.value.entries if isinstance(section.value, YamlMap) else ():
            paths.setdefault(name, f"{section.name}/{name}")
    return paths


def _deepest(node: Located, name: str, keys: Sequence[str]) -> tuple[Located, bool]:
    """Follow the keys from what was written under `name`, and return how far that leads; True for all the way."""
    for key in keys:
        inner = _written_child(node, name, key)
        if inner is None:
            return node, False
        node, name = inner, key
    return node, True


def _replaced(node: Located, name: str, keys: Sequence[str]) -> Sequence[Link]:
    """Return the values that were replaced at the deepest key on the way to a value that replaced any."""
    entry: YamlEntry | None = None
    for key in keys:
        if isinstance(node, YamlMap) and key in node.entries and node.entries[key].replaced:
            entry = node.entries[key].replaced
        inner = _written_child(node, name, key)
        if inner is None:
            break
        node, name = inner, key
    links: list[Link] = []
    while entry:
        place = entry.value.span
        links.append((Kind.REPLACED_DEFAULT if is_default(place) else Kind.REPLACED, place, ""))
        entry = entry.replaced
    return links


def _overridden(node: Located, path: str) -> Iterator[Link]:
    """Yield what overrides changed in what is written at a node, and deeper in it, each with its path."""
    for change in node.span.changes:
        yield Kind.OVERRIDE, change.span, f"{path}{change.key}"
    for entry in node if isinstance(node, YamlMap) else ():
        yield from _overridden(entry.value, f"{path}{entry.name}/")
    for position, item in enumerate(node) if isinstance(node, YamlList) else ():
        yield from _overridden(item, f"{path}{position}/")


def _written_child(node: Located, name: str, key: str) -> Located | None:
    """Return what was written for a key of the long form; a short form is all that was written."""
    if not isinstance(node, YamlMap):
        is_short = key == _SHORT_FORMS.get(name) or (isinstance(node, YamlScalar) and key.isdecimal())
        return node if is_short else node.child(int(key)) if key.isdecimal() else None
    inner = node.get(key)
    # One object is a list of one.
    return node if inner is None and key == "0" else inner


def _expression(place: Span) -> str | None:
    text = place.text
    return text if text and "$(" in text.replace("$$(", "") else None


def _text(path: str, node: YamlNode, builder: SpecBuilder) -> str:
    """Return `path: value` as a spec would write it, with the unit of a number or of the numbers in a list."""
    key = YamlScalar(path, path, node.span)
    if not path:
        assert isinstance(node, YamlMap), "a robot is a map"
        return write(node).rstrip("\n")
    text = write(YamlMap({path: YamlEntry(key, node)}, node.span)).rstrip("\n")
    number = node.items[0] if isinstance(node, YamlList) and len(node) else node
    unit = builder.units.get(number)
    return text if unit is None else f"{text} {unit.si_unit}"


_COMPUTED = ("origin", "inertia")


class Shape(NamedTuple):
    """A shape of the link: its path, such as `collision/0`, its geometry, and where it was written."""

    path: str
    geometry: str
    place: Span | None


class ComputedFrom(NamedTuple):
    """The quantity, `mass` or `density`, where it was written, and the shapes that it is distributed over."""

    quantity: str
    place: Provenance
    shapes: tuple[Shape, ...]


def computed_from(robot: Robot, path: Sequence[str]) -> ComputedFrom | None:
    """Return what the value at a path of a full spec was computed from; None unless it is part of such an inertial."""
    match path:
        case ("links", name, "inertial", *rest) if name in robot.links:
            link, field = robot.link(name), rest[0] if rest else None
        case _:
            return None
    source = link.inertial.source if link.inertial else None
    node = source.node if source else None
    if not isinstance(node, YamlMap) or node.get("inertia") is not None:
        return None
    quantity = "mass" if node.get("mass") is not None else "density"
    spread = node.get(quantity)
    is_computed = field in {None, *_COMPUTED} or (field == "mass" and quantity == "density")
    if spread is None or not is_computed:
        return None
    kind = "collision" if link.collisions else "visual"
    bodies: Sequence[Visual | Collision] = link.collisions or link.visuals
    shapes = tuple(
        Shape(f"{kind}/{place}", body.geometry.type.value, body.source.span if body.source else None)
        for place, body in enumerate(bodies)
    )
    return ComputedFrom(quantity, written_at(spread.span), shapes)
