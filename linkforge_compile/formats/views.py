"""Views of the parts of a robot, for templates: by the specs of their fields, then what no field covers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from operator import attrgetter
from types import SimpleNamespace
from typing import Any, ClassVar

from linkforge_compile.core.fields import Child, Parameters, Spec, Text, field_specs
from linkforge_compile.core.part import Element
from linkforge_compile.formats.element import attributes_of, elements, leaf, leaf_at, parameter_elements, placed
from linkforge_compile.formats.xml_text import NOTHING, spelled
from linkforge_compile.source import SourceRef


class View(SimpleNamespace):
    """What templates lay out of a part, every text and element ready for its place.

    `tag` and `attributes` are those of its element, `elements` is what no field covers. The rest has the names of the
    fields of its class, or for an element inside its tag: one with attributes alone is XML, any other a View.
    """


class Views:
    """Makes views of parts, by the specs of their fields."""

    makers: ClassVar[Mapping[type, Callable[[Any, Any], object]]] = {}
    """What makes the element or view of a part of a class, and of those derived from it, in another way."""

    def of(self, part: object) -> object:
        """Return the element of a part that has attributes alone, else its view."""
        own: type = type(self)
        kind: type = type(part)
        return _maker_of(own, kind)(self, part)

    def of_all(self, parts: Iterable[object]) -> tuple[object, ...]:
        """Return the elements or views of several parts."""
        return tuple([self.of(part) for part in parts])

    def view(self, part: Element, /, **changes: object) -> View:
        """Return the view of a part; `changes` are fields of the view in place of those by the specs."""
        kind: type = type(part)
        values: dict[str, object] = {"tag": part.TAG, **changes}
        if "attributes" not in values:
            values["attributes"] = attributes_of(part)
        for name, make in _view_fields(kind):
            if name not in values:
                values[name] = make(self, part)
        return View(**values, elements=elements(part))


@cache
def _maker_of(views: type[Views], kind: type) -> Callable[[Any, Any], object]:
    own = next((views.makers[base] for base in kind.__mro__ if base in views.makers), None)
    return own or ((lambda _, part: leaf(part)) if _is_leaf(kind) else views.view)


@cache
def _is_leaf(kind: type) -> bool:
    return all((spec.xml or "@")[0] == "@" for spec in field_specs(kind).values())


@cache
def _view_fields(kind: type) -> tuple[tuple[str, Callable[[Views, Any], object]], ...]:
    inside = {field: spec for field, spec in field_specs(kind).items() if (spec.xml or "@")[:1] not in {"@", "."}}
    return tuple((_view_name(field, spec), _maker(field, spec, spec.xml or "")) for field, spec in inside.items())


def _view_name(field: str, spec: Spec) -> str:
    is_element = isinstance(spec, Child) and not spec.container and spec.xml and spec.xml.isidentifier()
    return spec.xml or "" if is_element else field


def _maker(field: str, spec: Spec, xml: str) -> Callable[[Views, Any], object]:
    """Return what makes a field of a view."""
    get, key = attrgetter(field), spec.key or field
    if isinstance(spec, Child):
        return _child_maker(get, spec, xml)
    if isinstance(spec, Parameters):
        if xml == "*":
            return lambda _, part: parameter_elements(get(part), part.source, key)
        return lambda _, part: named_texts(get(part), part.source, key)
    if spec.container:
        return lambda _, part: [placed(text, part.source, key, number) for number, text in enumerate(get(part))]
    tag, _, attribute = xml.partition("/@")
    if attribute and spec.may_be_none:
        return lambda _, part: (
            NOTHING if (value := get(part)) is None else leaf_at(tag, part.source, key, **{attribute: value})
        )
    if isinstance(spec, Text) and not spec.may_be_none:
        return lambda _, part: placed(get(part), part.source, key)
    return lambda _, part: None if (value := get(part)) is None else placed(spelled(value), part.source, key)


def _child_maker(get: Callable[[object], Any], spec: Child, xml: str) -> Callable[[Views, Any], object]:
    if spec.container and getattr(spec.kinds[0], "TAG", None) != "":
        return lambda views, part: views.of_all(get(part))
    if spec.container:
        return lambda _, part: tuple([leaf(one, xml) for one in get(part)])
    missing = NOTHING if _is_leaf(spec.kinds[0]) else None
    return lambda views, part: missing if (value := get(part)) is None else views.of(value)


def named_texts(texts: Mapping[str, str], source: SourceRef | None, *path: str) -> tuple[tuple[str, str], ...]:
    """Return the names and texts of `<param name>`, written under a path of an object."""
    return tuple((placed(name, source, *path, name), spelled(value)) for name, value in texts.items())
