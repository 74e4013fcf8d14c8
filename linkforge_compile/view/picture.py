"""A picture of a page, drawn by a local browser without a window or a graphics card."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import signal
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

VARIABLE = "LINKFORGE_BROWSER"
"""The environment variable that names the browser, with options if it needs some."""

PROGRAMS = (
    *("google-chrome", "google-chrome-stable", "chromium", "chromium-browser"),
    *("microsoft-edge", "microsoft-edge-stable", "msedge", "chrome"),
)

_MACOS = (
    "Google Chrome.app/Contents/MacOS/Google Chrome",
    "Chromium.app/Contents/MacOS/Chromium",
    "Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
)
_WINDOWS = ("Google/Chrome/Application/chrome.exe", "Microsoft/Edge/Application/msedge.exe")
_WINDOWS_FOLDERS = ("ProgramFiles", "ProgramFiles(x86)", "LocalAppData")

TIME_LIMIT = 180.0
"""How long a browser may draw a picture [s]."""

_OPTIONS = (
    "--headless",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--force-device-scale-factor=1",
    "--force-color-profile=srgb",
    "--hide-scrollbars",
    "--enable-logging=stderr",
    "--no-first-run",
    "--no-default-browser-check",
    "--disable-extensions",
    "--disable-sync",
    "--disable-component-update",
    "--disable-background-networking",
    "--disable-dev-shm-usage",
    "--host-resolver-rules=MAP * ~NOTFOUND",
)

_DONE, _FAILED = "linkforge: drawn", "linkforge: failed: "

WAIT = f"""<script>
(() => {{
  const inner = document.createElement("iframe");
  inner.hidden = true;
  document.body.append(inner);
  inner.contentDocument.open();
  const end = (message) => {{
    console.log(message);
    inner.contentDocument.close();
    inner.remove();
  }};
  const ready = window.linkforge?.ready ?? Promise.reject("the page did not start");
  ready.then(() => end("{_DONE}"), (error) => end("{_FAILED}" + error));
}})();
</script>
"""
"""The end of a page that is drawn as a picture: the browser draws it when the page has loaded, and an open document
inside the page delays that until the robot is drawn."""

_NOT_SHOWN = re.compile(r':CONSOLE[:(\d)]*\] "linkforge: not shown: (\w+) (.*)", source: ')
_MESSAGE = re.compile(r':CONSOLE[:(\d)]*\] "(.*)", source: ')


class Size(NamedTuple):
    """The width and height of a picture [pixels]."""

    width: int
    height: int


class PictureError(Exception):
    """No browser was found, or it did not draw the picture; the message has the reason and the way out."""


def find_browser() -> Sequence[str]:
    """Return the command of a browser.

    Raises:
        PictureError: No browser was found; the message names those that were looked for.

    """
    if words := os.environ.get(VARIABLE):
        command = [words] if shutil.which(words) else _words_in(words)
        if command and shutil.which(command[0]):
            return command
        raise PictureError(f"there is no program '{words}', which {VARIABLE} names")
    found = next(filter(None, map(shutil.which, (*PROGRAMS, *_usual_places()))), None)
    if found is None:
        raise PictureError(
            f"a picture needs Chrome, Chromium or Edge, and there is none of {', '.join(PROGRAMS)}; "
            f"install one, or name one in {VARIABLE}"
        )
    return [found]


def _words_in(text: str) -> list[str]:
    """Return the words of a command; on Windows a backslash separates folders and does not quote."""
    is_posix = os.name != "nt"
    return [word if is_posix else word.strip('"') for word in shlex.split(text, posix=is_posix)]


def _usual_places() -> Iterator[str]:
    """Yield the usual places of browsers on macOS and Windows, where they are not on the PATH."""
    for applications in (Path("/Applications"), Path.home() / "Applications"):
        yield from (str(applications / place) for place in _MACOS)
    for programs in filter(None, map(os.environ.get, _WINDOWS_FOLDERS)):
        yield from (str(Path(programs) / place) for place in _WINDOWS)


class Picture(NamedTuple):
    """A PNG, and the reasons why files are not shown in it, by their digests."""

    png: bytes
    not_shown: Mapping[str, str]


def draw_picture(html: str, size: Size, browser: Sequence[str], time_limit: float = TIME_LIMIT) -> Picture:
    """Draw a page that ends with WAIT, once all that it shows is loaded.

    Raises:
        PictureError: The browser cannot draw it, or not within the time limit [s].

    """
    with TemporaryDirectory(prefix="linkforge-", dir=_folder_for(browser), ignore_cleanup_errors=True) as name:
        folder = Path(name)
        page, picture, log = folder / "page.html", folder / "picture.png", folder / "log.txt"
        page.write_text(html, "utf-8")
        options = (f"--user-data-dir={folder / 'profile'}", f"--window-size={size.width},{size.height}")
        command = [*browser, *_OPTIONS, *_sandbox(), *options, f"--screenshot={picture}", page.as_uri()]
        _run(command, log, time_limit)
        messages = log.read_text("utf-8", "replace")
        if f'"{_DONE}"' not in messages or not picture.is_file():
            raise PictureError(f"{Path(browser[0]).name} drew no picture: {_reason(messages)}")
        return Picture(picture.read_bytes(), dict(_NOT_SHOWN.findall(messages)))


def _folder_for(browser: Sequence[str]) -> Path | None:
    """Return the folder for temporary files; None for the usual one; a snap has its own /tmp."""
    program = Path(browser[0])
    folder = Path.home() / "snap" / program.name / "common"
    return folder if program.parts[:2] == ("/", "snap") and folder.is_dir() else None


def _sandbox() -> Iterator[str]:
    """Yield the option to run without the sandbox for root, for whom it does not start; containers run as root."""
    if hasattr(os, "geteuid") and os.geteuid() == 0:
        yield "--no-sandbox"


def _run(command: Sequence[str], log: Path, time_limit: float) -> None:
    """Run a browser; then end it and all processes that it started, which could outlive it."""
    with log.open("wb") as stderr:
        try:
            process = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=stderr, stderr=stderr, start_new_session=True
            )
        except OSError as error:
            raise PictureError(f"'{command[0]}' does not start: {error.strerror}") from error
        try:
            process.wait(time_limit)
        except subprocess.TimeoutExpired as error:
            name = Path(command[0]).name
            raise PictureError(f"{name} did not draw the picture within {time_limit:.0f} s") from error
        finally:
            _end(process)


def _end(process: subprocess.Popen[bytes]) -> None:
    if hasattr(os, "killpg"):
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
    else:
        process.kill()
    process.wait()


def _reason(log: str) -> str:
    """Return why the browser drew no picture, from its output."""
    if "No usable sandbox" in log:
        return f"its sandbox does not start on this machine; {VARIABLE}='chromium --no-sandbox' leaves it out"
    messages = _MESSAGE.findall(log)
    if messages:
        return str(messages[-1]).removeprefix(_FAILED)
    return next((line for line in reversed(log.splitlines()) if line.strip()), "it printed nothing")
