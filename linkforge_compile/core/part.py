"""Base classes of the model: frozen parts with their source, and elements with the raw XML that no field covers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass, replace
from functools import cache
from operator import is_
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, Self

from linkforge_compile.core.fields import Child, Name, Reference, Spec, check_numbers, field_specs
from linkforge_compile.core.frozen_map import FrozenMap, frozen
from linkforge_compile.core.naming import prefixed_topic
from linkforge_compile.source import Sourced


@dataclass(frozen=True, slots=True, kw_only=True)
class Part(Sourced):
    """A frozen value; since nothing in it changes, a copy of it is the part itself."""

    def __init_subclass__(cls) -> None:
        # dataclasses puts inherited fields first, but `fields` and `astuple` have to begin with LinkForge's fields:
        # those of the class itself, none of which is keyword-only. With `slots=True`, dataclass makes each class a
        # second time, and that one has its fields by now.
        if fields := vars(cls).get("__dataclass_fields__"):
            cls.__dataclass_fields__ = dict(sorted(fields.items(), key=lambda item: item[1].kw_only is True))

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    if TYPE_CHECKING:
        # dataclass makes both. Without `__eq__`, mypy reports `name in robot.joints` as a comparison that is never
        # true, because the items of a NamedTable are parts, and not names.
        def __eq__(self, other: object) -> bool: ...
        def __hash__(self) -> int: ...

    def with_prefix(self, prefix: str) -> Self:
        """Return the part with the prefix before its names; itself where it has none. An empty name stays so.

        Raises:
            RobotModelError: What the constructor raises, where the prefix makes a name that it refuses.

        """
        changed = prefixed_fields(self, prefix)
        return replace(self, **changed) if changed else self


def prefixed_fields(part: object, prefix: str) -> dict[str, Any]:  # Any: names, parts, sequences and mappings of them
    """Return the fields of a part that a prefix changes, by name, with the prefix put before the names in them."""
    changed: dict[str, Any] = {}
    kind: type = type(part)
    for name, put_prefix in _prefixers(kind).items():
        value = getattr(part, name)
        if value and prefix and (new := put_prefix(prefix, value)) is not value:
            changed[name] = new
    return changed


@cache
def _prefixers(kind: type) -> Mapping[str, Callable[[str, Any], Any]]:
    """Return the fields of a class with names that take a prefix: its own, of others, and in the elements in it."""
    prefixers: dict[str, Callable[[str, Any], Any]] = {}
    for name, spec in field_specs(kind).items():
        if isinstance(spec, Reference) and spec.to == "topic":
            prefixers[name] = prefixed_topic
        elif isinstance(spec, Name | Reference) or _holds_names(spec):
            prefixers[name] = _put_prefix
    if getattr(kind, "NAMES_INSIDE_TAKE_PREFIX", False):
        prefixers["extra_inside"] = _put_prefix
    return prefixers


def _holds_names(spec: Spec) -> bool:
    """Whether a field has elements with names that take a prefix."""
    return isinstance(spec, Child) and any(is_dataclass(kind) and _prefixers(kind) for kind in spec.kinds)


def _put_prefix(prefix: str, value: Any) -> Any:
    """Return a name, parts, or a mapping by names under a prefix; the value itself where nothing changes."""
    if isinstance(value, str):
        return prefix + value if value else value
    if isinstance(value, Mapping):
        return FrozenMap({prefix + name: each for name, each in value.items()})
    if isinstance(value, Iterable):
        values = tuple(value)
        copies = tuple(_put_prefix(prefix, each) for each in values)
        return values if all(map(is_, copies, values)) else copies
    return value.with_prefix(prefix)


_NOTHING: Final = ()


def freeze(element: Element, *sequences: str, mappings: tuple[str, ...] = ()) -> None:
    """Make tuples of the named sequences and FrozenMaps of the named mappings, all the way down; extras are tuples.

    For `__post_init__` only, of elements with collections of their own; others inherit it.
    """
    for name in sequences:
        set_field(element, name, tuple(getattr(element, name)))
    for name in mappings:
        set_field(element, name, frozen(FrozenMap(getattr(element, name))))
    has_no_elements, has_no_attributes = element.extra_elements is _NOTHING, element.extra_attributes is _NOTHING
    if has_no_elements and has_no_attributes and element.extra_inside is _NOTHING:
        return  # most elements
    set_field(element, "extra_elements", tuple(element.extra_elements))
    set_field(element, "extra_attributes", attribute_pairs(element.extra_attributes))
    set_field(element, "extra_inside", tuple(element.extra_inside))


@dataclass(frozen=True, slots=True, kw_only=True)
class Element(Part):
    """A part that becomes an XML element.

    `extra_attributes` are (name, value) pairs and `extra_elements` the texts of child elements that no field covers;
    they are written unchanged and take no prefix. `extra_inside` has the same for child elements that have no class of
    their own. They are compared, but not shown by `repr`.
    """

    TAG: ClassVar[str] = ""
    """The tag of the element; empty where it depends on what holds the part."""
    NAMES_INSIDE_TAKE_PREFIX: ClassVar[bool] = False
    """Whether the names in `extra_inside` are those of links, joints and groups, which take a prefix."""

    extra_attributes: Sequence[tuple[str, str]] = field(default=(), repr=False)
    extra_elements: Sequence[str] = field(default=(), repr=False)
    extra_inside: Sequence[Inside] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        freeze(self)
        check_numbers(self)


@dataclass(frozen=True, slots=True)
class Inside(Element):
    """Raw XML of a child element that has no class of its own, such as `<parent>` of a joint.

    `tag` is its tag. `name` tells several of one tag apart: the attribute `name` or `link`, or the text, of a
    `<joint name>` of a group or a `<param name>`; None where there is only one.
    """

    tag: str
    name: Annotated[str | None, Reference("part")] = None


def attribute_pairs(attributes: Sequence[tuple[str, str]] | Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return (name, value) pairs in the order given."""
    if attributes is _NOTHING:
        return attributes  # most elements
    pairs = attributes.items() if isinstance(attributes, Mapping) else attributes
    return tuple((name, value) for name, value in pairs)


def set_field(part: Part, name: str, value: object) -> None:
    """Give a field its final value while the part is being made."""
    object.__setattr__(part, name, value)
