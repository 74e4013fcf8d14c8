"""The code of docs/python.md runs, in order, with a spec of the examples."""

import re
import shutil
from pathlib import Path

import pytest

from tests.conftest import ROOT


def test_code_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    shutil.copy(ROOT / "examples" / "01_two_link_arm" / "two_link_arm.robot.yaml", tmp_path / "arm.robot.yaml")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "python.md").read_text("utf-8"), re.DOTALL):
        exec(block, names)
    printed = capsys.readouterr().out
    assert '<joint name="arm_mount" type="fixed">' in printed
    assert "linkforge: 1" in printed
