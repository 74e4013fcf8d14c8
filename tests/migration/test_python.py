"""Expressions of Python that the language does not have, of values that no argument changes."""

from pathlib import Path

from tests.migration.migrated import migrated


def test_an_argument_that_is_a_list_of_python_keeps_its_value(tmp_path: Path):
    text = """
<xacro:arg name="arms" default="['left', 'right']"/>
<xacro:arg name="size" default="0.1"/>
<xacro:property name="names" value="${$(arg arms)}"/>
<link name="base"/>
<link name="${names[1]}"><visual><geometry><sphere radius="$(arg size)"/></geometry></visual></link>
<joint name="${names[1]}_joint" type="fixed"><parent link="base"/><child link="${names[1]}"/></joint>"""
    made = migrated(tmp_path, text)
    assert "right: {visual: {sphere: $(size)}}" in made.robot
    [pinned] = [one.message for one in made.proved.diagnostics if one.code.id == "LF8042"]
    assert pinned.startswith("'arms' is '['left', 'right']' in the specs")


def test_loops_and_lists_of_python_are_computed_where_all_values_are_known(tmp_path: Path):
    text = """
<xacro:property name="old" default="${None}"/>
<xacro:if value="${old}"><link name="old"/></xacro:if>
<xacro:property name="found" value="${None}"/>
<xacro:if value="${found is None and python.isinstance('a=b', str)}">
  <xacro:property name="found" value="${dict(list(python.zip(['th', 'ff'], 2 * ['pst'])) + [('ff', 'bt')])}"/>
</xacro:if>
<xacro:property name="upper" value="${xacro.dotify(dict([(k, v.upper()) for k, v in found.items()]))}"/>
<link name="${upper.th}_${upper.ff}"/>"""
    assert "PST_BT: {}" in migrated(tmp_path, text).robot
