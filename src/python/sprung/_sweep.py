"""Runs sweeps by the program sprung, and reads their results."""
import csv
import json
import os
import shutil
import subprocess
import sys
import warnings
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy
import numpy.typing

from ._errors import FileError, InputError, Problem, SprungWarning
from ._scene import plain

_ERROR = "sprung: error: "
_DONE, _USAGE, _INVALID, _FAILED_RUNS, _INTERRUPTED = 0, 2, 3, 4, 130


def _program() -> str:
    """The program beside which this package is installed or built, else that of the PATH."""
    for folder in Path(__file__).absolute().parents:
        program = folder / "bin" / "sprung"
        if os.access(program, os.X_OK):
            return str(program)
    found = shutil.which("sprung")
    if found is None:
        raise FileError("cannot find the program sprung, which does the runs; add its folder to PATH")
    return found


def _refuse(key: str, rule: str, remedy: str) -> InputError:
    return InputError(f"{key}: {rule}; {remedy}", (Problem("", key, "", rule, remedy),))


def _json(key: str, value: Any) -> str:
    try:
        return json.dumps(value, default=plain, allow_nan=False)
    except (TypeError, ValueError) as error:
        raise _refuse(key, f"must be what JSON can hold: {error}",
                      "use dicts with texts as keys, lists, texts, finite numbers, booleans and None") from None


def _values(key: str, values: Any) -> str:
    if isinstance(values, (str, bytes, Mapping)) or not hasattr(values, "__iter__"):
        raise _refuse(f"vary[{key!r}]", f"must be a list of values, not a {type(values).__name__}", "write [value, value]")
    return key + "=" + ",".join(_json(key, value) for value in values)


def _call(words: List[str], scene: Optional[str], shows: bool) -> Tuple[int, List[str]]:
    """Runs the program. Returns its exit code and its errors; what else it says is shown or left out."""
    try:
        # In a session of its own, Ctrl-C reaches it through this process alone, which asks it to end once.
        started = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   encoding="utf-8", errors="replace", start_new_session=True)
    except OSError as error:
        raise FileError(f"cannot start {words[0]}: {error.strerror}") from None
    with started as process:
        assert process.stdin is not None and process.stderr is not None
        errors = []
        try:
            try:
                process.stdin.write(scene or "")
                process.stdin.close()
            except BrokenPipeError:
                pass  # it refused its options before it read the scene
            for line in process.stderr:
                if line.startswith(_ERROR):
                    errors.append(line[len(_ERROR):].rstrip("\n").replace("standard input", "<dict>", 1))
                elif shows:
                    sys.stderr.write(line)
            return process.wait(), errors
        except BaseException:
            process.terminate()
            process.stderr.read()
            raise


def _raise_unless_done(code: int, errors: List[str]) -> None:
    if code in (_DONE, _FAILED_RUNS):
        return
    if code == _INTERRUPTED:
        raise KeyboardInterrupt
    text = "\n".join(errors) or f"sprung ended with exit code {code}"
    if code in (_USAGE, _INVALID):
        raise InputError(text, tuple(Problem("", "", "", error, "") for error in errors))
    raise FileError(text)


def _column(texts: List[str]) -> "numpy.typing.NDArray[Any]":
    try:
        return numpy.array([int(text) for text in texts], dtype=numpy.int64)
    except (ValueError, OverflowError):
        pass
    try:
        return numpy.array([float(text or "nan") for text in texts], dtype=numpy.float64)
    except ValueError:
        return numpy.array(texts, dtype=numpy.str_)


def sweep_results(folder: Union[str, "os.PathLike[str]"]) -> "Dict[str, numpy.typing.NDArray[Any]]":
    """The results of a sweep so far: an array for each column of its results.csv, with an entry for each run that ended.

    Columns are ``number``, ``status`` (``done`` or ``failed``), ``exit_code``, ``seconds``; the keys that vary; the last row of
    the run's diagnostics; ``largest_stretch`` and ``largest_stretch_excess`` [1] of all its frames, and ``wall_seconds``. Whole
    numbers are int64, others float64 with NaN for what is missing, and texts str. ``pandas.DataFrame(sweep_results(folder))`` is
    a table.

    Raises InputError if the folder has no sweep, and FileError if it cannot be read.
    """
    path = os.fspath(folder)
    _raise_unless_done(*_call([_program(), "sweep", "--status", path], None, False))  # brings results.csv up to date
    try:
        with open(os.path.join(path, "results.csv"), newline="", encoding="utf-8") as file:
            names, *rows = csv.reader(file)
    except FileNotFoundError:
        raise FileError(f"cannot read {path}: the sweep has just begun; ask again later") from None
    except OSError as error:
        raise FileError(f"cannot read {path}: {error}") from None
    return {name: _column([row[place] for row in rows]) for place, name in enumerate(names)}


