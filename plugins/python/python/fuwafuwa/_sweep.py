"""Sweeps: the same measurement in many worlds, on one machine or on a Ray cluster.

This module has no scheduler. With more than one worker, Ray runs the rows and restarts those whose process was lost.
"""

from __future__ import annotations

import hashlib
import importlib
import inspect
import itertools
import json
import math
import os
import sys
import time
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from pathlib import Path
from typing import Any

from ._core import Error, Scene, __version__

_KEY = b"fuwafuwa.sweep"
#: Shortest time between two writes of the results file, in durations of the last write. Lower values lose fewer rows
#: when this process is killed, and take more time.
_WRITE_INTERVAL = 20.0
#: Time after which rows that have ended are written, although no other row ends [s].
_PAUSE = 1.0
#: Largest number of rows that wait in Ray at once. More cost memory and gain no speed.
_MAX_WAITING = 1000

_Row = dict[str, Any]
#: Numbers of rows with the values that were measured; None while no row ends.
_Computed = Generator[tuple[int, _Row] | None, None, None]


class SweepError(RuntimeError):
    """A row of a sweep failed. The text names the row, its parameters and the reason."""


def sweep(
    scene: str | os.PathLike[str] | Scene | Callable[..., Any],
    parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    measure: Callable[..., Mapping[str, Any]],
    *,
    results: str | os.PathLike[str] | None = None,
    workers: int | None = None,
    address: str | None = None,
    retries: int = 3,
    version: str | None = None,
    progress: bool = True,
) -> Any:
    """Measure a world for each row of parameters, and return the table of all rows.

    A row has its parameters and what `measure` returned for them. Rows stand in the order of the parameters. The table
    does not depend on the number of workers, if `measure` uses neither a clock nor random numbers without a seed.

    scene: name of a built-in scene, path of a scene file, text of a scene (a text with a line break), a `Scene`, or a
    function that takes parameters by name and returns a world or a `Scene`.

    parameters: mapping of names to values, for all combinations of the values, of which the last name varies fastest;
    a number or a text alone is one value for all rows. Or a sequence of mappings, one for each row, with the same
    names. Values are numbers, texts, booleans and lists of these. A name which `measure` has as an argument goes to
    `measure`. Any other name is a field of the scene, as in `Scene.read(path, ["material.young=9000"])`; for a
    function as scene, it is an argument of this function.

    measure: function of a world, which steps this world and returns a dict of numbers, texts, booleans or None, with
    the same keys in all rows. It is called as `measure(world, **parameters)` with the parameters that it names, or with
    all parameters of the row if it ends in `**`. An argument `scene` receives the `Scene` of the row.

    results: Parquet file that holds the finished rows. If it exists, its rows are not computed again. It is refused,
    and stays as it is, if it comes from other parameters, another scene, another `measure` or another version of the
    engine. The file is replaced as a whole. Writing takes at most 5 % of the time.

    workers: number of rows that run at once. Without an address, 1 runs them in this process; more start a local Ray with so many
    processes. By default, all processors of Ray, if this process is connected to Ray or an address is given;
    otherwise 1.

    address: address of a Ray cluster, such as "auto" or "ray://head:10001". The cluster needs fuwafuwa of this version.

    retries: how often a row is restarted whose process was lost, default 3; -1 restarts without limit. Errors of
    `measure` are not retried.

    version: text by which the results file recognises `measure`, and the function that is given as scene. By default
    it is their source text, without the functions that they call and values from outside.

    progress: whether to show progress on stderr, with tqdm if it is installed.

    Returns a `pyarrow.Table`; its `to_pandas()` returns a data frame.

    Raises `fuwafuwa.Error` before anything runs if an argument is invalid or the file is refused, and
    `fuwafuwa.SweepError` if a row fails. The rows that were finished are in the file.
    """
    arrow = _require("pyarrow", "sweep() requires pyarrow")
    _check_count("workers", workers, 1)
    _check_count("retries", retries, -1)
    rows = _rows(parameters)
    plan = _Plan(scene, rows, measure)
    table = _Table(arrow, rows)
    path = None
    if results is not None:
        path = Path(results)
        table.identity = plan.identity(version)
        table.read(path)
    missing = [index for index in range(len(rows)) if index not in table.finished]
    if address is not None or (_is_connected() if workers is None else workers > 1):
        ray = _require("ray", "sweep() in several processes requires Ray")
        computed = _on_ray(ray, plan, missing, workers, address, retries)
    else:
        computed = _here(plan, missing)
    with closing(computed), closing(_Progress(len(rows), len(table.finished), progress)) as bar:
        next_write = -math.inf
        changed = False
        try:
            for row in computed:
                if row is not None:
                    with plan.errors_of(row[0]):
                        table.add(*row)
                    changed = True
                    bar.advance()
                start = time.monotonic()
                if path is not None and changed and start >= next_write:
                    table.write(path)
                    end = time.monotonic()
                    next_write, changed = end + _WRITE_INTERVAL * (end - start), False
        finally:
            if path is not None and changed:
                table.write(path)
    return table.table()


