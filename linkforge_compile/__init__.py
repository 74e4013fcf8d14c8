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

from linkforge_compile._version import __version__ as __version__

if TYPE_CHECKING:
    from linkforge_compile.core import Robot as Robot
    from linkforge_compile.diagnostics import Diagnostic as Diagnostic
    from linkforge_compile.diagnostics import Diagnostics as Diagnostics
    from linkforge_compile.diagnostics import Severity as Severity
    from linkforge_compile.export_spec import write_spec as write_spec
    from linkforge_compile.formats.render import render as render
    from linkforge_compile.formats.render import render_files as render_files
    from linkforge_compile.formats.render import render_srdf as render_srdf
    from linkforge_compile.formats.render import render_srdf_with_map as render_srdf_with_map
    from linkforge_compile.formats.render import render_templates as render_templates
    from linkforge_compile.formats.render import render_urdf as render_urdf
    from linkforge_compile.formats.render import render_urdf_with_map as render_urdf_with_map
    from linkforge_compile.formats.source_map import SourceMap as SourceMap
    from linkforge_compile.formats.user_templates import TemplateError as TemplateError
    from linkforge_compile.importing import Import as Import
    from linkforge_compile.importing import import_urdf as import_urdf
    from linkforge_compile.pipeline import Compilation as Compilation
    from linkforge_compile.pipeline import CompileError as CompileError
    from linkforge_compile.pipeline import check_file as check_file
    from linkforge_compile.pipeline import check_text as check_text
    from linkforge_compile.pipeline import compile_file as compile_file
    from linkforge_compile.pipeline import compile_text as compile_text
    from linkforge_compile.source import Span as Span

_NAMES = {
    "_version": "__version__",
    "core": "Robot",
    "diagnostics": "Diagnostic Diagnostics Severity",
    "export_spec": "write_spec",
    "formats.render": "render render_files render_srdf render_srdf_with_map "
    "render_templates render_urdf render_urdf_with_map",
    "formats.source_map": "SourceMap",
    "formats.user_templates": "TemplateError",
    "importing": "Import import_urdf",
    "pipeline": "Compilation CompileError check_file check_text compile_file compile_text",
    "source": "Span",
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names.split()}

if not TYPE_CHECKING:
    __all__ = list(_MODULE_OF)

    def __getattr__(name: str) -> object:
        """Import a public name when it is first used, so that `linkforge --help` starts fast."""
        if name not in _MODULE_OF:
            raise AttributeError(f"module '{__name__}' has no attribute '{name}'")
        from importlib import import_module

        value = getattr(import_module(f"{__name__}.{_MODULE_OF[name]}"), name)
        globals()[name] = value
        return value

    def __dir__() -> list[str]:
        return __all__
