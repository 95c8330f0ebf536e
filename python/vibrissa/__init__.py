"""Vibrissa finds why a whisker or airflow sensor on the bench differs from its simulation.

Records contain NumPy arrays in SI units; the names end in the unit. Each `report` is the document
that the program prints with --json. docs/notebook.md is an example: from a recording to a
diagnosis.
"""
import json as _json
import os as _os
import tempfile as _tempfile
import warnings as _warnings

import numpy as _numpy

from . import _core
from ._core import (
    Bvrm,
    Dataset,
    Model,
    NonlinearBvrm,
    Record,
    TooLittleData,
    ResourceError,
    UserError,
    write_record,
)

__all__ = [
    "Bvrm",
    "Check",
    "Dataset",
    "Diagnosis",
    "Identification",
    "Model",
    "NonlinearBvrm",
    "Record",
    "TooLittleData",
    "ResourceError",
    "UserError",
    "check",
    "diagnose",
    "from_arrays",
    "identify",
    "read_dataset",
    "read_record",
    "separate",
    "simulate",
    "solve",
    "write_record",
]


class Identification:
    """Result of `identify`: the base vibration response model `model`, and `report` as a dict."""

    def __init__(self, model, report):
        self.model = model
        self.report = report

    def __repr__(self):
        modes = ", ".join(f"{mode['frequency_hz']:.5g} Hz" for mode in self.report["modes"])
        return f"Identification({modes}; fit {self.report['fit_percent']:.4g} %)"


class Diagnosis:
    """Why records differ from a simulation.

    `report` is diagnosis.json as a dict, `words` is the text for people, `updated` is the
    simulation with the effects that were found.
    """

    def __init__(self, answer):
        self.updated = answer.updated
        self.words = answer.words
        self.report = _json.loads(answer.json)

    @property
    def verdict(self):
        return self.report["verdict"]

    def __str__(self):
        return self.words

    def __repr__(self):
        best = self.report["ranking"][0]
        return f"Diagnosis({self.verdict}, probability {best['probability']:.2g})"


class Check:
    """What a recording is and which commands it serves.

    `report` is the document of `vibrissa check --json`, `words` is its text. `serves` gives "good",
    "limited" or "no" for each of identify, separate, diagnose and plan.
    """

    def __init__(self, texts):
        self.report = _json.loads(texts[0])
        self.words = texts[1]

    @property
    def serves(self):
        return {command: entry["verdict"] for command, entry in self.report["serves"].items()}

    def __str__(self):
        return self.words

    def __repr__(self):
        return f"Check({', '.join(f'{name}: {word}' for name, word in self.serves.items())})"


def _longest(recording, source):
    pieces, words = recording
    record = max(pieces, key=len)
    if len(pieces) > 1:
        _warnings.warn(f"{source}: samples are lost; the longest of {len(pieces)} pieces is used "
                       f"({words})", stacklevel=3)
    return record


def read_record(file, **options):
    """Reads .csv and other text, .mat, .h5, .npy, .uff or .wav as the commands do.

    Options: `columns` names the column and the unit of each channel, as in {"base_acceleration":
    "ax[g]", "base_moment": "B[uT]*0.18[N m/T]"}; `sampling_rate_hz` for a file without time;
    `remove_mean`, a list of channels; `rows`, the first and the last; `gaps`: "pieces" takes the
    longest piece between lost samples and warns, "refuse" raises UserError; `resample_hz` estimates
    even samples from uneven ones.
    """
    return _longest(_core.read_recording(_os.fspath(file), _core.FileOptions(**options)), file)


def read_dataset(source, **options):
    """Reads a folder of records, with or without dataset.json, or one record; options as
    `read_record`. Without `gaps` lost samples raise UserError."""
    options.setdefault("gaps", "refuse")
    return _core.read_dataset(_os.fspath(source), _core.FileOptions(**options))


def from_arrays(time, columns, units=None, **options):
    """Makes a Record of NumPy arrays or pandas columns, with the clock of the readers of files.

    `time` may jitter and miss samples; it is in seconds, in units["time"], or dates. None needs
    `sampling_rate_hz`. `columns` is a DataFrame or a dict. Names are channels with or without their
    unit ("base_moment"); `units` gives the units of columns, which are converted to SI. Other
    columns are kept as they are. Options as `read_record`. Raises UserError for values that are not
    finite and for uneven sampling (see `resample_hz`).
    """
    named = [(str(name), _numbers(columns[name])) for name in columns]
    if time is not None:
        time = _seconds(time)
    return _longest(_core.recording_of(time, named, dict(units or {}),
                                       _core.FileOptions(**options)), "arrays")


