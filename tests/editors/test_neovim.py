"""Neovim with the set-up of docs/editors.md."""

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.editors.setups import MESSAGE, blocks, environment, write_spec

PROBE = Path(__file__).with_name("probe.lua")


def test_reports_and_finds_definitions(tmp_path: Path) -> None:
    nvim = shutil.which("nvim")
    if nvim is None:
        pytest.skip("there is no program 'nvim'")
    version = re.match(r"NVIM v0\.(\d+)", subprocess.check_output([nvim, "--version"], text=True))
    since_11, _on_save, before_11 = blocks("Neovim", "lua")
    settings = tmp_path / "init.lua"
    settings.write_text(before_11 if version and int(version[1]) < 11 else since_11, "utf-8")
    spec = write_spec(tmp_path)
    command = [nvim, "--headless", "-n", "-u", str(settings), str(spec), "-c", f"luafile {PROBE}"]
    run = subprocess.run(
        command, cwd=tmp_path, env=environment(tmp_path), capture_output=True, text=True, timeout=120, check=False
    )
    seen = json.loads(run.stdout)
    assert seen == {"filetype": "yaml.linkforge", "line": 4, "message": MESSAGE, "code": "LF4102", "definition": 2}
