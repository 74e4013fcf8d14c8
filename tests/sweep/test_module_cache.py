"""Points of a sweep use the same modules where no varied parameter reaches, which changes nothing but the time."""

from pathlib import Path

import pytest

from linkforge_compile.core.models.robot import Robot
from linkforge_compile.diagnostics import Diagnostic, Diagnostics
from linkforge_compile.expand.varied import varied_in_modules
from linkforge_compile.limits import Budget
from linkforge_compile.source import SourceFile
from linkforge_compile.sweep import run
from linkforge_compile.sweep.plan import Choice, Plan, plan_of
from linkforge_compile.sweep.store import Chunk
from linkforge_compile.sweep.work import Request, compile_point, make
from linkforge_compile.syntax import YamlMap, read
from tests.conftest import ROOT
from tests.meshes import block, content

ARM = """\
linkforge: 1
name: arm
parameters: {size: {type: length, default: 0.5 m}}
links:
  base: {visual: {box: [0.1, 0.1, $(size)]}, inertial: {mass: 1 kg}}
  tip: {visual: {sphere: 0.1}, inertial: {mass: 1 kg}}
joints: {wrist: {type: continuous, parent: base, child: tip, axis: z}}
"""

CELL = """\
linkforge: 1
name: cell
parameters: {height: {type: length, default: 1 m}, size: {type: length, default: 0.3 m}}
variants: {low: {size: 0.1 m}, wide: {size: 0.6 m}}
links: {table: {visual: {box: [1, 1, $(height)]}}}
modules:
  placed: {use: arm.robot.yaml, parent: table, origin: [0, 0, $(height)], with: {size: $(size)}}
  sized: {use: arm.robot.yaml, parent: table, with: {size: $(height)}}
"""


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    (tmp_path / "arm.robot.yaml").write_text(ARM)
    path = tmp_path / "cell.robot.yaml"
    path.write_text(CELL)
    return path


def plan(spec: Path, *sets: str, variants: tuple[str, ...] = ()) -> Plan:
    return plan_of(Request(str(spec), "robot", formats=("urdf", "srdf")), Choice(sets, variants))


def assert_as_alone(plan: Plan) -> None:
    """Compare all that is made of each point after the ones before with what is made of it alone."""
    request, cache = plan.request, plan.request.new_cache()
    for point in plan.points_of(Chunk(0, plan.size)):
        assert make(request, point, cache=cache) == make(request, point), point
        cached, alone = compile_point(request, point, cache=cache), compile_point(request, point)
        assert [str(one) for one in cached.diagnostics] == [str(one) for one in alone.diagnostics]
        assert [with_notes(one) for one in cached.diagnostics] == [with_notes(one) for one in alone.diagnostics]
        assert (cached.files, cached.unread) == (alone.files, alone.unread)


def with_notes(diagnostic: Diagnostic) -> list[tuple[str, str]]:
    notes = [(note.message, note.span) for note in diagnostic.notes]
    return [(words, str(span)) for words, span in [(diagnostic.message, diagnostic.span), *notes]]


def robots(plan: Plan) -> list[Robot]:
    """Return the robots of all points, which share modules."""
    cache = plan.request.new_cache()
    points = plan.points_of(Chunk(0, plan.size))
    return [compile_point(plan.request, point, cache=cache).result() for point in points]


def heights(robot: Robot) -> list[object]:
    return [robot.link(name).visuals[0].geometry.size.z for name in ("table", "placed_base", "sized_base")]  # type: ignore[union-attr]


def test_a_module_that_is_only_placed_by_a_parameter_is_made_once(cell: Path):
    first, second = robots(plan(cell, "height=1 m,2 m"))
    assert first.link("placed_base").inertial is second.link("placed_base").inertial
    assert first.link("sized_base").inertial is not second.link("sized_base").inertial
    assert (heights(first), heights(second)) == ([1, 0.3, 1], [2, 0.3, 2])
    assert second.joint("placed_joint").origin.xyz.z == 2
    assert_as_alone(plan(cell, "height=1 m,2 m,1 m"))


