"""Hostile files, each checked by a process of its own with 512 MB and ten seconds: an answer, and no more than one."""

import os
import re
from collections.abc import Callable
from pathlib import Path

import pytest

pytest.importorskip("resource", reason="the limits are those of POSIX")

from tests.limited import run

HEAD = "linkforge: 1\nname: r\nlinks:\n  base:\n"
LINK = "linkforge: 1\nname: r\nlinks:\n  base: "
PART = "linkforge: 1\nname: part\nlinks: {base: , tip: }\njoints: {wrist: {type: fixed, parent: base, child: tip}}\n"
Make = Callable[[Path], str | bytes]
"""Writes the other files that a spec needs, and returns the spec."""


def write(folder: Path, name: str, text: str | bytes) -> None:
    (folder / name).write_bytes(text if isinstance(text, bytes) else text.encode())


def refused(make: Make, code: str, folder: Path) -> str:
    write(folder, "a.robot.yaml", make(folder))
    done = run("check", "a.robot.yaml", folder=folder)
    assert done.returncode == 1, (done.returncode, done.stderr[-2000:])
    assert f"[{code}]" in done.stderr
    assert "Traceback" not in done.stderr
    assert done.stderr.count("\n") < 800
    return done.stderr


def laughs(key: str = "x-") -> str:
    lines = [f"{key}{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]\n" for i in range(1, 10)]
    return f"{key}0: &a0 [lol]\n" + "".join(lines)


def doubled(first: str, again: str, times: int) -> str:
    steps = "".join(f"  v{i}: {again.format(f'$(v{i - 1})')}\n" for i in range(1, times))
    return f"variables:\n  v0: {first}\n{steps}"


