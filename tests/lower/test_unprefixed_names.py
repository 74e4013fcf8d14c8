"""Names that get no prefix are reported if a file is used with one, and only then."""

import time

import pytest

from tests.lower.specs import Spec, robot_of

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
    "#topic": "# W[LF5705]:12 '/touch' is an absolute topic and gets no prefix, so every use of this file publishes "
    "there",
    "#name": "# W[LF5704]:71 'finger' is a link of this file and gets the prefix, but not here; "
    "write '$(link('finger'))'",
}
CELL = "name: cell\nlinks: {table: , finger: }\njoints: {j: {type: fixed, parent: table, child: finger}}\n"


def used(inner: Spec, **fields: str) -> Spec:
    entry = ", ".join(f"{key}: {value}" for key, value in {"parent": "table", **fields}.items())
    return Spec(f"{CELL}modules: {{left: {{{entry}}}}}\n", {"left": inner})


def reported_gripper() -> Spec:
    text = GRIPPER
    for sign, expectation in TOLD.items():
        text = text.replace(sign, expectation)
    return Spec(text)


def test_names_in_plugins_and_absolute_topics_are_reported_under_a_prefix():
    robot_of(used(reported_gripper()))


def test_nothing_is_reported_for_the_compiled_file():
    robot_of(GRIPPER)


def test_nothing_is_reported_if_names_do_not_change():
    spec = used(Spec(GRIPPER), prefix='""')
    spec.text = spec.text.replace("finger", "thumb")
    robot_of(spec)


def test_a_prefix_further_out_counts_as_well():
    arm = Spec(
        "name: arm\nlinks: {flange: }\nmodules: {hand: {parent: flange, prefix: ''}}\n", {"hand": reported_gripper()}
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


def test_names_anywhere_in_raw_xml_are_reported():
    unnamed = "name: lamp\nlinks: {bulb: , stand: }\njoints: {j: {type: fixed, parent: stand, child: bulb}}\nextra: "
    entry = "  # W[LF5704]:8 'bulb' is a link of this file and gets the prefix, but not here; write '$(link('bulb'))'"
    for raw in ("<a b = 'bulb'/>", '<a x="1"y="bulb"/>', "<a> bulb </a>", "<a.b:c-d>bulb", '<a x=">" b="bulb"/>'):
        robot_of(used(Spec(f"{unnamed}{raw}{entry}\n")))
    for raw in (
        "bulb>",
        "a b='bulb'>",
        '<visual name="bulb"/>',
        "<!-- bulb -->",
        "<!-- <a b='bulb'/> -->",
        "<a b='bulb'",
        "</bulb>",
    ):
        robot_of(used(Spec(f"{unnamed}{raw}\n")))


@pytest.mark.parametrize(
    "text", ["bulb,shade", "bulb, other", "[bulb]", "['bulb', 'other']", "bulb stand", "[bulb stand]"]
)
def test_each_name_in_a_list_is_reported(text: str):
    entry = " ## ".join(
        f"W[LF5704]:8 '{name}' is a link of this file and gets the prefix, but not here; write '$(link('{name}'))'"
        for name in ("bulb", "stand")
        if name in text
    )
    unnamed = "name: lamp\nlinks: {bulb: , stand: }\njoints: {j: {type: fixed, parent: stand, child: bulb}}\nextra: "
    robot_of(used(Spec(f"{unnamed}<a>{text}</a>  # {entry}\n")))


@pytest.mark.parametrize("text", ["the bulb", "turn, the bulb", "bulb-stand", "bulb stand lamp", "bulb/a,b"])
def test_names_in_prose_are_none(text: str):
    unnamed = "name: lamp\nlinks: {bulb: , stand: }\njoints: {j: {type: fixed, parent: stand, child: bulb}}\nextra: "
    robot_of(used(Spec(f"{unnamed}<a>{text}</a>\n")))


@pytest.mark.parametrize(
    "raw",
    [
        "<" + "a" * 100_000,
        "<a " + "b" * 100_000 + ">",
        "<a b" + " " * 100_000 + ">",
        "<a " + "'" * 99_999,
        "<a ' " * 20_000,
    ],
)
def test_what_is_no_xml_is_read_in_time_that_grows_with_its_length(raw: str):
    spec = used(Spec(f'name: lamp\nlinks: {{bulb: }}\nextra: "{raw}"\n'))
    started = time.process_time()
    robot_of(spec)
    assert time.process_time() - started < 2
