"""Compiled templates, kept as Python keeps its own bytecode: at the same place, under the same switches.

To compile the templates of a robot takes a tenth of a whole `linkforge compile`.
"""

from __future__ import annotations

import sys
from contextlib import suppress
from importlib.util import cache_from_source
from pathlib import Path
from pickle import UnpicklingError

from jinja2 import FileSystemBytecodeCache, compiler
from jinja2.bccache import Bucket


class TemplateBytecode(FileSystemBytecodeCache):
    """Jinja's cache of bytecode, in `__pycache__` beside a module, or below PYTHONPYCACHEPREFIX.

    What was compiled holds for its template's text, for this Python, and for what compiled it, Jinja's compiler with
    the options that the `module` gives it: of these two files the time and size are asked, as Python asks them of a
    source. Where Python may not write its bytecode, or nobody may write at all, templates are compiled each time.
    """

    def __init__(self, module: str) -> None:
        super().__init__(str(Path(cache_from_source(module)).parent), "template_%s.jinja")
        made_by = [Path(str(file)).stat() for file in (compiler.__file__, module)]
        self._made_by = " ".join(f"{file.st_mtime_ns} {file.st_size}" for file in made_by)

    def get_source_checksum(self, source: str) -> str:
        return super().get_source_checksum(f"{self._made_by}\n{source}")

    def load_bytecode(self, bucket: Bucket) -> None:
        try:
            super().load_bytecode(bucket)
        except (OSError, EOFError, ValueError, LookupError, UnpicklingError):
            bucket.reset()  # a broken file is none

    def dump_bytecode(self, bucket: Bucket) -> None:
        if sys.dont_write_bytecode:
            return
        with suppress(OSError):
            Path(self.directory).mkdir(parents=True, exist_ok=True)
            super().dump_bytecode(bucket)
