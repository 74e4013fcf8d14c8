"""A named tuple of ours is what the standard library would make of it."""

from __future__ import annotations

import copy
import inspect
import pickle
import sys
import typing
from types import FunctionType

import pytest

from linkforge_compile.named_tuple import NamedTuple


def _of(base: type) -> type:
    class Place(base):
        """Where something is."""

        file: str
        line: int = 1
        column: int | None = None

        unit = "character"

        @property
        def shown(self) -> str:
            return f"{self.file}:{self.line}"

        def below(self) -> Place:
            return self._replace(line=self.line + 1)

    return Place


OURS, THEIRS = _of(NamedTuple), _of(typing.NamedTuple)
# For pickle, which looks a class up by its name.
OURS.__qualname__ = "OURS"


def outcome(make: FunctionType) -> object:
    """Return what is made, or the kind and the words of what is raised."""
    try:
        return make()
    except (TypeError, ValueError, AttributeError) as error:
        return type(error), str(error).replace("_of.<locals>.", "")


def is_quick(cls: type) -> bool:
    return cls.__mro__[1] is not tuple


def test_it_is_not_the_standard_librarys():
    assert is_quick(OURS)
    assert not is_quick(THEIRS)


@pytest.mark.parametrize(
    "use",
    [
        lambda cls: cls("a"),
        lambda cls: cls("a", 2, 3),
        lambda cls: cls("a", column=3),
        lambda cls: cls(file="a", line=2),
        lambda cls: cls(),
        lambda cls: cls("a", 2, 3, 4),
        lambda cls: cls("a", colum=3),
        lambda cls: cls("a", file="b"),
        lambda cls: repr(cls("a", ("b",))),
        lambda cls: str(cls("%s")),
        lambda cls: cls("a").shown,
        lambda cls: cls("a").below(),
        lambda cls: cls("a").unit,
        lambda cls: cls("a")._asdict(),
        lambda cls: cls("a")._replace(file="b", column=2),
        lambda cls: cls("a")._replace(fil="b"),
        lambda cls: cls._make(["a", 1, 2]),
        lambda cls: cls._make(["a"]),
        lambda cls: (cls._fields, cls._field_defaults, cls.__match_args__, cls.__name__, cls.__module__, cls.__doc__),
        lambda cls: hash(cls("a")),
        lambda cls: cls("a") < cls("b") and cls("a") == ("a", 1, None),
        lambda cls: [*cls("a")],
        lambda cls: cls("a")[1:],
        lambda cls: cls.line.__doc__,
        lambda cls: cls.line.__get__(cls("a")),
        lambda cls: setattr(cls("a"), "file", "b"),
        lambda cls: hasattr(cls("a"), "__dict__"),
        lambda cls: list(inspect.signature(cls).parameters),
        lambda cls: [str(one.default) for one in inspect.signature(cls).parameters.values()],
        typing.get_type_hints,
        lambda cls: typing.get_type_hints(cls.__new__),
    ],
)
def test_it_does_what_theirs_does(use):
    ours, theirs = outcome(lambda: use(OURS)), outcome(lambda: use(THEIRS))
    assert ours == theirs
    assert isinstance(ours, tuple) == isinstance(theirs, tuple)


@pytest.mark.parametrize("through", [lambda one: pickle.loads(pickle.dumps(one)), copy.copy, copy.deepcopy])
def test_its_copies_are_of_its_class(through):
    assert through(OURS("a")) == OURS("a")
    assert type(through(OURS("a"))) is OURS


def test_it_matches_by_position():
    match OURS("a", 2):
        case OURS(file, line):
            assert (file, line) == ("a", 2)


@pytest.mark.skipif(sys.version_info < (3, 13), reason="copy.replace is of Python 3.13")
def test_copy_replaces_its_fields():
    assert copy.replace(OURS("a"), line=2) == OURS("a", 2)


def test_one_without_a_docstring_has_its_fields():
    class Pair(NamedTuple):
        first: int
        second: int

    assert Pair.__doc__ == "Pair(first, second)"


def test_what_takes_more_than_a_look_is_the_standard_librarys():
    T = typing.TypeVar("T")

    class Held(NamedTuple, typing.Generic[T]):
        value: T
        name: str = ""

    assert not is_quick(Held)
    assert Held[int](3) == (3, "")
    assert Held.__parameters__ == (T,)


def test_annotations_that_are_still_to_be_computed_are_the_standard_librarys():
    # As Python 3.14 hands over a body without the import from __future__.
    body = {"__module__": __name__, "__qualname__": "Late", "__annotate_func__": lambda _: {"x": int}}
    assert not is_quick(type(NamedTuple)("Late", (NamedTuple,), body))


def test_the_docstring_of_a_field_is_its_own():
    class One(NamedTuple):
        name: str

    class Other(NamedTuple):
        name: str

    One.name.__doc__ = "What one is called."
    assert Other.name.__doc__ == "Alias for field number 0"


FAULTS = {
    "cannot start with an underscore": {"__annotations__": {"_name": "str"}},
    "Non-default namedtuple field text cannot follow": {"__annotations__": {"name": "str", "text": "str"}, "name": ""},
    "Cannot overwrite NamedTuple attribute _make": {"__annotations__": {"name": "str"}, "_make": None},
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_refused(fault):
    with pytest.raises((TypeError, ValueError, AttributeError), match=fault):
        type(NamedTuple)("Faulty", (NamedTuple,), {"__module__": __name__, "__qualname__": "Faulty"} | FAULTS[fault])