def test_each_variant_has_modules_of_its_own(cell: Path):
    both = plan(cell, "height=1 m,2 m", variants=("low", "wide"))
    assert both.size == 4
    assert [heights(robot)[1] for robot in robots(both)] == [0.1, 0.6, 0.1, 0.6]
    assert_as_alone(both)


def test_what_a_function_changes_in_a_robot_stays_in_it(cell: Path):
    def harden(robot: Robot, _values: object) -> float:
        base = robot.link("base")
        before = base.mass
        base.inertial = None
        return before

    cell.write_text(CELL.replace("parent: table, origin", 'prefix: "", parent: table, origin'))
    assert run(cell, {"height": [1, 2, 3]}, harden)["result"].to_pylist() == [1, 1, 1]


@pytest.mark.parametrize(
    ("arm", "words"),
    [
        (ARM.replace("mass: 1 kg", "mass: 0 kg"), "mass"),
        (ARM.replace("axis: z", "axis: $(1 / 0)"), "zero"),
        (ARM.replace("child: tip", "child: top"), "top"),
        (ARM.replace("$(size)", "0.01 mm"), "box"),
        ("linkforge: 1\nname: [", "]"),
    ],
)
def test_every_robot_is_told_what_is_wrong_in_a_module(cell: Path, arm: str, words: str):
    cell.with_name("arm.robot.yaml").write_text(arm)
    assert_as_alone(plan(cell, "height=1 m,2 m,3 m"))
    rows = run(cell, {"height": [1, 2]})["diagnostics"].to_pylist()
    assert words in rows[0]
    assert rows[0] == rows[1]


@pytest.mark.parametrize(("rounds", "errors"), [(5_000, 0), (15_000, 1)])
def test_a_cached_module_counts_for_the_limits_of_each_robot(cell: Path, rounds: int, errors: int):
    """The first module has 40,000 rounds of 'for', the second, which is made anew, the others; 50,000 are allowed."""
    for name, count in (("arm", 40_000), ("second", rounds)):
        extra = f"extra: [{{for: {{i: {count}}}, when: $(i < 0), value: <a/>}}]"
        text = ARM.replace("tip: {", f"tip: {{{extra}, ").replace("type: length, default: 0.5 m", "default: 0.5")
        cell.with_name(f"{name}.robot.yaml").write_text(text)
    second = "{use: second.robot.yaml, parent: table, with: {size: $(n)}}"
    cell.write_text(f"{N}{TABLE}modules: {{a: {{use: arm.robot.yaml, parent: table}}, b: {second}}}\n")
    both = plan(cell, "n=1,2")
    assert_as_alone(both)
    assert make(both.request, both.points[0]).row["errors"] == errors


def test_a_cached_module_names_its_files_for_each_robot(cell: Path):
    (cell.parent / "sizes.yaml").write_text("size: 0.2\n")
    cell.with_name("arm.robot.yaml").write_text(f"{ARM}data: {{sizes: sizes.yaml}}\n")
    both = plan(cell, "height=1 m,2 m")
    assert_as_alone(both)
    cache = both.request.new_cache()
    for point in (both.points[0], both.points[1]):
        read_files = {path.name for path in make(both.request, point, cache=cache).read}
        assert read_files == {"cell.robot.yaml", "arm.robot.yaml", "sizes.yaml"}


def test_a_module_of_a_vendor_runs_xacro_once(cell: Path, monkeypatch: pytest.MonkeyPatch):
    from linkforge_compile.load import xacro

    (cell.parent / "arm.urdf.xacro").write_text(
        '<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro"><xacro:arg name="mass" default="1"/>'
        '<link name="base"/><link name="tip"><inertial><mass value="$(arg mass)"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>'
        '<joint name="wrist" type="fixed"><parent link="base"/><child link="tip"/></joint></robot>'
    )
    cell.write_text(CELL.replace("arm.robot.yaml", "arm.urdf.xacro").replace("with: {size", "with: {mass"))
    runs: list[object] = []
    expand = xacro.expand_xacro
    monkeypatch.setattr(xacro, "expand_xacro", lambda *given: (runs.append(given), expand(*given))[1])
    three = robots(plan(cell, "height=1,2,3"))
    assert [robot.link("placed_tip").mass for robot in three] == [0.3, 0.3, 0.3]
    assert [robot.link("sized_tip").mass for robot in three] == [1, 2, 3]
    assert len(runs) == 4
    assert_as_alone(plan(cell, "height=1,2"))


