"""Compiled templates: what Python they become, and that it is kept as Python keeps its own bytecode.

To compile the templates of a robot takes a tenth of a whole `linkforge compile`.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from pathlib import Path
from pickle import UnpicklingError

from jinja2 import FileSystemBytecodeCache, compiler, nodes
from jinja2.bccache import Bucket

from linkforge_compile.bytecode import BROKEN, folder_beside, stamp


class TemplatePython(compiler.CodeGenerator):
    """Places what `finalize` returns: that is escaped, and Jinja's own look at every value takes a tenth of a robot.

    These two are private to Jinja: in one that does not call them, its own look finds nothing to do.
    """

    def _output_child_pre(
        self, node: nodes.Expr, frame: compiler.Frame, finalize: compiler.CodeGenerator._FinalizeInfo
    ) -> None:
        self.write("environment.finalize(")

    def _output_child_post(
        self, node: nodes.Expr, frame: compiler.Frame, finalize: compiler.CodeGenerator._FinalizeInfo
    ) -> None:
        self.write(")")


class TemplateBytecode(FileSystemBytecodeCache):
    """Jinja's cache of bytecode, beside that of a module.

    What was compiled holds for its template's text, for this Python, and for what compiled it: Jinja's compiler, ours,
    and the options that the `module` gives them. Where Python may not write its bytecode, or nobody may write at all,
    templates are compiled each time.
    """

    def __init__(self, module: str) -> None:
        super().__init__(str(folder_beside(module)), "template_%s.jinja")
        self._made_by = stamp((compiler.__file__, __file__, module))

    def get_source_checksum(self, source: str) -> str:
        return super().get_source_checksum(f"{self._made_by}\n{source}")

    def load_bytecode(self, bucket: Bucket) -> None:
        try:
            super().load_bytecode(bucket)
        except (*BROKEN, UnpicklingError, AttributeError, ImportError):  # the last three of Jinja's own pickle
            bucket.reset()  # a broken file is none

    def dump_bytecode(self, bucket: Bucket) -> None:
        if sys.dont_write_bytecode:
            return
        with suppress(OSError):
            Path(self.directory).mkdir(parents=True, exist_ok=True)
            super().dump_bytecode(bucket)
