"""Makes, as a wheel is built, what is made of our own files alone: hatchling runs it, and no wheel has it."""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class MadeFiles(BuildHookInterface[Any]):  # Any: the configuration of whatever builder runs it
    """Puts made files into the wheel, in `linkforge_compile/_data`; an editable install works without them."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make them, unless the build is that of an editable install."""
        if version == "editable":
            return
        # The sources that are built, whatever linkforge is installed.
        sys.path.insert(0, self.root)
        from linkforge_compile.formats.environment import compile_templates
        from linkforge_compile.schema.registry import linked_schema_text

        self._folder = TemporaryDirectory()
        made = Path(self._folder.name)
        compile_templates(made / "compiled_templates")
        (made / "linked_schema.json").write_text(linked_schema_text(), "utf-8")
        for path in made.iterdir():
            build_data["force_include"][str(path)] = f"linkforge_compile/_data/{path.name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove them from where they were made."""
        if version != "editable":
            sys.path.remove(self.root)
            self._folder.cleanup()
