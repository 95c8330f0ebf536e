"""Vibrissa finds why a whisker or airflow sensor on the bench differs from its simulation.

Records contain NumPy arrays in SI units; the names end in the unit. Each `report` is the document
that the program prints with --json. docs/notebook.md is an example: from a recording to a
diagnosis.
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


def identify(record, *, held_out=None, order=None, max_order=20, period_samples=0,
             method="output-error", hold=None, direct_term=True):
    """Identifies the model from base_acceleration_m_s2 to base_moment_N_m.

    Without `held_out`, the first two thirds of the record are fitted and the last third scores the
    model. `order` is the number of poles, two for each mode; by default an information criterion
    selects it.
    """
    model, report = _core.identify(record, held_out, order, max_order, period_samples, method, hold,
                                   direct_term)
    return Identification(model, _json.loads(report))


def separate(record, *, model=None, methods=("fdaf",), block=64, taps=512, step=None,
             hold=None):
    """Returns the part of the base moment that the wind causes [N m], one array for each method.

    `model` (a Bvrm or an Identification) adds the method "bvrm". `hold` is the assumed course of
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
