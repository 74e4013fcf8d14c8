"""`linkforge graph`: pydot reads the graph of Graphviz, and lxml the picture."""

import warnings
from pathlib import Path

import pydot
import pytest
from lxml import etree

from linkforge_compile.cli.main import main
from linkforge_compile.core import Joint, JointMimic, JointType, Link, Robot, Vector3
from linkforge_compile.overview.dot import render_dot
from linkforge_compile.overview.graph import order_by_module
from linkforge_compile.overview.mermaid import render_mermaid
from linkforge_compile.overview.svg import render_svg
from linkforge_compile.overview.tree import tree_rows
from tests.cli.in_process import linkforge

SPECS = {
    "tool.robot.yaml": """\
linkforge: 1
name: tool
links: {palm: {}, finger: {}}
joints: {grip: {type: fixed, parent: palm, child: finger}}
""",
    "arm.robot.yaml": """\
linkforge: 1
name: arm
modules: {tool: {use: tool.robot.yaml, prefix: "", parent: wrist, joint: {name: tool_mount}}}
links: {shoulder: {}, wrist: {}, elbow_cover: {}}
joints:
  lift: {type: revolute, parent: shoulder, child: wrist, axis: -y, limits: {lower: 0, upper: 1, effort: 1, velocity: 1}}
  cover: {type: fixed, parent: shoulder, child: elbow_cover}
""",
    "cell.robot.yaml": """\
linkforge: 1
name: cell
modules:
  left: {use: arm.robot.yaml, parent: table, prefix: l_}
links: {table: {}, camera: {}, flash: {}}
joints:
  camera_mount: {type: fixed, parent: l_wrist, child: camera}
  flash_mount: {type: fixed, parent: l_elbow_cover, child: flash}
""",
}
ORDER = ["table", "l_shoulder", "l_wrist", "l_palm", "l_finger", "camera", "l_elbow_cover", "flash"]


@pytest.fixture
def cell(tmp_path: Path) -> Path:
    for name, text in SPECS.items():
        (tmp_path / name).write_text(text)
    return tmp_path


def read_dot(text: str) -> pydot.Dot:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # pydot calls a name of pyparsing that is deprecated
        (graph,) = pydot.graph_from_dot_data(text)
    return graph


def test_graphviz_has_modules_as_clusters_and_joints_as_edges(cell: Path):
    run = linkforge("graph", "cell.robot.yaml", "--format", "dot", cwd=cell)
    assert run.returncode == 0, run.stderr
    graph = read_dot(run.stdout)

    def inside(of: pydot.Graph) -> dict[str, object]:
        names = {node.get_name().strip('"') for node in of.get_nodes()} - {"node", "edge"}
        return {"links": names, **{one.get_label().strip('"'): inside(one) for one in of.get_subgraphs()}}

    assert inside(graph) == {
        "links": {"table", "camera", "flash"},
        "left": {
            "links": {"l_shoulder", "l_wrist", "l_elbow_cover"},
            "tool": {"links": {"l_palm", "l_finger"}},
        },
    }
    edges = {(edge.get_source(), edge.get_destination()): edge.get_label() for edge in graph.get_edges()}
    assert edges['"l_shoulder"', '"l_wrist"'] == r'"l_lift\nrevolute -y"'
    assert len(edges) == 7


def test_the_picture_has_each_link_in_the_boxes_of_its_modules(cell: Path):
    run = linkforge("graph", "cell.robot.yaml", "-o", "cell.svg", cwd=cell)
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "wrote cell.svg\n")
    boxes, links = shapes(etree.fromstring((cell / "cell.svg").read_bytes()))
    around = {name: [box for box, place in boxes if holds(place, link)] for name, link in links.items()}
    assert list(around) == ORDER
    assert around == {
        "table": [],
        "l_shoulder": ["left"],
        "l_wrist": ["left"],
        "l_palm": ["left", "tool"],
        "l_finger": ["left", "tool"],
        "camera": [],
        "l_elbow_cover": ["left (continued)"],
        "flash": [],
    }
    places = [place for _, place in boxes]
    for one in places:
        for other in places:
            assert holds(one, other) or holds(other, one) or not overlaps(one, other)


Rectangle = tuple[float, float, float, float]


def shapes(picture: etree._Element) -> tuple[list[tuple[str, Rectangle]], dict[str, Rectangle]]:
    """Return the boxes and the links of a picture by name, which is the text after each rectangle."""
    assert picture.tag == "{http://www.w3.org/2000/svg}svg"
    found = [
        (one.getnext().text, one.get("class"), tuple(float(one.get(key)) for key in ("x", "y", "width", "height")))
        for one in picture.iter("{*}rect")
    ]
    width, height = (float(picture.get(key)) for key in ("width", "height"))
    assert all(holds((0, 0, width, height), place) for _, _, place in found)
    boxes = [(name, place) for name, kind, place in found if kind == "module"]
    return boxes, {name: place for name, kind, place in found if kind != "module"}


def holds(outer: Rectangle, inner: Rectangle) -> bool:
    x, y, width, height = outer
    return x <= inner[0] and y <= inner[1] and inner[0] + inner[2] <= x + width and inner[1] + inner[3] <= y + height


