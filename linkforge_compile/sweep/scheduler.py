"""Run chunks on the workers of a cluster."""

from __future__ import annotations

import gc
import shutil
import warnings
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from functools import lru_cache
from pathlib import Path
from typing import Any
from uuid import uuid4

from linkforge_compile._version import __version__
from linkforge_compile.expand.module_cache import ModuleCache
from linkforge_compile.roots import exists
from linkforge_compile.sweep.arrow import distributed
from linkforge_compile.sweep.bundle import Bundle, Files, Tree
from linkforge_compile.sweep.connection import RETRIES, require_same_versions
from linkforge_compile.sweep.errors import SweepError
from linkforge_compile.sweep.points import Point
from linkforge_compile.sweep.store import Chunk
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.sweep.work import Made, Request, make_all

_PATIENCE = 60
"""How long no worker may be there while chunks wait for one [s]."""

_IN_FLIGHT = 3
"""Chunks that are sent for each process: one is computed, one waits, and one is on its way back."""

PointsOf = Callable[[Chunk], list[Point]]
"""Returns the points of a chunk that are to be compiled."""

Grow = Callable[[list[Made], Bundle], Bundle]
"""Returns the bundle with the files that compiled points lack, the same one if there are none."""

Job = tuple[Request, Bundle, str, str]
"""What is compiled, the files, the version that does, and a name of the sweep that no other one has."""


class Cluster:
    """Sends chunks to the workers of a client, with the files that they need, and collects what they make."""

    def __init__(self, client: Any, request: Request, files: Files, grow: Grow, words: Wording) -> None:
        self._client, self._request, self._grow, self._words = client, request, grow, words
        self._sweep = uuid4().hex
        self.bundle, self._blobs = files
        """The files on which all depends that was yielded so far, and what came with them."""
        self._sent: set[str] = set()
        self._setups: list[Any] = []
        self._send_setup()

    def _send_setup(self) -> None:
        """Send what the workers do not have yet, as tasks, whose results a lost worker does not take along."""
        new = {digest: self._blobs[digest] for digest in set(self.bundle.files.values()) - self._sent}
        self._sent |= set(new)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", message="Sending large graph")
            self._setups.append(self._client.submit(_as_it_is, new, pure=False))
            job = _pickled((self._request, self.bundle, __version__, self._sweep))
            self._job = self._client.submit(_as_it_is, job, pure=False)

    def run(self, chunks: Iterable[Chunk], points_of: PointsOf) -> Iterator[tuple[Chunk, list[Made]]]:
        """Yield each chunk with what was made of it, in the order in which they are done.

        Only some chunks are sent at a time, so that neither side keeps many robots in memory.
        """
        waiting, sent = iter(chunks), dict[Any, tuple[Chunk, list[Point], Bundle]]()

        def send(chunk: Chunk, points: list[Point]) -> None:
            future = self._client.submit(_work, self._job, self._setups, points, pure=False, retries=RETRIES)
            sent[future] = chunk, points, self.bundle

        def send_next() -> None:
            if chunk := next(waiting, None):
                send(chunk, points_of(chunk))

        for _ in range(_IN_FLIGHT * max(1, len(self._client.scheduler_info(n_workers=-1)["workers"]))):
            send_next()
        while sent:
            future = self._next_of(sent)
            chunk, points, bundle = sent.pop(future)
            made = self._result(future, points)
            del future  # or the cluster keeps its result
            if self._lacks_files(made, bundle):
                send(chunk, points)
                continue
            send_next()
            yield chunk, made

    def _next_of(self, futures: Iterable[Any]) -> Any:
        """Return the next future that is done; SweepError if nothing computes any."""
        while True:
            try:
                with self._client.as_current():
                    return distributed().wait([*futures], _PATIENCE, "FIRST_COMPLETED").done.pop()
            except CancelledError as error:
                raise self._lost() from error
            except TimeoutError as error:
                if not self._client.scheduler_info(n_workers=-1)["workers"]:
                    problem = f"all workers were lost, and none came back within {_PATIENCE} s"
                    raise SweepError(f"{problem}; {self._words.continuing}") from error

    def _lost(self) -> SweepError:
        return SweepError(f"the connection to the scheduler was lost; {self._words.continuing}")

    def _result(self, future: Any, points: Sequence[Point]) -> list[Made]:
        from distributed.scheduler import KilledWorker

        try:
            result: list[Made] = future.result()
        except KilledWorker as error:
            lost, first = error.allowed_failures + 1, " ".join(points[0].words)
            robots = f"the same {len(points)} robots, from '{first}' on" if len(points) > 1 else f"the robot '{first}'"
            reasons = "does one need too much memory, or does your function end its process?"
            raise SweepError(f"{lost} workers were lost with {robots}; {reasons}") from error
        except CancelledError as error:
            raise self._lost() from error
        except SweepError:
            raise
        except Exception as error:
            require_same_versions(self._client)  # of workers that came after the first chunks
            if isinstance(error, ImportError | AttributeError):
                raise SweepError(f"a worker lacks what your function needs: {error}") from error
            raise
        return result

    def _lacks_files(self, made: list[Made], bundle: Bundle) -> bool:
        """Whether points lacked files that the client has, which are in the bundle by now."""
        if not any(one.is_about_files for one in made):
            return False
        grown = self._grow(made, self.bundle)
        if grown is not self.bundle:
            self.bundle = grown
            self._send_setup()
        return self.bundle is not bundle


def _as_it_is(value: object) -> object:
    return value


def _pickled(job: Job) -> bytes:
    """Return a job as the scheduler passes it on, unread: it may lack the modules of the function."""
    import cloudpickle

    try:
        pickled: bytes = cloudpickle.dumps(job)
    except Exception as error:  # the objects that the function refers to may raise anything
        raise SweepError(f"the function cannot be sent to other processes: {error}") from error
    return pickled


# In a worker

_trees: dict[str, Tree] = {}
"""The trees of this process, by the name of their sweep."""

_TREES = 2
"""How many sweeps have a tree, so that the disk of a cluster does not fill."""


def _work(job: bytes, blobs: Sequence[Mapping[str, bytes]], points: list[Point]) -> list[Made]:
    """Compile points in a tree of the client's files."""
    (request, bundle, version, sweep), cache = _loaded(job)
    if version != __version__:
        raise SweepError(f"a worker has linkforge-compile {__version__}, and the sweep was begun with {version}")
    return make_all(request, points, _tree_of(sweep, bundle, blobs), cache)


@lru_cache(maxsize=2)
def _loaded(job: bytes) -> tuple[Job, ModuleCache]:
    """Return a job, and the cache of its modules in this process."""
    import cloudpickle

    loaded: Job = cloudpickle.loads(job)
    return loaded, loaded[0].new_cache()


def _tree_of(sweep: str, bundle: Bundle, blobs: Sequence[Mapping[str, bytes]]) -> Tree:
    """Return the tree of a sweep, which has all files of a bundle."""
    contents = {digest: content for part in blobs for digest, content in part.items()}
    if sweep not in _trees or not exists(Path(_trees[sweep].top)):
        # As in the command itself: looking for cyclic garbage after each robot takes an eighth of the time.
        gc.set_threshold(100_000, 50)
        while len(_trees) >= _TREES:
            shutil.rmtree(_trees.pop(next(iter(_trees))).top, ignore_errors=True)
        # A worker removes its folder when it ends, and those of workers that were killed.
        folder = Path(distributed().get_worker().local_directory, f"linkforge-{sweep}")
        _trees[sweep] = Tree(folder, bundle, contents)
    _trees[sweep].add(bundle, contents)
    return _trees[sweep]
