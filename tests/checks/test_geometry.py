from linkforge_compile.core import Box, Collision, Inertial, InertiaTensor, Link, Robot, Vector3, Visual
from linkforge_compile.diagnostics import UnresolvedNames
from tests.checks.robots import fixed, messages_of

CUBE = Box(Vector3(0.1, 0.1, 0.1))
INERTIAL = Inertial(1.0, inertia=InertiaTensor(0.002, 0.002, 0.002))


def link(name: str, *, seen: bool, touched: bool, inertial: Inertial | None = INERTIAL) -> Link:
    return Link(name, inertial, visuals=[Visual(CUBE)] * seen, collisions=[Collision(CUBE)] * touched)


def of(*links: Link) -> Robot:
    first, *others = links
    return Robot("r", links=links, joints=[fixed(f"to_{one.name}", first.name, one.name) for one in others])


def test_links_that_nothing_touches_are_reported():
    whole = link("base", seen=True, touched=True)
    subject = of(whole, *(link(name, seen=True, touched=False) for name in ("a", "b")))
    assert messages_of(subject) == [
        "LF6050 link 'a' has a visual and no collision, so everything passes through it",
        "LF6050 link 'b' has a visual and no collision, so everything passes through it",
    ]
    assert messages_of(subject, UnresolvedNames(frozenset({"c"}))) == []


def test_a_robot_only_to_be_seen_is_fine():
    assert messages_of(of(link("base", seen=True, touched=False), link("a", seen=True, touched=False))) == []


def test_a_robot_only_to_be_touched_is_fine():
    assert messages_of(of(link("base", seen=False, touched=True), link("a", seen=False, touched=True))) == []


def test_ornaments_and_frames_are_fine():
    base = link("base", seen=True, touched=True)
    assert messages_of(of(base, link("label", seen=True, touched=False, inertial=None), Link("tool0"))) == []
