"""Links and their parts."""

import copy
import math
import pickle
import weakref

import pytest

from linkforge_compile.core.exceptions import (
    RobotMathError,
    RobotPhysicsError,
    RobotValidationError,
    ValidationErrorCode,
)
from linkforge_compile.core.models.geometry import Box, Color, Material, Sphere, Transform, Vector3
from linkforge_compile.core.models.link import (
    Collision,
    Inertial,
    InertiaTensor,
    Link,
    LinkPhysics,
    Visual,
)

BALL = Sphere(0.1)


@pytest.mark.parametrize(
    "entries", [(0, 0, 0), (-1, 1, 1), (1, 1, 100), (1, 1, 1, 5, 5, 5)], ids=["zero", "negative", "triangle", "mixed"]
)
def test_a_tensor_holds_any_finite_numbers_for_real_robots_have_them(entries):
    assert InertiaTensor(*entries).ixx == entries[0]


def test_a_tensor_has_its_diagonal_first():
    tensor = InertiaTensor(1, 2, 3, 0.1, 0.2, 0.3)
    assert (tensor.ixx, tensor.iyy, tensor.izz) == (1, 2, 3)
    assert (tensor.ixy, tensor.ixz, tensor.iyz) == (0.1, 0.2, 0.3)
    assert InertiaTensor.stability_floor() == InertiaTensor(1e-9, 1e-9, 1e-9)


def test_a_mass_may_be_zero_but_not_less():
    assert Inertial(0).inertia == InertiaTensor.stability_floor()
    with pytest.raises(RobotPhysicsError) as caught:
        Inertial(-1e-9)
    assert caught.value.code is ValidationErrorCode.OUT_OF_RANGE
    assert caught.value.field == ("mass",)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda bad: InertiaTensor(1, 1, 1, ixz=bad), "ixz"),
        (Inertial, "mass"),
        (lambda bad: LinkPhysics(kp=bad), "kp"),
    ],
)
def test_nan_and_infinity_are_refused(make, field):
    for bad in (math.nan, math.inf):
        with pytest.raises(RobotMathError) as caught:
            make(bad)
        assert caught.value.field == (field,)


def test_shapes_that_the_order_does_not_list_come_last_and_what_it_lists_too_much_is_none():
    one, two, touch = Visual(BALL, name="one"), Visual(BALL, name="two"), Collision(BALL, name="touch")
    link = Link("a", visuals=[one], collisions=[touch], shape_order=["collision", "collision"])
    link.add_visual(two)
    assert list(link.shapes) == [touch, one, two]
    assert list(link.with_prefix("b_").shapes) == [shape.with_prefix("b_") for shape in link.shapes]


def test_the_order_of_shapes_knows_two_words():
    with pytest.raises(RobotValidationError) as caught:
        Link("a", shape_order=["visual", "colision"])
    assert caught.value.code is ValidationErrorCode.INVALID_VALUE
    assert caught.value.field == ("shape_order",)


def test_a_link_without_inertial_weighs_nothing():
    frame = Link("tool0")
    assert frame.mass == 0
    assert frame.inertia == InertiaTensor.stability_floor()
    assert frame.inertial_origin == Transform.identity()


def test_a_link_answers_for_its_inertial():
    inertial = Inertial(2, Transform(Vector3(1, 2, 3)), InertiaTensor(1, 2, 3))
    link = Link("base", inertial)
    assert (link.mass, link.inertial_origin, link.inertia) == (2, inertial.origin, inertial.inertia)


@pytest.mark.parametrize(
    ("name", "code"),
    [("", ValidationErrorCode.NAME_EMPTY), ("base link", ValidationErrorCode.INVALID_NAME)],
)
def test_a_link_needs_a_name_that_urdf_readers_read(name, code):
    with pytest.raises(RobotValidationError) as caught:
        Link(name)
    assert caught.value.code is code
    assert caught.value.field == ("name",)
    assert Link("2nd.base/link").name == "2nd.base/link"


