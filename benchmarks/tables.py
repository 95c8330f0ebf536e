"""The tables of measured numbers in the pages: a function for each file NAME.json of benchmarks/results.

Each takes the file's numbers and yields the lines of its table, for tools/check_tables.
"""


def _row(*cells):
    return f"| {' | '.join(cells)} |"


def _head(*cells, left=1):
    """Names of columns; those behind the first ones hold numbers."""
    yield _row(*cells)
    yield f"|{'---|' * left}{'---:|' * (len(cells) - left)}"


def _power(value, power):
    """Three digits with a fixed power of ten: 5.5e7 by 6 is 55e6."""
    return f"{value / 10 ** power:.3g}e{power}" if value < 1e3 * 10 ** power else f"{value / 10 ** power:.0f}e{power}"


def modes(numbers):
    yield from _head("unknowns", "Vibrissa [s]", "`ccx` [s]", "ratio")
    for case, n in numbers.items():
        yield _row(case, f"{n['vibrissa_s']:.3g}", f"{n['ccx_s']:.3g}", f"{n['ratio']:.2f}")


def finite_strain(numbers):
    yield from _head("22k unknowns, one core", "[ms]", "")
    for part in ("residual", "tangent", "factorisation", "solution"):
        yield _row(part, f"{numbers[part]['time_ms']:.3g}", "")
    n = numbers["step at resonance"]
    yield _row("step of 1 ms at 1.2 g in resonance", f"{n['time_ms']:.3g}",
               f"{n['iterations']:.2g} iterations, {n['factorisations']:.2g} factorisations")
    n = numbers["step from rest"]
    yield _row("step from rest, undamped", f"{n['time_ms']:.3g}",
               f"`ccx`: {n['ccx_ms']:.0f}, {n['ratio']:.3g} times; displacements {n['difference_percent']:.2f} % apart")


def separation(numbers):
    columns = {"Msamples_per_s": ("Msamples/s", 1), "of_bound": ("of the bound", 2),
               "of_bound_same_plans": ("of the bound, same plans", 2), "over_speex": ("over SpeexDSP", 1)}
    columns = {key: column for key, column in columns.items() if all(key in n for n in numbers["filters"].values())}
    yield from _head("case", *(name for name, _ in columns.values()))
    for case, n in numbers["filters"].items():
        yield _row(case, *(f"{n[key]:.{digits}f}" for key, (_, digits) in columns.items()))
    yield ""
    yield from _head("other", "")
    for samples, ns in numbers["bvrm_ns_per_sample"].items():
        yield _row(f"BVRM with three modes, {samples}", f"{ns:.2g} ns per sample")
    for what, n in numbers["time_warping_Mcells_per_s"].items():
        yield _row(f"time warping of 10k x 10k, {what}", f"{n['low']:.0f} to {n['high']:.0f} million cells per second")


def reading(numbers):
    yield from _head("stamps", "Vibrissa [s]", "`numpy.loadtxt` [s]", "ratio", "memory over that of the numbers")
    for stamps, n in numbers.items():
        yield _row(stamps, f"{n['vibrissa_s']:.2f}", f"{n['loadtxt_s']:.2f}", f"{n['ratio']:.2f}", f"{n['memory']:.1f}")


def identification(numbers):
    yield from _head("fit [ms]", "`start`", "`refine`", "`whole`")
    for case, n in numbers.items():
        yield _row(case, *(f"{n[part]:.3g}" for part in ("start_ms", "refine_ms", "whole_ms")))


def prediction(numbers):
    yield from _head("chain", "ns per sample")
    for chain, ns in numbers.items():
        yield _row(chain, f"{ns:.3g}")


def _scaling(rows, parts):
    for unknowns, n in rows.items():
        yield _row(unknowns, *(f"{n[part]:.3g}" for part in parts), _power(n["factor_entries"], 6),
                   _power(n["factor_operations"], 9), f"{n['peak_mib']:.0f}")


def scaling_one(numbers):
    parts = ("operators_cpu_s", "tangent_cpu_s", "residual_cpu_s", "analysis_cpu_s", "numeric_cpu_s", "solve_cpu_s")
    yield from _head("unknowns", "operators", "tangent", "residual", "analysis", "factors", "solution",
                     "entries of factors", "operations", "peak MiB")
    yield from _scaling(numbers["sizes"], parts)
    powers = numbers["exponents"]
    yield _row("exponent", *(f"{powers[part]:.2f}" if part in powers else "–"
                             for part in (*parts, "factor_entries", "factor_operations", "peak_mib")))
    speeds = [1e-9 * n["factor_operations"] / n["numeric_cpu_s"] for n in numbers["sizes"].values()]
    yield ""
    yield f"Speed of the factorisation, size by size: {', '.join(f'{speed:.0f}' for speed in speeds)} Gflop/s."


def scaling_mumps(numbers):
    yield from _head("unknowns, MUMPS on one process [s]", "analysis", "factors", "solution")
    for unknowns, n in numbers.items():
        yield _row(unknowns, *(f"{n[part]:.3g}" for part in ("analysis_s", "numeric_s", "solve_s")))


