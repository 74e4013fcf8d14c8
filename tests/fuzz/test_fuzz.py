"""What fuzzing kept breaks no promise any more, and a few seconds of it in CI break none."""

import os
from pathlib import Path

import pytest

from tests.fuzz.__main__ import MOST_KEPT, fuzz, write_seeds
from tests.fuzz.targets import CORPUS, TARGETS

SECONDS = int(os.environ.get("LINKFORGE_FUZZ_SECONDS", "0"))


@pytest.mark.parametrize("path", sorted(CORPUS.glob("*/*")), ids=lambda path: path.relative_to(CORPUS).as_posix())
def test_what_was_kept_breaks_no_promise(path: Path):
    TARGETS[path.parent.name](path.read_bytes())


def test_what_is_kept_stays_small():
    files = list(CORPUS.glob("*/*"))
    assert len(files) <= MOST_KEPT * len(TARGETS) < 300
    assert sum(path.stat().st_size for path in files) < 1024**2


takes_a_while = pytest.mark.skipif(
    not SECONDS, reason="it takes a while: LINKFORGE_FUZZ_SECONDS, which CI sets, says how long"
)


@takes_a_while
@pytest.mark.parametrize("target", TARGETS)
def test_fuzzing_finds_nothing(
    target: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
):
    pytest.importorskip("atheris", reason="it is for Linux, and not for every version of Python")
    found, beginning = tmp_path / "found", tmp_path / "beginning"
    found.mkdir()
    beginning.mkdir()
    write_seeds(target, beginning)
    monkeypatch.chdir(tmp_path)
    # The dice fall the same way each time: what stops a change should be the change. The long run looks further.
    assert fuzz(target, SECONDS, found, beginning, dice=1) == 0, [path.read_bytes() for path in tmp_path.glob("*-*")]
    if target in ("compile", "import"):
        log = capfd.readouterr().err
        watched = {line.rpartition(" ")[2] for line in log.splitlines() if line.startswith("INFO: Instrumenting")}
        modules = ("pipeline", "importing", "lower.joint", "checks.joints", "formats.urdf", "importers.urdf")
        assert watched >= {f"linkforge_compile.{module}" for module in modules}