def _require(name: str, what: str) -> Any:
    try:
        return importlib.import_module(name)
    except ModuleNotFoundError as error:
        raise ImportError(f"{what}: install it with `pip install fuwafuwa[sweep]`") from error


def _check_count(name: str, value: int | None, low: int) -> None:
    if value is None and name == "workers":
        return
    if isinstance(value, bool) or not isinstance(value, int) or value < low:
        raise Error(f"{name}: expected a whole number of {low} or more, given {value!r}")


# Parameters.


def _rows(parameters: Mapping[str, Any] | Sequence[Mapping[str, Any]]) -> list[_Row]:
    """Return the rows of parameters as plain values of Python."""
    if isinstance(parameters, Mapping):
        names = list(parameters)
        lists = [_list_of_values(name, parameters[name]) for name in names]
        rows = [dict(zip(names, values, strict=True)) for values in itertools.product(*lists)]
    elif isinstance(parameters, (str, bytes)) or not isinstance(parameters, Iterable):
        raise Error(f"parameters: expected a mapping or a sequence of mappings, given {parameters!r}")
    else:
        rows = []
        for number, row in enumerate(parameters, 1):
            if not isinstance(row, Mapping):
                raise Error(f"parameters, row {number}: expected a mapping of names to values, given {row!r}")
            names = list(rows[0]) if rows else list(row)
            if set(names) != set(row):
                expected, given = ", ".join(map(str, names)), ", ".join(map(str, row))
                raise Error(f"parameters, row {number}: expected the names of row 1, {expected}, given {given}")
            rows.append({name: _plain(f"parameters, row {number}, {name}", row[name]) for name in names})
    if not rows or not rows[0]:
        raise Error(f"parameters: expected at least one name and one value, given {parameters!r}")
    for name in rows[0]:
        if not isinstance(name, str) or not name or "=" in name:
            raise Error(f"parameters: expected a name without '=', given {name!r}")
    return rows


def _list_of_values(name: str, values: Any) -> list[Any]:
    is_one = isinstance(values, (str, bytes)) or not isinstance(values, Iterable) or getattr(values, "ndim", 1) == 0
    return [_plain(f"parameters, {name}", value) for value in ([values] if is_one else values)]


def _plain(place: str, value: Any) -> Any:
    """Return a parameter as a plain value of Python."""
    if hasattr(value, "tolist"):
        value = value.tolist()
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, (list, tuple)):
        return [_plain(place, entry) for entry in value]
    raise Error(f"{place}: expected a number, a text, a boolean or a list of these, given {value!r}")


def _change(name: str, value: Any) -> str:
    """Return a change of a scene, such as `material.young=9000.0`."""
    return f"{name}={_toml(name, value)}"


def _toml(name: str, value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, list):
        return "[" + ", ".join(_toml(name, entry) for entry in value) + "]"
    raise Error(f"{name}: expected a value for a field of the scene, given {value!r}")


# Scenes and measurements.