SPECS: dict[str, tuple[str, str | bytes]] = {
    "aliases of aliases": ("LF3301", HEAD + laughs()),
    "flow lists in flow lists": ("LF1107", HEAD + "x-a: " + "[" * 1_000_000),
    "flow maps in flow maps": ("LF1107", HEAD + "x-a: " + "{a: " * 1_000_000),
    "lists in lists": ("LF1107", HEAD + "x-a:\n" + "- " * 1_000_000),
    "maps in maps": ("LF1107", HEAD + "x-a:\n" + "".join(" " * i + "a:\n" for i in range(1, 2000))),
    "a list of millions": ("LF3301", HEAD + "x-a: [" + "[]," * 5_000_000 + "]\n"),
    "millions of links": ("LF3301", HEAD + "".join(f"  l{i}:\n" for i in range(1_000_000))),
    "what is refused among many errors": (
        "LF5006",
        HEAD
        + "".join(f"  l{i}: {{inertial: {{mass: -1, density: 2}}}}\n" for i in range(300))
        + "transmissions:\n  t$(i): {for: {i: 5000}, type: a/B, joints: {j: {mechanical_reduction: 0}}}\n",
    ),
    "a million unknown keys": ("LF2101", HEAD + "".join(f"    q{i}: 1\n" for i in range(100_000))),
    "the same key for ever": ("LF3302", HEAD + "x-q: 1\n" * 200_000),
    "lists of an alias behind a long text": (
        "LF2101",
        f"{HEAD}nosuch: 1\nmetadata:\n  a:\n  - &b 1\n  - |\n" + f"    {'x' * 400}\n" * 12_000 + "  - - *b\n" * 12_000,
    ),
    "a text of many expressions behind a long one": (
        "LF3101",
        f"{HEAD}description: |\n" + f"  {'x' * 400}\n" * 10_000 + "  $(+)\n" * 4_000,
    ),
    "a huge product": ("LF3301", HEAD + "  l_$(a)_$(b)_$(c): {for: {a: 1000, b: 1000, c: 1000}}\n"),
    "a huge for": ("LF3301", HEAD + "  l_$(a): {for: {a: 1000000000000}}\n"),
    "more links than there may be": ("LF3301", HEAD + "  l_$(a): {for: {a: 40000}}\n"),
    "for over what is not there": ("LF3301", HEAD + "  l_$(a): {for: {a: 100000}, when: false}\n"),
    "powers": ("LF3127", HEAD + "metadata: {a: $(10**10**10), b: $(9**9**9), c: $(10**308*10**308)}\n"),
    "text times a number": ("LF3121", HEAD + "metadata: {a: \"$('a' * 10**9)\"}\n"),
    "text by a format": ("LF3121", HEAD + "metadata: {a: \"$('%1000000000d' % 3)\"}\n"),
    "a method": ("LF3106", HEAD + "metadata: {a: \"$('x'.join('y'))\"}\n"),
    "a long number": ("LF1112", HEAD + "x-a: " + "9" * 5_000_000),
    "a number with a unit that is beyond a double": ("LF5004", LINK + f"{{inertial: {{mass: {'9' * 320} kg}}}}"),
    "text that doubles": ("LF3128", HEAD + doubled("abcdefgh", "{0}{0}", 60) + "metadata: {a: $(v59)}\n"),
    "lists that double": ("LF3301", HEAD + doubled("[1, 2]", "[{0}, {0}]", 60) + "metadata: {a: $(v59)}\n"),
    "many long texts": (
        "LF3301",
        HEAD
        + doubled("abcdefgh", "{0}{0}", 13)
        + "".join(f"  w{i}: $(v12)x{i}\n" for i in range(5000))
        + f"  all: [{', '.join(f'$(w{i})' for i in range(5000))}]\nmetadata: {{a: $(len(all))}}\n",
    ),
    "a long list looked through often": (
        "LF3301",
        f"variables: {{big: [{', '.join(map(str, range(50_000)))}]}}\n"
        + HEAD
        + "  l_$(a): {for: {a: 40000}, when: $(a in big and -1 in big or max(big) < 0)}\n",
    ),
    "a long expression": ("LF3105", HEAD + "metadata: {a: $(" + "(" * 100_000 + "1" + ")" * 100_000 + ")}\n"),
    "a pattern that tries for ever": (
        "LF3027",
        HEAD + "parameters: {p: {type: string, pattern: '^(a+)+$', default: " + "a" * 900 + "b}}\n",
    ),
    "a pattern that counts far": ("LF3032", HEAD + "parameters: {p: {type: string, pattern: '((a{99}){99}){99}'}}\n"),
    "many patterns": (
        "LF3301",
        HEAD
        + "parameters:\n"
        + "".join(f"  p{i}: {{type: string, pattern: '(a?){{480}}z|{i}', default: {'a' * 999}}}\n" for i in range(99)),
    ),
    "names that are like one another": (
        "LF4102",
        HEAD
        + "".join(f"  {'ab' * 40}{i}:\n" for i in range(500))
        + "joints:\n"
        + "".join(f"  j{i}: {{type: fixed, parent: {'ab' * 40}x{i}, child: {'ab' * 40}y{i}}}\n" for i in range(40)),
    ),
    "collision pairs without end": (
        "LF3301",
        f"{HEAD}semantic:\n  disabled_collisions:\n"
        + "".join(f"    l{i}: {{{', '.join(f'l{k}: Never' for k in range(i))}}}\n" for i in range(1, 500)),
    ),
    "one line of 15 MB": ("LF2201", "linkforge: 1\nname: r\nlinks: " + "x" * 15_000_000),
    "no UTF-8": ("LF3002", b"linkforge: 1\nname: \xff\xfe\n"),
    "UTF-16": ("LF3002", HEAD.encode("utf-16")),
    "a NUL": ("LF1019", HEAD + "x-a: a\0b\n"),
    "NULs": ("LF1019", "\0" * 10_000_000),
    "a module of itself": ("LF3012", HEAD + "modules: {a: {use: a.robot.yaml, parent: base}}\n"),
    "an include of itself": ("LF3063", HEAD + "include: [a.robot.yaml]\n"),
    "data that names itself": ("LF3141", HEAD + "data: {d: $(e.x), e: $(d.x)}\n"),
    "a device as a module": ("LF3003", HEAD + "modules: {a: {use: /dev/zero, parent: base}}\n"),
    "a device as data": ("LF3401", HEAD + "data: {d: /dev/zero, e: /dev/stdin}\n"),
    "long paths": ("LF3002", HEAD + f"modules: {{a: {{use: {'a/' * 5000}b.yaml}}, b: {{use: {'a' * 10_000}.yaml}}}}\n"),
    "entities": (
        "LF7001",
        LINK + '{extra: \'<!DOCTYPE x [<!ENTITY a "lol"><!ENTITY b SYSTEM "file:///etc/passwd">]><x>&a;&b;</x>\'}',
    ),
    "deep raw XML": ("LF7001", LINK + "{extra: '" + "<a>" * 100_000 + "</a>" * 100_000 + "'}\n"),
    "wide raw XML": ("LF3301", LINK + "{extra: '" + "<a/>" * 3_000_000 + "'}\n"),
    "raw XML again and again": (
        "LF3301",
        HEAD + "  l$(i): {for: {i: 20000}, extra: '" + "<a/>" * 10_000 + "'}\n",
    ),
}


