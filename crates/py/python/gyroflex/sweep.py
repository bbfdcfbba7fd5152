"""Sweeps: one scenario over many values of its keys, one table of numbers."""

from __future__ import annotations

import csv
import hashlib
import importlib.util
import itertools
import json
import os
import uuid
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import closing
from numbers import Integral
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _checks, _gyroflex
from ._extras import extra
from .errors import ArgumentError, DivergedError, FileError, ModelError, ScenarioError
from .results import SimulationResult
from .simulation import attempt

if TYPE_CHECKING:
    import pandas
    from numpy.typing import NDArray

__all__ = ["SweepResult", "sweep"]

Measure = Callable[[SimulationResult], Mapping[str, Any]]
Values = Mapping[str, object]
Ended = Generator[tuple[int, dict[str, Any]], None, None]


class SweepResult(Mapping[str, "NDArray[Any]"]):
    """The table of a sweep: arrays of one entry a run, by name.

    The swept keys come first, then what was measured (NaN or ``None`` for a run that failed), then ``error``, the reason why a run
    has no measures, empty for all others. Without ``measure`` these are, of each joint, ``rms_tracking_error.<joint>`` and
    ``peak_tracking_error.<joint>`` [rad or m], ``peak_torque.<joint>`` [N m or N, link side], ``saturation.<joint>``, the share of
    ticks at the torque limit [-]; and ``fastest_mode`` [Hz], ``energy_drift`` [-], ``constraint_drift`` [m or rad], ``steps``.
    """

    __slots__ = ("_columns", "swept")

    def __init__(self, columns: Mapping[str, NDArray[Any]], swept: tuple[str, ...]) -> None:
        self._columns = dict(columns)
        self.swept = swept
        """The keys that were swept."""

    @property
    def failed(self) -> NDArray[np.bool_]:
        """Which runs have an error instead of measures."""
        return np.array([bool(error) for error in self["error"]], dtype=bool)

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __repr__(self) -> str:
        return f"<SweepResult: {self['error'].size} runs over {', '.join(self.swept)}, {self.failed.sum()} of them failed>"

    def to_pandas(self) -> pandas.DataFrame:
        """The table as a ``pandas.DataFrame``."""
        frame: pandas.DataFrame = extra("pandas", "pandas").DataFrame(self._columns)
        return frame


def sweep(
    scenario: str | os.PathLike[str],
    values: Mapping[str, Iterable[object]] | Iterable[Values],
    *,
    n_jobs: int = -1,
    measure: Measure | None = None,
    output: str | os.PathLike[str] | None = None,
    overwrite: bool = False,
    client: Any = None,
    progress: bool = True,
) -> SweepResult:
    """Runs a scenario over many values of its keys and returns one table. Rows are in the order of the values, and the table is the
    same whichever way it was made.

    Parameters
    ----------
    scenario
        The scenario's file. Workers of a cluster must see it under the same path.
    values
        The values of each key, of which all combinations are run, the last key changing fastest; or the runs themselves, a mapping
        from keys to values each. Keys are those of ``simulate(..., set=...)``.
    n_jobs
        How many runs at once on this machine; -1 for as many as there are cores.
    measure
        What to write down of a run: a function of its ``SimulationResult`` that returns numbers or texts by name, the same names for
        every run. Default: the numbers of `SweepResult`.
    output
        A ``.parquet`` or ``.csv`` file for the table; Parquet needs ``pip install "./crates/py[sweep]"``. Until all runs are done, each is
        kept in ``<output>.journal`` as it ends, and the same call goes on from there after an interruption.
    overwrite
        Whether to write over an ``output`` that is complete.
    client
        A ``distributed.Client``: runs go to the workers of its Dask cluster (extra ``dask``); those of a worker that dies go to
        another one.
    progress
        Whether to show a bar, if ``tqdm`` is installed.

    Raises
    ------
    FormatError, FileError
        What is wrong with a file or a key, which would meet every run. A run that diverges or is refused is a row with its ``error``.
    """
    runs, swept = _runs(values)
    if not isinstance(n_jobs, Integral) or n_jobs == 0 or n_jobs < -1:
        raise _checks.refused("n_jobs", f"{_checks.shown(n_jobs)} is not a number of jobs", "give a number above zero, or -1 for all cores")
    if measure is not None and not callable(measure):
        raise _checks.refused("measure", f"{_checks.shown(measure)} cannot be called", "give a function of a `SimulationResult`")
    if client is not None and not all(hasattr(client, name) for name in ("submit", "cancel", "nthreads")):
        raise _checks.refused("client", f"it is of type `{type(client).__name__}`", "give a `distributed.Client`")
    target = None if output is None else Path(_checks.path("output", output))
    overwrite, progress = _checks.flag("overwrite", overwrite), _checks.flag("progress", progress)
    if target is not None:
        _check_output(target, overwrite)
    run = _Run(os.path.abspath(_checks.path("scenario", scenario)), measure)
    journal = _Journal(target, [swept, runs])
    rows = journal.rows
    with closing(journal):
        if rows:
            _check_last(run, runs, rows, journal.path)
        todo = {i: runs[i] for i in range(len(runs)) if i not in rows}
        ended = _on_threads(run, todo, n_jobs) if client is None else _on_cluster(run, todo, client)
        with closing(ended), _bar(progress, len(runs), len(rows)) as bar:
            for i, row in ended:
                rows[i] = row
                journal.add(i, row)
                bar.update()
    columns = _columns(swept, runs, [rows[i] for i in range(len(runs))])
    if target is not None:
        _write(target, columns)
        journal.remove()
    return SweepResult(columns, swept)


