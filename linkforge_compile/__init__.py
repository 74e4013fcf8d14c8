"""A declarative compiler for robots: YAML specs in; URDF, SRDF and other formats out.

For example::

    from linkforge_compile import compile_file, render, render_urdf

    compilation = compile_file("arm.robot.yaml", parameters={"reach": "0.7 m"})
    for diagnostic in compilation.diagnostics:
        print(diagnostic)
    urdf = render_urdf(compilation.result())      # CompileError where the spec has errors
    mjcf = render(compilation.result(), "mjcf")   # any format that `linkforge formats` lists

Nothing here prints or exits. The model of a robot is `linkforge_compile.core`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from linkforge_compile._version import __version__

if TYPE_CHECKING:
    from linkforge_compile.core import Robot
    from linkforge_compile.diagnostics import Diagnostic, Diagnostics, Severity
    from linkforge_compile.export_spec import write_spec
    from linkforge_compile.formats.render import (
        render,
        render_files,
        render_srdf,
        render_srdf_with_map,
        render_templates,
        render_urdf,
        render_urdf_with_map,
    )
    from linkforge_compile.formats.source_map import SourceMap
    from linkforge_compile.formats.user_templates import TemplateError
    from linkforge_compile.importing import Import, import_urdf
    from linkforge_compile.pipeline import (
        Compilation,
        CompileError,
        check_file,
        check_text,
        compile_file,
        compile_text,
    )
    from linkforge_compile.source import Span

__all__ = [
    "Compilation",
    "CompileError",
    "Diagnostic",
    "Diagnostics",
    "Import",
    "Robot",
    "Severity",
    "SourceMap",
    "Span",
    "TemplateError",
    "__version__",
    "check_file",
    "check_text",
    "compile_file",
    "compile_text",
    "import_urdf",
    "render",
    "render_files",
    "render_srdf",
    "render_srdf_with_map",
    "render_templates",
    "render_urdf",
    "render_urdf_with_map",
    "write_spec",
]

_HOMES = {
    "Compilation": "pipeline",
    "CompileError": "pipeline",
    "Diagnostic": "diagnostics",
    "Diagnostics": "diagnostics",
    "Import": "importing",
    "Robot": "core",
    "Severity": "diagnostics",
    "SourceMap": "formats.source_map",
    "Span": "source",
    "TemplateError": "formats.user_templates",
    "check_file": "pipeline",
    "check_text": "pipeline",
    "compile_file": "pipeline",
    "compile_text": "pipeline",
    "import_urdf": "importing",
    "render": "formats.render",
    "render_files": "formats.render",
    "render_srdf": "formats.render",
    "render_srdf_with_map": "formats.render",
    "render_templates": "formats.render",
    "render_urdf": "formats.render",
    "render_urdf_with_map": "formats.render",
    "write_spec": "export_spec",
}


def __getattr__(name: str) -> object:
    """Import a public name when it is first used, so that `linkforge --help` starts fast."""
    if name not in _HOMES:
        raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
    from importlib import import_module

    value: object = getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
