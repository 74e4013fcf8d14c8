"""Read elements that hold a text only."""

from __future__ import annotations

from collections import Counter

from linkforge_compile.core.fields import Flag, Number, Spec
from linkforge_compile.importers.element_reader import ElementReader
from linkforge_compile.importers.spec_draft import number_of
from linkforge_compile.source.xml_tree import XmlElement
from linkforge_compile.syntax import YamlMap, YamlNode, YamlScalar
from linkforge_compile.units import number_text


def read_text(element: ElementReader) -> YamlScalar:
    """Read an element that contains text only."""
    node = element.draft.word(text_of(element.element), element.span)
    element.take_text()
    element.require_used_up()
    return node


def read_word(element: ElementReader) -> YamlScalar:
    """Read an element that contains text only, and not only blanks."""
    node = read_text(element)
    if not node.text.strip():
        raise element.cannot_represent("it is empty")
    return node


def text_of(element: XmlElement) -> str:
    """Return the text of an element, without the space around it if that has line breaks."""
    text = element.text
    stripped = text.strip()
    around = (text.partition(stripped)[0], text.rpartition(stripped)[2]) if stripped else (text, "")
    return stripped if any("\n" in space for space in around) else text


def take_texts(owner: ElementReader) -> dict[str, YamlNode | None]:
    """Take the children that contain text only and whose tag does not repeat."""
    children = owner.remaining()
    counts = Counter(child.tag for child in children)
    texts = [one for one in children if not one.values and not one.children and counts[one.tag] == 1]
    return {one.tag: owner.read(one, read_text) for one in texts if not one.tag.startswith("_")}


def exact_number(element: XmlElement) -> float | None:
    """Return the number that an element contains, if nothing else is in it and its spelling is normal."""
    if element.values or element.children:
        return None
    text = element.text.strip()
    value = number_of(text)
    return value if value is not None and number_text(value) == text else None


def is_normal(child: XmlElement, spec: Spec) -> bool:
    """Whether an element holds only the value of a field, in the spelling that it is written with."""
    match spec:
        case Number():
            value = exact_number(child)
            return value is not None and (spec.bound is None or spec.bound.holds(value))
        case Flag():
            return is_flag(child)
    return is_text(child)


def is_text(child: XmlElement) -> bool:
    """Whether an element holds a text and nothing else."""
    return not child.values and not child.children and bool(child.text.strip())


def is_flag(child: XmlElement) -> bool:
    """Whether an element holds true or false and nothing else."""
    return is_text(child) and child.text.strip() in ("true", "false")


def is_empty(node: YamlNode) -> bool:
    """Whether a node is an empty map."""
    return isinstance(node, YamlMap) and not len(node)