class _Run:
    """A run by its values; an object that can be sent to another process."""

    def __init__(self, scenario: str, measure: Measure | None) -> None:
        self.scenario = scenario
        self.measure = measure

    def __call__(self, values: Values) -> dict[str, Any]:
        """What was measured by name, or ``error``. Numbers and texts only, as they come back from a journal."""
        try:
            if self.measure is None:
                row: Mapping[str, Any] = _gyroflex.measure_scenario(self.scenario, values)
            else:
                result, error = attempt(self.scenario, None, values)
                if error is not None:
                    raise error
                row = self.measure(result)
                if not isinstance(row, Mapping):
                    problem = f"it returns {type(row).__name__}, not a mapping"
                    raise ArgumentError(problem, "argument `measure`", remedy="return numbers or texts by name")
                for taken in ("error", *values):
                    if taken in row:
                        remedy = "name it otherwise: there is a column of that name"
                        raise ArgumentError(f"it measures `{taken}`", "argument `measure`", remedy=remedy)
        except (DivergedError, ModelError, ScenarioError) as error:
            return {"error": str(error).splitlines()[0]}
        except ArgumentError as error:
            if error.element != "argument `set`":
                raise
            # What a run is told to set is what was given to the sweep.
            raise ArgumentError(error.problem, "argument `values`", error.file, error.remedy) from None
        return {str(name): _plain(value) for name, value in row.items()}


def _plain(value: Any) -> Any:
    """A NumPy value as Python's own."""
    return value.tolist() if hasattr(value, "tolist") else value


def _json(value: Any) -> str:
    """JSON, of anything."""
    return json.dumps(value, default=lambda x: x.tolist() if hasattr(x, "tolist") else repr(x))


