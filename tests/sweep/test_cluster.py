"""Sweeps on processes of Dask, which see the client's files only as it sends them."""

import importlib
import os
import re
import signal
from collections.abc import Iterator
from contextlib import nullcontext
from pathlib import Path
from threading import Lock
from typing import Any

import distributed
import pytest

from linkforge_compile._version import __version__
from linkforge_compile.sweep import SweepError, connection, run, scheduler, session
from linkforge_compile.sweep.bundle import Bundle, Files, Tree
from linkforge_compile.sweep.connection import cluster, require_same_versions
from linkforge_compile.sweep.place import Place
from linkforge_compile.sweep.plan import Choice, Plan, plan_of
from linkforge_compile.sweep.points import Point
from linkforge_compile.sweep.session import Judge, collect_files, results_of, with_files_of
from linkforge_compile.sweep.store import Chunk, chunks_of
from linkforge_compile.sweep.wording import Wording
from linkforge_compile.sweep.work import Made, Request, make, make_all
from tests.conftest import ROOT
from tests.meshes import block
from tests.sweep.specs import write_arm

EXAMPLES = sorted((ROOT / "examples").rglob("*.robot.yaml"))


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    """Two processes of Dask."""
    with cluster(Place(2), Wording()) as connected:
        yield connected


def results(plan: Plan, client: Any) -> Iterator[tuple[Chunk, list[Made]]]:
    """Yield what the processes make of the chunks of a plan."""
    for chunk, made, _ in results_of(plan, collect_files(plan), client, chunks_of(plan.size, plan.chunk)):
        yield chunk, made


def rows(made: list[tuple[Chunk, list[Made]]]) -> list[dict[str, object]]:
    return [one.row for _, part in sorted(made) for one in part]


def test_a_killed_worker_loses_nothing(client: Any, tmp_path: Path):
    """One of two is killed while both work; what it was computing is computed by the other, or by its successor."""
    plan = plan_of(Request(str(write_arm(tmp_path)), "arm"), Choice(sample=60, seed=4, chunk=3))
    workers = set(client.run(os.getpid).values())
    assert len(workers) == 2
    made: list[tuple[Chunk, list[Made]]] = []
    for number, (chunk, part) in enumerate(results(plan, client)):
        made.append((chunk, part))
        if number == 3:
            os.kill(min(workers), signal.SIGKILL)
    assert [chunk for chunk, _ in sorted(made)] == list(chunks_of(60, 3))
    undisturbed = make_all(plan.request, plan.points_of(Chunk(0, 60)))
    assert rows(made) == [one.row for one in undisturbed]
    assert [one.files for _, part in sorted(made) for one in part] == [one.files for one in undisturbed]
    assert min(workers) not in client.run(os.getpid).values()


def write_family(folder: Path) -> Path:
    """Write an arm whose parameter chooses its tool in another package, with a mesh and a table of numbers."""
    package = folder / "tools"
    (package / "meshes").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>tools</name></package>")
    (folder / "arms/data").mkdir(parents=True)
    (folder / "arms/package.xml").write_text("<package><name>arms</name></package>")
    for size, tool in enumerate(("hand", "hook"), 1):
        block(0.1 * size, 0.1, 0.1).export(package / f"meshes/{tool}.stl")
        (package / f"{tool}.robot.yaml").write_text(
            f"linkforge: 1\nname: {tool}\nlinks:\n  palm:\n    visual: {{mesh: package://tools/meshes/{tool}.stl}}\n"
            "    collision: visual\n    inertial: {density: 1000 kg/m^3}\n"
        )
        (folder / f"arms/data/{tool}.yaml").write_text(f"length: {size} m\n")
    spec = folder / "arms/arm.robot.yaml"
    spec.write_text(
        "linkforge: 1\nname: arm\nparameters: {tool: hand}\ndata: {numbers: data/$(tool).yaml}\nlinks: {base: {}}\n"
        "modules: {tool: {use: 'package://tools/$(tool).robot.yaml', parent: base, "
        "origin: [0, 0, $(numbers.length)]}}\n"
    )
    return spec