class _Arguments:
    """Names of the arguments of a function."""

    def __init__(self, what: str, function: Callable[..., Any], skipped: int) -> None:
        if not callable(function):
            raise Error(f"{what}: expected a function, given {function!r}")
        try:
            arguments = list(inspect.signature(function).parameters.values())
        except ValueError as error:
            raise Error(f"{what}: expected a function with a signature, given {function!r}") from error
        positional = (inspect.Parameter.POSITIONAL_ONLY, inspect.Parameter.POSITIONAL_OR_KEYWORD)
        if len([argument for argument in arguments if argument.kind in positional]) < skipped:
            raise Error(f"{what}: expected a function of a world, given {function!r}")
        arguments = arguments[skipped:]
        named = (inspect.Parameter.POSITIONAL_OR_KEYWORD, inspect.Parameter.KEYWORD_ONLY)
        self.names = {argument.name for argument in arguments if argument.kind in named}
        self.required = [
            argument.name
            for argument in arguments
            if argument.default is inspect.Parameter.empty and argument.kind in (*named, *positional)
        ]
        self.takes_all = any(argument.kind is inspect.Parameter.VAR_KEYWORD for argument in arguments)


class _Plan:
    """Scene, rows and measurement of a sweep, checked."""

    def __init__(self, scene: Any, rows: list[_Row], measure: Callable[..., Any]) -> None:
        self.rows = rows
        self.measure = measure
        names = list(rows[0])
        arguments = _Arguments("measure", measure, 1)
        self.gives_scene = "scene" in arguments.names and "scene" not in names
        known = {*names, "scene"} if self.gives_scene else set(names)
        self._check_required("measure", arguments, known)
        self.to_measure = names if arguments.takes_all else [name for name in names if name in arguments.names]
        self.build: Callable[..., Any] | None = None
        if isinstance(scene, (str, os.PathLike, Scene)):
            self.to_scene = [name for name in names if name not in arguments.names]
            self._read, self._name = _reader(scene)
            # Reads the scene of every row, so that an unknown field is an error before anything runs.
            digest = hashlib.sha256()
            for index in range(len(rows)):
                text = self.scene(index).text().encode()
                digest.update(b"%d\n" % len(text) + text)
            self.digest = digest.hexdigest()
        elif callable(scene):
            self.build = scene
            built = _Arguments("scene", scene, 0)
            self._check_required("scene", built, set(names))
            self.to_scene = [
                name for name in names if name in built.names or (built.takes_all and name not in arguments.names)
            ]
            lost = [name for name in names if name not in self.to_scene and name not in arguments.names]
            if lost:
                raise Error(f"parameters: neither scene nor measure has an argument {lost[0]!r}")
        else:
            raise Error(f"scene: expected a name, a path, a text, a Scene or a function, given {scene!r}")

    @staticmethod
    def _check_required(what: str, arguments: _Arguments, known: set[str]) -> None:
        for name in arguments.required:
            if name not in known:
                raise Error(f"{what} requires an argument {name!r}, which is not among the parameters")

    def scene(self, index: int) -> Scene:
        """Return the scene of a row, read from its text, as it is in other processes."""
        row = self.rows[index]
        scene = self._read([_change(name, row[name]) for name in self.to_scene])
        return Scene.from_text(scene.text(), name=self._name)

    def work(self, index: int) -> tuple[Any, _Row, bool]:
        """Return what a row needs besides the functions: its scene or arguments of the function, its parameters."""
        row = self.rows[index]
        if self.build is None:
            source: Any = self.scene(index)
        else:
            source = {name: row[name] for name in self.to_scene}
        return source, {name: row[name] for name in self.to_measure}, self.gives_scene

    def identity(self, version: str | None) -> dict[str, str]:
        """Return the texts by which a results file recognises this sweep."""
        if version is not None and not isinstance(version, str):
            raise Error(f"version: expected a text, given {version!r}")
        scene = self.digest if self.build is None else _source("scene", self.build, version)
        return {
            "another version of the engine": __version__,
            "other parameters": _digest(json.dumps(self.rows)),
            "another scene": scene,
            "another measure": _source("measure", self.measure, version),
        }

    @contextmanager
    def errors_of(self, index: int) -> Iterator[None]:
        """Turn an error into one that names the row."""
        try:
            yield
        except Exception as error:
            # Ray wraps the exception of another process.
            cause = getattr(error, "cause", None)
            reason = cause if isinstance(cause, Exception) else error
            values = ", ".join(f"{name}={value!r}" for name, value in self.rows[index].items())
            text = f"row {index + 1} of {len(self.rows)} ({values}): {type(reason).__name__}: {reason}"
            raise SweepError(text) from error


