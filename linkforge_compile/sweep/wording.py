"""How messages name what a sweep was requested with: the options of the command, or the arguments of `run`."""

from __future__ import annotations

from typing import NamedTuple


class Wording(NamedTuple):
    """The names that the user knows. Without a folder, which the command always has, no sweep is continued."""

    is_python: bool = False
    has_folder: bool = True

    def option(self, name: str, value: object = "") -> str:
        """Return `--max-points 9` or `max_points=9`; without a value the name alone."""
        if self.is_python:
            return f"{name.replace('-', '_')}={value}" if value else name.replace("-", "_")
        return f"--{name} {value}".rstrip()

    @property
    def resuming(self) -> str:
        """What continues a sweep."""
        return "resume=True" if self.is_python else "--resume"

    @property
    def continuing(self) -> str:
        """What to do once a sweep was stopped."""
        if self.has_folder:
            return f"{self.resuming} continues"
        return "start again; with output=FOLDER, what is done would remain"

    @property
    def one_process(self) -> str:
        """What starts no other process."""
        return "jobs=1" if self.is_python else "--jobs 1"

    @property
    def certificates(self) -> str:
        """What names the files of TLS."""
        if self.is_python:
            return "security={'tls_ca_file': FILE, 'tls_client_cert': FILE, 'tls_client_key': FILE}"
        return "--tls-ca FILE --tls-cert FILE --tls-key FILE"

    @property
    def forms(self) -> str:
        """What varies parameters, and how it is written."""
        if self.is_python:
            return "grid takes values by parameter, such as {'reach': '0.4m:1m:20'} or {'reach': [0.4, 1.0]}"
        return "--set takes NAME=START:STOP:COUNT, such as reach=0.4m:1m:20, or NAME=VALUE,VALUE,…"

    def varied(self, name: str, values: str) -> str:
        """Return what varies a parameter."""
        return f"grid={{'{name}': '{values}'}}" if self.is_python else f"--set {name}={values}"

    def fixed(self, name: str) -> str:
        """Return what sets a parameter of all robots."""
        return f"parameters={{'{name}': VALUE}}" if self.is_python else f"-p {name}=VALUE"

    def source(self, option: str) -> tuple[str, str]:
        """Return the name of the text of an option as a source, and what precedes it there."""
        return (
            (f"<{'grid' if option == 'set' else option}>", "") if self.is_python else ("<command line>", f"--{option} ")
        )
