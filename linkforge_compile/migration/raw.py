"""Raw XML in a spec that is made."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence

from linkforge_compile.migration.groups import MARK
from linkforge_compile.source.xml_tree import first_tag
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar


def raw_elements(tree: YamlMap, is_wanted: Callable[[str], bool]) -> list[YamlScalar]:
    """Return the raw XML of the robot or a part of it whose tags are wanted."""
    extra = tree.get("extra")
    items = extra.items if isinstance(extra, YamlList) else () if extra is None else (extra,)
    return [one for one in items if isinstance(one, YamlScalar) and is_wanted(first_tag(one.text))]


def raw_element(tree: YamlMap, key: tuple[str, str]) -> YamlScalar | None:
    """Return the raw XML of a group: the element of its tag that has its name or mark."""
    tag, name = key
    sign = f"<{MARK}>{name}</{MARK}>" if tag == "gazebo" else f'name="$(prefix){name}"'
    found = raw_elements(tree, lambda one: one == tag)
    texts = [one for one in found if sign in one.text]
    if len(texts) < 2:
        return texts[0] if texts else None
    whole = "\n".join(one.text for one in texts)  # a name may be written twice
    return YamlScalar(whole, whole, texts[0].span)


def without_marks(extra: YamlNode) -> YamlNode:
    """Return raw XML without the marks of blocks."""
    if isinstance(extra, YamlList):
        return YamlList(tuple(map(without_marks, extra)), extra.span)
    if isinstance(extra, YamlMap):
        return extra.mapped(lambda entry: without_marks(entry.value))
    if isinstance(extra, YamlScalar):
        text = re.sub(rf"\s*<{MARK}>\d+</{MARK}>", "", extra.text)
        return YamlScalar(text, text, extra.span)
    return extra


def raw_in(node: YamlNode) -> Iterator[str]:
    """Yield the tags of the raw XML in a tree; attributes that the language has no key for are none."""
    if isinstance(node, YamlMap):
        for entry in node:
            if entry.name == "extra":
                yield from _tags_in(entry.value)
            elif entry.name != "with":
                yield from raw_in(entry.value)
    elif isinstance(node, YamlList):
        for item in node:
            yield from raw_in(item)


def _tags_in(extra: YamlNode) -> Iterator[str]:
    if isinstance(extra, YamlScalar):
        yield first_tag(extra.text)
    elif isinstance(extra, YamlList):
        for item in extra:
            yield from _tags_in(item)
    elif isinstance(extra, YamlMap):
        yield from _tags_in(extra.entries["value"].value if "value" in extra.entries else next(iter(extra)).value)


def valid_variants(found: Sequence[YamlNode | None], raw: Sequence[YamlNode | None]) -> list[int]:
    """Return which variants of a part are valid, as the others show: none that is raw, as hardware without a plugin.

    `raw` has the XML of those that are raw as a whole.
    """
    if not any(node is not None for node in found):
        return [*range(len(found))]
    has_inertia = any(isinstance(node, YamlMap) and node.get("inertial") is not None for node in found)
    return [
        number
        for number, (node, text) in enumerate(zip(found, raw, strict=True))
        if (node is not None or text is None) and not (has_inertia and _has_partial_inertial(node))
    ]


def _has_partial_inertial(node: YamlNode | None) -> bool:
    """Whether a link has an inertial that URDF does not allow, such as one without an inertia."""
    return isinstance(node, YamlMap) and bool(raw_elements(node, lambda tag: tag == "inertial"))
