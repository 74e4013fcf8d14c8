"""Names in raw XML say `$(prefix)` where they are certain, and nothing else does."""

import pytest

from linkforge_compile.importers.raw_xml import Shapes, raw_with_prefix


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
            '<sensor name="a"><x y="/>"/><contact><collision> hull </collision></contact><topic>/t</topic></sensor>',
            '<sensor name="$(prefix)a"><x y="/>"/><contact><collision> $(prefix)hull </collision></contact>'
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
        ("contact", "<topic>__default_topic__</topic>", "<topic>__default_topic__</topic>"),
        ("sensor", "<topic><!-- c --> x</topic>", "<topic><!-- c --> $(prefix)x</topic>"),
        ("sensor", "<topic>\n <![CDATA[ x]]></topic>", "<topic>\n <![CDATA[ $(prefix)x]]></topic>"),
        ("sensor", "<topic>a<!-- c -->::b</topic>", "<topic>a<!-- c -->::b</topic>"),
        ("sensor", "<topic/><x>y</x>", "<topic/><x>y</x>"),
        ("contact", "<collision>b_collision</collision>", "<collision>$(prefix)b_collision</collision>"),
        ("contact", "<collision>b_collision_1</collision>", "<collision>$(prefix)b_collision_1</collision>"),
        ("contact", "<collision>c_collision</collision>", "<collision>c_collision</collision>"),
        (
            "contact",
            "<collision>b_fixed_joint_lump__b_collision_1</collision>",
            "<collision>b_fixed_joint_lump__b_collision_1</collision>",
        ),
        ("group", '<passive_joint name="j"/>', '<passive_joint name="$(prefix)j"/>'),
        (
            "robot",
            '<gripper name="g"><position>1</position><link name="tool0"/></gripper>',
            '<gripper name="$(prefix)g"><position>1</position><link name="$(prefix)tool0"/></gripper>',
        ),
        ("robot", '<mimic joint="x"/>', '<mimic joint="x"/>'),
        ("robot", '<parent link="x"/>', '<parent link="x"/>'),
        ("robot", '<chain base_link="x"/>', '<chain base_link="x"/>'),
    ],
)
def test_a_name_has_the_prefix_where_it_is_certain(around: str, raw: str, prefixed: str):
    assert raw_with_prefix(raw, around, Shapes(frozenset({"b"}), frozenset({"hull"}))) == prefixed
