"""Vibrissa: why the whisker or airflow sensor on the bench differs from the one in the simulation.

Records are NumPy arrays with units in their names (SI). What each function returns as a `report` is
the very document that the program prints with --json. docs/notebook.md walks from a recording to a
verdict.
"""
import json as _json
import os as _os
import tempfile as _tempfile

from . import _core
from ._core import (
    Bvrm,
    Dataset,
    Model,
    Record,
    TooLittleData,
    ResourceError,
    UserError,
    read_dataset,
    read_record,
    write_record,
)

__all__ = [
    "Bvrm",
    "Dataset",
    "Diagnosis",
    "Identification",
    "Model",
    "Record",
    "TooLittleData",
    "ResourceError",
    "UserError",
    "diagnose",
    "identify",
    "read_dataset",
    "read_record",
    "separate",
    "simulate",
    "solve",
    "write_record",
]


class Identification:
    """A base vibration response model found in a record: `model`, and `report` as a dict."""

    def __init__(self, model, report):
        self.model = model
        self.report = report

    def __repr__(self):
        modes = ", ".join(f"{mode['frequency_hz']:.3f} Hz" for mode in self.report["modes"])
        return f"Identification({modes}; fit {self.report['fit_percent']:.2f} %)"


class Diagnosis:
    """Why records differ from a simulation: `report` (diagnosis.json as a dict), `words` for people,
    `updated`, the simulation with what was found."""

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
        return f"Diagnosis({self.verdict}, probability {best['probability']:.2f})"


def identify(record, *, held_out=None, order=None, max_order=6, period_samples=0,
             method="output-error", hold=None, direct_term=True):
    """Finds the model from base_acceleration_m_s2 to base_moment_N_m.

    Without `held_out` the last third of the record only scores the model. `order` is the number of
    poles, two for each mode; by default an information criterion chooses it.
    """
    model, report = _core.identify(record, held_out, order, max_order, period_samples, method, hold,
                                   direct_term)
    return Identification(model, _json.loads(report))


def separate(record, *, model=None, methods=("fdaf",), block=64, taps=512, step=None,
             hold=None):
    """The wind's part of the base moment [N m], one array for each method.

    `model`, a Bvrm or an Identification, adds the method "bvrm". `hold`, how the base acceleration
    runs between its samples, is by default as the model was fitted, else "first_order".
    `methods`: one name or several of those that `vibrissa separate --help` lists.
    """
    if isinstance(methods, str):
        methods = (methods,)
    if isinstance(model, Identification):
        model = model.model
    return _core.separate(record, model, list(methods), block, taps, step, hold)


def diagnose(real, *, simulation, max_effects=3, possible_experiments=()):
    """Why the records `real` differ from `simulation`, and how far the gap closes.

    Either may be a path; `simulation` may be a Dataset (anybody's simulated records), a Model, a
    model.json, or a case file (.prm). Raises TooLittleData when nothing can be said.
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
    """The record of a sensor that is shaken and blown at as the case file (.prm) says.

    `settings`: entries that replace those of the file, as "SECTION/ENTRY=VALUE".
    """
    from . import _solid

    rate_hz, start_s, channels = _solid.simulate(_os.fspath(case), list(settings))
    return Record(rate_hz, channels, start_s)


def solve(case, *, settings=()):
    """The reduced model of the solid that a case file (.prm) describes."""
    from . import _solid

    with _tempfile.TemporaryDirectory() as folder:
        file = _os.path.join(folder, "model.json")
        _solid.write_model(_os.fspath(case), list(settings), file)
        return Model.read(file)