def test_the_modules_of_an_example_are_made_once():
    spec = ROOT / "examples/09_mobile_manipulator/mobile_manipulator.robot.yaml"
    assert_as_alone(plan(spec, "torso_height=0.5 m,0.6 m", "hardware=mock,gazebo"))
    first, second = robots(plan(spec, "torso_height=0.5 m,0.6 m"))
    shared = {link.name for link in second.links if link.inertial and first.link(link.name).inertial is link.inertial}
    assert {"base_link", "left_upper_arm_link", "right_gripper_palm"} <= shared
    assert "torso" not in shared


N = "linkforge: 1\nname: cell\nparameters: {n: {default: 1}}\n"
TABLE = "links: {table: {visual: {box: [1, 1, 1]}, inertial: {mass: 1 kg}}}\n"
MIDDLE = """\
linkforge: 1
name: middle
parameters: {size: {default: 0.1}, height: {default: 0.1}}
links: {plate: {visual: {box: [0.1, 0.1, $(height)]}, inertial: {mass: 1 kg}}}
modules: {arm: {use: arm.robot.yaml, parent: plate, with: {size: $(size)}}}
"""
ARM_USE, XACRO_USE = (
    "arm.robot.yaml, parent: plate, with: {size: $(size)}",
    "arm.xacro, parent: plate, origin: [0, 0, $(height)]",
)
MACRO = """\
<robot name="arm" xmlns:xacro="http://wiki.ros.org/xacro">
  <xacro:macro name="arm" params="prefix parent *origin">
    <link name="${prefix}base"/>
    <joint name="${prefix}at" type="fixed">
      <xacro:insert_block name="origin"/><parent link="${parent}"/><child link="${prefix}base"/>
    </joint>
  </xacro:macro>
</robot>
"""
CASES = {
    "copies of one name": "arm_$(i % 2): {for: {i: [1, 3]}, when: $(i == n), ARM, with: {size: $(i * 1)}}",
    "copies around one name": "c$(i)$(j): {for: {i: [1, 11], j: [2, 12]}, prefix: c$(i)_$(j)_, joint: c$(i)_$(j)_j, "
    "MIDDLE, with: {size: $(i * 1), height: $(n * 1)}}",
    "a computed argument": "a: {MIDDLE, with: {$('si' + 'ze'): $(n * 1)}}",
    "an override that adds a macro": "a: {OUTER, with: {height: $(n * 1)}, override: {modules: {arm: {macro: arm}}}}",
    "an error that another part reported": "z: {ARM}\na: {when: $(n > 1), ARM, with: {size: $(bad)}}\n"
    "b: {ARM, with: {size: $(bad)}}",
    "a warning that another part reported": "z: {ARM}\na: {ARM, origin: [$(wide if n > 1 else 0), 0, 0]}\n"
    "b: {ARM, with: {size: $(wide)}}",
    "other files before it": "a: {when: $(n > 1), MIDDLE}\nb: {ARM}",
}
"""Modules, of which copies of a `for` may have one name, and of which the first has other faults than the second."""


