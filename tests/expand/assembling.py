"""Specs written in a test, expanded, and what came of it as plain values."""

from collections.abc import Mapping
from pathlib import Path
from textwrap import dedent
from typing import NamedTuple

from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand import Instance, Unset, arguments_from_text, arguments_from_values, expand
from linkforge_compile.load import Loader
from linkforge_compile.syntax import YamlList, YamlMap, YamlNode, YamlScalar


class Assembled(NamedTuple):
    """An instance and the diagnostics of the way to it, as text."""

    instance: Instance
    messages: list[str]

    @property
    def metadata(self) -> object:
        """The `metadata` of the compiled file, where tests put the values to check."""
        return metadata_of(self.instance)


def assemble(
    text: str, *pairs: str, folder: Path | None = None, unset: Unset = Unset.ERROR, **values: object
) -> Assembled:
    """Expand a spec without `linkforge` and `name`, which are added; parameters as text or as Python values."""
    sink = Diagnostics()
    loader = Loader()
    spec = loader.parse(f"linkforge: 1\nname: test\n{dedent(text).lstrip()}", "test.robot.yaml", folder, sink)
    assert spec, [str(diagnostic) for diagnostic in sink]
    arguments = arguments_from_values(values) if values else arguments_from_text(pairs, sink)
    instance = expand(spec, arguments, loader, sink, unset=unset)
    return Assembled(instance, [diagnostic.message for diagnostic in sink.sorted()])


def write(folder: Path, files: Mapping[str, str]) -> None:
    """Write spec files without `linkforge` and `name`, which are added."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"linkforge: 1\nname: {path.name.partition('.')[0]}\n{dedent(text).lstrip()}")


def metadata_of(instance: Instance) -> object:
    assert instance.tree
    return plain(instance.tree.get("metadata"))


def plain(node: YamlNode | None) -> object:
    """Return a tree as Python's values; a fault is the word 'FAULT'."""
    match node:
        case YamlMap():
            return {entry.name: plain(entry.value) for entry in node}
        case YamlList():
            return [plain(item) for item in node]
        case YamlScalar():
            return node.value
        case None:
            return None
    return "FAULT"