def sweep(scene: Union[str, "os.PathLike[str]", Mapping[str, Any]], out: Union[str, "os.PathLike[str]"], *,
          vary: Optional[Mapping[str, Iterable[Any]]] = None, sample: Optional[Mapping[str, str]] = None, count: int = 0,
          seed: int = 0, overrides: Optional[Mapping[str, Any]] = None, mesh_paths: Iterable[Union[str, "os.PathLike[str]"]] = (),
          formats: Iterable[str] = ("none",), frames: Optional[int] = None, jobs: Optional[int] = None, retry_failed: bool = False,
          engine: str = "local", array_size: Optional[int] = None, account: Optional[str] = None, partition: Optional[str] = None,
          time: Optional[str] = None, progress: bool = False) -> "Dict[str, numpy.typing.NDArray[Any]]":
    """Run a scene once for each combination of values, each run as a process of the program sprung, and return the results.

    scene: a path of a JSON file, or a dict with the same keys, which is kept in ``out``.
    out: the folder of the sweep. The same call goes on with what is there: what is done is not done again.
    vary: values of keys, ``{"bodies.cloth.mass": [0.1, 0.2], "gravity": [[0, -9.81, 0], [0, -1.62, 0]]}``.
    sample: distributions of keys, ``{"bodies.cloth.friction": "uniform(0.1, 0.5)"}``; also log_uniform(a, b), integer(a, b) and
    normal(mean, deviation). count: how many samples, each with every combination of ``vary``. seed: of the samples.
    overrides: values of keys that are the same in all runs. mesh_paths: as of load().
    formats: frames of each run, such as ``["npz"]``; none by default. frames: their number, instead of the scene's duration.
    jobs: runs at the same time, by default one for each core. retry_failed: run those again that failed in a former call.
    engine: "slurm" submits an array job of array_size tasks and returns at once; account, partition and time are passed to Slurm.
    Ask for its results by sweep_results(), and go on after its time limit by the same call.
    progress: write lines of progress to the standard error.

    Returns what sweep_results(out) does, and tells of failed runs by a SprungWarning.

    Raises InputError with all problems of the scene and the values, or with the differences if ``out`` has another sweep; FileError if
    files cannot be written or Slurm is not installed. Ctrl-C ends the runs; the same call goes on.
    """
    path = os.fspath(out)
    is_dict = isinstance(scene, Mapping)
    words = [_program(), "sweep", "-" if is_dict else os.fspath(scene), "--out", path]  # type: ignore[arg-type]

    def add(option: str, *values: Any) -> None:
        for value in values:
            if value is not None:
                words.append(f"{option}={value}")

    add("--vary", *(_values(key, values) for key, values in (vary or {}).items()))
    add("--sample", *(f"{key}={text}" for key, text in (sample or {}).items()))
    add("--count", count or None)
    add("--seed", seed)
    add("--set", *(f"{key}={_json(key, value)}" for key, value in (overrides or {}).items()))
    add("--mesh-path", *(os.fspath(folder) for folder in mesh_paths), *([os.getcwd()] if is_dict else []))
    add("--format", formats if isinstance(formats, str) else ",".join(formats))
    add("--frames", frames)
    add("--jobs", jobs)
    add("--engine", engine)
    add("--array-size", array_size)
    add("--account", account)
    add("--partition", partition)
    add("--time", time)
    if retry_failed:
        words.append("--retry-failed")
    if not progress:
        words.append("--quiet")
    code, errors = _call(words, _json("scene", scene) if is_dict else None, progress)
    _raise_unless_done(code, errors)
    if code == _FAILED_RUNS:
        first = errors[0] if errors else f"see {os.path.join(path, 'manifest.json')}"
        warnings.warn(f"runs of the sweep failed: {first}", SprungWarning, stacklevel=2)
    return sweep_results(path)
