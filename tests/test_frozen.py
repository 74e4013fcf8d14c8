"""A frozen class of ours is what the standard library would make of it."""

from __future__ import annotations

import copy
import dataclasses
import inspect
import pickle
import sys
import typing
from collections.abc import Callable
from dataclasses import KW_ONLY
from typing import ClassVar

import pytest

from linkforge_compile.frozen import dataclass, field, fields, replace

NAN = float("nan")


def _of(decorator: Callable, field: Callable) -> tuple[type, type, type]:
    """Return a class with all kinds of fields, one that inherits, and one of a single field, made by a decorator."""

    @decorator(frozen=True, slots=True, kw_only=True)
    class Sourced:
        """Remembers where."""

        place: str | None = field(default=None, compare=False, repr=False)

    @decorator(frozen=True, slots=True)
    class Joint(Sourced):
        """Moves."""

        moves: ClassVar[bool] = True
        name: str
        axis: tuple[float, ...] = (1.0, 0.0, 0.0)
        limits: dict[str, float] = field(default_factory=dict)
        mimic: object = field(default=None, kw_only=True)

        def __post_init__(self) -> None:
            if not self.name:
                raise ValueError("no name")

    @decorator(frozen=True, slots=True)
    class Mass:
        """Weighs."""

        kilograms: float

    return Sourced, Joint, Mass


OURS, THEIRS = _of(dataclass, field), _of(dataclasses.dataclass, dataclasses.field)
Sourced, Joint, Mass = OURS
# For pickle, which looks classes up by their names.
for one in OURS:
    one.__qualname__ = one.__name__


def is_quick(cls: type) -> bool:
    return "set_000" in cls.__init__.__code__.co_freevars


def test_it_is_not_the_standard_librarys():
    assert all(map(is_quick, OURS))
    assert not any(map(is_quick, THEIRS))


ARGUMENTS = [
    (("elbow",), {}),
    (("elbow", (0.0, NAN)), {"place": "here"}),
    (("elbow",), {"limits": {"lower": 1.0}, "mimic": "wrist"}),
    ((), {}),
    (("",), {}),
    (("elbow", (), {}, "wrist"), {}),
    (("elbow",), {"plaice": 1}),
]


def outcome(make: Callable[[], object]) -> object:
    """Return the values of what is made, or the kind of what is raised."""
    try:
        made = make()
    except (TypeError, ValueError) as error:
        return type(error), str(error).partition("()")[2] or str(error)
    return repr(made).partition("(")[2], dataclasses.astuple(made)


@pytest.mark.parametrize(("positional", "named"), ARGUMENTS)
def test_it_takes_the_same_arguments(positional, named):
    ours, theirs = (outcome(lambda cls=cls: cls(*positional, **named)) for cls in (Joint, THEIRS[1]))
    assert ours == theirs


def test_its_signature_is_the_same():
    _same_signature(Joint, THEIRS[1])
    _same_signature(CHANGING, THEIRS_CHANGING)


def _same_signature(*classes: type) -> None:
    ours, theirs = (inspect.signature(cls).parameters.values() for cls in classes)
    assert [(one.name, one.kind, one.annotation) for one in ours] == [
        (one.name, one.kind, one.annotation) for one in theirs
    ]
    assert [str(one.default) for one in ours] == [str(one.default) for one in theirs]


@pytest.mark.parametrize("classes", [OURS, THEIRS])
def test_equality_and_hash_are_of_what_is_compared(classes):
    sourced, joint, mass = classes
    assert joint("a", place="here") == joint("a", place="there")
    assert joint("a") != joint("b")
    assert joint("a", (NAN,)) != joint("a", (float("nan"),))
    # As of 3.13 the standard library compares field by field.
    assert (mass(NAN) == mass(NAN)) is (classes is OURS or sys.version_info < (3, 13))
    assert mass(1.0) != (1.0,)
    assert hash(mass(1.0)) == hash(mass(1))
    assert sourced(place="here") == sourced()
    with pytest.raises(TypeError, match="unhashable"):
        hash(joint("a"))