def overlaps(one: Rectangle, other: Rectangle) -> bool:
    return not (one[1] + one[3] <= other[1] or other[1] + other[3] <= one[1])


def test_branches_to_other_modules_come_last_so_that_a_module_stays_together(cell: Path):
    cell_text = SPECS["cell.robot.yaml"].replace("parent: l_elbow_cover", "parent: camera")
    (cell / "cell.robot.yaml").write_text(cell_text)
    assert main(["graph", str(cell / "cell.robot.yaml"), "-o", str(cell / "cell.svg"), "-q"]) == 0
    boxes, links = shapes(etree.parse(cell / "cell.svg").getroot())
    assert [name for name, _ in boxes] == ["left", "tool"]
    assert list(links) == ["table", "l_shoulder", "l_elbow_cover", "l_wrist", "l_palm", "l_finger", "camera", "flash"]


def test_mermaid_has_modules_as_subgraphs(cell: Path):
    run = linkforge("graph", "cell.robot.yaml", "--format", "mermaid", cwd=cell)
    assert run.stdout == MERMAID


MERMAID = """\
---
title: "cell"
---
flowchart LR
  n0["table"]
  n5["camera"]
  n7["flash"]
  subgraph m1["left"]
    n1["l_shoulder"]
    n2["l_wrist"]
    n6["l_elbow_cover"]
    subgraph m2["tool"]
      n3["l_palm"]
      n4["l_finger"]
    end
  end
  n0 -.->|"left_joint<br/>fixed"| n1
  n1 -->|"l_lift<br/>revolute -y"| n2
  n2 -.->|"l_tool_mount<br/>fixed"| n3
  n3 -.->|"l_grip<br/>fixed"| n4
  n2 -.->|"camera_mount<br/>fixed"| n5
  n1 -.->|"l_cover<br/>fixed"| n6
  n6 -.->|"flash_mount<br/>fixed"| n7
"""

NAMES = ["end", "graph", "é/臂", "a.b-c", "1.", "class"]


def hostile_robot() -> Robot:
    robot = Robot(name="r", links=map(Link, NAMES))
    joints = [Joint(f"j{number}", JointType.FIXED, NAMES[0], name) for number, name in enumerate(NAMES[1:])]
    loop = Joint("loop", JointType.FIXED, NAMES[1], NAMES[0])
    robot.add_parts(joints=[*joints, loop])
    return robot


def test_words_of_the_languages_and_loops_are_drawn():
    rows = order_by_module(tree_rows(hostile_robot()))
    graph = read_dot(render_dot('a "b" \\ {c}', rows))
    assert {node.get_name().strip('"') for node in graph.get_nodes()} == {"node", "edge", *NAMES}
    assert graph.get_name() == r'"a \"b\" \\ {c}"'
    assert len(graph.get_edges()) == 6
    picture = etree.fromstring(render_svg('<a> & "b"', rows).encode())
    assert picture.findtext("{*}title") == '<a> & "b"'
    assert [link for link in shapes(picture)[1] if "again" in link] == ["end (again)"]
    text = render_mermaid('a "b"', rows)
    assert 'title: "a #34;b#34;"' in text
    assert 'n2["é/臂"]' in text
    assert "n1 -.->" in text


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        ([], "takes -o with a file that ends in .svg, .dot or .mmd, or --format"),
        (["-o", "cell.png"], "or --format, found 'cell.png'"),
        (["-o", "cell.robot.yaml", "--format", "dot"], "'cell.robot.yaml' would be replaced"),
    ],
)
def test_wrong_usage_writes_nothing(cell: Path, words: list[str], reason: str):
    before = sorted(cell.iterdir())
    run = linkforge("graph", "cell.robot.yaml", *words, cwd=cell)
    assert (run.returncode, run.stdout, sorted(cell.iterdir())) == (2, "", before)
    assert reason in run.stderr


def test_a_spec_with_errors_has_no_graph(cell: Path):
    (cell / "cell.robot.yaml").write_text(SPECS["cell.robot.yaml"].replace("parent: l_wrist", "parent: l_wrst"))
    run = linkforge("graph", "cell.robot.yaml", "-o", "cell.svg", cwd=cell)
    assert (run.returncode, run.stdout, (cell / "cell.svg").exists()) == (1, "", False)
    assert "[LF4102]" in run.stderr


def test_a_joint_that_follows_another_one_is_marked():
    robot = Robot(name="r", links=[Link(name) for name in "abc"])
    axis = Vector3(0, 0, 1)
    robot.add_parts(
        joints=[
            Joint("lead", JointType.CONTINUOUS, "a", "b", axis=axis),
            Joint("echo", JointType.CONTINUOUS, "a", "c", axis=axis, mimic=JointMimic("lead", 0.5)),
        ]
    )
    rows = tree_rows(robot)
    assert r'"a" -> "c" [label="echo\ncontinuous z, follows lead * 0.5"]' in render_dot("r", rows)
    assert "follows lead #42; 0.5" in render_mermaid("r", rows)
    circles = etree.fromstring(render_svg("r", rows).encode()).findall("{*}circle")
    assert [circle.get("class") for circle in circles] == ["joint moving", "joint following"]
