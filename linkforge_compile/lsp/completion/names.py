"""The names that a place may refer to: those of the robot, or inside an override those in the module."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence

from linkforge_compile.checks.groups import LinkSets
from linkforge_compile.core.models.robot import Robot
from linkforge_compile.editor.completions import KEYS, NAMES, in_quotes_if_needed, marked_names
from linkforge_compile.editor.vocabulary import Entries, entries_of, names_by_kind
from linkforge_compile.expand import Instance
from linkforge_compile.lsp.completion.context import Context
from linkforge_compile.lsp.completion.items import REQUIRED, Kind, Offer
from linkforge_compile.lsp.completion.refused import refused_names
from linkforge_compile.lsp.cursor import MARKER
from linkforge_compile.schema.descriptions import Described, described_at
from linkforge_compile.syntax import YamlMap, YamlScalar

_SECTIONS = {"link": ("links",), "joint": ("joints",), "material": ("materials",), "group": ("semantic", "groups")}
"""Where an override has the names of a kind."""

_STATES = ("semantic", "group_states")


def kinds_of_names(branches: Iterable[Described], what: str) -> tuple[str, ...]:
    """Return the kinds of parts that values (NAMES) or keys (KEYS) here name."""
    marked = (marked_names(branch.schema) for branch in branches)
    return tuple(dict.fromkeys(kind for found, kinds in marked if found == what for kind in kinds))


def written(name: str, context: Context) -> str:
    """Return a name as YAML has it at the position: in quotes where it needs them and has none."""
    return name if context.is_quoted else in_quotes_if_needed(name)


def kinds_of_values(context: Context) -> tuple[str, ...]:
    """Return the kinds of parts that a value here names; in an override, those of the value that it replaces."""
    override = override_at(context)
    branches = described_at(override[1]) if override else context.branches
    return kinds_of_names(branches, NAMES)


def offer_names(context: Context) -> list[Offer]:
    """Return the names that a value here may be."""
    kinds, override = kinds_of_values(context), override_at(context)
    refused = refused_names(context, override[1] if override else context.cursor.path)
    offers = [
        Offer(name, written(name, context), Kind.Reference, REQUIRED, kind, sought=written(name, context))
        for kind in kinds
        for name in names_here(context, kind)
        if name not in refused
    ]
    return offers + _offer_states(context)


def names_here(context: Context, kind: str) -> Sequence[str]:
    """Return the names of a kind of parts, as the text of the position has them."""
    override = override_at(context)
    if override is not None:
        entries: Entries | Sequence[str] = override[0]
        for key in _SECTIONS.get(kind, (kind,)):
            entries = entries.get(key, ()) if isinstance(entries, Mapping) else ()
        return () if isinstance(entries, Mapping) else entries
    known = names_by_kind(context.robot).get(kind, ()) if context.robot else ()
    return [*dict.fromkeys((*known, *_written_names(context, kind)))]


def _written_names(context: Context, kind: str) -> Iterator[str]:
    """Yield the names of a kind as the text has them now, also one that was never readable."""
    section = context.node(_SECTIONS[kind]) if kind in _SECTIONS else None
    for entry in section if isinstance(section, YamlMap) else ():
        if "$(" not in entry.name and MARKER not in entry.name:
            yield entry.name
    if kind == "link":
        yield from (name for _, name, _ in context.sections("frames") if "$(" not in name)


def _offer_states(context: Context) -> list[Offer]:
    """Return the states of the group that is a key in a state of another group."""
    path = context.cursor.path
    if path[:2] != _STATES or context.robot is None:
        return []
    states = (state for state in context.robot.semantic.group_states if state.group == path[-1])
    return [Offer(one.name, written(one.name, context), Kind.Reference, REQUIRED, "state") for one in states]


def keys_that_name(context: Context) -> list[tuple[str, str]]:
    """Return the names that keys here may be, each with its kind."""
    override = override_at(context)
    if override is not None:
        entries: Entries | Sequence[str] = override[0]
        for key in override[1]:
            entries = entries.get(str(key), ()) if isinstance(entries, Mapping) else ()
        return [] if isinstance(entries, Mapping) else [(name, "in the module") for name in entries]
    kinds = kinds_of_names(context.branches, KEYS)
    path = context.cursor.path
    refused = refused_names(context, path)
    found = [(name, kind) for kind in kinds for name in names_here(context, kind) if name not in refused]
    if context.robot is None or path[:2] != _STATES or len(path) != len(_STATES) + 2:
        return found
    joints = _joints_moved_by(str(path[2]), context.robot)
    if joints:  # a new group has none yet
        found = [one for one in found if one[0] in joints]
    return [*_parts_of_group(str(path[2]), context.robot), *found]


def _joints_moved_by(group: str, robot: Robot) -> Collection[str]:
    """Return the joints that a group moves, also by its links, chains and subgroups."""
    links = LinkSets(robot)
    moved = links.of_groups.get(group, 0)
    return {joint for joint, link in links.moved.items() if links.bit(link) & moved}


def _parts_of_group(name: str, robot: Robot) -> list[tuple[str, str]]:
    """Return the groups within the group of a state, whose states it may name."""
    groups = (group for group in robot.semantic.groups if group.name == name)
    return [(one, "group") for group in groups for one in group.subgroups]


def override_at(context: Context) -> tuple[Entries, tuple[str | int, ...]] | None:
    """Return the names that the override around the position can address, and the path in it; None for no override."""
    path = context.cursor.path
    root = context.readable.instance if context.readable else None
    found: Entries | None = None
    begin = 0
    while path[begin : begin + 1] == ("modules",) and path[begin + 2 : begin + 3] == ("override",):
        use = context.node((*path[: begin + 2], "use"))
        root = _module(root, str(path[begin + 1]), use.text if isinstance(use, YamlScalar) else "")
        found, begin = entries_of(root) if root else {}, begin + 3
    return None if found is None else (found, path[begin:])


def _module(instance: Instance | None, name: str, use: str) -> Instance | None:
    """Return a module by its name, or the first that uses a file."""
    modules = instance.modules if instance else ()
    named = (one for one in modules if one.name == name)
    return next(named, next((one for one in modules if use and _use_of(one) == use), None))


def _use_of(module: Instance) -> str:
    use = module.entry.node.child("use") if module.entry else None
    return use.text if isinstance(use, YamlScalar) else ""
