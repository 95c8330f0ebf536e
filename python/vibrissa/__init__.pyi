from os import PathLike
from typing import Any, Iterable, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

_Path = Union[str, PathLike[str]]
_Array = NDArray[np.float64]

class UserError(ValueError): ...
class ResourceError(OSError): ...
class TooLittleData(RuntimeError): ...

class Record:
    def __init__(
        self, sampling_rate_hz: float, channels: Mapping[str, _Array], start_s: float = ...
    ) -> None: ...
    @property
    def sampling_rate_hz(self) -> float: ...
    @property
    def start_s(self) -> float: ...
    @property
    def duration_s(self) -> float: ...
    @property
    def channel_names(self) -> list[str]: ...
    @property
    def time_s(self) -> _Array: ...
    def __len__(self) -> int: ...
    def __contains__(self, name: str) -> bool: ...
    def __getitem__(self, name: str) -> _Array: ...

class Dataset:
    def __len__(self) -> int: ...
    @property
    def records(self) -> list[tuple[str, Record]]: ...
    @property
    def guesses(self) -> list[str]: ...

class Bvrm:
    @staticmethod
    def read(file: _Path) -> Bvrm: ...
    def write(self, file: _Path) -> None: ...
    def response(self, frequency_hz: Sequence[float]) -> NDArray[np.complex128]: ...
    @property
    def json(self) -> str: ...

class NonlinearBvrm:
    @staticmethod
    def read(file: _Path) -> NonlinearBvrm: ...
    def write(self, file: _Path) -> None: ...
    @property
    def json(self) -> str: ...

class Model:
    @staticmethod
    def read(file: _Path) -> Model: ...
    @staticmethod
    def from_records(simulated: Dataset) -> Model: ...
    def write(self, file: _Path) -> None: ...
    def simulate(self, inputs: Record, *, periodic: bool = ...) -> _Array: ...

class Identification:
    model: Union[Bvrm, NonlinearBvrm]
    report: dict[str, Any]

class Check:
    report: dict[str, Any]
    words: str
    @property
    def serves(self) -> dict[str, str]: ...

class Diagnosis:
    updated: Model
    words: str
    report: dict[str, Any]
    @property
    def verdict(self) -> str: ...

def read_record(
    file: _Path,
    *,
    columns: Mapping[str, str] = ...,
    sampling_rate_hz: Optional[float] = ...,
    remove_mean: Sequence[str] = ...,
    gaps: str = ...,
    resample_hz: Optional[float] = ...,
    rows: Optional[tuple[int, int]] = ...,
) -> Record: ...
def from_arrays(
    time: Optional[Any],
    columns: Mapping[str, Any],
    units: Optional[Mapping[str, str]] = ...,
    *,
    sampling_rate_hz: Optional[float] = ...,
    remove_mean: Sequence[str] = ...,
    gaps: str = ...,
    resample_hz: Optional[float] = ...,
    rows: Optional[tuple[int, int]] = ...,
) -> Record: ...
def check(
    source: Union[_Path, Record],
    *,
    columns: Mapping[str, str] = ...,
    sampling_rate_hz: Optional[float] = ...,
    remove_mean: Sequence[str] = ...,
    gaps: str = ...,
    resample_hz: Optional[float] = ...,
    rows: Optional[tuple[int, int]] = ...,
) -> Check: ...
def write_record(file: _Path, record: Record) -> None: ...
def read_dataset(
    source: _Path,
    *,
    columns: Mapping[str, str] = ...,
    sampling_rate_hz: Optional[float] = ...,
    remove_mean: Sequence[str] = ...,
    gaps: str = ...,
    resample_hz: Optional[float] = ...,
    rows: Optional[tuple[int, int]] = ...,
) -> Dataset: ...
def identify(
    record: Record,
    *,
    held_out: Optional[Record] = ...,
    order: Optional[int] = ...,
    max_order: int = ...,
    period_samples: int = ...,
    method: str = ...,
    hold: Optional[str] = ...,
    direct_term: bool = ...,
    nonlinear: bool = ...,
) -> Identification: ...
def separate(
    record: Record,
    *,
    model: Union[Bvrm, NonlinearBvrm, Identification, None] = ...,
    methods: Iterable[str] = ...,
    block: int = ...,
    taps: int = ...,
    step: Optional[float] = ...,
    hold: Optional[str] = ...,
) -> dict[str, _Array]: ...
def diagnose(
    real: Union[_Path, Dataset],
    *,
    simulation: Union[_Path, Dataset, Model],
    max_effects: int = ...,
    possible_experiments: Iterable[str] = ...,
) -> Diagnosis: ...
def simulate(case: _Path, *, settings: Iterable[str] = ...) -> Record: ...
def solve(case: _Path, *, settings: Iterable[str] = ...) -> Model: ...
