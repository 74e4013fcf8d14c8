"""Makes, as linkforge is built, what is made of its own files: hatchling runs it, and no wheel has it."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_NPM = (("ci", "--ignore-scripts", "--no-audit", "--no-fund"), ("run", "build"))


class MadeFiles(BuildHookInterface[Any]):  # Any: the configuration of whatever builder runs it
    """Puts made files into the wheel, in `linkforge_compile/_data`, and builds the viewer's page where its sources are.

    An editable install has the page only, and works without the others.
    """

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Make them."""
        page = self._made_page(Path(self.root, "linkforge_compile", "view", "page"))
        if self.target_name != "wheel" or version == "editable":
            return
        # The sources that are built, whatever linkforge is installed.
        sys.path.insert(0, self.root)
        from linkforge_compile.formats.environment import compile_templates
        from linkforge_compile.schema.registry import linked_schema_text

        self._folder = TemporaryDirectory()
        made = Path(self._folder.name)
        compile_templates(made / "compiled_templates")
        (made / "linked_schema.json").write_text(linked_schema_text(), "utf-8")
        for path in (*made.iterdir(), *page):
            build_data["force_include"][str(path)] = f"linkforge_compile/_data/{path.name}"

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what was made for the wheel."""
        if self.target_name == "wheel" and version != "editable":
            sys.path.remove(self.root)
            self._folder.cleanup()

    def _made_page(self, sources: Path) -> tuple[Path, ...]:
        """Build the page with npm unless it is as new as its sources, as that of an sdist is; none without npm."""
        page = sources / "out" / "view.html"
        if not _is_current(page, sources):
            try:
                for arguments in _NPM:
                    subprocess.run([which("npm") or "npm", *arguments], cwd=sources, check=True, capture_output=True)
            except (OSError, subprocess.CalledProcessError) as error:
                output = (
                    error.stderr.decode(errors="replace") if isinstance(error, subprocess.CalledProcessError) else ""
                )
                self.app.display_warning(f"`linkforge view` has no page, which npm builds: {error}\n{output}")
                return ()  # an older page would not be that of these sources
        return (page,) if page.is_file() else ()


def _is_current(made: Path, sources: Path) -> bool:
    if not made.is_file():
        return False
    written = made.stat().st_mtime
    for folder, names, files in os.walk(sources):
        names[:] = [name for name in names if name not in {"node_modules", "out"}]
        if any(Path(folder, file).stat().st_mtime > written for file in files):
            return False
    return True
