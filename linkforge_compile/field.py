"""`field`, `fields` and `replace` for the classes of `frozen.py`, where a compile needs no more of `dataclasses`.

To import that takes longer than to define a hundred classes, since it imports `inspect`. So it waits until somebody
asks for what only it has: its own fields, or a class that is none of ours.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Final, TypeAlias

if TYPE_CHECKING:
    import dataclasses

    from _typeshed import DataclassInstance

KNOWN: Final = "__frozen_fields__"
"""The attribute of a class of ours that holds its fields by name, in the order in which `fields` gives them."""

THEIRS: Final = "__dataclass_fields__"
"""The same for the standard library, which reads no other."""

MISSING: Final = object()
"""What stands for a default, or a factory, that is not there."""


class Field:
    """What is known of a field; of which class and kind, and whether by keyword only, as soon as its class is made."""

    __slots__ = ("compare", "default", "default_factory", "init", "kw_only", "may_be_left_out", "name", "repr", "type")
    name: str
    type: str

    def __init__(
        self,
        *,
        default: object = MISSING,
        default_factory: object = MISSING,
        init: bool = True,
        repr: bool = True,  # noqa: A002 the name is the standard library's
        compare: bool = True,
        kw_only: bool | None = None,
    ) -> None:
        self.default, self.default_factory = default, default_factory
        self.init, self.repr, self.compare, self.kw_only = init, repr, compare, kw_only
        self.may_be_left_out = default is not MISSING or default_factory is not MISSING


Fields: TypeAlias = Mapping[str, Field]


def fields_of(holder: DataclassInstance | type[DataclassInstance]) -> tuple[Field | dataclasses.Field[object], ...]:
    """Return the fields of a class or of one of its objects."""
    known = _known(holder if isinstance(holder, type) else type(holder))
    if known is not None:
        return tuple(known.values())
    import dataclasses

    return dataclasses.fields(holder)


def replaced(one: DataclassInstance, /, **changes: object) -> DataclassInstance:
    """Return an object of the same class with other values in some fields."""
    known = _known(type(one))
    if known is None or any(name in changes and not field.init for name, field in known.items()):
        import dataclasses

        return dataclasses.replace(one, **changes)  # or what is wrong with that
    kept = {name: getattr(one, name) for name, field in known.items() if field.init and name not in changes}
    return type(one)(**kept, **changes)


def _known(cls: type) -> Fields | None:
    """Return the fields of a class of ours, or that derives from one plainly; None for the standard library's."""
    for base in cls.__mro__:
        if KNOWN in vars(base):
            known: Fields = vars(base)[KNOWN]
            return known
        if THEIRS in vars(base):
            return None
    return None


class Standard:
    """The attribute that the standard library asks for the fields of a class of ours: made as it does so."""

    def __get__(self, one: object, cls: type) -> Mapping[str, dataclasses.Field[object]]:
        from dataclasses import make_dataclass

        owner = next(base for base in cls.__mro__ if KNOWN in vars(base))
        if not isinstance(vars(owner)[THEIRS], Standard):  # another thread was quicker
            made_before: Mapping[str, dataclasses.Field[object]] = vars(owner)[THEIRS]
            return made_before
        known: Fields = vars(owner)[KNOWN]
        rows = [(name, field.type, standard(field)) for name, field in known.items()]
        made = make_dataclass(owner.__name__, rows, init=False, repr=False, eq=False)
        shown: Mapping[str, dataclasses.Field[object]] = vars(made)[THEIRS]
        type.__setattr__(owner, THEIRS, shown)
        return shown


def standard(field: Field) -> dataclasses.Field[object]:
    """Return a field as the standard library wants it in the body of a class."""
    import dataclasses

    said = {name: getattr(field, name) for name in ("default", "default_factory", "init", "repr", "compare")}
    if field.kw_only is not None:
        said["kw_only"] = field.kw_only
    made: dataclasses.Field[object] = dataclasses.field(
        **{name: value for name, value in said.items() if value is not MISSING}
    )
    return made
