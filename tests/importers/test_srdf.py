"""An SRDF comes in as the semantic part that a person would write, and what only it knows stays."""

import re
from dataclasses import replace
from pathlib import Path
from textwrap import dedent, indent

import pytest

from benchmarks.import_table import differences_of
from linkforge_compile import Import, compile_text, import_urdf, render_srdf
from linkforge_compile.limits import Limit
from tests.importers.robots import ALONE

TREE = """
  <link name="base"/> <link name="upper"/> <link name="tip"/>
  <joint name="turn" type="revolute">
    <parent link="base"/> <child link="upper"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
  </joint>
  <joint name="slide" type="prismatic">
    <parent link="upper"/> <child link="tip"/> <axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="1" velocity="1"/>
  </joint>"""


def imported(folder: Path, srdf: str, urdf: str = f'<robot name="r">{TREE}</robot>') -> Import:
    (folder / "r.urdf").write_text(urdf, "utf-8")
    (folder / "r.srdf").write_text(srdf, "utf-8")
    return import_urdf(folder / "r.urdf", srdf=folder / "r.srdf")


@pytest.fixture
def read(tmp_path: Path):
    """Import an SRDF of the robot above without diagnostics; return the contents of `semantic`."""

    def read_srdf(text: str) -> str:
        whole = imported(tmp_path, f'<robot name="r">{text}</robot>')
        assert not [str(one) for one in whole.diagnostics]
        assert whole.text is not None
        compile_text(whole.text).result()
        return dedent(whole.text.partition("\nsemantic:\n")[2]).strip("\n")

    return read_srdf


@pytest.mark.parametrize(
    ("xml", "expected"),
    [
        (
            '<virtual_joint name="w" type="floating" parent_frame="odom" child_link="base"/>',
            "virtual_joints: {w: {type: floating, parent_frame: odom, child_link: base}}",
        ),
        (
            '<group name="g"><chain base_link="base" tip_link="tip"/></group>',
            "groups: {g: {chain: {base_link: base, tip_link: tip}}}",
        ),
        (
            """<group name="g"><joint name="slide"/><link name="upper"/><joint name="turn"/></group>
               <group name="all"><group name="g"/></group>""",
            "groups: {g: {links: [upper], joints: [slide, turn]}, all: {subgroups: [g]}}",
        ),
        ('<passive_joint name="turn"/><passive_joint name="slide"/>', "passive_joints: [turn, slide]"),
        (
            '<passive_joint name="turn"/><passive_joint name="slide" why="spring"/>',
            "passive_joints: {turn: {}, slide: {extra_attributes: {why: spring}}}",
        ),
        (
            """<disable_collisions link1="upper" link2="tip" reason="Adjacent"/>
               <disable_collisions link1="base" link2="upper" reason="1.0"/>
               <disable_collisions link1="upper" link2="base"/>
               <disable_collisions link1="base" link2="tip" reason="Never" by="me"/>""",
            """\
            disabled_collisions:
              upper: {tip: Adjacent, base: null}
              base: {upper: 1.0, tip: {reason: Never, extra_attributes: {by: me}}}""",
        ),
        (
            """<disable_default_collisions link="tip"/><enable_collisions link1="tip" link2="base" reason="User"/>""",
            "enabled_collisions: {tip: {base: User}}\nno_default_collision_links: [tip]",
        ),
        (
            """<joint_property joint_name="turn" property_name="angle_wraparound" value="true"/>
               <joint_property joint_name="turn" property_name="d" value="010" unit="m"/>""",
            """\
            joint_properties:
              turn: {angle_wraparound: true, d: {value: 010, extra_attributes: {unit: m}}}""",
        ),
        (
            """<link_sphere_approximation link="tip"><sphere center="0 0 0.10" radius=".5"/></link_sphere_approximation>
               <link_sphere_approximation link="base" by="hand"/>""",
            """\
            link_sphere_approximations:
              tip: [{center: [0, 0, 0.10], radius: 0.5}]
              base: {spheres: [], extra_attributes: {by: hand}}""",
        ),
        (
            '<specificities><size height="1"/></specificities>',
            'extra: <specificities><size height="1"/></specificities>',
        ),
    ],
)
def test_a_part_has_its_own_words(read, xml: str, expected: str):
    assert read(xml) == dedent(expected)


