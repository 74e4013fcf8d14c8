"""Base classes of the model: frozen parts, elements with raw XML, and mappings that cannot be changed."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass, replace
from functools import cache
from operator import is_
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Final, NoReturn, Self, TypeAlias, TypeVar

import yaml

from linkforge_compile.core.fields import (
    Child,
    Name,
    Reference,
    Spec,
    Text,
    check_numbers,
    container_fields,
    field_specs,
    tuple_fields,
)
from linkforge_compile.core.naming import prefixed_topic
from linkforge_compile.source import Key, Sourced, SourceRef

# The annotations of the model's classes are objects and not texts (`from __future__ import annotations`): the
# constructor of a derived class repeats them in a module that lacks these names, and libraries read them there.


class Part(Sourced):
    """A frozen value."""

    if TYPE_CHECKING:
        # dataclass makes both. Without `__eq__`, mypy reports `name in robot.joints` as a comparison that is never
        # true, because the items of a NamedTable are parts, and not names.
        def __eq__(self, other: object) -> bool: ...
        def __hash__(self) -> int: ...

    def with_fields(self, **changed: Any) -> Self:  # Any: each field has a type of its own
        """Return the part with these fields changed, and its `source`, which `dataclasses.replace` does not keep."""
        part = replace(self, **changed)  # type: ignore[type-var]  # every derived class is a dataclass
        set_field(part, "source", self.source)
        return part

    def with_prefix(self, prefix: str) -> Self:
        """Return the part with the prefix before its names; itself where it has none. An empty name stays so.

        Raises:
            RobotModelError: What the constructor raises, where the prefix makes a name that it refuses.

        """
        changed = prefixed_fields(self, prefix)
        return self.with_fields(**changed) if changed else self


def prefixed_fields(part: object, prefix: str) -> dict[str, Any]:  # Any: names, parts, sequences and mappings of them
    """Return the fields of a part that a prefix changes, by name, with the prefix applied."""
    changed: dict[str, Any] = {}
    kind: type = type(part)
    for name, put_prefix in _prefixers(kind).items():
        value = getattr(part, name)
        if value and prefix and (new := put_prefix(prefix, value)) is not value:
            changed[name] = new
    return changed


@cache
def _prefixers(kind: type) -> Mapping[str, Callable[[str, Any], Any]]:
    """Return the fields of a class that hold names with a prefix, also in the elements inside."""
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

C = TypeVar("C")


def extras_last(kind: type[C]) -> type[C]:
    """Put the keyword-only fields of a dataclass, such as those for raw XML, behind LinkForge's, for `fields`.

    The fields that a class inherits come first otherwise.
    """
    fields: dict[str, Any] = vars(kind)["__dataclass_fields__"]
    for name in [name for name, each in fields.items() if each.kw_only is True]:
        fields[name] = fields.pop(name)
    return kind


@dataclass(frozen=True, kw_only=True)
class WithExtras(Part):
    """What elements have in common: attributes and child elements that no field covers.

    `extra_attributes` are (name, value) pairs and `extra_elements` texts of XML; they are written unchanged and take
    no prefix. They are compared, but not shown by `repr`.
    """

    extra_attributes: Sequence[tuple[str, str]] = field(default=(), repr=False)
    extra_elements: Sequence[str] = field(default=(), repr=False)

    def __post_init__(self) -> None:
        """Make tuples of sequences, FrozenMaps of mappings and vectors of lists of numbers; then check the values."""
        if self.extra_attributes is not _NOTHING:
            set_field(self, "extra_attributes", attribute_pairs(self.extra_attributes))
        for name, container in container_fields(type(self)).items():
            value = getattr(self, name)
            if container is Mapping:
                set_field(self, name, frozen(FrozenMap(value)))
            elif not isinstance(value, tuple):
                set_field(self, name, tuple(value))
        for name, kind in tuple_fields(type(self)).items():
            if isinstance(value := getattr(self, name), list | tuple):
                set_field(self, name, kind(*value))
        self._check()

    def _check(self) -> None:
        """Refuse values that are not valid."""
        check_numbers(self)


@extras_last
@dataclass(frozen=True)
class Inside(WithExtras):
    """Raw XML of a child element that has no class of its own, such as `<parent>` of a joint.

    `tag` is its tag. `name` tells several of one tag apart: the attribute `name` or `link`, or the text, of a
    `<joint name>` of a group or a `<param name>`; None where there is only one.
    """

    tag: Annotated[str, Text(xml="name()")]
    name: Annotated[str | None, Reference("part")] = None
    extra_inside: "Sequence[Inside]" = field(default=(), repr=False, kw_only=True)

    @property
    def key(self) -> str:
        """The key of the element in `extra_inside`: its tag, and its name if any."""
        return self.tag if self.name is None else f"{self.tag} {self.name}"


@dataclass(frozen=True, kw_only=True)
class Element(WithExtras):
    """A part that becomes an XML element; `extra_inside` has the extras of child elements without a class."""

    TAG: ClassVar[str] = ""
    """The tag of the element; empty where it depends on what holds the part."""
    TITLE: ClassVar[str] = ""
    """What messages call an element, with its key fields in braces; empty where that is its tag and its name."""
    SHORT_FORM: ClassVar[str] = ""
    """The field whose value the language accepts in place of a map; empty where there is always a map."""
    ATTRIBUTE_ORDER: ClassVar[tuple[str, ...]] = ()
    """The attributes as they are written in XML; empty where their order is that of the fields."""
    NAMES_INSIDE_TAKE_PREFIX: ClassVar[bool] = False
    """Whether the names in `extra_inside` are those of links, joints and groups, which take a prefix."""

    extra_inside: Sequence[Inside] = field(default=(), repr=False)


class Stating:
    """Adds `is_written` to a part whose `stated` names fields that are written with their default."""

    def is_written(self, name: str) -> bool:
        """Whether a field becomes a tag: it differs from its default, or is stated."""
        stated: Sequence[str] = getattr(self, "stated")  # noqa: B009 the part's field
        return name in stated or getattr(self, name) != field_specs(type(self))[name].implied


def attribute_pairs(attributes: Sequence[tuple[str, str]] | Mapping[str, str]) -> tuple[tuple[str, str], ...]:
    """Return (name, value) pairs in the order given."""
    if attributes is _NOTHING:
        return attributes  # most elements
    pairs = attributes.items() if isinstance(attributes, Mapping) else attributes
    return tuple((name, value) for name, value in pairs)


def set_field(part: Part, name: str, value: object) -> None:
    """Give a field its final value while the part is being made."""
    object.__setattr__(part, name, value)


K = TypeVar("K")
V = TypeVar("V")

if TYPE_CHECKING:
    FreePart: TypeAlias = "str | Mapping[str, FreePart] | Sequence[FreePart]"
else:
    FreePart = Any  # until Python 3.12 there is no recursive type that libraries know
"""What a plugin reads from an element: its text; or its children by tag, where a key `_x` is its attribute `x` and
`_text` its text; or, for a tag that repeats, one of these for each element."""


def dump_like(kind: type, standard: type) -> None:
    """Let `yaml.safe_dump` write objects of a class as those of its base: dict, list or str.

    It refuses all classes that are not registered, even derived ones.
    """
    yaml.SafeDumper.add_representer(kind, yaml.SafeDumper.yaml_representers[standard])


class FrozenMap(dict[K, V]):
    """A dict that cannot be changed, in insertion order; equal to any mapping of the same items."""

    __slots__ = ()

    def __hash__(self) -> int:  # type: ignore[override]  # dict sets it to None
        return hash(frozenset(self.items()))

    def __or__(self, other: Mapping[K, V]) -> "FrozenMap[K, V]":  # type: ignore[override]  # dict accepts only dicts
        return FrozenMap({**self, **other})

    def __ror__(self, other: Mapping[K, V]) -> "FrozenMap[K, V]":  # type: ignore[override]  # as above
        return FrozenMap({**other, **self})

    def __reduce__(self) -> tuple[type[Self], tuple[dict[K, V]]]:
        return type(self), (dict(self),)

    def _refuse(self, *given: object, **named: object) -> NoReturn:
        raise TypeError("a FrozenMap cannot be changed")

    if not TYPE_CHECKING:  # mypy refuses a dict without these
        __setitem__ = __delitem__ = __ior__ = clear = pop = popitem = setdefault = update = _refuse


dump_like(FrozenMap, dict)


def frozen(value: object) -> object:
    """Return a value with FrozenMaps for mappings and tuples for lists, all the way down."""
    if isinstance(value, Mapping):
        return FrozenMap({name: frozen(item) for name, item in value.items()})
    return tuple(map(frozen, value)) if isinstance(value, list | tuple) else value


class SourcedText(str):
    """A text with its `source`, None if it was not read: it compares, hashes and prints as that text.

    Such are the texts of `extra_elements`, the names in `extra_attributes` and those in the parameters of a controller
    manager: merging robots puts texts of several files into one, so the source of their owner would not do. That of the
    name of an attribute is the map that it is in, that of the name of a parameter its value, with the name as `key`.
    """

    __slots__ = ("source",)

    source: SourceRef | None

    def __new__(cls, text: str, source: SourceRef | None = None) -> Self:
        sourced = super().__new__(cls, text)
        sourced.source = source
        return sourced

    def __reduce__(self) -> tuple[object, ...]:
        return type(self), (str(self), self.source)


dump_like(SourcedText, str)


def place_of_parameter(source: SourceRef | None, *path: str) -> tuple[SourceRef | None, *tuple[str, ...]]:
    """Return where the value at a path of a controller was written: an object, and the path from there."""
    name = path[-1]
    if isinstance(name, SourcedText) and name.source:
        return (SourceRef(name.source.node, None, name.source.trail),)
    return (source, *path)


def place_of_parameter_name(source: SourceRef | None, *path: str) -> tuple[SourceRef | None, *tuple[str, ...]]:
    """Return where the last name of a path itself was written."""
    *outer, name = path
    if isinstance(name, SourcedText) and name.source:
        return (name.source,)
    keys = (*outer, Key(name))
    return (source, *keys)
