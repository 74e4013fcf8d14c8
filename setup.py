"""What colcon runs to build linkforge as a package of `ament_python`. pip and others read pyproject.toml alone."""

import re
import subprocess
import sys
import tomllib
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

PACKAGE = "linkforge_compile"
SOURCES = Path(__file__).resolve().parent  # `--symlink-install` runs a link to this file in the build folder
PROJECT = tomllib.loads((SOURCES / "pyproject.toml").read_text("utf-8"))["project"]
(VERSION,) = re.findall(r'^__version__ = "(.+)"$', (SOURCES / PACKAGE / "_version.py").read_text("utf-8"), re.M)


class ColconDistribution(Distribution):
    def parse_config_files(self, *_args: object, **_options: object) -> None:
        """Leave pyproject.toml to hatchling: setuptools before 77 refuses its license, colcon its requires-python."""


class BuildFromWheel(build_py):
    """Takes the package from the wheel that hatchling builds, with its schemas, templates and pages."""

    def run(self) -> None:
        if self.editable_mode:  # of `colcon build --symlink-install`, which works like a checkout
            super().run()
            return
        isolation = ["--no-build-isolation"] if find_spec("hatchling") else []  # else pip downloads hatchling
        with TemporaryDirectory() as folder:
            wheel = [sys.executable, "-m", "pip", "wheel", "--no-deps", *isolation, "--wheel-dir", folder, str(SOURCES)]
            subprocess.run(wheel, check=True)
            (path,) = Path(folder).glob("*.whl")
            with ZipFile(path) as archive:
                archive.extractall(
                    self.build_lib, [name for name in archive.namelist() if name.startswith(PACKAGE + "/")]
                )

    def get_outputs(self, include_bytecode: int = 1) -> list[str]:
        return [str(path) for path in Path(self.build_lib, PACKAGE).rglob("*") if path.is_file()]


setup(
    distclass=ColconDistribution,
    name=PACKAGE,
    version=VERSION,
    packages=[PACKAGE],
    cmdclass={"build_py": BuildFromWheel},
    entry_points={"console_scripts": [f"{name} = {function}" for name, function in PROJECT["scripts"].items()]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"docs/packaging/ament_index/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/cmake", [str(path) for path in sorted(Path("cmake").glob("*.cmake"))]),
    ],
)
