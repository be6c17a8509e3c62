"""Sweeps: the table, its file, several processes, and what goes wrong."""

import importlib.util
import inspect
import itertools
import math
import os
import re
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
from test_files import letter, png

import fuwafuwa as fw

pa = pytest.importorskip("pyarrow", reason="pyarrow is not installed: pip install fuwafuwa[sweep]")
pq = pytest.importorskip("pyarrow.parquet")

needs_ray = pytest.mark.skipif(importlib.util.find_spec("ray") is None, reason="ray is not installed")

SCENE = """
dim = 2
sleep = false

[[material]]
unbreakable = true

[[body]]
shape = "ball"
n = 10
at = [0.0, 0.05, 0.0]

[[obstacle]]
half_space = { normal = [0.0, 1.0, 0.0], point = [0.0, 0.0, 0.0] }
"""

GRID = {"material.young": np.geomspace(1e3, 1e5, 3), "speed": [0, -2.5]}


def impact(world, speed):
    """Throw the ball to the floor and return how low its centre comes [m]."""
    (ball,) = world.soft_bodies
    world.set_velocity(ball, (0, speed))
    lowest = math.inf
    for _ in range(12):
        world.step()
        lowest = min(lowest, float(world[ball].positions[:, 1].mean()))
    return {
        "lowest": lowest,
        "hash": world.hash(),
        "rebound": math.nan if speed == 0 else float(world[ball].velocities[:, 1].mean()),
        "touched": None if lowest > 0.55 else "floor",
    }


def same(first, second):
    """Return whether two tables are equal, NaN included."""
    if first.schema != second.schema or first.num_rows != second.num_rows:
        return False
    return repr(first.to_pylist()) == repr(second.to_pylist())