@pytest.mark.parametrize("classes", [OURS, THEIRS])
def test_nothing_is_set_or_deleted(classes):
    joint = classes[1]("a")
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'name'"):
        joint.name = "b"
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'name'"):
        del joint.name
    assert not hasattr(joint, "__dict__")
    assert dataclasses.replace(joint, name="b", place="here").place == "here"


@pytest.mark.parametrize("through", [lambda one: pickle.loads(pickle.dumps(one)), copy.copy, copy.deepcopy])
def test_its_copies_are_equal(through):
    joint = Joint("a", (0.0,), {"lower": 1.0}, place="here")
    assert through(joint) == joint
    assert through(joint).place == "here"


def test_it_matches_by_position():
    match Joint("a", (0.0,)):
        case Joint(name, axis):
            assert (name, axis) == ("a", (0.0,))


@pytest.mark.parametrize("classes", [OURS, THEIRS])
def test_it_is_seen_as_a_dataclass(classes):
    _, joint, mass = classes
    assert [one.name for one in dataclasses.fields(joint)] == ["place", "name", "axis", "limits", "mimic"]
    assert [(one.type, one.default, one.kw_only) for one in dataclasses.fields(mass)] == [
        ("float", dataclasses.MISSING, False)
    ]
    assert dataclasses.is_dataclass(joint)
    assert dataclasses.asdict(joint("a"))["axis"] == (1.0, 0.0, 0.0)
    assert joint.moves
    assert repr(joint("a", place="here")).endswith("(name='a', axis=(1.0, 0.0, 0.0), limits={}, mimic=None)")
    assert typing.get_type_hints(mass.__init__) == {"kilograms": float, "return": type(None)}


@pytest.mark.skipif(sys.version_info < (3, 13), reason="copy.replace is of Python 3.13")
def test_copy_replaces_its_fields():
    assert copy.replace(Mass(1.0), kilograms=2.0) == Mass(2.0)


@pytest.mark.parametrize("base", [Joint, THEIRS[1]])
@pytest.mark.parametrize("decorator", [dataclass, dataclasses.dataclass])
def test_each_may_derive_from_the_other(base, decorator):
    @decorator(frozen=True, slots=True)
    class Motor(base):
        gear: float = 1.0
        name: str = "motor"

    assert Motor(gear=2.0) == dataclasses.replace(Motor(), gear=2.0)
    assert Motor("a", place="here").place == "here"
    assert [one.name for one in dataclasses.fields(Motor)] == ["place", "name", "axis", "limits", "mimic", "gear"]


def test_a_plain_class_of_it_is_free_but_for_the_fields():
    # As the standard library has it, too, for classes without slots.
    class Load(Mass):
        pass

    load = Load(1.0)
    load.color = "red"
    del load.color
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot assign to field 'kilograms'"):
        load.kilograms = 2.0
    with pytest.raises(dataclasses.FrozenInstanceError, match="cannot delete field 'kilograms'"):
        del load.kilograms


def test_the_own_methods_of_a_class_stay():
    @dataclass(frozen=True, slots=True)
    class Index:
        position: int

        def __init__(self) -> None:
            object.__setattr__(self, "position", 3)

        def __repr__(self) -> str:
            return f"#{self.position}"

        def __hash__(self) -> int:
            return 7

    assert repr(Index()) == "#3"
    assert hash(Index()) == 7
    assert Index() == Index()


@pytest.mark.parametrize("decorator", [dataclass, dataclasses.dataclass])
def test_with_an_equality_of_its_own_it_keeps_its_hash(decorator):
    @decorator(frozen=True, slots=True)
    class Name:  # noqa: PLW1641 which is what is tested
        text: str

        def __eq__(self, other: object) -> bool:
            return isinstance(other, Name) and self.text.lower() == other.text.lower()

    assert Name("a") == Name("A")
    assert hash(Name("a")) == hash(("a",))