def _runs(values: Mapping[str, Iterable[object]] | Iterable[Values]) -> tuple[list[dict[str, Any]], tuple[str, ...]]:
    """The values of every run, and the keys."""
    if isinstance(values, Mapping):
        swept = tuple(values)
        for key, several_values in values.items():
            if isinstance(several_values, str) or not isinstance(several_values, Iterable) or getattr(several_values, "ndim", None) == 0:
                problem = f"`{key}`: {_checks.shown(several_values)} is no list of values"
                raise ArgumentError(problem, "argument `values`", remedy="give a list, of one value if there is one")
        several = [[_plain(value) for value in values[key]] for key in swept]
        runs = [dict(zip(swept, combination, strict=True)) for combination in itertools.product(*several)]
    else:
        if not isinstance(values, Iterable):
            raise ArgumentError(f"{_checks.shown(values)} has no keys", "argument `values`", remedy="give a mapping from keys to lists of values")
        given = list(values)
        if not all(isinstance(run, Mapping) for run in given):
            raise ArgumentError("not every run is a mapping", "argument `values`", remedy="give each run its keys and values")
        swept = tuple(given[0]) if given else ()
        if any(set(run) != set(swept) for run in given):
            raise ArgumentError("not all runs have the same keys", "argument `values`", remedy="give every run every key")
        runs = [{key: _plain(run[key]) for key in swept} for run in given]
    for key in swept:
        if not isinstance(key, str):
            raise ArgumentError(f"{_checks.shown(key)} is not a key", "argument `values`", remedy="give keys as those of `simulate(..., set=...)`")
    if not runs or not swept:
        raise ArgumentError("there is nothing to run", "argument `values`", remedy="give each key at least one value")
    return runs, swept


