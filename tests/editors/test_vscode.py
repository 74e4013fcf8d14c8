"""The extension for VS Code: it is built and packed as its users get it, and agrees with the rest of the project."""

import json
import re
import struct
import subprocess
from pathlib import Path
from typing import Any
from zipfile import ZipFile

from linkforge_compile import __version__
from tests.conftest import ROOT
from tests.editors.conftest import EXTENSION
from tests.programs import program

MANIFEST = json.loads((EXTENSION / "package.json").read_text("utf-8"))
CONTRIBUTED = MANIFEST["contributes"]
SETTINGS = CONTRIBUTED["configuration"]["properties"]

# Loads the bundle with any class in place of each name of VS Code.
LOAD = """
const Module = require("node:module");
const load = Module._load;
const anything = new Proxy(class {}, { get: (made, name) => (name in made ? made[name] : anything) });
Module._load = (name, ...rest) => (name === "vscode" ? anything : load(name, ...rest));
console.log(Object.keys(require(process.argv[1])).sort().join(" "));
"""


def read_json(text: bytes) -> Any:
    return json.loads(text)


def test_has_the_bundle_and_no_sources(packed: ZipFile) -> None:
    names = [name.removeprefix("extension/") for name in packed.namelist() if name.startswith("extension/")]
    assert sorted(names) == [
        *("LICENSE.txt", "changelog.md", "icon.png", "language-configuration.json", "out/extension.js"),
        *("out/licenses.txt", "package.json", "readme.md", "syntaxes/linkforge.tmLanguage.json"),
    ]
    assert packed.read("extension/LICENSE.txt") == (ROOT / "LICENSE").read_bytes()


def test_manifest_names_files_that_are_packed(packed: ZipFile) -> None:
    manifest = read_json(packed.read("extension/package.json"))
    contributed = manifest["contributes"]
    language, grammar = contributed["languages"][0], contributed["grammars"][0]
    named = [manifest["main"], manifest["icon"], language["configuration"], grammar["path"], *language["icon"].values()]
    missing = [name for name in named if f"extension/{name.removeprefix('./')}" not in packed.namelist()]
    assert missing == []
    assert language["id"] == grammar["language"] == "linkforge"
    assert language["extensions"] == [".robot.yaml", ".robot.yml"]


def test_bundle_needs_nothing_but_vscode(packed: ZipFile, tmp_path: Path) -> None:
    packed.extract("extension/out/extension.js", tmp_path)
    bundle = tmp_path / "extension" / "out" / "extension.js"
    command = (program("node"), "--eval", LOAD, str(bundle))
    run = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False)
    assert (run.stdout, run.stderr) == ("activate deactivate\n", "")


def test_brings_the_licences_of_what_is_bundled(packed: ZipFile) -> None:
    licences = packed.read("extension/out/licenses.txt").decode()
    client = MANIFEST["devDependencies"]["vscode-languageclient"]
    assert f"vscode-languageclient {client}\n" in licences
    assert licences.count("Permission is hereby granted") >= 5


def test_icon_is_large_enough_for_the_marketplace(packed: ZipFile) -> None:
    signature, width, height = struct.unpack(">8s8xII", packed.read("extension/icon.png")[:24])
    assert (signature, width, height) == (b"\x89PNG\r\n\x1a\n", 256, 256)


def test_has_the_version_of_the_compiler() -> None:
    assert MANIFEST["version"] == __version__
    assert f"\n## {__version__}\n" in (EXTENSION / "CHANGELOG.md").read_text("utf-8")


def test_readme_lists_the_settings_with_their_defaults() -> None:
    rows = re.findall(r"^\| `(linkforge\.[\w.]+)` \| `(.+?)` \|", (EXTENSION / "README.md").read_text("utf-8"), re.M)
    assert rows == [
        (name, schema["default"] if isinstance(schema["default"], str) else json.dumps(schema["default"]))
        for name, schema in SETTINGS.items()
    ]


def test_problem_matchers_are_those_that_init_writes() -> None:
    tasks = json.loads((ROOT / "templates" / "init" / "tasks.json.j2").read_text("utf-8"))["tasks"]
    pattern, *others = [without(pattern, "name") for pattern in CONTRIBUTED["problemPatterns"]]
    contributed = [
        {**without(matcher, "name", "label", "source", "applyTo"), "pattern": pattern}
        for matcher in CONTRIBUTED["problemMatchers"]
    ]
    assert others == []
    assert contributed == [task["problemMatcher"] for task in tasks]


def without(values: dict[str, Any], *names: str) -> dict[str, Any]:
    return {name: value for name, value in values.items() if name not in names}


def test_lock_file_names_no_registry() -> None:
    lock = json.loads((EXTENSION / "package-lock.json").read_text("utf-8"))
    assert [name for name, package in lock["packages"].items() if "resolved" in package] == []
