#!/usr/bin/env python3
"""SciPy, NumPy and Octave read the record files that `vibrissa convert` writes, and it reads theirs.

usage: exchange.py VIBRISSA
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np
import scipy.io
import scipy.signal

VIBRISSA = sys.argv[1]
RATE_HZ = 1000.0 / 3.0
CHANNELS = ("base_acceleration_m_s2", "base_moment_N_m")


def run(*arguments):
    done = subprocess.run(arguments, capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{arguments}: {done.stdout}{done.stderr}"
    return done.stdout


def sample():
    random = np.random.default_rng(3)
    n = 300
    values = {name: random.standard_normal(n) * 10.0 ** random.integers(-9, 9, n) for name in CHANNELS}
    return {"time_s": 0.25 + np.arange(n) / RATE_HZ, **values}


def check_equal(found, expected, where, relative=0.0):
    for name in CHANNELS:
        error = np.abs(np.asarray(found[name], dtype=float).ravel() - expected[name])
        assert np.all(error <= relative * np.abs(expected[name])), f"{where}: {name}"
    time = np.asarray(found["time_s"], dtype=float).ravel()
    assert np.allclose(time, expected["time_s"], rtol=1e-12, atol=1e-12), f"{where}: time"


def write_csv(path, record):
    rows = zip(*(record[name].tolist() for name in ("time_s", *CHANNELS)))
    lines = [",".join(("time_s", *CHANNELS))] + [",".join(map(repr, row)) for row in rows]
    path.write_text("\n".join(lines) + "\n")


def read_csv(path):
    return np.genfromtxt(path, delimiter=",", names=True)


def scipy_reads_a_response(folder):
    """The response that SciPy itself estimates from the same record, by the same windows."""
    random = np.random.default_rng(5)
    acceleration = random.standard_normal(4000)
    moment = -2e-5 * scipy.signal.lfilter([1.0], [1.0, -1.2, 0.7], acceleration)
    write_csv(folder / "f.csv", {"time_s": np.arange(4000) / RATE_HZ, **dict(zip(CHANNELS, (acceleration, moment)))})
    run(VIBRISSA, "bode", folder / "f.csv", "--rate", repr(RATE_HZ), "--segment", "64", "--response", folder / "f.mat")
    found = scipy.io.loadmat(folder / "f.mat")
    f, cross = scipy.signal.csd(acceleration, moment, RATE_HZ, "hann", 64, detrend="constant")
    _, power = scipy.signal.welch(acceleration, RATE_HZ, "hann", 64, detrend="constant")
    expected = (cross / power)[1:-1]
    assert np.allclose(found["frequency_hz"].ravel(), f[1:-1], rtol=1e-9), "frequencies"
    assert np.allclose(found["response"].ravel(), expected, rtol=1e-9), "response"
    assert "exp(+j w t)" in str(found["convention"]), "convention"


def responses_of_others(folder):
    """A response that SciPy writes, through every format of responses, to the modes it was made of."""
    f = np.arange(1.0, 200.0, 0.25)
    s = 2j * np.pi * f
    w, zeta = 2 * np.pi * 31.47, 0.027
    response = -2e-5 * w**2 / (s**2 + 2 * zeta * w * s + w**2)
    in_mN_mm_per_g = response * 1e6 * 9.80665
    scipy.io.savemat(folder / "h.mat", {"f": f, "H": in_mN_mm_per_g})
    run(VIBRISSA, "convert", folder / "h.mat", folder / "h.uff", "--response-as", "H[mN mm/g]")
    run(VIBRISSA, "convert", folder / "h.uff", folder / "h.csv", "--frequency-response")
    run(VIBRISSA, "convert", folder / "h.csv", folder / "back.mat", "--frequency-response")
    back = scipy.io.loadmat(folder / "back.mat")
    assert np.allclose(back["response"].ravel(), response, rtol=1e-12), "a response through .uff and .csv"
    for name in ("h.uff", "h.csv", "back.mat"):
        found = json.loads(run(VIBRISSA, "identify", folder / name, "--frequency-response", "--order", "2", "--json"))
        mode = found["modes"][0]
        assert abs(mode["frequency_hz"] / 31.47 - 1) < 1e-9, f"{name}: {mode}"
        assert abs(mode["damping_ratio"] / zeta - 1) < 1e-8, f"{name}: {mode}"
        assert found["fit_percent"] > 99.99, f"{name}: {found}"


def model_through_a_universal_file(folder):
    """Dense, uneven frequencies, which the format rounds to six digits, and the modes that were solved."""
    coarse = ("--set", "Model/Mesh resolution=1")
    case = folder / "sensor.prm"
    run(VIBRISSA, "init", case)
    run(VIBRISSA, "bode", case, *coarse, "--response", folder / "model.uff")
    found = json.loads(run(VIBRISSA, "identify", folder / "model.uff", "--frequency-response", "--json"))
    solved = json.loads(run(VIBRISSA, "modes", case, *coarse, "--no-convergence", "--json"))
    first = found["modes"][0]["frequency_hz"]
    nearest = min(abs(first / mode["frequency_hz"] - 1) for mode in solved["modes"])
    assert nearest < 1e-4, f"mode at {first} Hz, solved: {solved['modes']}"


def scipy_and_numpy(folder, record):
    write_csv(folder / "r.csv", record)
    for name in ("r.mat", "r.npy", "r.h5"):
        run(VIBRISSA, "convert", folder / "r.csv", folder / name, "--rate", repr(RATE_HZ))
    check_equal(scipy.io.loadmat(folder / "r.mat"), record, "SciPy reads .mat")
    check_equal(np.load(folder / "r.npy"), record, "NumPy reads .npy")

    back = folder / "back.csv"
    scipy.io.savemat(folder / "s.mat", {**record, "fs": RATE_HZ})
    run(VIBRISSA, "convert", folder / "s.mat", back)
    check_equal(read_csv(back), record, "we read SciPy's .mat")
    scipy.io.savemat(folder / "c.mat", {"bench": record}, do_compression=True)
    columns = [f"--column={name}=bench.{name}" for name in CHANNELS]
    run(VIBRISSA, "convert", folder / "c.mat", back, *columns, "--column=time=bench.time_s")
    check_equal(read_csv(back), record, "we read SciPy's struct")
    structured = np.zeros(record["time_s"].size, dtype=[(name, ">f8") for name in record])
    for name, values in record.items():
        structured[name] = values
    np.save(folder / "s.npy", structured)
    run(VIBRISSA, "convert", folder / "s.npy", back)
    check_equal(read_csv(back), record, "we read NumPy's structured .npy")
    plain = np.asfortranarray(np.column_stack([record[name] for name in ("time_s", *CHANNELS)]))
    np.save(folder / "p.npy", plain)
    columns = [f"--column={name}=column_{i + 2}" for i, name in enumerate(CHANNELS)]
    run(VIBRISSA, "convert", folder / "p.npy", back, *columns, "--column=time=column_1[s]")
    check_equal(read_csv(back), record, "we read NumPy's matrix")


def octave(folder, record):
    write_csv(folder / "r.csv", record)
    for name in ("r.mat", "r.h5"):
        run(VIBRISSA, "convert", folder / "r.csv", folder / name, "--rate", repr(RATE_HZ))
    run(VIBRISSA, "convert", folder / "r.csv", folder / "r73.mat", "--mat-version", "7.3")
    names = "time_s base_acceleration_m_s2 base_moment_N_m"
    script = f"""
      warning('off', 'all');
      a = load('{folder}/r.mat'); b = load('{folder}/r.h5'); c = load('{folder}/r73.mat');
      for name = strsplit('{names}')
        n = name{{1}};
        assert(isequal(a.(n)(:), b.(n)(:), c.(n)(:)), n);
        eval([n ' = a.(n)(:);']);
      end
      fs = a.sampling_rate_hz;
      save('-v7', '{folder}/o7.mat', strsplit('{names}'){{:}}, 'fs');
      save('-v6', '{folder}/o6.mat', strsplit('{names}'){{:}}, 'fs');
      save('-v4', '{folder}/o4.mat', strsplit('{names}'){{:}}, 'fs');
    """
    run("octave-cli", "--norc", "--quiet", "--eval", script)
    for name in ("o7.mat", "o6.mat", "o4.mat"):
        run(VIBRISSA, "convert", folder / name, folder / "back.csv")
        check_equal(read_csv(folder / "back.csv"), record, f"we read Octave's {name}")


def main():
    record = sample()
    with tempfile.TemporaryDirectory() as name:
        scipy_and_numpy(pathlib.Path(name), record)
        scipy_reads_a_response(pathlib.Path(name))
        responses_of_others(pathlib.Path(name))
        model_through_a_universal_file(pathlib.Path(name))
        print("SciPy and NumPy: .mat and .npy both ways, responses as .mat, .uff and .csv")
        if shutil.which("octave-cli") is None:
            print("octave-cli is missing: its part is left out")
            return
        octave(pathlib.Path(name), record)
        print("Octave: .mat 4, 6, 7, 7.3 and .h5")


if __name__ == "__main__":
    main()
