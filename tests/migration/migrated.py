"""Migrates a xacro of a test and proves it: what xacro expands is the oracle."""

from pathlib import Path
from typing import NamedTuple

from linkforge_compile.analysis import Settings
from linkforge_compile.diagnostics import Diagnostics
from linkforge_compile.migration.combinations import OTHER_WORD
from linkforge_compile.migration.prove import Migrator, Proved


class Migrated(NamedTuple):
    """The specs by file name, and what was proved of them."""

    files: dict[str, str]
    proved: Proved

    @property
    def robot(self) -> str:
        return self.files[self.proved.main]


def write(folder: Path, **files: str) -> Path:
    """Write xacros into a folder, each with the root element around its text; return the path of `robot`."""
    for name, text in files.items():
        root = f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="{name}">\n{text}\n</robot>\n'
        (folder / f"{name}.xacro").write_text(root, "utf-8")
    return folder / "robot.xacro"


def migrated(
    folder: Path,
    text: str,
    given: dict[str, str] | None = None,
    packages: dict[str, Path] | None = None,
    **others: str,
) -> Migrated:
    """Migrate a xacro, and require that the specs are proved for all combinations that are robots."""
    main = write(folder, robot=text, **others)
    loader = Settings((), packages or {}).loader(main)
    proved = Migrator(main, given or {}, folder / "specs", loader, Diagnostics()).run()
    assert proved.is_equal, [one.message for one in proved.diagnostics]
    others = [one for one in proved.comparisons if not one.is_equal]
    assert all(one.refused and OTHER_WORD in one.arguments.values() for one in others), others
    return Migrated(dict(proved.files), proved)
