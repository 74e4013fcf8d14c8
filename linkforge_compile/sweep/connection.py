"""Connect to a scheduler of Dask, or start one with processes on this machine."""

from __future__ import annotations

import logging
import ssl
import warnings
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from linkforge_compile.sweep.arrow import distributed
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.place import Place
from linkforge_compile.sweep.wording import Wording

RETRIES = 10
"""How many workers may be lost with one chunk before it is given up."""

CONNECTING = 10.0
"""How long a scheduler may take to answer [s]."""

_WAITING_FOR_WORKERS = 30.0
"""How long a cluster may have no worker [s]."""

_CONFIGURATION = {
    "distributed.scheduler.allowed-failures": RETRIES,
    # Dask keeps so many messages for its developers, and with them the points of as many chunks.
    "distributed.admin.low-level-log-length": 100,
    # Dask watches its processes for its dashboard, which takes a tenth of a core with two workers.
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.system-monitor.interval": "10s",
}
"""The settings of Dask for this process and those that it starts."""

_PACKAGES = ("linkforge_compile", "cloudpickle", "distributed")
"""What must have the same version in all processes: robots depend on the first, messages on the others."""


def usable_processors(words: Wording) -> int:
    """Return how many processors this process may use, by its affinity and the quota of its container."""
    distributed(_instead(words))
    from dask.system import cpu_count

    count: int = cpu_count()
    return count


def _instead(words: Wording) -> str:
    return f", or use one process: {words.one_process}"


@contextmanager
def cluster(place: Place, words: Wording) -> Iterator[Any]:
    """Connect to a scheduler, or start one with processes of one thread each on this machine.

    Raises:
        SweepError: if there is no scheduler at the address, or it has no workers, or other versions, or no process can
            be started.

    """
    distributed(_instead(words))
    import dask
    from distributed.utils import silence_logging_cmgr as silent

    with dask.config.set(_CONFIGURATION):
        if place.scheduler is None:
            with _local(place.jobs, words) as client:
                yield client
        else:
            with silent(logging.CRITICAL), _connected(place.scheduler, place.security, words) as client:
                require_same_versions(client)
                yield client


@contextmanager
def _local(jobs: int, words: Wording) -> Iterator[Any]:
    library = distributed()
    try:
        # Only this user can connect, by a certificate as old as the cluster, and only from this machine.
        local = library.LocalCluster(
            n_workers=jobs,
            threads_per_worker=1,
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            scheduler_kwargs={"dashboard": False},
            security=library.Security.temporary(),
            silence_logs=logging.CRITICAL,
        )
    except RuntimeError as error:
        way = "a script must call run() below `if __name__ == '__main__':`, or use " if words.is_python else "use "
        text = f"no process can be started: {str(error).rstrip('.')}; {way}{words.one_process}"
        raise SweepError(text) from None  # Dask's own tracebacks are long, and each process prints them
    with local, library.Client(local, set_as_default=False) as client:
        yield client


def _connected(address: str, security: Mapping[str, str], words: Wording) -> Any:
    library, tls = distributed(), _security(address, security, words)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", library.versions.VersionMismatchWarning)  # require_same_versions checks
            client = library.Client(address, set_as_default=False, security=tls, timeout=CONNECTING)
    except (OSError, ValueError, ImportError, TypeError, RuntimeError) as error:
        raise SweepError(f"cannot connect to a scheduler at '{address}': {_reason(error, address)}") from error
    try:
        client.wait_for_workers(1, timeout=_WAITING_FOR_WORKERS)
    except TimeoutError as error:
        client.close()
        raise SweepError(f"the scheduler at '{address}' has no workers; start some: dask worker {address}") from error
    return client


def _security(address: str, files: Mapping[str, str], words: Wording) -> Any:
    """Return the settings of TLS: the files, or else those of Dask's own configuration."""
    is_encrypted = address.startswith("tls://")
    if files and not is_encrypted:
        raise SweepError(f"'{address}' is an address without TLS; write tls://…, or leave out the certificates and key")
    for file in files.values():
        try:
            Path(file).read_bytes()
        except OSError as error:
            raise SweepError(f"cannot read '{file}': {error.strerror}") from error
    security = distributed().Security(require_encryption=is_encrypted or None, **files)
    if is_encrypted and not (security.tls_ca_file and security.tls_client_cert and security.tls_client_key):
        raise SweepError(
            f"'{address}' needs the certificate of your authority, your own, and your key: {words.certificates}"
        )
    return security


def _reason(error: BaseException, address: str) -> str:
    """Return why there is no connection; Dask's own words name sockets and its documentation."""
    while error.__cause__ is not None:
        inner = error.__cause__
        if isinstance(inner, ConnectionRefusedError):
            return "no program listens there"
        if isinstance(inner, ssl.SSLCertVerificationError):
            return f"its certificate is not valid for your authority ({inner.verify_message})"
        error = inner
    if isinstance(error, ssl.SSLError) and error.reason and error.reason.startswith(("KEY", "NO_")):
        return f"the certificates and the key cannot be used ({error.reason.replace('_', ' ').lower()})"
    if isinstance(error, ssl.SSLError) or "SSL" in str(error):
        return "it has no TLS (tcp://…), or does not accept your certificate"
    if isinstance(error, ConnectionResetError) and not address.startswith("tls://"):
        return "it closed the connection; with TLS, its address begins with tls://"
    text = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
    return text or f"it does not answer within {CONNECTING:g} s"


def require_same_versions(client: Any) -> None:
    """Refuse a cluster whose scheduler or workers have other versions than this process; SweepError says who."""
    found = client.get_versions(packages=["linkforge_compile"])
    ours = _versions(found["client"])
    theirs = {"scheduler": found["scheduler"]} | {f"worker {name}": one for name, one in found["workers"].items()}
    processes: dict[str, list[str]] = {}
    for process, about in theirs.items():
        versions = _versions(about)
        for name, version in versions.items():
            if version != ours[name]:
                processes.setdefault(
                    f"{name.replace('_', '-')} {version or 'is missing'}, here {ours[name]}", []
                ).append(process)
    if processes:
        lines = [f"  {text}: {_some(names)}" for text, names in processes.items()]
        raise SweepError("\n".join(("the cluster has other versions than this machine; install the same:", *lines)))


def _versions(about: Mapping[str, Any]) -> dict[str, str | None]:
    """Return the versions that must agree, of what `Client.get_versions` has of a process."""
    packages = about["packages"]
    return {"Python": ".".join(packages["python"].split(".")[:2])} | {name: packages.get(name) for name in _PACKAGES}


def _some(names: list[str]) -> str:
    return ", ".join(names if len(names) <= 3 else (*names[:3], f"{len(names) - 3} more"))
