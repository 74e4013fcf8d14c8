"""Make the tree of a spec of a template."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.importing import TAGS_GROUPED, TEXT_LEFT_OUT
from linkforge_compile.importers.document import Imported
from linkforge_compile.importers.link import are_shapes_of
from linkforge_compile.importers.urdf import read_urdf
from linkforge_compile.migration.alike import with_loops
from linkforge_compile.migration.conditions import close
from linkforge_compile.migration.dimensions import settle_dimensions
from linkforge_compile.migration.groups import MARK, NAMED, REST, Group, Groups
from linkforge_compile.migration.inertia import Place
from linkforge_compile.migration.materials import used_materials
from linkforge_compile.migration.merge import CannotMergeError, Merger
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.parameters import comment_of, declaration, names_of
from linkforge_compile.migration.placeholders import Placeholders
from linkforge_compile.migration.raw import raw_element, raw_elements, raw_in, valid_variants, without_marks
from linkforge_compile.migration.repeat import repeated
from linkforge_compile.migration.symbols import CannotTranslateError, NotConstantError, Symbol, symbols_in
from linkforge_compile.migration.template import Element, FileDraft, Spec
from linkforge_compile.migration.uses import Uses
from linkforge_compile.migration.values import Values
from linkforge_compile.migration.written import Writer
from linkforge_compile.source import SourceFile, Span
from linkforge_compile.syntax import YamlEntry, YamlList, YamlMap, YamlNode, YamlScalar

_SECTIONS = ("materials", "links", "joints", "frames", "transmissions", "ros2_control")

_ORDER = (
    "mount",
    "materials",
    "links",
    "joints",
    "frames",
    "modules",
    "transmissions",
    "ros2_control",
    "gazebo",
    "extra",
)
"""The order of the sections of a spec."""


class FileMaker:
    """Makes the spec of one file."""

    def __init__(
        self,
        draft: FileDraft,
        modules: Mapping[FileDraft, Spec],
        materials: Mapping[str, Element],
        *,
        keeps_raw: bool = False,
        computed: Collection[Place] = (),
        packages: Mapping[str, str] = MappingProxyType({}),
        folder: Path = Path(),
    ) -> None:
        self._folder = folder
        self._keeps_raw, self._computed, self._packages = keeps_raw, computed, packages
        self._draft, self._modules, self._materials = draft, modules, materials
        self._placeholders = Placeholders()
        self._writer = Writer(self._placeholders)
        self._names = names_of(draft.symbols)
        self._values = Values(self._placeholders, self._names)
        self._comments: dict[YamlNode, str] = {}
        self._endings: dict[YamlNode, str] = {}
        self._extra: list[YamlNode] = []
        """Raw XML of the robot."""
        self._notes: set[str] = set()

    def spec(self, head: str) -> Spec:
        """Return the spec of the file; `head` is the comment that begins it.

        Raises:
            CannotTranslateError: if a part of it has no form.
            NotConstantError: if that depends on the values of names.

        """
        uses = Uses(self._draft, self._placeholders, self._writer, self._modules, self._folder)
        content = [*used_materials(uses.content, self._materials), *uses.content]
        groups = Groups(content, self._writer)
        robot = {**self._draft.robot_attributes, "name": ("robot",)}
        outside = uses.names() | groups.others
        read = [self._read(groups.document(number, robot), outside) for number in range(groups.count)]
        merger = Merger(self._placeholders)
        where = read[0].tree.span
        sections: dict[str, dict[str, YamlEntry]] = {name: {} for name in _SECTIONS}
        rest: dict[str, YamlNode] = {}
        self._take_materials(read, sections)
        if REST in groups.by_key:
            self._extra += raw_elements(read[0].tree, lambda tag: tag not in (*NAMED, "gazebo"))
        for group in groups.by_key.values():
            self._take(group, read, merger, sections, rest)
        self._comments, self._endings = _moved(read[0].comments, merger.moved)
        uses.take(sections)
        tree = {name: YamlMap(entries, where) for name, entries in sections.items() if entries}
        of_uses = uses.sections(self._values, where)
        self._comments |= uses.comments
        made = self._assemble({**tree, **of_uses, **rest}, read[0].tree, where)
        raw = tuple(raw_in(made.without("parameters", "variables")))
        left_out, used = tuple(self._writer.left_out), dict(self._values.used)
        notes = frozenset(self._notes)
        return Spec(head, made, self._names, used, raw, left_out, notes, self._comments, self._endings)

    def _read(self, text: str, outside: frozenset[str]) -> Imported:
        sink = Diagnostics()
        file = SourceFile("<migrated>", text)
        imported = read_urdf(file, sink, keeps_refused=True, outside=outside)
        if imported is None:
            raise CannotTranslateError(f"a robot that is not read: {sink.sorted()[0].message}")
        self._notes |= {one.message for one in sink.sorted() if one.code in (TEXT_LEFT_OUT, TAGS_GROUPED)}
        return imported

    # Groups

    def _take_materials(self, read: list[Imported], sections: dict[str, dict[str, YamlEntry]]) -> None:
        """Take the materials that visuals declare, and those of the robot that a module uses."""
        for imported in read:
            for name, entry in imported.tree.section("materials").items():
                sections["materials"].setdefault(name, entry)

    def _take(
        self,
        group: Group,
        read: list[Imported],
        merger: Merger,
        sections: dict[str, dict[str, YamlEntry]],
        rest: dict[str, YamlNode],
    ) -> None:
        """Merge the variants of a group, and put the result into its section."""
        tag, name = group.key
        if group.key == REST:
            return
        found: list[tuple[Mapping[str, bool], YamlNode | None]] = []
        raw: list[tuple[Mapping[str, bool], YamlNode | None]] = []
        key: YamlScalar | None = None
        for number, outcomes in enumerate(group.outcomes):
            tree = read[number].tree
            is_present = group.is_present(outcomes)
            entry = None if tag == "gazebo" else tree.section(NAMED[tag]).get(name)
            node = _block(tree, name) if tag == "gazebo" else entry.value if entry else None
            key = key or (entry.key if entry else None)
            found.append((outcomes, node if is_present else None))
            is_raw = is_present and (node is None or group.is_twofold(outcomes))
            raw.append((outcomes, raw_element(tree, group.key) if is_raw else None))
        if not self._keeps_raw:
            kept = valid_variants([node for _, node in found], [node for _, node in raw])
            close([one for number, (one, _) in enumerate(found) if number not in kept], group.atoms)
            found, raw = [found[number] for number in kept], [raw[number] for number in kept]
        node = self._merged(group, found, merger)
        self._extra += [one for one in self._merged_raw(group, raw, merger) if one is not None]
        if node is None:
            return
        if tag == "gazebo":
            blocks = rest.get("gazebo")
            items = (*blocks.items, node) if isinstance(blocks, YamlList) else (node,)
            rest["gazebo"] = YamlList(items, node.span)
        elif key is not None:
            sections[NAMED[tag]][name] = YamlEntry(key, _shortened(node) if tag == "link" else node)

    def _merged(
        self, group: Group, found: Sequence[tuple[Mapping[str, bool], YamlNode | None]], merger: Merger
    ) -> YamlNode | None:
        try:
            return merger.merged(group.atoms, found)
        except CannotMergeError as error:
            symbols = frozenset().union(*map(symbols_in, group.atoms.values()))
            reason, origin = f"alternatives of '{error.key}'", group.placed[0].element.origin
            if not symbols:
                raise CannotTranslateError(reason) from None
            needed = NotConstantError(symbols, reason)
            needed.where = origin.span if origin else None
            raise needed from None

    def _merged_raw(
        self, group: Group, raw: Sequence[tuple[Mapping[str, bool], YamlNode | None]], merger: Merger
    ) -> Iterator[YamlNode | None]:
        """Yield the raw XML of a group, with the condition under which it is there."""
        texts = dict.fromkeys(node.text for _, node in raw if isinstance(node, YamlScalar))
        for text in texts:
            same = [(one, node if isinstance(node, YamlScalar) and node.text == text else None) for one, node in raw]
            yield self._merged(group, same, merger)

    def _shown(self, name: str) -> str:
        return self._values.text(self._placeholders.parts(name))

    # The tree

    def _assemble(self, sections: Mapping[str, YamlNode], first: YamlMap, where: Span) -> YamlMap:
        filled = {name: self._values.fill(node) for name, node in sections.items()}
        if self._extra:
            filled["extra"] = self._values.fill(without_marks(YamlList(tuple(self._extra), where)))
        if isinstance(links := filled.get("links"), YamlMap):
            filled["links"] = links.mapped(self._without_inertia)
        if isinstance(blocks := filled.get("gazebo"), YamlList) and len(blocks) == 1:
            filled["gazebo"] = blocks.items[0]
        self._comments, self._endings = _moved((self._comments, self._endings), self._values.moved)
        name = self._values.text(self._draft.robot_name or (self._draft.stem,))
        version = first.get("version")
        settle_dimensions(self._writer.placements)
        variables: dict[str, YamlNode] = {}
        if isinstance(modules := filled.get("modules"), YamlMap):
            filled["modules"], variables, moved = repeated(modules, [*self._names.values()], where)
            self._comments, _ = _moved((self._comments, {}), moved)
        for section in ("ros2_control", "transmissions"):
            if isinstance(parts := filled.get(section), YamlMap):
                filled[section] = self._with_loops(parts, section)
        declared = self._declared(where)
        if variables:
            known = declared.get("variables")
            entries = known.entries if isinstance(known, YamlMap) else {}
            declared["variables"] = YamlMap({**entries, **map_of(variables, where).entries}, where)
        used = {package: scalar(path, where) for package, path in self._packages.items()}
        head = {
            "linkforge": scalar("1", where, is_text=False),
            "name": scalar(name, where),
            "version": version,
            "packages": map_of(used, where) if used else None,
        }
        body = {key: filled.get(key) for key in _ORDER}
        attributes = first.get("extra_attributes")
        rest = self._values.fill(attributes) if attributes else None
        return map_of({**head, **declared, **body, "extra_attributes": rest}, where)

    def _with_loops(self, parts: YamlMap, section: str) -> YamlMap:
        """Return a section in which joints or transmissions that are alike are one entry."""
        if section == "transmissions":
            made, moved = with_loops(parts, "each", self._names.values())
            self._comments, self._endings = _moved((self._comments, self._endings), moved)
            return made
        blocks: dict[str, YamlEntry] = {}
        for block in parts:
            body = block.value
            joints = body.get("joints") if isinstance(body, YamlMap) else None
            if isinstance(body, YamlMap) and isinstance(joints, YamlMap):
                made, moved = with_loops(joints, "each", self._names.values())
                self._comments, self._endings = _moved((self._comments, self._endings), {**moved, joints: made})
                body = YamlMap({**body.entries, "joints": YamlEntry(body.entries["joints"].key, made)}, body.span)
            blocks[block.name] = YamlEntry(block.key, body)
        return YamlMap(blocks, parts.span)

    def _without_inertia(self, link: YamlEntry) -> YamlNode:
        """Return a link without its inertia if that is computed of its shapes."""
        body = link.value
        inertial = body.get("inertial") if isinstance(body, YamlMap) else None
        is_computed = (f"{self._draft.stem}.robot.yaml", link.name) in self._computed
        if not isinstance(body, YamlMap) or not isinstance(inertial, YamlMap) or not is_computed:
            return body
        return body.with_value("inertial", inertial.without("inertia", "origin"))

    def _declared(self, where: Span) -> dict[str, YamlNode | None]:
        """Return the parameters, data and variables that the spec names, also through one another."""
        made: dict[str, dict[Symbol, YamlNode]] = {"parameter": {}, "data": {}, "variable": {}}
        waiting = list(self._values.used)
        if not self._draft.is_module:
            waiting += [symbol for symbol in self._draft.symbols if symbol.role == "parameter"]
        while waiting:
            symbol = waiting.pop(0)
            if symbol in made[symbol.role]:
                continue
            before = set(self._values.used)
            self._values.name(symbol)
            if symbol.role == "parameter":
                node = declaration(symbol, self._values, where)
            else:
                kind = symbol.kind if symbol.role == "variable" else ""
                node = self._values.value(symbol.value or ("",), where, kind)
            made[symbol.role][symbol] = node
            waiting += [one for one in self._values.used if one not in before]
        order = _order([*self._draft.symbols, *self._values.used])
        sections: dict[str, YamlNode | None] = {}
        for role, section in (("parameter", "parameters"), ("data", "data"), ("variable", "variables")):
            nodes = dict(sorted(made[role].items(), key=lambda item: order[item[0]]))
            entries = map_of({self._names[symbol]: node for symbol, node in nodes.items()}, where)
            sections[section] = entries if len(entries) else None
            for symbol in nodes:
                if comment := comment_of(symbol, self._names[symbol]):
                    self._comments[entries.entries[self._names[symbol]].key] = comment
        return sections


def _block(tree: YamlMap, mark: str) -> YamlNode | None:
    """Return the Gazebo block of the robot with a mark, without the mark."""
    blocks = tree.get("gazebo")
    for block in blocks if isinstance(blocks, YamlList) else (blocks,):
        properties = block.get("properties") if isinstance(block, YamlMap) else None
        if isinstance(block, YamlMap) and isinstance(properties, YamlMap) and properties.text(MARK) == mark:
            left = properties.without(MARK)
            return block.with_value("properties", left) if len(left) else block.without("properties")
    return None


def _order(symbols: list[Symbol]) -> dict[Symbol, tuple[int, int]]:
    """Return the order of symbols: by file, in which they have the order of their definitions."""
    files: dict[str, int] = {}
    return {
        symbol: (files.setdefault(symbol.place[0], number), symbol.place[1] or number)
        for number, symbol in enumerate(dict.fromkeys(symbols))
    }


def _moved(
    comments: tuple[Mapping[YamlNode, str], Mapping[YamlNode, str]], moved: Mapping[YamlNode, YamlNode]
) -> tuple[dict[YamlNode, str], dict[YamlNode, str]]:
    above, endings = comments
    return {moved.get(node, node): text for node, text in above.items()}, {
        moved.get(node, node): text for node, text in endings.items()
    }


def _shortened(node: YamlNode) -> YamlNode:
    """Return a link with the word `visual` for collisions that have the shapes of its visuals."""
    if not isinstance(node, YamlMap):
        return node
    visuals, collisions = (_maps(node.get(key)) for key in ("visual", "collision"))
    if any(one.get("when") is not None for one in (*visuals, *collisions)) or not are_shapes_of(visuals, collisions):
        return node
    return node.with_value("collision", YamlScalar("visual", "visual", node.span))


def _maps(node: YamlNode | None) -> list[YamlMap]:
    """Return a map, or those in a list."""
    items = node.items if isinstance(node, YamlList) else (node,)
    return [one for one in items if isinstance(one, YamlMap)]