def _reader(scene: str | os.PathLike[str] | Scene) -> tuple[Callable[[list[str]], Scene], str]:
    """Return a function that reads a scene with changes, and the name of the scene in errors."""
    if isinstance(scene, Scene):
        text = scene.text()
        return (lambda changes: Scene.from_text(text, changes)), "scene"
    if isinstance(scene, str) and "\n" in scene:
        return (lambda changes: Scene.from_text(scene, changes)), "scene"
    return (lambda changes: Scene.read(scene, changes)), os.fspath(scene)


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _source(what: str, function: Callable[..., Any], version: str | None) -> str:
    if version is not None:
        return f"version {version}"
    try:
        return _digest(inspect.getsource(function))
    except (OSError, TypeError) as error:
        raise Error(f"{what}: {function!r} has no source text; give version= to recognise it in a file") from error


# Rows.


def _compute(
    functions: tuple[Any, ...], source: Any, given: _Row, gives_scene: bool, expected: str
) -> dict[str, bool | int | float | str | None]:
    """Build the world of a row, measure it and return the values."""
    if expected != __version__:
        raise Error(f"fuwafuwa of a worker: expected version {expected}, found {__version__}")
    measure, build = functions
    world = source if build is None else build(**source)
    if isinstance(world, Scene):
        if gives_scene:
            given = {**given, "scene": world}
        world = world.build()
    elif gives_scene:
        raise Error(f"measure has an argument scene, but the function scene returned {world!r}")
    values = measure(world, **given)
    if not isinstance(values, Mapping):
        raise Error(f"measure: expected a dict of numbers and texts, returned {values!r}")
    return {_key(name): _value(name, value) for name, value in values.items()}


def _key(name: Any) -> str:
    if not isinstance(name, str):
        raise Error(f"measure: expected texts as keys, returned the key {name!r}")
    return name


def _value(name: str, value: Any) -> bool | int | float | str | None:
    if hasattr(value, "item") and getattr(value, "size", 0) == 1:
        value = value.item()
    if value is None or isinstance(value, (bool, float, str)):
        return value
    if isinstance(value, int) and -(2**63) <= value < 2**64:
        return value
    raise Error(f"measure, {name}: expected a number of 64 bits, a text, a boolean or None, returned {value!r}")


def _here(plan: _Plan, missing: list[int]) -> _Computed:
    """Compute rows in this process."""
    for index in missing:
        with plan.errors_of(index):
            values = _compute((plan.measure, plan.build), *plan.work(index), __version__)
        yield index, values


def _is_connected() -> bool:
    ray = sys.modules.get("ray")
    return ray is not None and ray.is_initialized()


def _on_ray(
    ray: Any, plan: _Plan, missing: list[int], workers: int | None, address: str | None, retries: int
) -> _Computed:
    """Compute rows on Ray, in the order in which they end."""
    if not missing:
        return
    # A local Ray that starts here has one processor for each worker and keeps to them.
    is_given = ray.is_initialized() or address is not None
    limit = workers if is_given and workers is not None else _MAX_WAITING
    with _connected(ray, min(workers or 1, len(missing)), address):
        task = ray.remote(max_retries=retries, retry_exceptions=False)(_compute)
        functions = ray.put((plan.measure, plan.build))
        waiting: dict[Any, int] = {}
        rest = iter(missing)
        try:
            while True:
                for index in itertools.islice(rest, limit - len(waiting)):
                    waiting[task.remote(functions, *plan.work(index), __version__)] = index
                if not waiting:
                    return
                ended, _ = ray.wait(list(waiting), num_returns=1, timeout=_PAUSE)
                if not ended:
                    yield None
                    continue
                # Takes all that have ended, so that an error loses none of them.
                ended, _ = ray.wait(list(waiting), num_returns=len(waiting), timeout=0)
                failure = None
                for reference in sorted(ended, key=waiting.__getitem__):
                    index = waiting.pop(reference)
                    try:
                        with plan.errors_of(index):
                            values = ray.get(reference)
                    except SweepError as error:
                        failure = failure or error
                    else:
                        yield index, values
                if failure is not None:
                    raise failure
        finally:
            for reference in waiting:
                ray.cancel(reference)


