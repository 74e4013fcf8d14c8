"""Specs in tests: read, assembled by hand as `expand` would, lowered, and compared with what their lines expect."""

from collections.abc import Iterator, Mapping
from itertools import count
from textwrap import dedent

from linkforge_compile.core import Robot
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.expand.instance import Instance
from linkforge_compile.lower import Lowered, lower
from linkforge_compile.source import ModuleUse, SourceFile, SourceRef
from linkforge_compile.syntax import YamlMap, read
from tests.yaml_case import Finding, expected


class Spec:
    """The text of a file, the files that its `modules` use by entry, and where its meshes lie."""

    def __init__(self, text: str, modules: Mapping[str, "Spec | None"] | None = None, mesh_base: str = "") -> None:
        self.text = dedent(text).lstrip("\n")
        self.modules = modules or {}
        self.mesh_base = mesh_base

    def instance(
        self,
        sink: Diagnostics,
        order: Iterator[int],
        name: str = "spec",
        entry: SourceRef | None = None,
        trail: tuple[ModuleUse, ...] = (),
    ) -> Instance:
        tree = read(SourceFile(f"{name}.yaml", self.text, order=next(order)), sink)
        assert tree is not None, "the spec of a test is YAML"
        written = tree.get("modules")
        uses = written.entries if isinstance(written, YamlMap) else {}
        modules = []
        for key, spec in self.modules.items():
            use = uses[key]
            ref = SourceRef(use.value, use.key, trail)
            inner = (ModuleUse.of(use.key.span, key), *trail)
            if spec is None:
                modules.append(Instance(key, None, ref, f"{key}_", include_stack=inner))
            else:
                modules.append(spec.instance(sink, order, key, ref, inner))
        prefix = "" if entry is None else prefix_of(entry, name)
        bases = {tree.span.file: self.mesh_base}
        return Instance(name, tree, entry, prefix, bases, trail, tuple(modules))

    def texts(self, name: str = "spec") -> Mapping[str, str]:
        inner = {file: text for key, spec in self.modules.items() if spec for file, text in spec.texts(key).items()}
        return {f"{name}.yaml": self.text, **inner}


def prefix_of(entry: SourceRef, name: str) -> str:
    assert isinstance(entry.node, YamlMap)
    prefix = entry.node.get("prefix")
    return f"{name}_" if prefix is None else prefix.text  # type: ignore[union-attr]  # the tests write scalars


def lowered(spec: Spec | str) -> Lowered:
    """Lower a spec and compare every diagnostic with the expectations on its lines."""
    spec = spec if isinstance(spec, Spec) else Spec(spec)
    sink = Diagnostics()
    result = lower(spec.instance(sink, count()), sink)
    wanted = {one for file, text in spec.texts().items() for one in expected(file, text)}
    assert {finding_of(diagnostic) for diagnostic in sink} == wanted
    return result


def robot_of(spec: Spec | str) -> Robot:
    """Lower a spec that makes one robot."""
    result = lowered(spec)
    assert result.robot is not None
    return result.robot


def finding_of(diagnostic) -> Finding:
    span = diagnostic.span
    assert span is not None, "a spec's fault without a place"
    code = diagnostic.code
    return Finding(span.file.name, span.line, span.column, code.severity, code.id, diagnostic.message)