@pytest.mark.parametrize("name", SPECS)
def test_a_hostile_spec_is_refused_in_time(name: str, tmp_path: Path):
    code, text = SPECS[name]
    refused(lambda _: text, code, tmp_path)


def doubling_modules(folder: Path) -> str:
    for i in range(1, 40):
        entry = f"{{use: m{i + 1}.robot.yaml, parent: base}}"
        write(folder, f"m{i}.robot.yaml", PART + f"modules:\n  a: {entry}\n  b: {entry}\n")
    write(folder, "m40.robot.yaml", PART)
    return HEAD + "modules: {a: {use: m1.robot.yaml, parent: base}}\n"


def repeated_modules(folder: Path) -> str:
    for i in range(1, 10):
        entry = f"{{for: {{i: 100}}, use: m{i + 1}.robot.yaml, parent: base}}"
        write(folder, f"m{i}.robot.yaml", PART + f"modules:\n  a_$(i): {entry}\n")
    write(folder, "m10.robot.yaml", PART)
    return HEAD + "modules: {a: {use: m1.robot.yaml, parent: base}}\n"


def deep_modules(folder: Path) -> str:
    for i in range(60):
        write(folder, f"m{i}.robot.yaml", PART + f"modules: {{a: {{use: m{i + 1}.robot.yaml, parent: base}}}}\n")
    return HEAD + "modules: {a: {use: m0.robot.yaml, parent: base}}\n"


def a_large_module_often(folder: Path) -> str:
    links = "".join(f"  l{i}: {{visual: {{sphere: 1}}}}\n" for i in range(5000))
    write(folder, "m.robot.yaml", HEAD + links)
    return HEAD + "modules:\n  m$(i): {for: {i: 1000}, use: m.robot.yaml, parent: base}\n"


def long_modules(folder: Path) -> str:
    for i in range(5):
        write(folder, f"m{i}.robot.yaml", PART + "#" + "é" * 8_000_000)
    return HEAD + "modules:\n" + "".join(f"  i{i}: {{use: m{i}.robot.yaml, parent: base}}\n" for i in range(5))


def a_thousand_includes(folder: Path) -> str:
    for i in range(1000):
        write(folder, f"m{i}.yaml", f"linkforge: 1\nlinks: {{l{i}: }}\n")
    return HEAD + f"include: [{', '.join(f'm{i}.yaml' for i in range(1000))}]\n"


def modules_in_a_circle(folder: Path) -> str:
    write(folder, "b.robot.yaml", PART + "modules: {a: {use: a.robot.yaml, parent: base}}\n")
    return HEAD + "modules: {a: {use: b.robot.yaml, parent: base}}\n"


def a_circle_by_include(folder: Path) -> str:
    write(folder, "b.yaml", "linkforge: 1\nmodules: {a: {use: a.robot.yaml, parent: base}}\n")
    return HEAD + "include: [b.yaml]\n"


