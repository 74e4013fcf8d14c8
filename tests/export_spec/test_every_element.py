"""Every element that is written can have an unknown attribute and element, in the model and in a spec."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from itertools import count

import pytest
from lxml import etree

from linkforge_compile.core import Robot
from linkforge_compile.core.models.geometry import Material
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.models.ros2_control import Interface
from linkforge_compile.core.part import Element, Inside
from linkforge_compile.diagnostics import Severity
from linkforge_compile.export_spec import write_spec
from linkforge_compile.formats import SRDF, URDF
from linkforge_compile.formats.render import render_srdf, render_urdf
from tests.export_spec.test_every_field import full
from tests.export_spec.test_laws import compiled
from tests.formats.everything import everything

SAID_BY_A_GAZEBO_BLOCK = {"gazebo"}
"""Elements without a part of their own: the block around a sensor, and that of a link's physics."""

FREE = {"plugin"}
"""Elements whose children are free parts, which say attributes and children by themselves."""

Insides = Mapping[str, list[Inside]]


@pytest.mark.parametrize("robot", [full, everything], ids=lambda robot: robot.__name__)
@pytest.mark.parametrize("render", [render_urdf, render_srdf])
def test_every_element_may_have_more(robot: Callable[[], Robot], render: Callable[[Robot], str]):
    marked = stamped(robot(), {})
    insides: dict[str, list[Inside]] = {}
    for element in etree.fromstring(render(marked).encode()).iter(etree.Element):
        if "own" not in element.attrib and element.tag != "more":
            owner, inside = _inside(element)
            if owner is not None:
                insides.setdefault(owner, []).append(inside)
    marked = stamped(robot(), insides)
    for element in etree.fromstring(render(marked).encode()).iter(etree.Element):
        if element.tag == "more" or _is_free(element):
            continue
        assert {"own", "inner"} & {*element.attrib}, etree.tostring(element)
        assert element.find("more") is not None, etree.tostring(element)
    diagnostics = [*URDF.limits(marked, {}), *SRDF.limits(marked, {})]
    assert not [fault for fault in diagnostics if fault.severity is Severity.ERROR]
    again = compiled(write_spec(marked))
    assert render(again) == render(marked)


def _is_free(element: etree._Element) -> bool:
    above = [element.tag, *(ancestor.tag for ancestor in element.iterancestors())]
    gazebo = "gazebo" in above and "sensor" not in above
    return (gazebo and "own" not in element.attrib) or _is_in_free_part(element) or element.tag == "gazebo"


def _is_in_free_part(element: etree._Element) -> bool:
    above = list(element.iterancestors())
    # `role` is a parameter of the transmission.
    return any(ancestor.tag in FREE and "own" in ancestor.attrib for ancestor in above) or element.tag == "role"


def _inside(element: etree._Element) -> tuple[str | None, Inside]:
    """Return the part that contains an element, and what extends it."""
    inside = Inside(element.tag, _name(element), **_more("inner", "1"))
    for ancestor in element.iterancestors():
        if owner := ancestor.get("own"):
            return (None if _is_free(element) else owner), inside
        inside = Inside(ancestor.tag, _name(ancestor), extra_inside=[inside])
    return None, inside


def _name(element: etree._Element) -> str | None:
    """Return what distinguishes an element from its siblings of the same tag, None for the only one."""
    parent = element.getparent()
    if parent is None or len(parent.findall(element.tag)) < 2:
        return None
    return element.get("name") or element.get("link") or element.text


def _more(attribute: str, value: str) -> dict[str, object]:
    return {"extra_attributes": ((attribute, value),), "extra_elements": ("<more/>",)}


def stamped(robot: Robot, insides: Insides) -> Robot:
    """Return the robot with a number in each of its parts, and with additions to the elements inside of them."""
    numbers = map(str, count())
    stamp = _Stamp(numbers, insides)
    parts = {field.name: stamp(getattr(robot, field.name)) for field in fields(robot) if field.name in _SECTIONS}
    return Robot(robot.name, version=robot.version, version_stated=True, **parts, **_more("own", "robot"))


_SECTIONS = frozenset(
    {"materials", "links", "joints", "sensors", "transmissions", "ros2_controls", "gazebo_elements"}
) | {"semantic"}


class _Stamp:
    def __init__(self, numbers: Iterator[str], insides: Insides) -> None:
        self._numbers = numbers
        self._insides = insides
        self._materials: dict[str, object] = {}

    def __call__(self, part: object) -> object:
        if isinstance(part, Interface):
            return Interface(part, part.parameters, **self._extras(part))
        if isinstance(part, str):
            return part
        if isinstance(part, Material):
            # A visual refers to a material of the robot that is the same.
            return self._materials.setdefault(part.name, self._part(part))
        if is_dataclass(part):
            return self._part(part)
        if isinstance(part, Mapping):
            return {key: self(value) for key, value in part.items()}
        return tuple(map(self, part)) if hasattr(part, "__iter__") else part

    def _part(self, part: object) -> object:
        values = {field.name: self(getattr(part, field.name)) for field in fields(part) if field.init}
        values |= self._extras(part) if isinstance(part, Element | Link) else {}
        return replace(part, **values)

    def _extras(self, part: object) -> dict[str, object]:
        number = next(self._numbers)
        inside = {} if isinstance(part, Link) else {"extra_inside": _joined(self._insides.get(number, ()))}
        return _more("own", number) | inside


def _joined(insides: Iterable[Inside]) -> list[Inside]:
    """Return the additions to one element as one."""
    joined: dict[tuple[str, str | None], Inside] = {}
    for one in insides:
        known = joined.setdefault((one.tag, one.name), one)
        joined[one.tag, one.name] = replace(
            known,
            extra_attributes=known.extra_attributes or one.extra_attributes,
            extra_elements=known.extra_elements or one.extra_elements,
            extra_inside=_joined(dict.fromkeys((*known.extra_inside, *one.extra_inside))),
        )
    return list(joined.values())