def test_shapes_are_added_after_existing_ones():
    link = Link("base", visuals=[Visual(BALL)], collisions=[Collision(BALL)])
    link.add_visual(Visual(Box(Vector3(1, 1, 1))))
    link.add_collision(Collision(BALL, name="touch"))
    assert [visual.geometry.type for visual in link.visuals] == ["sphere", "box"]
    assert [collision.name for collision in link.collisions] == [None, "touch"]
    assert isinstance(link.visuals, tuple)


def test_a_copy_of_a_link_changes_alone():
    link = Link("base")
    twin = copy.deepcopy(link)
    twin.name = "other"
    assert link.name == "base"


def test_what_is_no_field_of_a_link_cannot_be_set():
    with pytest.raises(AttributeError):
        Link("base").visual = [Visual(BALL)]


def test_a_prefix_reaches_names_and_materials():
    paint = Material("red", Color(1, 0, 0))
    link = Link("base", visuals=[Visual(BALL, material=paint, name="v")], collisions=[Collision(BALL, name="c")])
    prefixed = link.with_prefix("left_")
    assert prefixed.name == "left_base"
    assert (prefixed.visuals[0].name, prefixed.visuals[0].material.name) == ("left_v", "left_red")
    assert prefixed.collisions[0].name == "left_c"
    assert link.name == "base"
    assert Visual(BALL).with_prefix("left_").name is None


class Watched(Link):
    """A link of a user's own, who looks at what is set, and has a property and slots for fields."""

    __slots__ = ("inertial", "seen")

    def __setattr__(self, field, value):
        if field == "physics" and value.mu > 5:
            raise ValueError(f"mu {value.mu}")
        super().__setattr__(field, value)

    @property
    def visuals(self):
        return self.seen

    @visuals.setter
    def visuals(self, visuals):
        self.seen = tuple(visuals)


def test_a_link_of_a_class_of_ones_own_sets_its_fields_in_its_way():
    link = Watched("base", Inertial(2.0), visuals=[Visual(BALL)])
    assert (link.visuals, link.mass) == ((Visual(BALL),), 2.0)
    with pytest.raises(ValueError, match=r"mu 9\.0"):
        Watched("base", physics=LinkPhysics(mu=9.0))


class Tool(Link):
    """A link of a user's own, that is made from something else than its fields."""

    def __init__(self, length):
        super().__init__(f"tool_{length}", visuals=[Visual(Sphere(length))])
        self.length = length


class Locked(Link):
    """A frozen link."""

    def __init__(self, name):
        super().__init__(name)
        self.locked = True

    def __setattr__(self, field, value):
        if "locked" in vars(self):
            raise TypeError(f"{self.name} is locked")
        super().__setattr__(field, value)


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda link: pickle.loads(pickle.dumps(link))])
def test_a_link_that_is_locked_can_be_copied(copied):
    twin = copied(Locked("base"))
    assert (twin, twin.locked) == (Locked("base"), True)


def test_somebody_may_watch_a_link_that_he_does_not_keep():
    link = Link("base")
    seen = weakref.ref(link)
    assert seen() is link


def test_a_link_that_is_made_otherwise_is_copied_and_not_made_anew():
    copied = Tool(2).with_prefix("left_")
    assert (type(copied), copied.name, copied.length) == (Tool, "left_tool_2", 2)
    assert copied.visuals == Tool(2).visuals


def test_a_link_of_a_class_of_ones_own_is_copied_in_its_way():
    link = Watched("base", Inertial(2.0), visuals=[Visual(BALL, name="v")], collisions=[Collision(BALL)])
    copied = link.with_prefix("left_")
    assert (type(copied), copied.name, copied.mass) == (Watched, "left_base", 2.0)
    assert [visual.name for visual in copied.visuals] == ["left_v"]
    assert copied.seen == copied.visuals
    assert (link.name, link.visuals[0].name) == ("base", "v")


@pytest.mark.parametrize("nothing", [None, 0, False])
def test_what_is_no_list_of_attributes_is_refused(nothing):
    with pytest.raises(TypeError):
        Link("base", extra_attributes=nothing)
    with pytest.raises(TypeError):
        Visual(BALL, extra_attributes=nothing)
