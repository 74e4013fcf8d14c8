"""What no prefix reaches is told where a file is used under one, and nowhere else."""

from tests.lowering.specs import Spec, robot_of

GRIPPER = """
    name: gripper
    links: {palm: , finger: }
    joints: {slide: {type: fixed, parent: palm, child: finger}}
    sensors:
      touch:
        type: camera
        link: finger
        topic: /touch   #topic
        plugin: {name: p, filename: p.so, parameters: {a: {frame: [other, finger]}}}   #name
"""
TOLD = {
    "#topic": "# W[LF5705]:12 '/touch' is an absolute topic and takes no prefix, so every use of this file publishes "
    "there",
    "#name": "# W[LF5704]:71 'finger' is a link of this file and takes the prefix, but not here; "
    "write '$(link('finger'))'",
}
CELL = "name: cell\nlinks: {table: , finger: }\njoints: {j: {type: fixed, parent: table, child: finger}}\n"


def used(inner: Spec, **fields: str) -> Spec:
    said = ", ".join(f"{key}: {value}" for key, value in {"parent": "table", **fields}.items())
    return Spec(f"{CELL}modules: {{left: {{{said}}}}}\n", {"left": inner})


def told_gripper() -> Spec:
    text = GRIPPER
    for sign, expectation in TOLD.items():
        text = text.replace(sign, expectation)
    return Spec(text)


def test_names_in_plugins_and_absolute_topics_are_told_under_a_prefix():
    robot_of(used(told_gripper()))


def test_nothing_is_told_of_the_compiled_file():
    robot_of(GRIPPER)


def test_nothing_is_told_where_names_stay():
    spec = used(Spec(GRIPPER), prefix='""')
    spec.text = spec.text.replace("finger", "thumb")
    robot_of(spec)


def test_a_prefix_further_out_counts_as_well():
    arm = Spec(
        "name: arm\nlinks: {flange: }\nmodules: {hand: {parent: flange, prefix: ''}}\n", {"hand": told_gripper()}
    )
    robot_of(used(arm))


def test_names_of_the_files_around_are_no_names_of_the_file():
    eye = Spec("""
        name: eye
        links: {lens: }
        gazebo: {plugins: {see: {filename: see.so, parameters: {frame: flange}}}}
    """)
    arm = Spec("name: arm\nlinks: {flange: }\nmodules: {eye: {parent: flange}}\n", {"eye": eye})
    robot_of(used(arm))