def a_hundred_megabytes(folder: Path) -> str:
    with (folder / "b.robot.yaml").open("wb") as file:
        file.truncate(100 * 1024**2)
    return HEAD + "modules: {a: {use: b.robot.yaml, parent: base}}\n"


def large_data(folder: Path) -> str:
    write(folder, "d.yaml", "[" + "0," * 4_000_000 + "]")
    return HEAD + "data: {d: d.yaml}\n"


def laughing_data(folder: Path) -> str:
    write(folder, "d.yaml", laughs("a"))
    return HEAD + "data: {d: d.yaml}\n"


def pipes(folder: Path) -> str:
    for name in ("f.robot.yaml", "g.yaml", "h.yaml", "package.xml"):
        os.mkfifo(folder / name)
    return HEAD + (
        "  l: {visual: {mesh: 'package://q/a.stl'}}\n"
        "modules: {a: {use: f.robot.yaml, parent: base}, b: {use: package://p/a.robot.yaml, parent: base}}\n"
        "include: [g.yaml]\ndata: {d: h.yaml}\n"
    )


def folders_and_devices(folder: Path) -> str:
    (folder / "f.robot.yaml").mkdir()
    (folder / "g.yaml").symlink_to("/dev/zero")
    return HEAD + "modules: {a: {use: f.robot.yaml, parent: base}}\ninclude: [g.yaml]\ndata: {d: f.robot.yaml}\n"


def many_unknown_overrides(folder: Path) -> str:
    write(folder, "m.robot.yaml", HEAD + "".join(f"  arm_l{i}:\n" for i in range(5_000)))
    names = "".join(f"        arm_{i}: {{inertial: {{mass: 1}}}}\n" for i in range(20_000))
    return HEAD + f"modules:\n  m:\n    use: m.robot.yaml\n    parent: base\n    override:\n      links:\n{names}"


FOLDERS: dict[str, list[Make]] = {
    "LF3301": [doubling_modules, repeated_modules, a_large_module_often, long_modules, large_data, laughing_data],
    "LF3013": [deep_modules],
    "LF3066": [a_thousand_includes],
    "LF3012": [modules_in_a_circle, a_circle_by_include],
    "LF3002": [a_hundred_megabytes, pipes, folders_and_devices],
    "LF3302": [many_unknown_overrides],
}


@pytest.mark.parametrize(
    ("code", "make"), [pytest.param(code, make, id=make.__name__) for code in FOLDERS for make in FOLDERS[code]]
)
def test_a_hostile_folder_is_refused_in_time(code: str, make: Make, tmp_path: Path):
    refused(make, code, tmp_path)


URDF = "<robot name='r'>"
URDFS: dict[str, tuple[str, str]] = {
    "entities": ("LF8002", '<!DOCTYPE x [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;">]><robot name="&b;"/>'),
    "an entity of another file": (
        "LF8002",
        '<!DOCTYPE x [<!ENTITY a SYSTEM "file:///etc/passwd">]><robot name="&a;"/>',
    ),
    "tags in tags": ("LF8003", URDF + "<a>" * 1_000_000),
    "millions of links": ("LF8098", URDF + "".join(f"<link name='l{i}'/>" for i in range(300_000)) + "</robot>"),
    "more links than there may be": (
        "LF3301",
        URDF + "".join(f"<link name='l{i}'/>" for i in range(31_000)) + "</robot>",
    ),
    "tags without end": ("LF8004", URDF + f"<gazebo>{'<a>' + '<b/>' * 90_000 + '</a>'}</gazebo>" * 3 + "</robot>"),
    "attributes without end": ("LF3301", URDF[:-1] + "".join(f" a{i}='1'" for i in range(100_000)) + "/>"),
    "the name of a codec that unpacks": ("LF3002", "<?xml version='1.0' encoding='zlib'?><robot/>"),
}