def scaling_two(numbers):
    yield from _head("unknowns", "tangent", "residual", "analysis", "factors", "solution", "entries of factors",
                     "operations", "peak MiB")
    yield from _scaling(numbers, ("tangent_s", "residual_s", "analysis_s", "numeric_s", "solve_s"))


def scaling_speed_up(numbers):
    yield from _head("wall seconds", "one", "two", "speed-up")
    for part, n in numbers.items():
        yield _row(part, f"{n['one_s']:.3g}", f"{n['two_s']:.3g}", f"{n['speed_up']:.2f}")


def linear_transient(numbers):
    yield from _head("`vibrissa transient --strain small`, 21.8k unknowns", "processor time")
    yield _row("one sample, base moment by both routes", f"{numbers['low_ms']:.1f} to {numbers['high_ms']:.1f} ms")


def trial_life(numbers):
    def of(share):
        return f"{share['hits']}/{share['of']}" if share else "–"

    def within(share):
        return f"{of(share)} ({share['low']:.2f}–{share['high']:.2f})" if share else "–"

    yield "|sensors|in the catalogue: right (95 % interval)|95 % set holds the truth|wrong name above 0.8|one effect, 3 limits: right|"
    yield "|---|---|---|---|---|"
    for name, n in numbers["classes"].items():
        yield f"|{name}|{within(n['right'])}|{of(n['set_holds'])}|{of(n['wrong'])}|{of(n.get('single_3_limits'))}|"
    n = numbers["others"]
    yield ""
    yield (f"* Right: one effect {within(n['single'])}, at 3 limits or more {within(n['single_3_limits'])}; "
           f"two effects {of(n['pair'])}; three {of(n['triple'])}.")
    yield (f"* Physics named where there is none: {of(n['none_false'])}; off in calibrations alone: "
           f"{of(n['calibration_false'])}; beside effects that are notes: {of(n['notes_false'])}.")
    yield (f"* `outside_catalogue`: in no catalogue {of(n['nameless'])}, taken out {of(n['left_out'])}. "
           f"Wrong log noticed: {of(n['metadata'])}.")
    yield f"* Expected calibration error: {numbers['calibration_error']:.2f}."


def silverbox(numbers):
    yield from _head("rms error [mV]", "unseen multisines", "arrow, levels of the fit", "arrow, beyond", "whole arrow")
    for model, n in numbers.items():
        yield _row(model, *(f"{n[part]:.3g}" if part in n else "–" for part in ("unseen_mV", "seen_mV", "beyond_mV", "all_mV")))


def ring_down(numbers):
    yield from _head("of 120 sensors", "")
    for what, n in numbers.items():
        yield _row(what, f"{n:.0f}")


def public_records(numbers):
    yield from _head("record", "order", "fit", "variance", "residual (lags)")
    for n in numbers:
        yield _row(n["record"], f"{n['order']}", f"{n['fit_percent']:.1f} %", f"{n['vaf_percent']:.2f} %", n["residual"])
    yield ""
    f16 = next(n for n in numbers if n["order"] == 16)
    yield f"Modes of the F-16 at order 16: {', '.join(f'{hz:.2f}' for hz in f16['modes_hz'])} Hz."


def output_only(numbers):
    yield from _head("record", "lines without decay [Hz]", "modes [Hz] (damping ratio)")
    for record, n in numbers.items():
        lines = ", ".join(f"{x['frequency_hz']:.2f} ± {x['sd_hz']:.1g}" for x in n["lines"])
        found = ", ".join(f"{x['frequency_hz']:.2f} ± {x['sd_hz']:.1g} ({x['damping_ratio']:.2g} ± {x['damping_sd']:.1g})"
                          for x in n["modes"])
        yield _row(f"`{record}`", lines or "none", found or "none")


def sensor_package_spectra(numbers):
    yield from _head("model of package over reference", "error left")
    for model, percent in numbers.items():
        yield _row(model, f"{percent:.1f} %")


def sensor_package(numbers):
    yield from _head("command", "verdict", "error on the last third", "updated", "noise alone", left=2)
    for command, n in numbers.items():
        values = ", ".join(f"{p['effect']} {p['name']} = {p['value']:.2g} {p['unit']}".removesuffix(" 1") for p in n["parameters"])
        yield _row(command, f"{n['verdict']} ({values})",
                   *(f"{n[part]:.2g} %" for part in ("before_percent", "after_percent", "noise_percent")))


def bus(numbers):
    yield from _head("what", "")
    yield _row("first resonance", f"{numbers['resonance_hz']:.2f} Hz")
    yield _row("fit of the model to the held-out third", f"{numbers['fit_percent']:.0f} %")
    for method, db in numbers["sdr_db"].items():
        yield _row(f"signal to distortion: {method}", f"{db:.1f} dB")


def without_calm_record(numbers):
    yield from _head("`separate` on records of `vibrissa simulate cases/flow_sensor.prm`", "signal to distortion")
    for method, db in numbers.items():
        yield _row(method, f"{db:.0f} dB")


def two_clocks(numbers):
    yield from _head("20 s at 500 Hz, noise a hundredth", "rms error of 10 joins")
    yield _row("offset", f"{numbers['offset_samples']:.1g} samples")
    yield _row("drift", f"{numbers['drift_ppm']:.1g} ppm")