def test_a_state_is_in_the_units_of_its_joints(read):
    group = '<group name="g"><chain base_link="base" tip_link="tip"/></group>'
    world = '<virtual_joint name="w" type="planar" parent_frame="odom" child_link="base"/>'
    state = f"""{world}{group}<group name="h"><joint name="w"/></group>
      <group_state name="up" group="g">
        <joint name="turn" value="1.5707963267948966"/> <joint name="slide" value="1.5707963267948966"/>
      </group_state>
      <group_state name="away" group="h"><joint name="w" value="1 2 1.5707963267948966"/></group_state>"""
    assert read(state).partition("group_states:\n")[2] == indent(
        "g: {up: {turn: 90 deg, slide: 1.5707963267948966}}\nh: {away: {w: [1, 2, 1.5707963267948966]}}", "  "
    )


def test_a_position_with_raw_parts_stays_raw_and_is_written_once(tmp_path: Path):
    whole = imported(
        tmp_path,
        """<robot name="r"><group name="g"><joint name="turn"/></group>
           <group_state name="up" group="g"><joint name="turn" value="1" unit="rad"/></group_state></robot>""",
    )
    assert whole.text is not None
    assert render_srdf(compile_text(whole.text).result()).count('<joint name="turn" value=') == 1


def test_a_removed_group_removes_those_that_contain_nothing_else(tmp_path: Path):
    chain = "".join(f'<group name="g{n}"><group name="g{n + 1}"/></group>' for n in range(60))
    tip = '<group name="hand"><link name="tip"/><group name="g0"/></group>'
    whole = imported(tmp_path, f'<robot name="r">{tip}{chain}</robot>')
    assert not whole.has_errors, whole.diagnostics
    assert whole.text is not None
    assert [group.name for group in compile_text(whole.text).result().semantic.groups] == ["hand"]


def test_groups_in_a_circle_come_apart_where_it_closes(tmp_path: Path):
    one, other = (
        f'<group name="{name}"><link name="tip"/><group name="{inner}"/></group>' for name, inner in ("ab", "ba")
    )
    whole = imported(tmp_path, f'<robot name="r">{one}{other}</robot>')
    assert [fault.message for fault in whole.diagnostics] == [
        "<group> is kept as raw XML: planning group 'a' contains the group that it is in"
    ]
    assert whole.text is not None
    semantic = compile_text(whole.text).result().semantic
    assert [(group.name, group.subgroups) for group in semantic.groups] == [("a", ("b",)), ("b", ())]


