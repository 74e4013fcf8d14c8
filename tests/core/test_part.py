"""What every part of the IR does alike: prefixes, copies, extras, and where it was written."""

import copy
import dataclasses
import inspect
import pickle

import pytest
from hypothesis import given
from hypothesis import strategies as st

from linkforge_compile.core.models import (
    gazebo,
    geometry,
    joint,
    link,
    ros2_control,
    sensor,
    srdf,
    transmission,
)
from linkforge_compile.core.models.geometry import Color, Vector3
from linkforge_compile.core.models.link import Link
from linkforge_compile.core.part import Element, Part
from linkforge_compile.source import SourceFile, SourceRef, Span
from tests.strategies import PREFIXED, parts, prefixes

MODULES = (
    gazebo,
    geometry,
    joint,
    link,
    ros2_control,
    sensor,
    srdf,
    transmission,
)
PART_CLASSES = {
    cls
    for module in MODULES
    for name, cls in vars(module).items()
    if inspect.isclass(cls) and issubclass(cls, Part) and cls not in {Part, Element} and not name.startswith("_")
}


class Node:
    """A node in a tree, as a part's source points at it."""

    span = Span(SourceFile("arm.robot.yaml", "base:"), 1, 1, 1, 5)

    def child(self, key: str | int) -> None:
        return None


WRITTEN = SourceRef(Node())


@given(st.one_of(*PREFIXED), prefixes, prefixes)
def test_prefixing_composes(part, inner, outer):
    assert part.with_prefix(inner).with_prefix(outer) == part.with_prefix(outer + inner)


@given(st.one_of(*PREFIXED))
def test_an_empty_prefix_changes_nothing(part):
    assert part.with_prefix("") == part


@given(parts)
def test_copies_and_pickles_are_equal(part):
    assert copy.copy(part) == part
    assert copy.deepcopy(part) == part
    assert pickle.loads(pickle.dumps(part)) == part


@given(parts)
def test_frozen_parts_hash_by_what_they_say(part):
    if isinstance(part, Link):
        return
    assert hash(pickle.loads(pickle.dumps(part))) == hash(part)


@given(st.one_of(*PREFIXED), prefixes)
def test_a_prefix_keeps_where_a_part_was_written(part, prefix):
    marked = part.with_source(WRITTEN)
    assert marked == part
    assert marked.with_prefix(prefix).source is WRITTEN


@given(st.one_of(*PREFIXED), prefixes)
def test_a_copy_under_a_prefix_is_as_frozen_as_the_part(part, prefix):
    if isinstance(part, Link):
        return
    copied = part.with_prefix(prefix)
    assert type(copied) is type(part)
    for field in dataclasses.fields(part):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(copied, field.name, None)


@given(parts)
def test_a_part_with_other_fields_keeps_where_it_was_written(part):
    if isinstance(part, Element):
        changed = part.with_source(WRITTEN).with_fields(extra_elements=["<a/>"])
        assert (changed.extra_elements, changed.source) == (("<a/>",), WRITTEN)


@pytest.mark.parametrize("cls", sorted(PART_CLASSES, key=lambda cls: cls.__name__), ids=lambda cls: cls.__name__)
def test_additional_parameters_follow_the_contract_and_are_keyword_only(cls):
    parameters = inspect.signature(cls).parameters
    assert "source" not in parameters
    if issubclass(cls, Element):
        assert parameters["extra_elements"].kind is inspect.Parameter.KEYWORD_ONLY


@given(parts)
def test_extras_become_tuples_and_are_compared(part):
    if not isinstance(part, Element | Link):
        return
    extended = dataclasses.replace(part, extra_attributes={"a": "1"}, extra_elements=["<b/>"])
    assert extended.extra_attributes == (("a", "1"),)
    assert extended.extra_elements == ("<b/>",)
    assert extended != part


def test_nothing_can_be_added_to_a_part_on_the_side():
    for part in (Vector3(0, 0, 0), Color(1, 0, 0)):
        with pytest.raises(dataclasses.FrozenInstanceError):
            part.note = "a"


@given(parts)
def test_a_pickled_part_keeps_its_source(part):
    there = pickle.loads(pickle.dumps(part.with_source(WRITTEN)))
    assert there == part
    assert str(there.source.span) == "arm.robot.yaml:1:1"