@pytest.mark.parametrize("modules", CASES.values(), ids=CASES)
def test_cached_modules_are_those_of_the_robot_alone(cell: Path, modules: str):
    cell.with_name("arm.robot.yaml").write_text(ARM.replace("type: length, default: 0.5 m", "default: 0.5"))
    cell.with_name("middle.robot.yaml").write_text(MIDDLE)
    cell.with_name("outer.robot.yaml").write_text(
        MIDDLE.replace("name: middle", "name: outer").replace(ARM_USE, XACRO_USE)
    )
    cell.with_name("arm.xacro").write_text(MACRO)
    for name in ("arm", "middle", "outer"):
        modules = modules.replace(name.upper(), f"use: {name}.robot.yaml, parent: table")
    bad = "variables: {bad: $(1 / 0), wide: $(2 + cos(90))}\n" if "(bad" in modules or "(wide" in modules else ""
    section = "\n".join(f"  {line}" for line in modules.splitlines())
    cell.write_text(f"{N}{bad}{TABLE}modules:\n{section}\n")
    assert_as_alone(plan(cell, "n=2,1,3,1"))


def test_a_constant_of_the_command_line_has_one_warning_in_each_robot(cell: Path):
    cell.with_name("arm.robot.yaml").write_text(ARM.replace("size: {", "other: {default: 1}, size: {"))
    modules = "  b: {ARM, with: {size: $(size)}}\n  c: {ARM, with: {size: $(size), other: $(n)}}\n"
    modules = modules.replace("ARM", "use: arm.robot.yaml, parent: table")
    size = "parameters: {n: {default: 1}, size: {type: length, default: 1 m}}"
    cell.write_text(f"linkforge: 1\nname: cell\n{size}\n{TABLE}modules:\n{modules}")
    request = Request(str(cell), "robot", ("size=5000 m",), formats=("urdf",))
    assert_as_alone(plan_of(request, Choice(("n=1,2",))))


@pytest.mark.parametrize("values", ["../outside/block.stl,inside.stl", "inside.stl,../outside/block.stl"])
def test_a_file_that_one_point_names_may_be_read_at_that_point_alone(
    tmp_path: Path, values: str, monkeypatch: pytest.MonkeyPatch
):
    for folder in ("robot/.git", "outside"):
        (tmp_path / folder).mkdir(parents=True)
    for path in ("outside/block.stl", "robot/inside.stl"):
        (tmp_path / path).write_bytes(content(block(0.1, 0.1, 0.1), "stl"))
    monkeypatch.chdir(tmp_path / "robot")  # where the values start
    mesh = "{visual: {mesh: ../outside/block.stl}, inertial: {mass: 1 kg}}"
    (tmp_path / "robot/arm.robot.yaml").write_text(f"linkforge: 1\nname: arm\nlinks: {{base: {mesh}}}\n")
    spec = tmp_path / "robot/cell.robot.yaml"
    file = "parameters: {f: {type: file, default: inside.stl}}\nlinks: {table: {visual: {mesh: $(f)}}}\n"
    spec.write_text(f"linkforge: 1\nname: cell\n{file}modules: {{a: {{use: arm.robot.yaml, parent: table}}}}\n")
    both = plan(spec, f"f={values}")
    request, cache = both.request, both.request.new_cache()
    for point in (both.points[0], both.points[1]):
        may_read = point.values["f"].startswith("..")
        assert make(request, point, cache=cache).row["errors"] == (not may_read)
        assert make(request, point, cache=cache) == make(request, point)


def test_a_file_read_as_data_and_as_a_spec_has_its_warnings_once(cell: Path):
    cell.with_name("arm.robot.yaml").write_text(ARM.replace("$(size)", "5000"))
    cell.with_name("other.yaml").write_text("a: 1\n")
    read = "data: {d: other.yaml, e: \"$('arm.robot.yaml' if k else 'other.yaml')\"}"
    cell.with_name("reads.robot.yaml").write_text(
        f"linkforge: 1\nname: reads\nparameters: {{k: true}}\n{read}\nlinks: {{base: }}\n"
    )
    modules = "p: {READS, with: {k: $(n == 1)}}\n  q: {when: $(n != 1), ARM}\n  m: {ARM}\n"
    for name in ("arm", "reads"):
        modules = modules.replace(name.upper(), f"use: {name}.robot.yaml, parent: table")
    cell.write_text(f"{N}{TABLE}modules:\n  {modules}")
    assert_as_alone(plan(cell, "n=1,2,1"))