def _numbers(values):
    """A missing value of pandas is not a number."""
    if hasattr(values, "to_numpy") and values.dtype != float:
        return values.to_numpy(dtype=float, na_value=_numpy.nan)
    return _numpy.asarray(values, dtype=float)


def _seconds(time):
    if getattr(getattr(time, "dtype", None), "tz", None) is not None:
        time = time.to_numpy(dtype="datetime64[ns]")  # pandas, with a time zone
    time = _numpy.asarray(time)
    if _numpy.issubdtype(time.dtype, _numpy.datetime64):
        return (time - time[0]) / _numpy.timedelta64(1, "s")
    if _numpy.issubdtype(time.dtype, _numpy.timedelta64):
        return time / _numpy.timedelta64(1, "s")
    return _numpy.asarray(time, dtype=float)


def check(source, **options):
    """Says what a recording is, what is wrong with it and which commands it serves.

    `source` is a path (a file, a folder of records or its dataset.json; options as `read_record`)
    or a Record.
    """
    if isinstance(source, Record):
        if options:
            raise TypeError("check: a Record has been read; options are for files")
        return Check(_core.check_record(source))
    return Check(_core.check_file(_os.fspath(source), _core.FileOptions(**options)))


def identify(record, *, held_out=None, order=None, max_order=20, period_samples=0,
             method="output-error", hold=None, direct_term=True, nonlinear=False):
    """Identifies the model from base_acceleration_m_s2 to base_moment_N_m.

    Without `held_out`, the first two thirds of the record are fitted and the last third scores the
    model. `order` is the number of poles, two for each mode; by default an information criterion
    selects it. `nonlinear` also fits the law of the joint that the record asks for; the model is
    then a NonlinearBvrm.
    """
    identify_by = _core.identify_nonlinear if nonlinear else _core.identify
    model, report = identify_by(record, held_out, order, max_order, period_samples, method, hold,
                                direct_term)
    return Identification(model, _json.loads(report))


def separate(record, *, model=None, methods=("fdaf",), block=64, taps=512, step=None,
             hold=None):
    """Returns the part of the base moment that the wind causes [N m], one array for each method.

    `model` (a Bvrm, a NonlinearBvrm or an Identification) adds the method "bvrm". `hold` is the assumed course of
    the base acceleration between its samples; the default is the hold of the fit, else
    "first_order".
    `methods` is one name, or several names, of the methods that `vibrissa separate --help` lists.
    """
    if isinstance(methods, str):
        methods = (methods,)
    if isinstance(model, Identification):
        model = model.model
    return _core.separate(record, model, list(methods), block, taps, step, hold)


def diagnose(real, *, simulation, max_effects=3, possible_experiments=()):
    """Finds why the records `real` differ from `simulation`, and how much of the gap is closed.

    Both may be paths. `simulation` may be a Dataset (simulated records of any program), a Model, a
    model.json or a case file (.prm). Raises TooLittleData when the data allow no answer.
    """
    rate_hz = 0.0
    if isinstance(simulation, (str, _os.PathLike)):
        simulation = _read_simulation(_os.fspath(simulation))
    if isinstance(simulation, Dataset):
        rate_hz = simulation.records[0][1].sampling_rate_hz
        simulation = Model.from_records(simulation)
    if isinstance(real, (str, _os.PathLike)):
        real = read_dataset(real)
    return Diagnosis(_core.diagnose(simulation, real, max_effects, rate_hz,
                                    list(possible_experiments)))


def _read_simulation(path):
    if path.endswith(".prm"):
        return solve(path)
    return Model.read(path) if path.endswith(".json") else read_dataset(path)


def simulate(case, *, settings=()):
    """Simulates the base moment under base vibration and wind, as the case file (.prm) describes.

    Returns a Record. `settings` replace entries of the case file: "SECTION/ENTRY=VALUE".
    """
    from . import _solid

    rate_hz, start_s, channels = _solid.simulate(_os.fspath(case), list(settings))
    return Record(rate_hz, channels, start_s)


def solve(case, *, settings=()):
    """Returns the reduced model of the solid that the case file (.prm) describes."""
    from . import _solid

    with _tempfile.TemporaryDirectory() as folder:
        file = _os.path.join(folder, "model.json")
        _solid.write_model(_os.fspath(case), list(settings), file)
        return Model.read(file)