def test_what_has_an_identity_is_equal_to_itself_only():
    @dataclass(frozen=True, slots=True, eq=False)
    class Node:
        text: str

    node = Node("a")
    assert is_quick(Node)
    assert {node, node, Node("a")} - {node} != set()


def test_what_takes_more_than_a_look_is_the_standard_librarys():
    @dataclass(frozen=True, slots=True)
    class Scaled:
        factor: dataclasses.InitVar[float]
        value: float = dataclasses.field(init=False)
        _: dataclasses.KW_ONLY
        unit: str = "m"

        def __post_init__(self, factor: float) -> None:
            object.__setattr__(self, "value", 2 * factor)

    assert repr(Scaled(1.5, unit="mm")).endswith("Scaled(value=3.0, unit='mm')")
    assert [one.name for one in dataclasses.fields(Scaled)] == ["value", "unit"]


def test_annotations_that_are_still_to_be_computed_are_the_standard_librarys():
    # As Python 3.14 makes a class without the import from __future__.
    late = type("Late", (), {"__annotate_func__": lambda _: {"x": int}})
    made = dataclass(frozen=True, slots=True)(late)
    assert type(made.__dataclass_params__) is type(THEIRS[0].__dataclass_params__)


FAULTS = {
    "mutable default": {"__annotations__": {"name": "list"}, "name": []},
    "non-default argument": {"__annotations__": {"name": "str", "text": "str"}, "name": ""},
    "no type annotation": {"name": dataclasses.field(default=1)},
    "Cannot overwrite attribute __setattr__": {"__setattr__": object.__setattr__},
    "already specifies __slots__": {"__annotations__": {"name": "str"}, "__slots__": ("name",)},
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_refused(fault):
    with pytest.raises((TypeError, ValueError), match=fault):
        dataclass(frozen=True, slots=True)(type("Faulty", (), dict(FAULTS[fault])))


def test_a_base_that_may_be_changed_is_refused():
    @dataclasses.dataclass
    class Base:
        name: str

    with pytest.raises(TypeError, match="cannot inherit frozen dataclass from a non-frozen one"):
        dataclass(frozen=True, slots=True)(type("Faulty", (Base,), {}))


def _that_changes_in_slots(decorator: Callable, field: Callable) -> type:
    class Counted:
        __slots__ = ()
        changes = 0

        def __setattr__(self, name: str, value: object) -> None:
            Counted.changes += 1
            super().__setattr__(name, value)

    @decorator(slots=True)
    class Counter(Counted):
        count: int = 0
        steps: list[int] = field(default_factory=list)
        source: str | None = field(default=None, compare=False, repr=False, kw_only=True)

        def add(self, step: int) -> None:
            self.count += step

    Counter.__qualname__ = "Counter"
    return Counter


@pytest.mark.parametrize(
    "made", [(dataclass, field), (dataclasses.dataclass, dataclasses.field)], ids=["ours", "standard"]
)
def test_what_changes_and_has_slots_is_what_the_standard_library_makes_of_it(made: tuple[Callable, Callable]):
    cls = _that_changes_in_slots(*made)
    counter = cls(2, source="here")
    counter.add(3)
    assert cls.__bases__[0].changes == 4  # each field is set as the class sets one
    assert (repr(counter), counter.source) == ("Counter(count=5, steps=[])", "here")
    assert counter == cls(5)
    assert cls().steps is not cls().steps
    assert copy.copy(counter) == copy.deepcopy(counter) == dataclasses.replace(counter) == counter
    assert not hasattr(counter, "__dict__")
    with pytest.raises(AttributeError):
        counter.cuont = 1
    with pytest.raises(TypeError, match="unhashable"):
        hash(counter)
    assert is_quick(cls) is (made[0] is dataclass)


def _that_changes(decorator: Callable, field: Callable) -> type:
    @decorator
    class Link:
        """Is rigid."""

        name: str
        shapes: list[str] = field(default_factory=list)
        _: KW_ONLY
        mass: float = 1.0
        source: str | None = field(default=None, compare=False, repr=False)
        drawn: str | None = field(default=None, init=False, compare=False)
        number: int = field(init=False, repr=False)

        def __post_init__(self) -> None:
            self.number = len(self.name)

    Link.__qualname__ = "Link"
    return Link


CHANGING, THEIRS_CHANGING = _that_changes(dataclass, field), _that_changes(dataclasses.dataclass, dataclasses.field)


def test_what_changes_and_has_no_slots_is_made_quickly():
    assert is_quick(CHANGING)
    assert not is_quick(THEIRS_CHANGING)


@pytest.mark.parametrize("cls", [CHANGING, THEIRS_CHANGING])
def test_what_changes_is_what_the_standard_library_makes_of_it(cls):
    link = cls("arm", ["box"], source="here")
    assert repr(link) == "Link(name='arm', shapes=['box'], mass=1.0, drawn=None)"
    assert (link.number, cls.drawn, hasattr(cls, "number")) == (3, None, False)
    link.mass = 2.0
    assert link == cls("arm", ["box"], mass=2.0)
    assert cls("arm").shapes is not cls("arm").shapes
    assert cls.__match_args__ == ("name", "shapes")
    assert [one.name for one in dataclasses.fields(link)] == ["name", "shapes", "mass", "source", "drawn", "number"]
    with pytest.raises(TypeError, match="unhashable"):
        hash(link)
    with pytest.raises(TypeError, match="positional"):
        cls("arm", [], 2.0)


@pytest.mark.parametrize("cls", [CHANGING, THEIRS_CHANGING, Joint, THEIRS[1]])
def test_either_replaces_fields_of_both(cls):
    for function in (replace, dataclasses.replace):
        assert function(cls("arm"), name="leg") == cls("leg")
        with pytest.raises(TypeError, match="unexpected keyword argument 'nme'"):
            function(cls("arm"), nme="leg")


@pytest.mark.parametrize("cls", [CHANGING, THEIRS_CHANGING])
def test_what_no_argument_sets_is_not_replaced(cls):
    for function in (replace, dataclasses.replace):
        with pytest.raises((ValueError, TypeError), match="field number is declared with init=False"):
            function(cls("arm"), number=2)


@pytest.mark.parametrize("cls", [CHANGING, THEIRS_CHANGING, Joint, THEIRS[1]])
def test_either_gives_the_fields_of_both(cls):
    class Motor(cls):
        pass

    for asked in (cls, Motor, Motor("arm")):
        ours, theirs = (function(asked) for function in (fields, dataclasses.fields))
        for name in ("name", "type", "init", "repr", "compare", "kw_only"):
            assert [getattr(one, name) for one in ours] == [getattr(one, name) for one in theirs]
        assert all(isinstance(one, dataclasses.Field) for one in theirs)


def test_a_thread_that_asks_for_fields_as_another_one_gets_them_gets_the_same():
    @dataclass(frozen=True, slots=True)
    class Arm(Mass):
        name: str

    class Forearm(Arm):
        pass

    asked = vars(Arm)["__dataclass_fields__"]  # what both threads have in hand
    gotten = dataclasses.fields(Arm)
    for cls in (Arm, Forearm):
        assert tuple(asked.__get__(None, cls).values()) == gotten


def test_with_a_field_of_the_standard_library_it_is_the_standard_librarys():
    @dataclass(frozen=True, slots=True)
    class Mass:
        kilograms: float = dataclasses.field(default=1.0)

    assert Mass().kilograms == 1.0
    assert not is_quick(Mass)


def test_more_fields_than_usual_are_set_all_the_same():
    names = [f"x{number}" for number in range(40)]
    many = dataclass(frozen=True, slots=True)(type("Many", (), {"__annotations__": dict.fromkeys(names, "int")}))
    assert dataclasses.astuple(many(*range(40))) == tuple(range(40))
    assert is_quick(many)
