"""Materials: declared by name in a file, or written where they are used."""

from __future__ import annotations

import re

from linkforge_compile.core.fields import ZERO_TO_ONE
from linkforge_compile.core.models.material import Color, Material
from linkforge_compile.diagnostics.codes.model import EMPTY_MATERIAL, OUT_OF_RANGE
from linkforge_compile.diagnostics.codes.names import UNKNOWN_MATERIAL
from linkforge_compile.diagnostics.suggest import nearest
from linkforge_compile.lower.extra import CommonKwargs, common_kwargs
from linkforge_compile.lower.fields import Fields
from linkforge_compile.lower.numbers import FRACTION
from linkforge_compile.lower.scope import FileScope
from linkforge_compile.source import SourceRef, Span
from linkforge_compile.syntax.nodes import YamlList, YamlMap, YamlNode, YamlScalar

_BYTE = 255
_LEAST_BYTE = 16
"""The brightest part of a color that was meant in bytes is at least so large; 2 is a slip for 0.2."""


def lower_materials(file: Fields, scope: FileScope) -> dict[str, Material | None]:
    """Lower the materials that a file declares, None for a faulty one."""
    return dict(file.each("materials", "material", lambda fields, name: _material(fields, name, scope)))


def lower_visual_material(visual: Fields, scope: FileScope) -> Material | None:
    """Lower a visual's material: one of the file's by its name, or one that is written in place."""
    node = visual.node.get("material")
    if node is None:
        return None
    if isinstance(node, YamlMap):
        inline = visual.map_at(node, "material")
        return None if inline is None else _material(inline, inline.text("name") or "", scope)
    name = visual.text_at(node, "material")
    if name is None:
        return None
    if name not in scope.materials and name not in scope.lost_materials:
        hint = "" if nearest(name, scope.materials) else "; declare it in 'materials', or write '{color: [r, g, b]}'"
        visual.report(UNKNOWN_MATERIAL, node, near=scope.materials, name=name, hint=hint)
    return scope.materials.get(name)


def _material(fields: Fields, name: str, scope: FileScope) -> Material | None:
    color, texture = fields.node.get("color"), fields.node.get("texture")
    if color is None and texture is None:
        fields.report_incomplete(
            EMPTY_MATERIAL, owner=fields.title, hint=_color_in_comment(fields.node.key_span("color"))
        )
        return None
    rgba, file = _color(fields), fields.text("texture")
    if rgba is None and file is None:
        return None
    image = scope.resource(file, texture) if file is not None and texture is not None else None
    after_links = fields.flag("after_links") or False
    return fields.build(lambda: Material(name, rgba, image, after_links=after_links, **common_kwargs(fields)))


def _color_in_comment(key: Span | None) -> str:
    """Say how a color is written that stands behind its key as in style sheets, which YAML takes for a comment."""
    behind = key.file.line(key.line)[key.end_column - 1 :] if key else ""
    written = re.match(r":[ \t]+(#((?:[0-9a-fA-F]{2}){3,4}))(?!\S)", behind)
    if written is None:
        return ""
    return f"; '{written[1]}' begins a comment: write '[{', '.join(map(_of_byte, bytes.fromhex(written[2])))}]'"


def _color(fields: Fields) -> Color | None:
    """Read `color`: red, green, blue and, unless it is 1, opacity, each from 0 to 1."""
    node = fields.node.get("color")
    long = fields.map_at(node, "color") if isinstance(node, YamlMap) else None
    numbers = node if long is None else long.get("rgba", "[0.6, 0.6, 0.65]")
    if isinstance(numbers, YamlList) and (meant := _of_bytes(numbers)):
        seen = f"[{', '.join(item.text for item in numbers if isinstance(item, YamlScalar))}]; write '{meant}'"
        fields.report(OUT_OF_RANGE, numbers, field="color", bound=ZERO_TO_ONE.words, found=seen)
        return None
    if isinstance(numbers, YamlList) and _report_bytes(fields, numbers):
        return None
    rgba = None if numbers is None else fields.numbers_at(numbers, "color", FRACTION, 3, 4)
    if node is None or rgba is None:
        return None
    rest: CommonKwargs = common_kwargs(long) if long else {"source": SourceRef(node, None, fields.trail)}
    return fields.build(lambda: Color(*rgba, **rest))


def _report_bytes(fields: Fields, numbers: YamlList) -> bool:
    """Tell of single parts that are written from 0 to 255, where the others are right; return whether there are any."""
    others = [item for item in numbers if not _is_part(item)]
    large = [byte for item in others if (byte := _byte(item)) is not None and byte >= _LEAST_BYTE]
    if len(large) < len(others):
        return False
    for item, byte in zip(others, large, strict=True):
        seen = f"{byte}; write '{_of_byte(byte)}'"
        fields.report(OUT_OF_RANGE, item, field="color", bound=ZERO_TO_ONE.words, found=seen)
    return bool(large)


def _of_bytes(numbers: YamlList) -> str | None:
    """Return the color whose parts are written from 0 to 255, each from 0 to 1; None for any other list."""
    rgb = [byte for byte in map(_byte, numbers.items[:3]) if byte is not None]
    if len(rgb) < 3 or len(numbers) > 4 or max(rgb) < _LEAST_BYTE:
        return None
    opacity = _opacity(numbers.items[3]) if len(numbers) == 4 else "1"
    return f"[{', '.join((*map(_of_byte, rgb), opacity))}]" if opacity else None


def _opacity(node: YamlNode) -> str | None:
    """Return an opacity from 0 to 1: style sheets count it so beside colors in bytes, others in bytes as well."""
    if isinstance(node, YamlScalar) and _is_part(node):
        return node.text
    byte = _byte(node)
    return None if byte is None else _of_byte(byte)


def _is_part(node: YamlNode) -> bool:
    """Whether a number from 0 to 1 is written."""
    value = node.value if isinstance(node, YamlScalar) else None
    return isinstance(value, int | float) and not isinstance(value, bool) and 0 <= value <= 1


def _byte(node: YamlNode) -> int | None:
    value = node.value if isinstance(node, YamlScalar) else None
    return value if isinstance(value, int) and not isinstance(value, bool) and 0 <= value <= _BYTE else None


def _of_byte(byte: int) -> str:
    return f"{byte / _BYTE:.3g}"
