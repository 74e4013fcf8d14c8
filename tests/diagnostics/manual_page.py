"""Parse a page of the manual; docs/diagnostics/README.md describes the form."""

import re
import shlex
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

ROOT_SPEC = "robot.robot.yaml"
PREAMBLE = "linkforge: 1\nname: robot\n"
IS_WHOLE = re.compile(r"^(linkforge|name):", re.MULTILINE)
SECTION = re.compile(r"^## (.+)\n", re.MULTILINE)
FENCE = re.compile(r"^```(?P<info>.+)\n(?P<text>(?:.*\n)*?)```$", re.MULTILINE)


@dataclass
class Example:
    """Files by name, the compiled one first, and the words that `linkforge` is called with."""

    files: dict[str, str] = field(default_factory=dict)
    command: list[str] = field(default_factory=list)

    @classmethod
    def read(cls, section: str) -> Self:
        example = cls()
        for fence in FENCE.finditer(section):
            language, *marks = fence["info"].split()
            if language == "sh":
                program, *example.command = shlex.split(fence["text"])
                assert program == "linkforge", "an example calls linkforge, and once"
                continue
            name = next((mark.removeprefix("file=") for mark in marks if mark.startswith("file=")), ROOT_SPEC)
            assert name not in example.files, f"two files named {name}"
            is_fragment = name.endswith(".robot.yaml") and "whole" not in marks and not IS_WHOLE.search(fence["text"])
            example.files[name] = PREAMBLE * is_fragment + fence["text"]
        example.command = example.command or ["compile", next(iter(example.files), ROOT_SPEC), "-o", "out/"]
        return example

    def write(self, folder: Path) -> None:
        for name, text in self.files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(text.encode())


@dataclass
class Page:
    heading: str
    paragraphs: list[str]
    sections: dict[str, str]

    @classmethod
    def read(cls, path: Path) -> Self:
        introduction, *rest = SECTION.split(path.read_text("utf-8"))
        heading, *paragraphs = (part.strip() for part in introduction.split("\n\n"))
        return cls(heading, paragraphs, dict(zip(rest[::2], rest[1::2], strict=True)))