def _on_threads(run: _Run, todo: Mapping[int, Values], n_jobs: int) -> Ended:
    """Runs with their numbers as they end; the interpreter is released while they run."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    pool = ThreadPoolExecutor(cores if n_jobs == -1 else n_jobs)
    try:
        number = {pool.submit(run, values): i for i, values in todo.items()}
        for future in as_completed(number):
            yield number[future], future.result()
    finally:
        pool.shutdown(cancel_futures=True)


def _on_cluster(run: _Run, todo: Mapping[int, Values], client: Any) -> Ended:
    """Runs with their numbers as they end. A few for every thread of the cluster are on their way, however many there are in all."""
    completed = extra("distributed", "dask").as_completed

    waiting, name = iter(todo.items()), f"sweep-{uuid.uuid4().hex}"

    def submit(count: int) -> list[Any]:
        some = itertools.islice(waiting, count)
        return [client.submit(run, values, key=f"{name}-{i}") for i, values in some]

    under_way = completed(submit(max(8, 4 * sum(client.nthreads().values()))))
    try:
        for future in under_way:
            yield int(future.key.removeprefix(f"{name}-")), future.result()
            for another in submit(1):
                under_way.add(another)
    finally:
        client.cancel(list(under_way.futures))


class _Journal:
    """The runs of a sweep that have ended, one a line of JSON, in any order: what an interrupted sweep leaves."""

    def __init__(self, target: Path | None, what: Sequence[Any]) -> None:
        self.path = None if target is None else target.with_name(target.name + ".journal")
        self.rows: dict[int, dict[str, Any]] = {}
        self._file = None
        if self.path is None:
            return
        digest = hashlib.sha256(_json(what).encode()).hexdigest()
        head = json.dumps({"gyroflex sweep": digest}) + "\n"
        text = _text_of(self.path) if self.path.exists() else ""
        # A line that was being written when the program or the machine stopped.
        kept = text[: text.rfind("\n") + 1]
        lines = kept.splitlines()
        # A head alone is of a call that failed before anything had run.
        if len(lines) == 1:
            kept = ""
        if kept and not kept.startswith(head):
            raise FileError("it is of a sweep over other values", "output", str(self.path), "name another output, or remove this file")
        for number, line in enumerate(lines[1:], start=2):
            try:
                i, row = json.loads(line)
            except ValueError:
                where = f"{self.path}:{number}"
                raise FileError("the line is damaged", "output", where, "take it out, or name another output") from None
            self.rows[i] = row
        try:
            self._file = self.path.open("a", encoding="utf-8")
        except OSError as error:
            raise FileError(f"it cannot be written: {error.strerror}", "output", str(self.path), "name another output") from error
        self._file.truncate(len(kept.encode()))
        if not kept:
            self._file.write(head)
            self._file.flush()

    def add(self, i: int, row: Mapping[str, Any]) -> None:
        """Keeps a run, one write a line."""
        if self._file is not None:
            self._file.write(_json([i, row]) + "\n")
            self._file.flush()

    def close(self) -> None:
        if self._file is not None:
            self._file.close()

    def remove(self) -> None:
        """The table is complete."""
        if self.path is not None:
            self.path.unlink()


def _text_of(journal: Path) -> str:
    try:
        return journal.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise FileError(f"it cannot be read: {error}", "output", str(journal), "name another output, or remove it") from error


def _check_output(target: Path, overwrite: bool) -> None:
    if target.suffix not in (".parquet", ".csv"):
        raise ArgumentError(f"`{target.name}` is no file for a table", "argument `output`", remedy="end it in .parquet or .csv")
    if not target.absolute().parent.is_dir():
        raise FileError("its folder does not exist", "output", str(target), "make the folder first")
    if target.is_dir():
        raise FileError("it is a folder", "output", str(target), "name another file")
    if target.exists() and not overwrite:
        raise FileError("it exists already", "output", str(target), "name another file, remove this one, or say `overwrite=True`")
    if target.suffix == ".parquet":
        extra("pyarrow.parquet", "sweep")  # before hours of runs, not after


def _check_last(run: _Run, runs: Sequence[Values], rows: dict[int, dict[str, Any]], path: Path | None) -> None:
    """Refuses to go on if a run that was kept comes out otherwise now."""
    last = next(reversed(rows))
    if _json(run(runs[last])) != _json(rows[last]):
        problem = "a run that it has comes out otherwise now: the scenario, the robot, the measure or the program have changed since"
        raise FileError(problem, "output", str(path), "name another output, or remove this file")


def _columns(swept: tuple[str, ...], runs: Sequence[Values], rows: Sequence[Mapping[str, Any]]) -> dict[str, NDArray[Any]]:
    """Rows as columns: the keys, the measures, the errors."""
    measured = next((tuple(row) for row in rows if "error" not in row), ())
    for i, row in enumerate(rows):
        if "error" not in row and tuple(row) != measured:
            problem = f"run {i} measured other things than the runs before it: {', '.join(row)}"
            raise ArgumentError(problem, "argument `measure`", remedy="measure the same for every run")
    columns = {key: _array([run[key] for run in runs]) for key in swept}
    columns.update({name: _array([row.get(name) for row in rows]) for name in measured})
    columns["error"] = np.array([row.get("error", "") for row in rows], dtype=object)
    return columns


def _array(values: list[Any]) -> NDArray[Any]:
    """Numbers and truth values as such, with NaN for what is missing; else texts, of lists and mappings as JSON."""
    given = [value for value in values if value is not None]
    if given and len(given) == len(values) and all(isinstance(value, bool) for value in given):
        return np.array(values, dtype=bool)
    if given and all(isinstance(value, int | float) for value in given):
        return np.array([np.nan if value is None else float(value) for value in values])
    texts = [value if value is None or isinstance(value, str) else _json(value) for value in values]
    array = np.empty(len(texts), dtype=object)
    array[:] = texts
    return array


def _write(target: Path, columns: Mapping[str, NDArray[Any]]) -> None:
    """Writes the table beside its place first: a file that is there is whole."""
    part = target.with_name(target.name + ".part")
    if target.suffix == ".parquet":
        pyarrow, parquet = extra("pyarrow", "sweep"), extra("pyarrow.parquet", "sweep")
        parquet.write_table(pyarrow.table({name: pyarrow.array(column) for name, column in columns.items()}), part)
    else:
        with part.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(columns)
            writer.writerows(zip(*(["" if _missing(x) else x for x in column.tolist()] for column in columns.values()), strict=True))
    part.replace(target)


def _missing(value: Any) -> bool:
    return value is None or value != value


class _NoBar:
    def __enter__(self) -> _NoBar:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def update(self) -> None:
        pass


def _bar(shown: bool, total: int, initial: int) -> Any:
    """A bar of tqdm, or none."""
    if shown and importlib.util.find_spec("tqdm"):
        return extra("tqdm", "sweep").tqdm(total=total, initial=initial, unit="run")
    return _NoBar()
