"""The files of a new robot: a first spec, and what editors, git, pre-commit and CMake want beside it."""

from __future__ import annotations

import re

from linkforge_compile.resources import templates_folder

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
"""What a robot may be called whose name is that of files and of a CMake project as well."""

_TEMPLATES = {
    "{name}.robot.yaml": "robot.robot.yaml",
    "CMakeLists.txt": "CMakeLists.txt",
    ".gitignore": "gitignore",
    ".pre-commit-config.yaml": "pre-commit-config.yaml",
    ".vscode/settings.json": "settings.json",
    ".vscode/extensions.json": "extensions.json",
}


def robot_files(name: str) -> dict[str, str]:
    """Return the text of each file by its path in the folder; the schema that the spec names is not among them."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    # Nothing is escaped: the name is letters, digits, `_` and `-`, and no file is XML.
    environment = Environment(
        loader=FileSystemLoader(templates_folder() / "init"), undefined=StrictUndefined, keep_trailing_newline=True
    )
    return {
        path.format(name=name): environment.get_template(f"{template}.j2").render(name=name)
        for path, template in _TEMPLATES.items()
    }
