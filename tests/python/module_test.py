#!/usr/bin/env python3
"""The Python package gives, to the last bit, what the program gives.

usage: module_test.py VIBRISSA CASE
"""
import ctypes
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import vibrissa

PROGRAM, CASE = sys.argv[1], sys.argv[2]
QUICK = ["Model/Mesh resolution=1", "Model/Sensitivities=false", "Records/Duration=8"]


def kernel_of_this_process():
    """On a processor that OpenBLAS does not know the program starts anew with another kernel, which
    rounds otherwise; a module cannot."""
    try:
        name = ctypes.CDLL("libopenblas.so.0").openblas_get_corename
    except (OSError, AttributeError):
        return {}
    name.restype = ctypes.c_char_p
    return {"OPENBLAS_CORETYPE": name().decode()}


def program(*arguments):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False,
                          env=os.environ | kernel_of_this_process())
    assert done.returncode == 0, done.stderr
    return done.stdout


class Module(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.path = pathlib.Path(cls.folder.name)
        settings = [word for setting in QUICK for word in ("--set", setting)]
        program("simulate", CASE, "--record", str(cls.path / "r.csv"), "--write-model",
                str(cls.path / "model.json"), "--quiet", *settings)
        cls.record = vibrissa.read_record(cls.path / "r.csv")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_simulates_the_same_record(self):
        record = vibrissa.simulate(CASE, settings=QUICK)
        self.assertEqual(record.channel_names, self.record.channel_names)
        for name in record.channel_names:
            np.testing.assert_array_equal(record[name], self.record[name])

    def test_checks_as_the_program_does(self):
        done = subprocess.run([PROGRAM, "check", "--json", str(self.path / "r.csv")],
                              capture_output=True, text=True, check=False,
                              env=os.environ | kernel_of_this_process())
        self.assertIn(done.returncode, (0, 3), done.stderr)
        expected = json.loads(done.stdout)
        of_file = vibrissa.check(self.path / "r.csv")
        self.assertEqual(of_file.report, expected)
        of_record = vibrissa.check(self.record)
        self.assertEqual(of_record.serves, of_file.serves)
        self.assertEqual(set(of_record.serves), {"identify", "separate", "diagnose", "plan"})

    def test_takes_arrays_with_the_clock_and_units_of_files(self):
        random = np.random.default_rng(1)
        even = np.arange(2000) / 500.0
        jittering = np.round(even + random.normal(0, 2e-4, even.size), 3)
        values = random.normal(size=even.size)
        record = vibrissa.from_arrays(1e3 * jittering, {"base_acceleration": values, "hall": values},
                                      {"time": "ms", "base_acceleration": "g"})
        self.assertAlmostEqual(record.sampling_rate_hz, 500, delta=0.1)
        np.testing.assert_allclose(record["base_acceleration_m_s2"], 9.80665 * values)
        np.testing.assert_array_equal(record["hall"], values)
        dates = np.datetime64("2024-01-02T10:11:12") + (even * 1e6).astype("timedelta64[us]")
        self.assertEqual(vibrissa.from_arrays(dates, {"base_moment": values}).sampling_rate_hz, 500)
        without = vibrissa.from_arrays(None, {"base_moment": values}, sampling_rate_hz=250)
        self.assertEqual(without.sampling_rate_hz, 250)
        kept = np.r_[0:900, 910:2000]
        with self.assertWarns(UserWarning):
            longest = vibrissa.from_arrays(even[kept], {"base_moment": values[kept]})
        self.assertEqual(len(longest), 1090)
        for time, columns, units, options in (
                (even[kept], {"base_moment": values[kept]}, {}, {"gaps": "refuse"}),
                (even, {"base_moment": values[:100]}, {}, {}),
                (even, {"base_moment": np.where(even > 1, np.nan, values)}, {}, {}),
                (even, {"base_moment": values}, {"base_moment": "g"}, {}),
                (even, {"base_moment": values}, {"bas_moment": "N m"}, {}),
                (None, {"base_moment": values}, {}, {}),
                (np.cumsum(random.exponential(size=2000)), {"base_moment": values}, {}, {})):
            with self.assertRaises(vibrissa.UserError):
                vibrissa.from_arrays(time, columns, units, **options)

    def test_takes_pandas(self):
        try:
            import pandas
        except ImportError:
            self.skipTest("pandas is not installed")
        random = np.random.default_rng(3)
        even = np.arange(2000) / 500
        table = pandas.DataFrame({"base_moment": random.normal(size=2000),
                                  "base_acceleration": random.normal(size=2000)})
        stamps = pandas.Timestamp("2024-01-02T10:11:12") + pandas.to_timedelta(even, unit="s")
        for time in (pandas.Series(even), stamps, stamps.tz_localize("Europe/Vienna"),
                     pandas.Series(stamps.tz_localize("UTC")), stamps - stamps[0]):
            record = vibrissa.from_arrays(time, table, {"base_acceleration": "g"})
            self.assertEqual(record.sampling_rate_hz, 500)
            np.testing.assert_allclose(record["base_acceleration_m_s2"],
                                       9.80665 * table["base_acceleration"])
        gap = table.convert_dtypes()
        gap.loc[7, "base_moment"] = pandas.NA
        with self.assertRaises(vibrissa.UserError):
            vibrissa.from_arrays(even, gap)

    def test_identifies_the_same_model(self):
        found = vibrissa.identify(self.record, order=2)
        said = json.loads(program("identify", str(self.path / "r.csv"), "--order", "2", "-o",
                                  str(self.path / "bvrm.json"), "--json"))
        self.assertEqual(found.report, said)
        self.assertEqual(json.loads(found.model.json),
                         json.loads((self.path / "bvrm.json").read_text()))
        self.assertEqual(found.model.response([1.0, 2.0]).shape, (2,))

    def test_separates_the_same_signals(self):
        found = vibrissa.identify(self.record, order=2)
        found.model.write(self.path / "m.json")
        program("separate", str(self.path / "r.csv"), "--model", str(self.path / "m.json"),
                "--method", "fdaf", "--method", "kalman", "-o", str(self.path / "s.csv"), "--quiet")
        written = vibrissa.read_record(self.path / "s.csv")
        for name, values in vibrissa.separate(self.record, model=found,
                                              methods=["fdaf", "kalman"]).items():
            np.testing.assert_array_equal(values, written[f"wind_moment_{name}_N_m"])

    def test_identifies_and_separates_the_same_with_a_law_of_the_joint(self):
        file = str(self.path / "nonlinear.json")
        printed = json.loads(program("identify", str(self.path / "r.csv"), "--nonlinear", "--order",
                                     "2", "-o", file, "--json"))
        found = vibrissa.identify(self.record, order=2, nonlinear=True)
        self.assertEqual(found.report, printed)
        document = json.loads(found.model.json)
        document["law"] = [{"kind": "cubic_stiffness", "coefficient": 1e9}]
        pathlib.Path(file).write_text(json.dumps(document))
        program("separate", str(self.path / "r.csv"), "--model", file, "-o",
                str(self.path / "n.csv"), "--quiet")
        model = vibrissa.NonlinearBvrm.read(file)
        model.write(file)
        self.assertEqual(json.loads(model.json)["law"][0]["coefficient"], 1e9)
        separated = vibrissa.separate(self.record, model=model)
        np.testing.assert_array_equal(
            separated["bvrm"], vibrissa.read_record(self.path / "n.csv")["wind_moment_bvrm_N_m"])

    def test_reads_and_writes_alike_under_decimal_commas(self):
        script = """if True:
            import locale, sys
            print(locale.setlocale(locale.LC_ALL, sys.argv[1]), file=sys.stderr)
            import vibrissa
            record = vibrissa.read_record(sys.argv[2] + "/r.csv", columns={
                "base_acceleration": "base_acceleration_m_s2[g]*0.5[m/m]",
                "base_moment": "base_moment_N_m[mN mm]"})
            vibrissa.write_record(sys.argv[2] + "/written.csv", record)
            print(record, vibrissa.identify(record, order=2).report)
            simulated = vibrissa.simulate(sys.argv[3], settings=sys.argv[4:] + ["Wind/Mean speed=1.5"])
            print(float(abs(simulated["base_moment_N_m"]).sum()))"""
        if subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", str(self.path / "de_DE.UTF-8")],
                          capture_output=True, check=False).returncode:
            self.skipTest("no locales here (package locales)")
        said = []
        for name in ["C", "de_DE.UTF-8"]:
            done = subprocess.run(
                [sys.executable, "-c", script, name, str(self.path), CASE, *QUICK],
                env=dict(os.environ, LOCPATH=str(self.path)), capture_output=True, text=True,
                check=False)
            self.assertEqual(done.returncode, 0, done.stderr)
            said.append((done.stdout, (self.path / "written.csv").read_text()))
        self.assertEqual(*said)

    def test_diagnoses_the_same(self):
        model = str(self.path / "model.json")
        record = vibrissa.read_record(self.path / "r.csv")
        scaled = {name: record[name].copy() for name in record.channel_names}
        scaled["base_moment_N_m"] *= 1.3
        vibrissa.write_record(self.path / "bench.csv", vibrissa.Record(
            record.sampling_rate_hz, scaled, record.start_s))
        found = vibrissa.diagnose(self.path / "bench.csv", simulation=model, max_effects=1)
        said = program("diagnose", "--model", model, "--real", str(self.path / "bench.csv"),
                       "--max-effects", "1", "--json")
        self.assertEqual(found.report, json.loads(said))
        self.assertIn(found.verdict, str(found.report["ranking"][0]["effect"]))
        np.testing.assert_array_equal(found.updated.simulate(record).shape, (len(record),))

    def test_takes_simulated_records_for_the_simulation(self):
        simulated = vibrissa.read_dataset(self.path / "r.csv")
        model = vibrissa.Model.from_records(simulated)
        self.assertEqual(len(model.simulate(self.record)), len(self.record))
        record = self.record
        scaled = {name: record[name].copy() for name in record.channel_names}
        scaled["base_moment_N_m"] *= 1.3
        vibrissa.write_record(self.path / "scaled.csv", vibrissa.Record(
            record.sampling_rate_hz, scaled, record.start_s))
        found = vibrissa.diagnose(self.path / "scaled.csv", simulation=simulated, max_effects=1)
        said = program("diagnose", "--sim", str(self.path / "r.csv"), "--real",
                       str(self.path / "scaled.csv"), "--max-effects", "1", "--json")
        self.assertEqual(found.report, json.loads(said))

    def test_a_users_mistake_is_a_value_error(self):
        with self.assertRaisesRegex(vibrissa.UserError, "unknown channel"):
            vibrissa.read_record(self.path / "r.csv", columns={"base_acc": "x"})
        with self.assertRaises(ValueError):
            vibrissa.simulate("missing.prm")

    def test_units_are_converted(self):
        record = vibrissa.Record(500.0, {"ax_g": np.ones(100), "base_moment_N_m": np.zeros(100)})
        vibrissa.write_record(self.path / "g.h5", record)
        read = vibrissa.read_record(self.path / "g.h5", columns={"base_acceleration": "ax_g[g]"})
        np.testing.assert_allclose(read["base_acceleration_m_s2"], 9.80665, rtol=1e-15)

    def test_stubs_name_all_that_there_is(self):
        stub = (pathlib.Path(vibrissa.__file__).parent / "__init__.pyi").read_text()
        for name in vibrissa.__all__:
            self.assertRegex(stub, rf"(def|class) {name}\b")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
