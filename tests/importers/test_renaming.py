"""Names that a spec cannot have are replaced wherever they name the part, and nowhere else."""

from pathlib import Path

from linkforge_compile import compile_file, compile_text, import_urdf
from linkforge_compile.core import Vector3


def test_an_srdf_gets_the_names_that_the_parts_of_its_robot_got(tmp_path: Path):
    urdf, srdf, spec = (tmp_path / name for name in ("r.urdf", "r.srdf", "whole.robot.yaml"))
    urdf.write_text(
        """<robot name="r"><link name="base"/><link name="a b"/><link name="a_b"/><link name="x_y"/>
        <joint name="j" type="fixed"><parent link="base"/><child link="a b"/></joint>
        <joint name="k" type="fixed"><parent link="base"/><child link="a_b"/></joint>
        <joint name="l" type="fixed"><parent link="base"/><child link="x_y"/></joint></robot>""",
        "utf-8",
    )
    srdf.write_text(
        """<robot name="r"><group name="a b"><link name="a b"/></group>
        <unknown link="a b" text="a b"/>
        <disable_collisions link1="base" link2="a b" reason="a b"/>
        <disable_collisions link1="base" link2="x y" reason="Never"/></robot>""",
        "utf-8",
    )
    use = f'{{use: {urdf.name}, srdf: {srdf.name}, prefix: ""}}'
    spec.write_text(f"linkforge: 1\nname: m\nmodules: {{r: {use}}}\n", "utf-8")
    read = import_urdf(urdf, srdf=srdf)
    places = {(one.code.id, one.span.file.name, one.span.line) for one in read.diagnostics if one.span}
    assert {("LF8105", str(urdf), 1), ("LF8021", str(srdf), 4)} <= places
    for compiled in (compile_text(read.text or ""), compile_file(spec)):
        semantic = compiled.result().semantic
        assert [(group.name, group.links) for group in semantic.groups] == [("a b", ("a-b",))]
        assert [(one.link1, one.link2, one.reason) for one in semantic.disabled_collisions] == [("base", "a-b", "a b")]
        assert '<unknown link="a-b" text="a b"/>' in semantic.extra_elements


def test_numbers_that_are_also_names_of_links_stay(tmp_path: Path):
    urdf = tmp_path / "r.urdf"
    urdf.write_text(
        """<robot name="r"><link name="0 0 1"><visual><origin xyz="0 0 1"/><geometry><box size="1 1 1"/></geometry>
        </visual></link><link name="1 1 1"/>
        <joint name="j" type="fixed"><parent link="0 0 1"/><child link="1 1 1"/></joint></robot>""",
        "utf-8",
    )
    (joint,) = (robot := compile_text(import_urdf(urdf).text or "").result()).joints
    assert (joint.parent, joint.child) == ("0_0_1", "1_1_1")
    (visual,) = robot.link("0_0_1").visuals
    assert (visual.origin.xyz.z, visual.geometry.size) == (1, Vector3(1, 1, 1))
