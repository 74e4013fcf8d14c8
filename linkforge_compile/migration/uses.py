"""Uses of modules in a file, and the joint that attaches a module to the file that uses it."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

from linkforge_compile.importers.origin import relative_path
from linkforge_compile.migration.attachment import parts_of
from linkforge_compile.migration.blocks import carrier, given_block
from linkforge_compile.migration.nodes import map_of, scalar
from linkforge_compile.migration.parameters import type_of
from linkforge_compile.migration.placeholders import Placeholders
from linkforge_compile.migration.symbols import (
    BOOLEAN,
    NUMBER,
    UNSET,
    VECTOR,
    Parts,
    Reference,
    Symbol,
    as_parts,
    is_literal,
    literal_of,
    value_of,
)
from linkforge_compile.migration.template import BlockForm, Choice, Content, Element, FileDraft, Kept, Spec, Use
from linkforge_compile.migration.values import Values
from linkforge_compile.migration.vectors import as_vector
from linkforge_compile.migration.written import Writer
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar

_MOUNT = "linkforge_mount"
_CARRIER = "linkforge_use_"
_BLOCK = "linkforge_block_"


class Uses:
    """The uses in one file. `content` is that of the file with a joint in the place of each use and of the mount."""

    def __init__(
        self,
        draft: FileDraft,
        placeholders: Placeholders,
        writer: Writer,
        modules: Mapping[FileDraft, Spec],
        spec_folder: Path,
    ) -> None:
        self._spec_folder = spec_folder
        self._draft, self._placeholders, self._writer, self._modules = draft, placeholders, writer, modules
        self._uses: list[tuple[Use | Kept, tuple[ast.expr, ...]]] = []
        self._carried: dict[str, YamlMap] = {}
        self._mount: YamlEntry | None = None
        self.comments: dict[YamlNode, str] = {}
        """The comments above entries of `modules`, by their keys."""
        self.content = self._without_uses(draft.content, ())

    def _without_uses(self, content: list[Content], guards: tuple[ast.expr, ...]) -> list[Content]:
        made: list[Content] = []
        for one in content:
            if isinstance(one, Use | Kept):
                made += self._carriers(one, len(self._uses))
                self._uses.append((one, guards))
            elif isinstance(one, Choice):
                made.append(Choice(one.test, self._without_uses(one.content, (*guards, one.test)), one.origin))
            elif one is self._draft.attachment:
                made.append(_attached_to(one, (_MOUNT,), None))
            else:
                made.append(one)
        return made

    def _carriers(self, use: Use | Kept, number: int) -> list[Content]:
        """Return a joint that carries the parent and the origin of a use, and a link for each of its blocks."""
        blocks: list[Content] = []
        if isinstance(use, Kept):
            if use.parent is None:
                return []
            parent, origin = Element("parent", {"link": use.parent}, []), use.origin
        else:
            blocks += [
                carrier(f"{_BLOCK}{number}_{symbol.wish}", form, content) for symbol, form, content in self._blocks(use)
            ]
            if use.attachment is None:
                return blocks
            parts = {one.tag: one for one in use.attachment.content if isinstance(one, Element)}
            parent, origin = parts["parent"], parts.get("origin")
        child = Element("child", {"link": (f"{_CARRIER}{number}",)}, [])
        content: list[Content] = [parent, child, *([origin] if origin else [])]
        return [Element("joint", {"name": (f"{_CARRIER}{number}",), "type": ("fixed",)}, content), *blocks]

    def _blocks(self, use: Use) -> Iterator[tuple[Symbol, BlockForm, list[Content]]]:
        """Yield the parameters of a module for blocks, with what a use of it gives."""
        used = self._modules[use.module].used
        for parameter, (symbol, form) in use.module.blocks.items():
            if symbol in used:
                yield symbol, form, use.blocks[parameter]

    def names(self) -> frozenset[str]:
        """Return the names of the links and joints of the modules."""
        inline = [use.inline or [] for use, _ in self._uses if isinstance(use, Use)]
        parts = (one for content in inline for one, _ in parts_of(content, ()))
        return frozenset(
            self._writer.name(one.attributes.get("name", ())) for one in parts if one.tag in ("link", "joint")
        )

    def take(self, sections: dict[str, dict[str, YamlEntry]]) -> None:
        """Take the joints that carry something out of the sections."""
        for section in (joints := sections["joints"], sections["links"]):
            for name in [name for name in section if name.startswith((_CARRIER, _BLOCK))]:
                body = section.pop(name).value
                if isinstance(body, YamlMap):
                    self._carried[name] = body
        for name, entry in list(joints.items()):
            if isinstance(entry.value, YamlMap) and entry.value.text("parent") == _MOUNT:
                self._mount = YamlEntry(entry.key, entry.value.without("parent", "origin"))
                del joints[name]

    def sections(self, values: Values, where: Span) -> dict[str, YamlNode]:
        """Return the sections `mount` and `modules`."""
        made: dict[str, YamlNode] = {}
        if self._mount is not None:
            made["mount"] = YamlMap({self._mount.name: self._mount}, where)
        entries: dict[str, YamlNode | None] = {}
        short = Counter(_words_of(use)[:1] for use, _ in self._uses)
        for number, (use, guards) in enumerate(self._uses):
            words = _words_of(use)
            name = self._entry_name(use, words[:1] if short[words[:1]] == 1 else words, entries)
            carried = self._carried.get(f"{_CARRIER}{number}")
            own = self._kept(use, values, where) if isinstance(use, Kept) else self._own(use, number, values, where)
            entries[name] = self._entry(own, guards, carried, where)
        if entries:
            made["modules"] = modules = map_of(entries, where)
            uses = zip(modules.entries.values(), self._uses, strict=True)
            self.comments = {entry.key: use.comment for entry, (use, _) in uses if isinstance(use, Use) and use.comment}
        return made

    def _entry_name(self, use: Use | Kept, words: Sequence[str], taken: Mapping[str, object]) -> str:
        """Return the name of an entry: words of its arguments if there are any, else that of the macro."""
        text = "_".join(words)
        own = use.name if isinstance(use, Kept) else use.module.name
        base = re.sub(r"\W+", "_", text).strip("_") or own
        if text and base != own and len(base) < 3:
            base = f"{base}_{own}"
        name, number = base, 2
        while name in taken:
            name, number = f"{base}_{number}", number + 1
        return name

    def _kept(self, kept: Kept, values: Values, where: Span) -> dict[str, YamlNode | None]:
        """Return what the entry of a macro that stays one has of its own."""
        given = {name: values.value(parts or ("",), where, "") for name, parts in kept.arguments.items()}
        return {
            "use": scalar(relative_path(self._spec_folder, kept.file.absolute()), where),
            "macro": scalar(kept.name, where),
            "prefix": None if kept.prefix is None else scalar(kept.prefix, where),
            "with": map_of(given, where) if given else None,
        }

    def _own(self, use: Use, number: int, values: Values, where: Span) -> dict[str, YamlNode | None]:
        """Return what the entry of a module has of its own."""
        spec = self._modules[use.module]
        given: dict[str, YamlNode | None] = {}
        parameters = [one for one in use.module.symbols if one.role == "parameter" and not one.is_block]
        by_wish = {symbol.wish: symbol for symbol in parameters}
        for wish, parts in use.arguments.items():
            symbol = by_wish.get(wish)
            if symbol is None or symbol not in spec.used or _same_value(parts, symbol):
                continue
            if symbol.is_closed and len(parts) == 1 and isinstance(parts[0], Reference):
                _close(parts[0].symbol, symbol)
            given[spec.names[symbol]] = self._placed(parts, symbol, values, where)
        for symbol, form, _ in self._blocks(use):
            given[spec.names[symbol]] = given_block(form, self._carried[f"{_BLOCK}{number}_{symbol.wish}"], where)
        return {
            "use": scalar(f"{use.module.stem}.robot.yaml", where),
            "prefix": scalar("", where),
            "with": map_of(given, where) if given else None,
        }

    def _entry(
        self, own: Mapping[str, YamlNode | None], guards: tuple[ast.expr, ...], carried: YamlMap | None, where: Span
    ) -> YamlMap:
        """Return an entry with its condition, and the parent and origin that a joint has carried."""
        when = None
        if guards:
            test = guards[0] if len(guards) == 1 else ast.BoolOp(op=ast.And(), values=list(guards))
            text = self._placeholders.number(test)
            when = YamlScalar(text, text, where)
        joint = {key: carried.get(key) if carried else None for key in ("parent", "origin")}
        first = {key: own[key] for key in ("use", "macro") if key in own}
        return map_of({"when": when, **first, **joint, **own}, where)

    def _placed(self, parts: Parts, symbol: Symbol, values: Values, where: Span) -> YamlNode:
        """Return the value of a parameter."""
        if len(parts) == 1 and isinstance(node := parts[0], ast.expr):
            if symbol.kind == VECTOR:
                node = as_vector(node, symbol.size)
            self._writer.placements.append((node, type_of(symbol)))
            parts = (node,)
        if symbol.kind in (BOOLEAN, NUMBER) and is_literal(parts):
            parts = as_parts(value_of(parts)) or ("",)
        return values.value(parts, where, symbol.kind)


def _close(outer: Symbol, symbol: Symbol) -> None:
    """Give a parameter that is handed on to another one the words of that one."""
    words = dict.fromkeys([*outer.choices, *symbol.choices])
    if outer.role == "parameter" and (outer.value is None or "".join(map(str, outer.value)) in words):
        outer.choices, outer.is_closed = words, True


def _words_of(use: Use | Kept) -> tuple[str, ...]:
    """Return the arguments that tell one use from another."""
    values = [use.arguments.get(key) for key in ("name", "prefix", "link_name", "side", "suffix")]
    texts = [str(one[0]).strip(" _") for one in values if one and is_literal(one)]
    return tuple(text for text in texts if text)


def _same_value(parts: Parts, symbol: Symbol) -> bool:
    """Whether a text is the literal that is the default of a parameter."""
    one, other = literal_of(value_of(parts)), UNSET if symbol.value is None else literal_of(value_of(symbol.value))
    return one is not UNSET and other is not UNSET and type(one) is type(other) and one == other


def _attached_to(joint: Element, parent: Parts, origin: Element | None) -> Element:
    """Return a joint with another parent and origin."""
    content: list[Content] = [
        one for one in joint.content if not (isinstance(one, Element) and one.tag in ("parent", "origin"))
    ]
    content.append(Element("parent", {"link": parent}, []))
    return Element(joint.tag, joint.attributes, content, joint.origin, joint.calls)
