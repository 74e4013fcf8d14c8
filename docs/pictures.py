"""Draws the pictures of the docs from the examples, and knows of which robots they are.

`python docs/pictures.py` draws those whose robot has changed since, `--all` all of them. Look at each before you commit
it. It needs Chromium or Chrome, and the extra `dev`.
"""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from hashlib import sha256
from io import BytesIO
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from linkforge_compile import compile_file
from linkforge_compile.view.files import RobotFiles
from linkforge_compile.view.picture import find_browser
from linkforge_compile.view.scene import make_scene

HERE = Path(__file__).parent
FOLDER = HERE / "pictures"
DIGESTS = FOLDER / "digests.json"
EXAMPLES = HERE.parent / "examples"

MAX_BYTES = 60_000
"""The largest picture that the docs have."""

_SMALL = ("--size", "480x360")
_COLORS = 192
"""With as many, a screenshot has a third of its size, and looks the same."""


class Picture(NamedTuple):
    """A picture of an example: the command that draws it, and what is done in the page of a screenshot first."""

    words: Sequence[str]
    actions: Sequence[str] = ()

    @property
    def spec(self) -> Path:
        return EXAMPLES / self.words[1]

    @property
    def is_screenshot(self) -> bool:
        return bool(self.actions)


PICTURES = {
    "two_link_arm.png": Picture(
        (
            "view",
            "01_two_link_arm/two_link_arm.robot.yaml",
            "--pose",
            "shoulder=-50deg",
            "--pose",
            "elbow=80deg",
            *_SMALL,
        )
    ),
    "rover.png": Picture(("view", "06_rover/rover.robot.yaml", *_SMALL)),
    "quadruped.png": Picture(("view", "07_quadruped/quadruped.robot.yaml", "--pose", "legs/stand", *_SMALL)),
    "hand.png": Picture(("view", "08_hand/hand.robot.yaml", "--pose", "hand/closed", "--camera=35,25", *_SMALL)),
    "pan_tilt.png": Picture(
        ("view", "11_ros2_package/robots/pan_tilt.robot.yaml", "--pose", "tilt_turn=20deg", *_SMALL)
    ),
    "page.png": Picture(
        ("view", "07_quadruped/quadruped.robot.yaml", "--pose", "legs/stand", "--show", "visuals,grid,axes,centers"),
        ("linkforge.select('front_right_shank')",),
    ),
    "diff.png": Picture(
        ("diff", *("07_quadruped/quadruped.robot.yaml",) * 2, "--html", "--after", "length=0.46m"),
        ("linkforge.ready",),
    ),
    "hand.svg": Picture(("graph", "08_hand/hand.robot.yaml")),
}


def digest_of(picture: Picture) -> str:
    """Return a digest of the command, and of the robot as it is drawn, wherever its parts are written."""
    scene = make_scene(compile_file(picture.spec).result(), RobotFiles())
    parts = [
        {key: value for key, value in part.items() if key != "source"} for part in (*scene["links"], *scene["joints"])
    ]
    text = json.dumps([*picture.words, *picture.actions, parts, scene["states"]], default=str)
    # The last digits of a sine are not the same on all machines.
    rounded = json.loads(text, parse_float=lambda number: round(float(number), 9))
    return sha256(json.dumps(rounded).encode()).hexdigest()[:16]


def known_digests() -> dict[str, str]:
    return json.loads(DIGESTS.read_text("utf-8")) if DIGESTS.exists() else {}


def draw(name: str, picture: Picture) -> None:
    """Run the command of a picture; of a page, take a screenshot."""
    with TemporaryDirectory() as folder:
        file = Path(folder, "page.html") if picture.is_screenshot else FOLDER / name
        command = [sys.executable, "-m", "linkforge_compile", *picture.words, "-o", str(file), "--quiet"]
        done = subprocess.run(command, cwd=EXAMPLES, check=False)
        if done.returncode not in ({0, 1} if picture.words[0] == "diff" else {0}):
            raise SystemExit(f"{name}: {' '.join(command)} ended with {done.returncode}")
        if picture.is_screenshot:
            _take_screenshot(file, picture.actions, FOLDER / name)


def _take_screenshot(page: Path, actions: Sequence[str], picture: Path) -> None:
    from PIL import Image
    from playwright.sync_api import sync_playwright

    program, *options = find_browser()
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=[*options, "--force-color-profile=srgb"])
        tab = browser.new_page(viewport={"width": 960, "height": 600})
        tab.goto(page.as_uri())
        tab.evaluate("linkforge.ready")
        for action in actions:
            tab.evaluate(action)
        tab.wait_for_timeout(500)
        taken = Image.open(BytesIO(tab.screenshot())).convert("RGB")
        browser.close()
    taken.quantize(_COLORS, dither=Image.Dither.NONE).save(picture, optimize=True)


def main() -> None:
    known, digests = known_digests(), {name: digest_of(picture) for name, picture in PICTURES.items()}
    for name, picture in PICTURES.items():
        if "--all" in sys.argv[1:] or known.get(name) != digests[name] or not (FOLDER / name).exists():
            draw(name, picture)
            print(f"drew {name}, {(FOLDER / name).stat().st_size:,} bytes")
    DIGESTS.write_text(json.dumps(digests, indent=2) + "\n", "utf-8")


if __name__ == "__main__":
    main()