@contextmanager
def _connected(ray: Any, workers: int, address: str | None) -> Iterator[None]:
    """Connect to Ray: to the given cluster, to that of this process, or to a local one that ends with the sweep."""
    if ray.is_initialized():
        if address is not None:
            raise Error(f"address: this process is already connected to Ray, given {address!r}")
        yield
        return
    if address is not None:
        ray.init(address=address, logging_level="WARNING")
    else:
        # Workers find the modules that this process finds, and nothing is reported to the authors of Ray.
        settings = {
            "PYTHONPATH": os.pathsep.join(path or os.getcwd() for path in sys.path),
            "RAY_USAGE_STATS_ENABLED": "0",
        }
        with _environment(settings):
            ray.init(
                address="local",
                num_cpus=workers,
                include_dashboard=False,
                logging_level="ERROR",
                # The least that Ray accepts, with a margin: rows and functions are small.
                object_store_memory=100 * 2**20,
            )
    try:
        yield
    finally:
        ray.shutdown()


@contextmanager
def _environment(settings: dict[str, str]) -> Iterator[None]:
    before = {name: os.environ.get(name) for name in settings}
    os.environ.update(settings)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


# Results.


class _Table:
    """Finished rows and their file."""

    def __init__(self, arrow: Any, rows: list[_Row]) -> None:
        self.arrow = arrow
        self.rows = rows
        self.finished: dict[int, _Row] = {}
        self.identity: dict[str, str] = {}
        self.kinds: dict[str, str | None] | None = None
        #: Smallest and largest whole number of each column.
        self.spans: dict[str, tuple[int, int]] = {}
        self.parameters = {name: self._column(name, [row[name] for row in rows]) for name in rows[0]}

    def add(self, index: int, values: _Row) -> None:
        """Add a row. Its keys and the kinds of its values must be those of the other rows."""
        kinds = self.kinds
        if kinds is None:
            for name in values:
                if name in self.parameters:
                    raise Error(f"measure returned {name!r}, which is the name of a parameter")
            kinds = dict.fromkeys(values)
        if kinds.keys() != values.keys():
            expected, given = ", ".join(kinds), ", ".join(values)
            raise Error(
                f"measure: expected the keys of the other rows, {expected or 'none'}, returned {given or 'none'}"
            )
        for name, value in values.items():
            if isinstance(value, int):
                low, high = self.spans.get(name, (0, 0))
                self.spans[name] = low, high = min(low, value), max(high, value)
                if low < 0 and high >= 2**63:
                    raise Error(f"measure, {name}: expected numbers of one type of 64 bits, returned {low} and {high}")
        found = {name: _kind(value) for name, value in values.items()}
        for name, kind in found.items():
            if kind is not None and kinds[name] not in (None, kind):
                raise Error(f"measure, {name}: expected a {kinds[name]}, as in other rows, returned {values[name]!r}")
        self.kinds = {name: kind or found[name] for name, kind in kinds.items()}
        self.finished[index] = values

    def table(self) -> Any:
        """Return the finished rows as a table, in the order of the parameters."""
        order = sorted(self.finished)
        columns = {name: column.take(self.arrow.array(order)) for name, column in self.parameters.items()}
        for name in self.finished[order[0]]:
            columns[name] = self._column(name, [self.finished[index][name] for index in order])
        return self.arrow.table(columns)

    def _column(self, name: str, values: list[Any]) -> Any:
        numbers = [value for value in values if value is not None and not isinstance(value, bool)]
        try:
            if numbers and all(isinstance(value, (int, float)) for value in numbers):
                if any(isinstance(value, float) for value in numbers):
                    values = [None if value is None else float(value) for value in values]
                    return self.arrow.array(values, self.arrow.float64())
                is_large = max(numbers) >= 2**63
                return self.arrow.array(values, self.arrow.uint64() if is_large else self.arrow.int64())
            return self.arrow.array(values)
        except (self.arrow.ArrowException, OverflowError, ValueError) as error:
            raise Error(f"{name}: expected values of one type, given {_shortened(values)}: {error}") from error

    def read(self, path: Path) -> None:
        """Read the rows that a file has of this sweep."""
        parquet = importlib.import_module("pyarrow.parquet")
        if not path.exists():
            if not (path.parent.is_dir() and os.access(path.parent, os.W_OK)):
                raise Error(f"results: expected a folder that can be written, given {str(path.parent)!r}")
            return
        try:
            with parquet.ParquetFile(path) as file:
                found = file.read()
        except (self.arrow.ArrowException, OSError) as error:
            raise Error(f"results: {str(path)!r} exists and is no Parquet file that can be read: {error}") from error
        text = (found.schema.metadata or {}).get(_KEY)
        if text is None:
            raise Error(f"results: {str(path)!r} exists and is not the file of a sweep")
        told = json.loads(text)
        for name, expected in self.identity.items():
            given = told["identity"].get(name)
            if given != expected:
                is_readable = "version" in name or expected.startswith("version")
                detail = f": expected {expected}, found {given}" if is_readable else ""
                raise Error(
                    f"results: {str(path)!r} is the file of a sweep with {name}{detail}; give another file, or remove it"
                )
        names = found.column_names[len(self.parameters) :]
        columns = [found.column(name).to_pylist() for name in names]
        for position, index in enumerate(told["rows"]):
            self.add(index, {name: column[position] for name, column in zip(names, columns, strict=True)})

    def write(self, path: Path) -> None:
        """Replace the file as a whole, so that it is never seen partly written."""
        parquet = importlib.import_module("pyarrow.parquet")
        told = json.dumps({"identity": self.identity, "rows": sorted(self.finished)})
        table = self.table().replace_schema_metadata({_KEY: told})
        part = path.with_name(f".{path.name}.{os.getpid()}.part")
        try:
            with part.open("wb") as file:
                parquet.write_table(table, file)
                file.flush()
                os.fsync(file.fileno())
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)


