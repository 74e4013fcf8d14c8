"""Names in raw XML say `$(prefix)` where they are certain, and nothing else does."""

import pytest

from linkforge_compile.importers.prefixed import raw_with_prefix


@pytest.mark.parametrize(
    ("around", "raw", "prefixed"),
    [
        ("gazebo", '<sensor type="imu" name="eye"/>', '<sensor type="imu" name="$(prefix)eye"/>'),
        ("gazebo", "<plugin name='a' filename='b'>", "<plugin name='$(prefix)a' filename='b'>"),
        (
            "gazebo",
            "<plugin name='p'><joint name='x'/></plugin>",
            "<plugin name='$(prefix)p'><joint name='x'/></plugin>",
        ),
        ("gazebo", '<link name="x"/>', '<link name="x"/>'),
        (
            "robot",
            '<joint name="j"><parent link="a"/></joint>',
            '<joint name="$(prefix)j"><parent link="$(prefix)a"/></joint>',
        ),
        ("joint", "<mimic joint='>' x=\"it's\"/>", "<mimic joint='$(prefix)>' x=\"it's\"/>"),
        ("robot", '<gazebo reference=""/>', '<gazebo reference=""/>'),
        (
            "gazebo",
            '<sensor name="a"><x y="/>"/><contact><collision> b </collision></contact><topic>/t</topic></sensor>',
            '<sensor name="$(prefix)a"><x y="/>"/><contact><collision> $(prefix)b </collision></contact>'
            "<topic>/t</topic></sensor>",
        ),
        (
            "robot",
            '<link name="a"><!-- <visual name="b"> --><visual name="c"/>'
            '<drake:x name="d"><visual name="e"/></drake:x></link>',
            '<link name="$(prefix)a"><!-- <visual name="b"> --><visual name="$(prefix)c"/>'
            '<drake:x name="d"><visual name="e"/></drake:x></link>',
        ),
        ("sensor", "<topic>model::x</topic>", "<topic>model::x</topic>"),
    ],
)
def test_a_name_has_the_prefix_where_it_is_certain(around: str, raw: str, prefixed: str):
    assert raw_with_prefix(raw, around) == prefixed