@pytest.mark.parametrize("name", URDFS)
def test_a_hostile_urdf_is_refused_in_time(name: str, tmp_path: Path):
    code, text = URDFS[name]
    write(tmp_path, "v.urdf", text)
    refused(lambda _: HEAD + "modules: {v: {use: v.urdf, parent: base}}\n", code, tmp_path)


def test_an_srdf_whose_groups_take_each_other_along_is_imported_in_time(tmp_path: Path):
    """The last of the groups is missing, so that none has a member: each reading of it finds one more."""
    write(tmp_path, "a.urdf", URDF + "<link name='a'/></robot>")
    groups = "".join(f"<group name='g{i}'><group name='g{i + 1}'/></group>" for i in range(2_000))
    write(tmp_path, "a.srdf", URDF + groups + "</robot>")
    done = run("import", "a.urdf", "--srdf", "a.srdf", folder=tmp_path)
    assert "Traceback" not in done.stderr
    assert done.returncode in (0, 1), (done.returncode, done.stderr[-500:])


MESHES: dict[str, tuple[str, str, bytes]] = {
    "a header of four billion triangles": ("f.stl", "LF6012", b"\0" * 80 + b"\xff" * 4),
    "a face of no corner": ("f.obj", "LF6012", b"v 0 0 0\nf 1 2 99999999999\n"),
    "entities": (
        "f.dae",
        "LF6012",
        b'<!DOCTYPE x [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;"><!ENTITY c SYSTEM "file:///etc/passwd">]>'
        b"<COLLADA>&b;&c;</COLLADA>",
    ),
    "tags in tags": ("f.dae", "LF6012", b"<COLLADA>" + b"<a>" * 1_000_000),
}


@pytest.mark.parametrize("name", MESHES)
def test_a_hostile_mesh_is_refused_in_time(name: str, tmp_path: Path):
    file, code, content = MESHES[name]
    write(tmp_path, file, content)
    refused(lambda _: f"{LINK}{{visual: {{mesh: {file}}}, collision: visual, inertial: {{mass: 1}}}}\n", code, tmp_path)


def test_a_hundred_megabytes_are_not_read(tmp_path: Path):
    with (tmp_path / "a.robot.yaml").open("wb") as file:
        file.truncate(100 * 1024**2)
    assert "[LF3002]" in run("check", "a.robot.yaml", folder=tmp_path).stderr


@pytest.mark.parametrize("spec", [".", "/dev/zero", "no.yaml", "a" * 10_000])
def test_what_is_no_file_is_refused(spec: str, tmp_path: Path):
    done = run("check", spec, folder=tmp_path)
    assert (done.returncode, done.stderr.count("error:")) == (1, 1)


@pytest.mark.parametrize("text", [HEAD.replace("\n", "\r\n"), HEAD.replace("\n", "\r"), "\ufeff" + HEAD])
def test_line_ends_and_byte_order_marks_are_no_fault(text: str, tmp_path: Path):
    write(tmp_path, "a.robot.yaml", text)
    assert run("check", "a.robot.yaml", folder=tmp_path).stderr == "checked 1 spec: no errors\n"


def test_a_thousand_modules_compile(tmp_path: Path):
    entries = "".join(f"  i{i}: {{use: m{i}.robot.yaml, parent: base}}\n" for i in range(1000))
    for i in range(1000):
        write(tmp_path, f"m{i}.robot.yaml", PART)
    write(tmp_path, "a.robot.yaml", HEAD + f"modules:\n{entries}")
    done = run("compile", "a.robot.yaml", "-o", "a.urdf", folder=tmp_path)
    assert done.returncode == 0, done.stderr[-2000:]
    assert (tmp_path / "a.urdf").read_text().count("<joint ") == 2000


def test_a_fault_in_every_round_of_a_for_is_reported_once_with_a_count(tmp_path: Path):
    messages = refused(lambda _: HEAD + "  l_$(i): {for: {i: 2000}, inertial: {mass: $(-i - 1)}}\n", "LF5006", tmp_path)
    assert "more like this at the same place" in messages
    assert messages.count("[LF5006]") == 3