def _kind(value: Any) -> str | None:
    if value is None:
        return None
    if isinstance(value, bool):
        return "boolean"
    return "text" if isinstance(value, str) else "number"


def _shortened(values: list[Any]) -> str:
    text = repr(values)
    return text if len(text) <= 80 else text[:77] + "..."


# Progress.


class _Progress:
    """Progress on stderr: a bar of tqdm, otherwise a line."""

    def __init__(self, total: int, done: int, shown: bool) -> None:
        self.total, self.done, self.shown = total, done, shown
        self.bar: Any = None
        if not shown:
            return
        try:
            self.bar = importlib.import_module("tqdm").tqdm(total=total, initial=done, desc="sweep", unit="row")
        except ImportError:
            self.show()

    def advance(self) -> None:
        """Count a row."""
        self.done += 1
        if self.bar is not None:
            self.bar.update()
        elif self.shown:
            # A terminal gets each row in one line, a file one line each 5 %.
            step = 1 if sys.stderr.isatty() else math.ceil(self.total / 20)
            if self.done % step == 0 or self.done == self.total:
                self.show()

    def show(self) -> None:
        """Print the line."""
        start, end = ("\r", "") if sys.stderr.isatty() else ("", "\n")
        print(f"{start}sweep: {self.done} of {self.total} rows", end=end, file=sys.stderr, flush=True)

    def close(self) -> None:
        """End the line."""
        if self.bar is not None:
            self.bar.close()
        elif self.shown and sys.stderr.isatty():
            print(file=sys.stderr)