def test_each_reading_of_an_srdf_may_take_what_a_compile_may(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(Limit.ENTRIES, "_value_", replace(Limit.ENTRIES.value, most=9))
    up = '<group name="g"><chain base_link="tip" tip_link="base"/></group>'
    whole = imported(tmp_path, f'<robot name="r"><passive_joint name="turn"/>{up}</robot>')
    assert [one.code.id for one in whole.diagnostics] == ["LF8021"], "it is known to be refused when it is judged"
    compile_text(whole.text).result()


def test_comments_stand_where_they_stood(read):
    assert read("""
      <!-- who moves -->
      <group name="g">
        <chain base_link="base" tip_link="tip"/> <!-- all of it -->
      </group>
      <!-- computed by hand -->
      <disable_collisions link1="base" link2="upper" reason="Adjacent"/>
      <!-- never seen -->
      <disable_collisions link1="base" link2="tip" reason="Never"/>
      <!-- that is all -->""") == dedent("""\
        groups:
          # who moves
          g:
            # all of it
            chain: {base_link: base, tip_link: tip}
        disabled_collisions:
          # computed by hand
          base:
            upper: Adjacent
            # never seen
            tip: Never
        # that is all""")


def test_headings_of_the_assistant_stand_above_the_sections(read):
    assert read("""
      <!--GROUPS: Representation of a set of joints and links.-->
      <!--LINKS: When a link is specified, its parent joint is included-->
      <group name="g"> <!-- all of it -->
        <chain base_link="base" tip_link="tip"/>
      </group>
      <!--END EFFECTOR: Purpose: Represent information about an end effector.-->
      <!--DISABLE COLLISIONS: By default any link could collide with any other.-->
      <!-- computed by hand -->
      <disable_collisions link1="base" link2="upper" reason="Adjacent"/>""") == dedent("""\
        # GROUPS: Representation of a set of joints and links.
        # LINKS: When a link is specified, its parent joint is included
        groups:
          # all of it
          g: {chain: {base_link: base, tip_link: tip}}
        # END EFFECTOR: Purpose: Represent information about an end effector.
        # DISABLE COLLISIONS: By default any link could collide with any other.
        disabled_collisions:
          # computed by hand
          base: {upper: Adjacent}""")


def test_comments_around_both_files_are_kept(tmp_path: Path):
    text = imported(
        tmp_path,
        '<!-- planners --><robot name="r"><passive_joint name="turn"/></robot><!-- end of SRDF -->',
        f'<!-- tree --><robot name="r">{TREE}</robot><!-- end of URDF -->',
    ).text
    assert text is not None
    assert text.startswith("# tree\nlinkforge: 1\n")
    assert "\n# planners\nsemantic:\n" in text
    assert text.endswith("\n# end of URDF\n# end of SRDF\n")


def test_an_empty_srdf_is_imported(tmp_path: Path):
    whole = imported(tmp_path, '<robot name="r"/>')
    assert whole.text is not None
    assert compile_text(whole.text).result().has_semantic


@pytest.mark.parametrize("srdf", ["<robot/>", '<group name="g"/>', "<robot"])
def test_what_is_no_srdf_is_refused(tmp_path: Path, srdf: str):
    whole = imported(tmp_path, srdf)
    assert whole.text is None
    assert [one.span.file.name for one in whole.diagnostics if one.span] == [str(tmp_path / "r.srdf")]


def test_a_missing_srdf_is_reported(tmp_path: Path):
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{TREE}</robot>', "utf-8")
    assert import_urdf(tmp_path / "r.urdf", srdf=tmp_path / "none.srdf").text is None


def stand_in(srdf: str) -> str:
    """Return a URDF with the links and joints that an SRDF names, in no order of theirs."""
    links = set(re.findall(r'\b(?:link\d?|base_link|tip_link|parent_link|child_link|link name)="([^"]+)"', srdf))
    joints = set(re.findall(r'<(?:passive_)?joint name="([^"]+)"|joint_name="([^"]+)"', srdf))
    virtual = set(re.findall(r'<virtual_joint name="([^"]+)"', srdf))
    moved = {name: ("fixed", f"{name}_stand") for name in sorted(links)}
    moved |= {f"{name}_link": ("continuous", name) for one in joints for name in one if name and name not in virtual}
    parts = [
        f'<link name="{link}"/><joint name="{joint}" type="{kind}"><parent link="stand"/><child link="{link}"/></joint>'
        for link, (kind, joint) in moved.items()
    ]
    [name] = re.findall(r'<robot\s+name="([^"]*)"', srdf)
    return f'<robot name="{name}"><link name="stand"/>{"".join(parts)}</robot>'


@pytest.mark.parametrize("path", ALONE, ids=lambda path: path.stem)
def test_an_srdf_without_its_robot_comes_back_the_same(path: Path, shared: Path, tmp_path: Path):
    srdf = path.read_text("utf-8")
    whole = imported(tmp_path, srdf, stand_in(srdf))
    assert whole.text is not None
    assert not whole.has_errors, whole.diagnostics
    assert not whole.losses
    robot = compile_text(whole.text).result()
    assert robot.semantic.disabled_collisions
    assert not differences_of(robot, shared / "tools" / "urdf_equiv.py", tmp_path / "r.urdf", path, "xml")
    (tmp_path / "r.srdf").write_text(render_srdf(robot), "utf-8")
    again = import_urdf(tmp_path / "r.urdf", srdf=tmp_path / "r.srdf")
    assert again.text is not None
    assert render_srdf(compile_text(again.text).result()) == render_srdf(robot)
