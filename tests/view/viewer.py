"""Runs `linkforge view` as a process."""

import signal
import subprocess
from pathlib import Path
from queue import Queue
from threading import Thread

from tests.programs import interruptible


class Viewer:
    """A process of the command in a folder, and the lines that it prints."""

    def __init__(self, *words: str, cwd: Path) -> None:
        command = interruptible("view", *words, "--no-browser")
        self.process = subprocess.Popen(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        assert self.process.stdout
        assert self.process.stderr
        self._stderr = self.process.stderr
        self._lines = Queue[str]()
        self._reader = Thread(target=self._read, daemon=True)
        self._reader.start()
        self.url = self.process.stdout.readline().strip()

    def _read(self) -> None:
        for line in self._stderr:
            self._lines.put(line.rstrip("\n"))

    def wait_for(self, *expected: str) -> None:
        """Wait until these lines were printed, one after the other."""
        for line in expected:
            while (printed := self._lines.get(timeout=60)) != line:
                assert not printed.startswith("linkforge"), printed

    def interrupt(self) -> int:
        self.process.send_signal(signal.SIGINT)
        code = self.process.wait(60)
        self._reader.join(60)
        return code

    def close(self) -> None:
        self.process.kill()
        self.process.wait(60)
        self._reader.join(60)
        for stream in (self.process.stdout, self.process.stderr):
            if stream:
                stream.close()