def test_workers_get_the_files_that_a_value_leads_to(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """What is compiled first reads the files of one tool only; a third tool exists nowhere."""
    spec = write_family(tmp_path)
    monkeypatch.chdir(tmp_path)
    request = Request(str(spec.relative_to(tmp_path)), "arm", packages={"tools": str(tmp_path / "tools")})
    plan = plan_of(request, Choice(("tool=hand,hook,hok",), chunk=1))
    made = dict(results(plan, client))
    here = make_all(plan.request, plan.points_of(Chunk(0, 3)))
    assert rows(list(made.items())) == [one.row for one in here]
    assert [bool(one.row["errors"]) for one in here] == [False, False, True]
    assert "hook.robot.yaml" in str(here[2].row["diagnostics"])


def test_a_tree_lies_elsewhere_and_nothing_else_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """The client's folder is gone before the tree is compiled."""
    spec = write_family(tmp_path / "client")
    monkeypatch.chdir(tmp_path / "client")
    request = Request("arms/arm.robot.yaml", "arm", packages={"tools": str(tmp_path / "client/tools")})
    plan = plan_of(request, Choice(("tool=hand,hand",)))
    here = make_all(plan.request, plan.points_of(Chunk(0, 2)))
    files = collect_files(plan)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "client").rename(tmp_path / "gone")
    tree = Tree(tmp_path / "tree", files.bundle, files.blobs)
    there = make_all(plan.request, plan.points_of(Chunk(0, 2)), tree)
    assert [(one.row, one.files) for one in there] == [(one.row, one.files) for one in here]
    assert Path.cwd() == tmp_path
    assert not spec.exists()


def test_all_files_that_a_chunk_lacks_are_sent_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Of two points that lack the same mesh, one is compiled here."""
    for size in range(1, 5):
        block(0.1 * size, 0.1, 0.1).export(tmp_path / f"{size}.stl")
    (tmp_path / "arm.robot.yaml").write_text(
        "linkforge: 1\nname: arm\nparameters: {size: 1}\nlinks:\n"
        "  base: {visual: {mesh: $(size).stl}, inertial: {mass: 1, inertia: {ixx: 1, iyy: 1, izz: 1}}}\n"
    )
    monkeypatch.chdir(tmp_path)
    plan = plan_of(Request("arm.robot.yaml", "arm"), Choice(("size=1,2,2,3,4",)))
    points, files, compiled = plan.points_of(Chunk(0, 5)), collect_files(plan), []

    def counted(request: Request, point: Point, some: Files) -> Files:
        compiled.append(point.index)
        return with_files_of(request, point, some)

    monkeypatch.setattr("linkforge_compile.sweep.session.with_files_of", counted)
    made = make_all(plan.request, points, Tree(tmp_path / "tree", files.bundle, files.blobs))
    grown = Judge(plan, files.blobs).grow(made, files.bundle)
    assert compiled == [1, 3, 4]
    there = make_all(plan.request, points, Tree(tmp_path / "grown", grown, files.blobs))
    assert [one.row for one in there] == [one.row for one in make_all(plan.request, points)]


def test_a_tree_grows_by_the_files_that_it_lacks(tmp_path: Path):
    names, files = [tmp_path / "a.yaml", tmp_path / "b.yaml"], Files(Bundle(str(tmp_path), {}), {})
    for name in names:
        name.write_text(f"{name.stem}: 1\n")
    first, second = files.with_paths(names[:1]), files.with_paths(names)
    tree = Tree(tmp_path / "tree", first.bundle, first.blobs)
    before = Path(tree.place(str(names[0]))).stat()
    tree.add(second.bundle, {second.bundle.files[str(names[1])]: b"b: 1\n"})  # all that it needs
    assert Path(tree.place(str(names[0]))).stat() == before
    assert Path(tree.place(str(names[1]))).read_bytes() == b"b: 1\n"


def test_a_file_that_arrives_changed_is_an_error(tmp_path: Path):
    path = tmp_path / "a.yaml"
    path.write_text("a: 1\n")
    bundle, blobs = Files(Bundle(str(tmp_path), {}), {}).with_paths([path])
    with pytest.raises(SweepError, match="a file arrived changed"):
        Tree(tmp_path / "tree", bundle, dict.fromkeys(blobs, b"a: 2\n"))


def test_a_worker_keeps_the_trees_of_two_sweeps(client: Any, tmp_path: Path):
    """Of three, each of which needs another file in its second chunk."""

    def count_trees(dask_worker: Any) -> int:
        return len(list(Path(dask_worker.local_directory).glob("linkforge-*")))

    spec = write_family(tmp_path)
    plan = plan_of(
        Request(str(spec), "arm", packages={"tools": str(tmp_path / "tools")}), Choice(("tool=hand,hook",), chunk=1)
    )
    for _ in range(3):
        assert [one.row["errors"] for _, made in results(plan, client) for one in made] == [0, 0]
    assert max(client.run(count_trees).values()) <= 2


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_an_example_is_the_same_in_a_tree(example: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Its modules, data, meshes and vendors' files reach the tree, and nothing names the tree."""
    monkeypatch.chdir(example.parent)
    request, point = Request(example.name, "robot"), Point(0, {})
    here = make(request, point)
    files = with_files_of(request, point, Files(Bundle.of_here(), {}))
    tree = Tree(tmp_path / "tree", files.bundle, files.blobs)
    (there,) = make_all(request, [point], tree)
    assert (there.row, there.files) == (here.row, here.files)
    assert here.row["errors"] == 0


