"""Uses of modules in a file, and the joint that attaches a module to the file that uses it."""

from __future__ import annotations

import ast
import re
from collections.abc import Mapping

from linkforge_compile.migration.attachment import parts_of
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
from linkforge_compile.migration.template import Choice, Content, Element, FileDraft, Spec, Use
from linkforge_compile.migration.values import Values
from linkforge_compile.migration.written import Writer, mark_vector
from linkforge_compile.source import Span
from linkforge_compile.syntax import YamlEntry, YamlMap, YamlNode, YamlScalar

_MOUNT = "linkforge_mount"
_CARRIER = "linkforge_use_"


class Uses:
    """The uses in one file. `content` is that of the file with a joint in the place of each use and of the mount."""

    def __init__(
        self, draft: FileDraft, placeholders: Placeholders, writer: Writer, modules: Mapping[FileDraft, Spec]
    ) -> None:
        self._draft, self._placeholders, self._writer, self._modules = draft, placeholders, writer, modules
        self._uses: list[tuple[Use, tuple[ast.expr, ...]]] = []
        self._carried: dict[str, YamlMap] = {}
        self._mount: YamlEntry | None = None
        self.content = self._without_uses(draft.content, ())

    def _without_uses(self, content: list[Content], guards: tuple[ast.expr, ...]) -> list[Content]:
        made: list[Content] = []
        for one in content:
            if isinstance(one, Use):
                made += self._carrier(one, len(self._uses))
                self._uses.append((one, guards))
            elif isinstance(one, Choice):
                made.append(Choice(one.test, self._without_uses(one.content, (*guards, one.test)), one.origin))
            elif one is self._draft.attachment:
                made.append(_attached_to(one, (_MOUNT,), None))
            else:
                made.append(one)
        return made

    def _carrier(self, use: Use, number: int) -> list[Content]:
        """Return a joint that carries the parent and the origin of a use."""
        if use.attachment is None:
            return []
        origin = next((one for one in use.attachment.content if isinstance(one, Element) and one.tag == "origin"), None)
        parent = next(one for one in use.attachment.content if isinstance(one, Element) and one.tag == "parent")
        child = Element("child", {"link": (f"{_CARRIER}{number}",)}, [])
        content: list[Content] = [parent, child, *([origin] if origin else [])]
        return [Element("joint", {"name": (f"{_CARRIER}{number}",), "type": ("fixed",)}, content)]

    def names(self) -> frozenset[str]:
        """Return the names of the links and joints of the modules."""
        parts = (one for use, _ in self._uses for one, _ in parts_of(use.inline or [], ()))
        return frozenset(
            self._writer.name(one.attributes.get("name", ())) for one in parts if one.tag in ("link", "joint")
        )

    def take(self, sections: dict[str, dict[str, YamlEntry]]) -> None:
        """Take the joints that carry something out of the sections."""
        joints = sections["joints"]
        for name in [name for name in joints if name.startswith(_CARRIER)]:
            body = joints.pop(name).value
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
        for number, (use, guards) in enumerate(self._uses):
            name = self._entry_name(use, entries)
            entries[name] = self._entry(use, guards, self._carried.get(f"{_CARRIER}{number}"), values, where)
        if entries:
            made["modules"] = map_of(entries, where)
        return made

    def _entry_name(self, use: Use, taken: Mapping[str, object]) -> str:
        """Return the name of an entry: that in its arguments if there is one, else that of the macro."""
        words = [use.arguments.get(key) for key in ("name", "prefix", "link_name", "side", "suffix")]
        text = next((str(one[0]) for one in words if one and is_literal(one) and str(one[0]).strip()), "")
        base = re.sub(r"\W+", "_", text).strip("_") or use.module.name
        if text and base != use.module.name and len(base) < 3:
            base = f"{base}_{use.module.name}"
        name, number = base, 2
        while name in taken:
            name, number = f"{base}_{number}", number + 1
        return name

    def _entry(
        self, use: Use, guards: tuple[ast.expr, ...], carried: YamlMap | None, values: Values, where: Span
    ) -> YamlMap:
        spec = self._modules[use.module]
        given: dict[str, YamlNode | None] = {}
        by_wish = {symbol.wish: symbol for symbol in use.module.symbols if symbol.role == "parameter"}
        for wish, parts in use.arguments.items():
            symbol = by_wish.get(wish)
            if symbol is None or symbol not in spec.used:
                continue
            if _same_value(parts, symbol):
                continue
            if len(parts) == 1 and isinstance(parts[0], ast.expr):
                if symbol.kind == VECTOR and isinstance(parts[0], Reference):
                    mark_vector(parts[0].symbol, symbol.size)
                self._writer.placements.append((parts[0], type_of(symbol)))
            given[spec.names[symbol]] = self._placed(parts, symbol, values, where)
        when = None
        if guards:
            test = guards[0] if len(guards) == 1 else ast.BoolOp(op=ast.And(), values=list(guards))
            text = self._placeholders.number(test)
            when = YamlScalar(text, text, where)
        parts_of_joint = {key: carried.get(key) if carried else None for key in ("parent", "origin")}
        return map_of(
            {
                "when": when,
                "use": scalar(f"{use.module.stem}.robot.yaml", where),
                **parts_of_joint,
                "prefix": scalar("", where),
                "with": map_of(given, where) if given else None,
            },
            where,
        )

    def _placed(self, parts: Parts, symbol: Symbol, values: Values, where: Span) -> YamlNode:
        """Return the value of a parameter."""
        if symbol.kind in (BOOLEAN, NUMBER) and is_literal(parts):
            parts = as_parts(value_of(parts)) or ("",)
        return values.value(parts, where, symbol.kind)


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