def test_a_mesh_that_two_parts_use_is_a_file_of_each_robot(cell: Path):
    (cell.parent / "block.stl").write_bytes(content(block(0.1, 0.1, 0.1), "stl"))
    link = "{visual: {mesh: block.stl}, inertial: {mass: 1 kg}}"
    cell.with_name("arm.robot.yaml").write_text(f"linkforge: 1\nname: arm\nlinks: {{base: {link}}}\n")
    own = link.replace("{visual", "{when: $(n > 1), visual")
    joint = "joints: {own_joint: {when: $(n > 1), type: fixed, parent: a_base, child: own}}"
    cell.write_text(f"{N}links: {{own: {own}}}\n{joint}\nmodules: {{a: {{use: arm.robot.yaml}}}}\n")
    assert_as_alone(plan(cell, "n=2,1"))


def varied(text: str, *names: str) -> dict[str, frozenset[str] | None]:
    tree = read(SourceFile("robot.yaml", text), Diagnostics(), Budget())
    assert isinstance(tree, YamlMap)
    return varied_in_modules(tree, frozenset(names))


@pytest.mark.parametrize(
    ("module", "found"),
    [
        ("{use: a.yaml}", frozenset()),
        ("{use: a.yaml, origin: [0, 0, $(n)], parent: $(n), when: $(n > 1), joint: {name: $(n)}}", frozenset()),
        ("{use: a.yaml, with: {x: $(n), y: $(m), z: 1}}", frozenset({"x"})),
        ("{use: a.yaml, with: {x: {deep: [1, $(n)]}}}", frozenset({"x"})),
        ("{use: a.yaml, with: {x: $(twice), y: $(fixed), z: $(name)}}", frozenset({"x"})),
        ("{use: a.yaml, for: {i: $(n)}, with: {x: $(i)}}", None),
        ("{use: a.yaml, for: {i: 3}, with: {x: $(i)}}", frozenset()),
        ("{use: $(n)}", None),
        ("{use: a.yaml, prefix: $(n)}", None),
        ("{use: a.yaml, override: {links: {base: {inertial: {mass: $(twice)}}}}}", None),
        ("{use: a.yaml, with: $(n)}", None),
        ("{use: a.yaml, with: {$(n): 1}}", None),
        ("{use: a.yaml, with: {$(m): $(n)}}", None),
        ("{use: a.yaml, with: {$(m): 1}}", frozenset()),
        ("{use: a.xacro, macro: arm, origin: [0, 0, $(n)]}", None),
        ("{use: a.xacro, macro: arm, when: $(n > 1)}", frozenset()),
        ("$(n)", None),
        ("{use: a.yaml, with: {x: $(1 +)}}", frozenset()),
    ],
)
def test_what_may_vary_in_a_module(module: str, found: frozenset[str] | None):
    names = "{n: {default: 1}, m: {default: 2}}"
    variables = "{twice: $(fourfold / 2), fourfold: $(4 * n), fixed: $(m)}"
    text = f"name: robot\nparameters: {names}\nvariables: {variables}\nmodules:\n  one: {module}\n"
    assert varied(text, "n") == {"one": found}


def test_a_name_or_a_variant_carries_what_varies():
    use = "modules: {one: {use: a.yaml, with: {x: $(name)}}, two: {use: a.yaml, with: {x: $(m)}}}\n"
    text = f"name: $(n)\nparameters: {{n: 1, m: 2}}\nvariants: {{big: {{m: $(n)}}}}\n{use}"
    assert varied(text, "n") == {"one": frozenset({"x"}), "two": frozenset({"x"})}


def test_a_varied_package_folder_may_change_every_module():
    text = "name: a\nparameters: {n: 1}\npackages: {vendor: $(n)}\nmodules: {one: {use: 'package://vendor/a.yaml'}}\n"
    assert varied(text, "n") == {"one": None}
