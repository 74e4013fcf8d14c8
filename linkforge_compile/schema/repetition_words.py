"""Tell `for` and `when` that repeat a map from keys of that name, which what plugins read may have."""

from __future__ import annotations

from collections.abc import Collection

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.diagnostics.codes.modules import LONG_FORM
from linkforge_compile.schema.shapes import Shape
from linkforge_compile.syntax import YamlFault, YamlMap, YamlNode, YamlScalar, has_expression
from linkforge_compile.syntax.nodes import YAML_1_1_BOOLEANS

FOR_AND_WHEN = frozenset({"for", "when"})


def repetition_words(node: YamlNode, shape: Shape, *, is_entry: bool) -> frozenset[str]:
    """Return those of `for` and `when` in a map that decide how often it occurs; XML for plugins has data alone.

    `is_entry` is whether it is an item of a list, or a value in a map whose keys are names or those of a plugin.
    """
    if not isinstance(node, YamlMap) or not (words := FOR_AND_WHEN & node.entries.keys()):
        return frozenset()
    if not shape.is_for_plugins:
        return words if (shape.is_object or is_entry) and not shape.is_plain else frozenset()
    written = {word: node.entries[word].value for word in words if is_entry or word in shape.own_words}
    return frozenset(word for word, value in written.items() if _is_word(word, value) and not value.span.file.is_xml)


def _is_word(word: str, value: YamlNode) -> bool:
    """Whether the value is one of `for`, a map, or of `when`: true, false, a misspelling of these, an expression."""
    if word == "for" or not isinstance(value, YamlScalar):
        return word == "for" and isinstance(value, YamlMap)
    return isinstance(value.value, bool) or value.text.lower() in YAML_1_1_BOOLEANS or has_expression(value.text)


def without_words(node: YamlMap, words: Collection[str], shape: Shape, sink: Diagnostics) -> YamlNode | None:
    """Return what occurs of a map with these words; None for a malformed long form, which is reported."""
    rest = {name: entry for name, entry in node.entries.items() if name not in words}
    if shape.is_for_plugins:
        return rest["value"].value if rest.keys() == {"value"} else YamlMap(rest, node.span)
    if shape.is_object and not (shape.has_short_form and "value" in rest):
        return YamlMap(rest, node.span)
    others = [entry.key for name, entry in rest.items() if name != "value"]
    if any(isinstance(entry.value, YamlFault) for entry in node):
        return None  # the schema reported it
    if others or "value" not in rest:
        where = others[0].span if others else next(iter(node)).key.span
        sink.report(LONG_FORM.at(where, found=f"'{others[0].text}'" if others else "no 'value'"))
        return None
    return rest["value"].value