def test_files_travel_by_their_digest(tmp_path: Path):
    path = tmp_path / "a.yaml"
    path.write_text("a: 1\n")
    files = Files(Bundle(str(tmp_path), {}), {}).with_paths([path, tmp_path / "none.yaml"])
    assert (len(files.bundle.files), list(files.blobs.values())) == (1, [b"a: 1\n"])
    assert files.with_paths([path]) is files


def test_a_function_runs_on_workers(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """A closure travels; what it raises is a diagnostic of one robot."""
    factor = 2.0

    def score(robot, values):
        if values["fingers"] == 3:
            raise ZeroDivisionError("no third finger")
        return {"links": len(robot.links), "double": factor * values["reach"]}

    spec = write_arm(tmp_path)
    here = run(spec, {"reach": [0.5, 1.0], "fingers": "2,3"}, score)
    monkeypatch.setattr(session, "cluster", lambda *_: nullcontext(client))
    there = run(spec, {"reach": [0.5, 1.0], "fingers": "2,3"}, score, jobs=2)
    assert there.equals(here)
    assert here["double"].to_pylist() == [1.0, None, 2.0, None]
    assert here["links"].to_pylist() == [4, None, 4, None]
    message = r"the function raised ZeroDivisionError in line \d+, in score: no third finger"
    assert re.search(message, here["diagnostics"].to_pylist()[1])


def test_a_scheduler_that_is_not_there_is_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(connection, "CONNECTING", 0.5)
    with pytest.raises(
        SweepError, match=r"at 'tcp://127\.0\.0\.1:1': (no program listens there|it does not answer within 0\.5 s)"
    ):
        run(write_arm(tmp_path), {"reach": [0.5, 1.0]}, scheduler="tcp://127.0.0.1:1")


def test_a_worker_with_another_version_is_refused(client: Any, monkeypatch: pytest.MonkeyPatch):
    def get_versions(packages: list[str]) -> dict[str, Any]:
        found = real(packages=packages)
        one, other = (about["packages"] for about in found["workers"].values())
        one["linkforge_compile"], other["python"] = None, "3.9.1.final.0"
        found["scheduler"]["packages"]["cloudpickle"] = "2.0.0"
        return found

    client.wait_for_workers(2)  # after the test that kills one
    real = client.get_versions
    require_same_versions(client)
    monkeypatch.setattr(client, "get_versions", get_versions)
    with pytest.raises(SweepError) as caught:
        require_same_versions(client)
    first, *lines = caught.value.message.splitlines()
    assert first == "the cluster has other versions than this machine; install the same:"
    expected = [
        r"  cloudpickle 2\.0\.0, here \S+: scheduler",
        rf"  linkforge-compile is missing, here {re.escape(__version__)}: worker tls://\S+",
        r"  Python 3\.9, here 3\.\d+: worker tls://\S+",
    ]
    assert all(re.fullmatch(pattern, line) for pattern, line in zip(expected, lines, strict=True)), lines


def test_a_function_whose_module_a_worker_lacks_is_an_error(
    client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """The scheduler does not read it, so it needs none of its modules."""
    (tmp_path / "legs_of_mine.py").write_text("def score(robot, values):\n    return 1\n")
    monkeypatch.syspath_prepend(tmp_path)
    module = importlib.import_module("legs_of_mine")
    monkeypatch.setattr(session, "cluster", lambda *_: nullcontext(client))
    with pytest.raises(SweepError, match="a worker lacks what your function needs: No module named 'legs_of_mine'"):
        run(write_arm(tmp_path), {"reach": [0.5, 1.0]}, module.score, jobs=2)


def test_a_worker_that_comes_later_has_the_same_version(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(scheduler, "__version__", "0.0.1")
    monkeypatch.setattr(session, "cluster", lambda *_: nullcontext(client))
    message = f"a worker has linkforge-compile {__version__}, and the sweep was begun with 0.0.1"
    with pytest.raises(SweepError, match=re.escape(message)):
        run(write_arm(tmp_path), {"reach": [0.5, 1.0]}, jobs=2)


def test_a_lost_scheduler_is_an_error(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """As Dask reports it: each task is cancelled."""
    monkeypatch.setattr(session, "cluster", lambda *_: nullcontext(client))
    monkeypatch.setattr(distributed.Future, "result", lambda self: self.cancel() or self.client.sync(self._result))
    spec, lost = write_arm(tmp_path), "the connection to the scheduler was lost"
    with pytest.raises(SweepError, match=f"{lost}; resume=True continues"):
        run(spec, {"reach": [0.5, 1.0]}, jobs=2, output=tmp_path / "out")
    with pytest.raises(SweepError, match=f"{lost}; start again; with output=FOLDER"):
        run(spec, {"reach": [0.5, 1.0]}, jobs=2)


def test_a_function_that_cannot_be_sent_is_an_error(client: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    lock = Lock()
    monkeypatch.setattr(session, "cluster", lambda *_: nullcontext(client))
    with pytest.raises(SweepError, match=r"the function cannot be sent to other processes: .*lock"):
        run(write_arm(tmp_path), {"reach": [0.5, 1.0]}, lambda _robot, _values: lock.locked(), jobs=2)


@pytest.mark.parametrize(
    ("address", "files", "message"),
    [
        ("tls://127.0.0.1:1", {}, "needs the certificate of your authority, your own, and your key: --tls-ca FILE"),
        ("tls://127.0.0.1:1", {"tls_ca_file": "none.pem"}, "cannot read 'none.pem': No such file or directory"),
        ("tcp://127.0.0.1:1", {"tls_ca_file": "none.pem"}, "is an address without TLS; write tls://"),
        ("127.0.0.1", {}, "cannot connect to a scheduler at '127.0.0.1': missing port number"),
    ],
)
def test_a_scheduler_needs_an_address_and_its_certificates(address: str, files: dict[str, str], message: str):
    with pytest.raises(SweepError, match=re.escape(message)), cluster(Place(1, address, files), Wording()):
        pass


def test_points_travel_as_they_are():
    import pickle

    point = Point(3, {"reach": "0.4 m"}, "sim")
    assert pickle.loads(pickle.dumps(point)) == point
