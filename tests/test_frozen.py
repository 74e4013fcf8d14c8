"""A frozen class of ours is what the standard library would make of it."""

import dataclasses
import inspect
import pickle
from collections.abc import Callable

import pytest

from linkforge_compile.frozen import dataclass

NAN = float("nan")


def _of(decorator: Callable) -> tuple[type, type, type]:
    """Return a class with all kinds of fields, one that inherits, and one of a single field, made by a decorator."""

    @decorator(frozen=True, slots=True, kw_only=True)
    class Sourced:
        """Remembers where."""

        place: str | None = dataclasses.field(default=None, compare=False, repr=False)

    @decorator(frozen=True, slots=True)
    class Joint(Sourced):
        """Moves."""

        name: str
        axis: tuple[float, ...] = (1.0, 0.0, 0.0)
        limits: dict[str, float] = dataclasses.field(default_factory=dict, hash=None)
        mimic: object = dataclasses.field(default=None, kw_only=True)

        def __post_init__(self) -> None:
            if not self.name:
                raise ValueError("no name")

    @decorator(frozen=True)
    class Mass:
        """Weighs."""

        kilograms: float

    return Sourced, Joint, Mass


OURS, THEIRS = _of(dataclass), _of(dataclasses.dataclass)
Sourced, Joint, Mass = OURS
# For pickle, which looks classes up by their names.
for one in OURS:
    one.__qualname__ = one.__name__

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
    ours, theirs = (inspect.signature(cls).parameters.values() for cls in (Joint, THEIRS[1]))
    assert [(one.name, one.kind, one.annotation) for one in ours] == [
        (one.name, one.kind, one.annotation) for one in theirs
    ]


@pytest.mark.parametrize("classes", [OURS, THEIRS])
def test_equality_and_hash_are_of_what_is_compared(classes):
    sourced, joint, mass = classes
    assert joint("a", place="here") == joint("a", place="there")
    assert joint("a") != joint("b")
    assert joint("a", (NAN,)) != joint("a", (float("nan"),))
    assert mass(NAN) == mass(NAN)
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


def test_it_goes_through_pickle():
    joint = Joint("a", (0.0,), {"lower": 1.0}, place="here")
    copy = pickle.loads(pickle.dumps(joint))
    assert copy == joint
    assert copy.place == "here"


def test_it_matches_by_position():
    match Joint("a", (0.0,)):
        case Joint(name, axis):
            assert (name, axis) == ("a", (0.0,))


def test_others_may_derive_from_it_with_the_standard_decorator():
    @dataclasses.dataclass(frozen=True)
    class Motor(Joint):
        gear: float = 1.0

    assert Motor("a", gear=2.0) == dataclasses.replace(Motor("a"), gear=2.0)


def test_the_own_methods_of_a_class_stay():
    @dataclass(frozen=True, slots=True)
    class Index:
        position: int

        def __repr__(self) -> str:
            return f"#{self.position}"

    assert repr(Index(3)) == "#3"


def test_what_has_an_identity_is_equal_to_itself_only():
    @dataclass(frozen=True, eq=False)
    class Node:
        text: str

    node = Node("a")
    assert {node, node, Node("a")} - {node} != set()


def test_what_is_not_frozen_is_the_standard_librarys():
    @dataclass(slots=True)
    class Counter:
        count: int = 0

    counter = Counter()
    counter.count += 1
    assert counter == Counter(1)