class Calls:
    """Calls of a measurement, counted by lines in files, whatever the process."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir()

    def note(self, name):
        """Append the number of this process to the file of a row."""
        with open(self.folder / str(name), "a", encoding="utf-8") as file:
            file.write(f"{os.getpid()}\n")

    def count(self):
        """Return the number of calls of each row."""
        return {path.name: len(self.processes(path.name)) for path in self.folder.iterdir()}

    def processes(self, name):
        """Return the processes that called a row, in the order of the calls."""
        path = self.folder / str(name)
        return [int(line) for line in path.read_text(encoding="utf-8").split()] if path.exists() else []


@pytest.fixture
def calls(tmp_path):
    """Counter of calls."""
    return Calls(tmp_path / "calls")


@pytest.fixture(scope="module")
def serial():
    """Table of the grid, computed in this process."""
    return fw.sweep(SCENE, GRID, impact, workers=1, progress=False)


# The table.


def test_table_has_the_values_of_worlds_that_were_built_one_by_one(serial):
    rows = []
    for young, speed in itertools.product([1e3, 1e4, 1e5], [0, -2.5]):
        world = fw.Scene.from_text(SCENE, [f"material.young={young}"]).build()
        rows.append({"material.young": young, "speed": speed, **impact(world, speed)})
    found = serial.to_pylist()
    assert [row["hash"] for row in found] == [row["hash"] for row in rows]
    assert len({row["hash"] for row in found}) == 6
    assert [list(row) for row in found] == [list(row) for row in rows]
    for row, expected in zip(found, rows, strict=True):
        assert repr(row["lowest"]) == repr(expected["lowest"])
        assert row["touched"] == expected["touched"]
        assert row["material.young"] == pytest.approx(expected["material.young"], rel=1e-12)


def test_falling_ball_has_the_speed_of_free_fall():
    gravities = [[0.0, -1.6, 0.0], [0.0, -9.81, 0.0]]

    def fall(world, seconds):
        (ball,) = world.soft_bodies
        world.translate(ball, (0, 20))
        world.step(round(60 * seconds))
        return {"speed": world[ball].velocities[:, 1].mean()}

    table = fw.sweep(SCENE, {"gravity": gravities, "seconds": [0.5, 1.0]}, fall, progress=False)
    assert table["gravity"].to_pylist() == [gravities[0]] * 2 + [gravities[1]] * 2
    expected = [gravity[1] * seconds for gravity in gravities for seconds in (0.5, 1.0)]
    np.testing.assert_allclose(table["speed"].to_numpy(), expected, rtol=5e-5)


def test_rows_may_be_given_one_by_one(serial):
    rows = [{"speed": row["speed"], "material.young": row["material.young"]} for row in serial.to_pylist()[::-1]]
    rows[3] = dict(reversed(rows[3].items()))
    table = fw.sweep(SCENE, rows, impact, progress=False)
    assert table.column_names[:2] == ["speed", "material.young"]
    assert table["hash"].to_pylist() == serial["hash"].to_pylist()[::-1]


def test_scene_may_be_a_name_a_path_a_text_a_scene_or_a_function(tmp_path):
    path = tmp_path / "ball.toml"
    path.write_text(SCENE, encoding="utf-8")

    def build(young):
        return fw.Scene.from_text(SCENE, [f"material.young={young}"]).build()

    def hashes(world):
        world.step(3)
        return {"hash": world.hash()}

    tables = [
        fw.sweep(scene, {"material.young": [2e3, 3e3]}, hashes, progress=False)
        for scene in (SCENE, path, str(path), fw.Scene.read(path))
    ]
    tables.append(fw.sweep(build, {"young": [2e3, 3e3]}, hashes, progress=False))
    assert [table["hash"].to_pylist() for table in tables[1:]] == [tables[0]["hash"].to_pylist()] * 4
    found = fw.sweep("drop", {"gravity": [[0, -5, 0]]}, hashes, progress=False)["hash"].to_pylist()
    world = fw.Scene.read("drop", ["gravity=[0.0, -5.0, 0.0]"]).build()
    world.step(3)
    assert found == [world.hash()]


def test_measure_receives_the_scene_with_its_hands():
    def push(world, scene):
        split = 0
        for tick in range(scene.ticks):
            scene.set_hand_targets(world, tick)
            split += world.step().nodes_split
        return {"ticks": scene.ticks, "split": split}

    table = fw.sweep(
        "tear", {"body.n": 16, "seconds": [0.25, 2], "material.strength": [3e3, 1e9]}, push, progress=False
    )
    assert table["ticks"].to_pylist() == [15, 15, 120, 120]
    untouched, strong, torn, whole = table["split"].to_pylist()
    assert untouched == strong == whole == 0 < torn


def test_measure_that_takes_all_parameters_receives_those_of_the_scene():
    table = fw.sweep(
        SCENE, {"material.young": [2e3], "drag": [0.5, 1]}, lambda world, **given: {"sum": sum(given.values())}
    )
    assert table["sum"].to_pylist() == [2000.5, 2001.0]


def test_values_keep_their_types_in_table_and_file(tmp_path):
    values = {
        "float": [1.5, math.nan, None, -math.inf],
        "mixed": [1, 2.5, None, 3],
        "whole": [1, -(2**63), None, 2**63 - 1],
        "hash": [2**64 - 1, 0, None, 1],
        "text": ["", 'ä "\n', None, "nan"],
        "flag": [True, False, None, True],
        "none": [None] * 4,
        "numpy": [np.float32(0.1), np.float64(0.2), np.array(0.3), np.array([0.4])],
        "numpy_flag": [np.bool_(True), np.bool_(False), None, True],
    }
    path = tmp_path / "types.parquet"

    def measure(world, i):
        if i == 3 and not (tmp_path / "go").exists():
            raise RuntimeError("stop")
        return {name: column[i] for name, column in values.items()}

    with pytest.raises(fw.SweepError, match="stop"):
        fw.sweep(SCENE, {"i": range(4)}, measure, results=path, progress=False)
    (tmp_path / "go").touch()
    resumed = fw.sweep(SCENE, {"i": range(4)}, measure, results=path, progress=False)
    whole = fw.sweep(SCENE, {"i": range(4)}, measure, progress=False)
    assert same(resumed, whole) and same(pq.read_table(path).replace_schema_metadata(None), whole)
    kinds = ["int64", "double", "double", "int64", "uint64", "string", "bool", "null", "double", "bool"]
    assert [str(kind) for kind in whole.schema.types] == kinds
    for name in ("float", "whole", "hash", "text", "flag", "none"):
        assert repr(whole[name].to_pylist()) == repr(values[name])
    assert repr(whole["mixed"].to_pylist()) == "[1.0, 2.5, None, 3.0]"
    assert whole["numpy"].to_pylist() == [float(np.float32(0.1)), 0.2, 0.3, 0.4]


def test_table_becomes_a_data_frame(serial):
    pytest.importorskip("pandas", reason="pandas is not installed")
    frame = serial.to_pandas()
    assert list(frame.columns) == ["material.young", "speed", "lowest", "hash", "rebound", "touched"]
    assert frame["rebound"].isna().tolist() == [True, False] * 3


# Several processes.


@needs_ray
def test_two_workers_give_the_table_of_one(serial, tmp_path):
    names = ["PYTHONPATH", "RAY_USAGE_STATS_ENABLED"]
    before = [os.environ.get(name) for name in names]
    path = tmp_path / "two.parquet"
    table = fw.sweep(SCENE, GRID, impact, workers=2, results=path, progress=False)
    assert same(table, serial)
    assert same(fw.sweep(SCENE, GRID, impact, workers=1, results=path, progress=False), serial)
    assert [os.environ.get(name) for name in names] == before

    import ray

    assert not ray.is_initialized()


@needs_ray
def test_worker_that_is_killed_is_replaced_and_its_row_computed_again(serial, calls):
    folder = calls.folder
    rows = [{"number": number, **row} for number, row in enumerate(serial.select([0, 1]).to_pylist())]

    def measure(world, number, speed):
        noted = Calls.__new__(Calls)
        noted.folder = folder
        noted.note(number)
        # The first process of this row waits until the test kills it.
        while number == 3 and len(noted.processes(3)) == 1:
            time.sleep(0.01)
        return impact(world, speed)

    killed = []

    def kill():
        while not calls.processes(3):
            time.sleep(0.01)
        (process,) = calls.processes(3)
        os.kill(process, signal.SIGKILL)
        killed.append(process)

    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    table = fw.sweep(SCENE, rows, measure, workers=2, progress=False)
    killer.join()
    assert same(table.drop_columns(["number"]), serial)
    first, second = calls.processes(3)
    assert [first] == killed and second != first and os.getpid() not in (first, second)
    # A row that waited for the killed process may have begun there, too; no other row ran twice.
    again = {number for number, count in calls.count().items() if count > 1}
    assert all(killed[0] in calls.processes(number) for number in again)


@needs_ray
def test_cluster_that_loses_a_node_gives_the_whole_table(serial, calls):
    from ray.cluster_utils import Cluster

    folder = calls.folder
    node = {"num_cpus": 1, "object_store_memory": 100 * 2**20, "include_dashboard": False}
    # Workers find this module where this process finds it.
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
        patch.setenv("RAY_USAGE_STATS_ENABLED", "0")
        cluster = Cluster(initialize_head=True, head_node_args=node)
        second = cluster.add_node(**node, env_vars={"SECOND_NODE": "yes"})

    def measure(world, speed):
        # A row on the second node waits there until the test removes this node.
        if "SECOND_NODE" in os.environ:
            (folder / f"{os.getpid()}").touch()
            time.sleep(1000)
        # The first node is busy until then, so that the second one gets a row, however late it starts.
        while not list(folder.iterdir()):
            time.sleep(0.01)
        return impact(world, speed)

    removed = []

    def remove():
        while not list(folder.iterdir()):
            time.sleep(0.01)
        cluster.remove_node(second, allow_graceful=False)
        removed.append(second)

    remover = threading.Thread(target=remove, daemon=True)
    remover.start()
    try:
        table = fw.sweep(SCENE, GRID, measure, address=cluster.address, progress=False)
        remover.join()
    finally:
        cluster.shutdown()
    assert same(table, serial)
    assert removed and list(folder.iterdir())


@pytest.fixture(scope="class")
def connected():
    """A local Ray of two processors to which this process is connected."""
    ray = pytest.importorskip("ray", reason="ray is not installed")
    environment = {"env_vars": {"PYTHONPATH": os.pathsep.join(sys.path)}}
    ray.init(
        address="local",
        num_cpus=2,
        include_dashboard=False,
        object_store_memory=100 * 2**20,
        logging_level="ERROR",
        runtime_env=environment,
    )
    yield ray
    ray.shutdown()


class TestConnectedRay:
    """Sweeps of a process that is connected to Ray."""

    def test_connected_ray_is_used_and_left_connected(self, connected, serial):
        def process(world):
            return {"process": os.getpid()}

        processes = fw.sweep(SCENE, {"drag": [0, 1, 2, 3]}, process, progress=False)["process"].to_pylist()
        assert os.getpid() not in processes
        here = fw.sweep(SCENE, {"drag": [0, 1]}, process, workers=1, progress=False)["process"].to_pylist()
        assert here == [os.getpid()] * 2
        assert same(fw.sweep(SCENE, GRID, impact, progress=False), serial)
        assert connected.is_initialized()
        with pytest.raises(fw.Error, match="address: this process is already connected to Ray, given 'auto'"):
            fw.sweep(SCENE, GRID, impact, address="auto", progress=False)

    def test_error_in_another_process_names_the_row_and_keeps_the_others(self, connected, calls, tmp_path):
        folder = calls.folder
        path = tmp_path / "some.parquet"

        def measure(world, i):
            (folder / f"{i} {time.monotonic_ns()}").touch()
            # Row 3 fails after rows 0, 1 and 2 have ended.
            if i == 3 and not (folder.parent / "go").exists():
                raise KeyError("no row three")
            return {"square": i * i}

        with pytest.raises(fw.SweepError, match=r"row 4 of 4 \(i=3\): KeyError: 'no row three'") as error:
            fw.sweep(SCENE, {"i": range(4)}, measure, workers=2, results=path, progress=False)
        assert "in measure" in str(error.value.__cause__), "the traceback of the other process"
        kept = pq.read_table(path)["i"].to_pylist()
        assert len(kept) >= 2 and 3 not in kept
        (tmp_path / "go").touch()
        for file in folder.iterdir():
            file.unlink()
        table = fw.sweep(SCENE, {"i": range(4)}, measure, workers=2, results=path, progress=False)
        assert table["square"].to_pylist() == [0, 1, 4, 9]
        assert sorted(int(file.name.split()[0]) for file in folder.iterdir()) == sorted(set(range(4)) - set(kept))

    def test_row_that_ends_its_process_each_time_is_an_error(self, connected, calls):
        folder = calls.folder

        def measure(world, i):
            if i == 1:
                (folder / f"{os.getpid()}").touch()
                os.kill(os.getpid(), signal.SIGKILL)
            return {}

        with pytest.raises(fw.SweepError, match=r"row 2 of 2 \(i=1\): WorkerCrashedError"):
            fw.sweep(SCENE, {"i": range(2)}, measure, retries=1, progress=False)
        assert len(list(folder.iterdir())) == 2, "once, and once again"


# The file.


def test_resumed_sweep_computes_only_missing_rows(serial, calls, tmp_path):
    path = tmp_path / "rows.parquet"
    rows = [{"number": number, **row} for number, row in enumerate(serial.select([0, 1]).to_pylist())]

    def measure(world, number, speed):
        calls.note(number)
        if number == 4 and not (tmp_path / "go").exists():
            raise ArithmeticError("row four")
        return impact(world, speed)

    with pytest.raises(fw.SweepError, match=r"row 5 of 6 \(number=4, material.young=.*\): ArithmeticError: row four"):
        fw.sweep(SCENE, rows, measure, results=path, progress=False)
    assert pq.read_table(path)["number"].to_pylist() == [0, 1, 2, 3]
    assert calls.count() == {"0": 1, "1": 1, "2": 1, "3": 1, "4": 1}
    (tmp_path / "go").touch()
    table = fw.sweep(SCENE, rows, measure, results=path, progress=False)
    assert same(table.drop_columns(["number"]), serial)
    assert calls.count() == {"0": 1, "1": 1, "2": 1, "3": 1, "4": 2, "5": 1}
    assert same(fw.sweep(SCENE, rows, measure, results=path, progress=False), table)
    assert sum(calls.count().values()) == 7, "a whole file computes nothing"
    assert sorted(os.listdir(tmp_path)) == ["calls", "go", "rows.parquet"]


def test_killed_sweep_leaves_a_file_that_resumes(tmp_path, calls):
    script = tmp_path / "script.py"
    script.write_text(
        "import pathlib, sys, time\n"
        "import fuwafuwa as fw\n"
        "from fuwafuwa import _sweep\n"
        "_sweep._WRITE_INTERVAL = 0.0\n"
        "folder = pathlib.Path(sys.argv[1])\n"
        "def measure(world, i):\n"
        "    with open(folder / 'calls' / str(i), 'a') as file:\n"
        "        file.write('call\\n')\n"
        "    while i == 5 and not (folder / 'go').exists():\n"
        "        time.sleep(0.01)\n"
        "    return {'square': i * i}\n"
        "table = fw.sweep('drop', {'i': range(8)}, measure, results=folder / 'rows.parquet', progress=False)\n"
        "print(table['square'].to_pylist())\n",
        encoding="utf-8",
    )
    command = [sys.executable, str(script), str(tmp_path)]
    process = subprocess.Popen(command)
    while not (calls.folder / "5").exists():
        assert process.poll() is None, "the sweep ended"
        time.sleep(0.01)
    process.kill()
    process.wait()
    assert pq.read_table(tmp_path / "rows.parquet")["i"].to_pylist() == [0, 1, 2, 3, 4]
    (tmp_path / "go").touch()
    output = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    assert output.strip() == str([i * i for i in range(8)])
    assert {path.name: path.read_text().count("call") for path in calls.folder.iterdir()} == {
        str(i): 2 if i == 5 else 1 for i in range(8)
    }


def test_failed_write_leaves_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "rows.parquet"

    def measure(world, i):
        if i == 2 and not (tmp_path / "go").exists():
            raise RuntimeError("stop")
        return {"i2": i * i}

    with pytest.raises(fw.SweepError):
        fw.sweep(SCENE, {"i": range(4)}, measure, results=path, progress=False)
    before = path.read_bytes()
    (tmp_path / "go").touch()

    def fail(table, file):
        file.write(b"PAR1 half of a file")
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(pq, "write_table", fail)
        with pytest.raises(OSError, match="No space left"):
            fw.sweep(SCENE, {"i": range(4)}, measure, results=path, progress=False)
    assert path.read_bytes() == before
    assert sorted(os.listdir(tmp_path)) == ["go", "rows.parquet"]
    table = fw.sweep(SCENE, {"i": range(4)}, measure, results=path, progress=False)
    assert table["i2"].to_pylist() == [0, 1, 4, 9]


def test_file_of_another_sweep_is_refused_and_stays(tmp_path, calls, monkeypatch):
    path = tmp_path / "rows.parquet"
    (tmp_path / "letter.png").write_bytes(png(letter()))
    scene = tmp_path / "scene.toml"
    scene.write_text('dim = 2\n[[body]]\nfile = "letter.png"\nn = 8\n', encoding="utf-8")

    def measure(world, i):
        calls.note(i)
        return {"nodes": world[world.soft_bodies[0]].node_count}

    def other(world, i):
        calls.note(i)
        return {"nodes": 0}

    grid = {"i": [1, 2], "body.n": [4]}
    table = fw.sweep(scene, grid, measure, results=path, progress=False)
    before = path.read_bytes()

    def refused(words, scene=scene, grid=grid, measure=measure, **options):
        with pytest.raises(fw.Error, match=re.escape(str(path)) + ".*" + words):
            fw.sweep(scene, grid, measure, results=path, progress=False, **options)
        assert path.read_bytes() == before
        assert calls.count() == {"1": 1, "2": 1}

    refused("other parameters", grid={"i": [1, 3], "body.n": [4]})
    refused("other parameters", grid={"i": [1, 2, 3], "body.n": [4]})
    refused("another scene", scene="dim = 2\n[[body]]\nshape = 'ball'\nn = 4\n")
    refused("another measure", measure=other)
    refused("another measure: expected version 2, found ", version="2")
    with monkeypatch.context() as patch:
        patch.setattr("fuwafuwa._sweep.__version__", "0.1.9")
        refused(f"another version of the engine: expected 0.1.9, found {re.escape(fw.__version__)}")
    pixels = letter()
    pixels[0, 0] = 0
    (tmp_path / "letter.png").write_bytes(png(pixels))
    refused("another scene")
    (tmp_path / "letter.png").write_bytes(png(letter()))
    assert same(fw.sweep(scene, grid, measure, results=path, progress=False), table)

    for content in (b"", b"a,b\n1,2\n"):
        path.write_bytes(before := content)
        refused("is no Parquet file")
    pq.write_table(pa.table({"i": [1, 2]}), path)
    before = path.read_bytes()
    refused("is not the file of a sweep")


def test_version_stands_for_the_source_of_measure(tmp_path):
    path = tmp_path / "rows.parquet"
    edited = tmp_path / "edited.parquet"
    first = fw.sweep(SCENE, {"i": [1]}, lambda world, i: {"x": i}, results=edited, version="a", progress=False)
    second = fw.sweep(SCENE, {"i": [1]}, lambda world, i: {"x": 2 * i}, results=edited, version="a", progress=False)
    assert same(first, second)
    with pytest.raises(fw.Error, match="another measure: expected version b, found version a"):
        fw.sweep(SCENE, {"i": [1]}, lambda world, i: {"x": i}, results=edited, version="b", progress=False)
    without_source = eval("lambda world, i: {'x': i}")
    with pytest.raises(fw.Error, match="has no source text; give version="):
        fw.sweep(SCENE, {"i": [1]}, without_source, results=path, progress=False)
    assert not path.exists()


# Arguments.


def never(world, **given):
    """Fail if a row runs."""
    raise AssertionError("nothing may run")


@pytest.mark.parametrize(
    ("scene", "parameters", "measure", "words"),
    [
        (SCENE, {"material.young": [1e3], "material.yuong": [1e3]}, never, "unknown field `yuong`"),
        (SCENE, [{"material.young": 1e3}, {"material.young": "soft"}], never, "material.young"),
        (SCENE, {"sped": [1]}, impact, "measure requires an argument 'speed', which is not among the parameters"),
        (SCENE, {"speed": [1], "materiel.young": [1]}, impact, "materiel.young"),
        (SCENE, {"material.young": [None]}, never, "material.young: expected a value for a field of the scene"),
        (SCENE, {"material.young": []}, never, "at least one name and one value"),
        (SCENE, {}, never, "at least one name and one value"),
        (SCENE, [{"drag": 1}, {"gravity": 1}], never, "row 2: expected the names of row 1, drag, given gravity"),
        (SCENE, [3], never, "row 1: expected a mapping of names to values, given 3"),
        (SCENE, "drag", never, "expected a mapping or a sequence of mappings, given 'drag'"),
        (SCENE, {"drag": [{}]}, never, "drag: expected a number, a text, a boolean or a list of these, given {}"),
        (SCENE, {"drag=1": [1]}, never, "expected a name without '=', given 'drag=1'"),
        (SCENE, {"speed": ["fast", 1]}, lambda world, speed: {}, "speed: expected values of one type"),
        (SCENE, {"drag": [1]}, "impact", "measure: expected a function, given 'impact'"),
        (SCENE, {"drag": [1]}, lambda: None, "measure: expected a function of a world"),
        ("dorp", {"drag": [1]}, never, "dorp"),
        (7, {"drag": [1]}, never, "scene: expected a name, a path, a text, a Scene or a function, given 7"),
        (lambda young: None, {"n": [1]}, never, "scene requires an argument 'young'"),
        (lambda n: None, {"n": [1], "m": [1]}, lambda world: {}, "neither scene nor measure has an argument 'm'"),
    ],
)
def test_wrong_argument_is_an_error_before_anything_runs(scene, parameters, measure, words):
    with pytest.raises(fw.Error, match=re.escape(words)):
        fw.sweep(scene, parameters, measure, progress=False)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"workers": 0}, "workers: expected a whole number of 1 or more, given 0"),
        ({"workers": 1.5}, "workers: expected a whole number of 1 or more, given 1.5"),
        ({"retries": -2}, "retries: expected a whole number of -1 or more, given -2"),
        ({"results": "no-such-folder/rows.parquet"}, "expected a folder that can be written, given 'no-such-folder'"),
        ({"results": "rows.parquet", "version": 3}, "version: expected a text, given 3"),
    ],
)
def test_wrong_option_is_an_error_before_anything_runs(options, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(fw.Error, match=re.escape(words)):
        fw.sweep(SCENE, {"drag": [1]}, never, progress=False, **options)
    assert os.listdir(tmp_path) == []


@pytest.mark.parametrize(
    ("measure", "words"),
    [
        (lambda world, i: 3, "expected a dict of numbers and texts, returned 3"),
        (lambda world, i: {1: 2}, "expected texts as keys, returned the key 1"),
        (lambda world, i: {"x": [1]}, "measure, x: expected a number of 64 bits, a text, a boolean or None"),
        (lambda world, i: {"x": 2**64}, "measure, x: expected a number of 64 bits"),
        (lambda world, i: {"i": 1}, "measure returned 'i', which is the name of a parameter"),
        (lambda world, i: {"x": 1} if i < 2 else {"y": 1}, "expected the keys of the other rows, x, returned y"),
        (lambda world, i: {"x": "a" if i < 2 else 1}, "measure, x: expected a text, as in other rows, returned 1"),
        (lambda world, i: {"x": 1 if i < 2 else True}, "measure, x: expected a number, as in other rows"),
        (lambda world, i: {"x": 2**63 if i < 2 else -1}, "measure, x: expected numbers of one type of 64 bits"),
    ],
)
def test_wrong_result_is_an_error_that_names_the_row(measure, words):
    with pytest.raises(fw.SweepError, match=r"row [12] of 2 \(i=[12]\): Error: .*" + re.escape(words)):
        fw.sweep(SCENE, {"i": [1, 2]}, measure, progress=False)


def test_invalid_value_of_a_scene_is_an_error_of_its_row():
    words = r"row 2 of 2 \(material.young=-5\): Error: .*material 1, young: expected positive and finite"
    with pytest.raises(fw.SweepError, match=words):
        fw.sweep(SCENE, {"material.young": [5, -5]}, lambda world: {}, progress=False)


def test_missing_package_is_named(monkeypatch):
    for package, options in (("pyarrow", {}), ("ray", {"workers": 2})):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, package, None)
            with pytest.raises(ImportError, match=r"requires .*: install it with `pip install fuwafuwa\[sweep\]`"):
                fw.sweep(SCENE, {"drag": [1]}, never, progress=False, **options)


def test_progress_is_shown_on_stderr(capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "tqdm", None)
    fw.sweep(SCENE, {"i": range(40)}, lambda world, i: {}, workers=1)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [f"sweep: {count} of 40 rows" for count in range(0, 41, 2)]
    fw.sweep(SCENE, {"i": range(3)}, lambda world, i: {}, workers=1, progress=False)
    assert capsys.readouterr().err == ""


def test_sweep_is_imported_only_when_it_is_used():
    program = (
        "import sys, fuwafuwa as fw; print('fuwafuwa._sweep' in sys.modules, fw.sweep.__name__, 'sweep' in dir(fw))"
    )
    output = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    assert output.split() == ["False", "sweep", "True"]
    with pytest.raises(AttributeError, match="has no attribute 'swep'"):
        fw.swep  # noqa: B018
    assert "pyarrow.Table" in inspect.getdoc(fw.sweep)