def test_the_fault_of_25000_rounds_is_reported_with_the_number_of_others(tmp_path: Path):
    rounds = "{for: {i: 25000}, inertial: {mass: $(1 / (i - i))}, visual: {sphere: $(-i - 1)}}"
    messages = refused(lambda _: f"{HEAD}  l_$(i): {rounds}\n", "LF3125", tmp_path)
    assert re.findall(r"\[(LF\d+)\]", messages) == ["LF3125", "LF3302"]


def test_a_file_of_comments_that_ignore_is_read_in_time(tmp_path: Path):
    write(
        tmp_path,
        "a.robot.yaml",
        HEAD + "# linkforge: ignore\n" * 5_000 + "x-a: [\n" + "1, # linkforge: ignore\n" * 5_000 + "]\n",
    )
    done = run("check", "a.robot.yaml", folder=tmp_path)
    assert (done.returncode, done.stderr.count("[LF1201]"), done.stderr.count("[LF3303]")) == (0, 100, 1), done.stderr[
        -500:
    ]


def test_a_urdf_of_tags_of_their_own_is_imported_in_time(tmp_path: Path):
    tags = "".join(f"<a:t{i}>b</a:t{i}>" for i in range(15_000))
    write(tmp_path, "a.urdf", f"{URDF}<link name='a'/>{tags}<gazebo>{tags.replace('a:', '')}</gazebo></robot>")
    done = run("import", "a.urdf", folder=tmp_path)
    assert (done.returncode, done.stdout.count("t14999"), done.stderr) == (0, 3, "")


def test_a_urdf_of_comments_is_imported_in_time(tmp_path: Path):
    write(tmp_path, "a.urdf", "<robot name='r'><link name='a'/>" + "<!-- b -->\n" * 20_000 + "</robot>")
    done = run("import", "a.urdf", folder=tmp_path)
    assert (done.returncode, done.stdout.count("# b\n"), done.stderr) == (0, 20_000, "")


@pytest.mark.parametrize(
    ("mesh", "expected"), [("m$(i).stl", ["LF6021"] * 3 + ["LF5404"]), ("package://p$(i)/m.stl", ["LF3403", "LF5404"])]
)
def test_many_meshes_that_are_nowhere_are_looked_for_in_time(mesh: str, expected: list[str], tmp_path: Path):
    meshes = f"{{for: {{i: 6000}}, mesh: {mesh}}}"
    lines = refused(lambda _: f"{HEAD}  l: {{visual: [{meshes}], collision: visual}}\n", "LF5404", tmp_path)
    assert sorted(re.findall(r"\[(LF\d+)\]", lines)) == sorted(expected)


def test_many_groups_of_long_chains_are_checked_in_time(tmp_path: Path):
    links = "".join(f"  l{i}:\n" for i in range(1, 1000))
    joints = "".join(f"  j{i}: {{type: fixed, parent: l{i - 1}, child: l{i}}}\n" for i in range(2, 1000))
    groups = "".join(f"    g{i}: {{chains: [{{base_link: base, tip_link: l{i}}}]}}\n" for i in range(1, 1000))
    spec = (
        f"{HEAD}{links}joints:\n  j1: {{type: fixed, parent: base, child: l1}}\n{joints}semantic:\n  groups:\n{groups}"
    )
    write(tmp_path, "a.robot.yaml", spec)
    assert run("check", "a.robot.yaml", folder=tmp_path).stderr == "checked 1 spec: no errors\n"


def test_a_xacro_is_expanded_where_less_memory_is_allowed_than_its_own_limit(tmp_path: Path):
    pytest.importorskip("xacro")
    write(
        tmp_path,
        "a.urdf.xacro",
        '<robot name="r" xmlns:xacro="http://wiki.ros.org/xacro"><link name="a${1+1}"/></robot>',
    )
    done = run("compile", "a.urdf.xacro", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert '<link name="a2"/>' in done.stdout
