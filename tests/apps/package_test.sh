#!/usr/bin/env bash
# The library installs and builds the example; the Debian packages hold a program that runs.
# usage: package_test.sh BUILD SOURCE
set -euo pipefail
build=$1 source=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

cmake --install "$build" --prefix "$folder/prefix" --component library > /dev/null
cmake -S "$source/examples/separate_a_record" -B "$folder/example" \
  -DCMAKE_PREFIX_PATH="$folder/prefix" > /dev/null
cmake --build "$folder/example" > /dev/null
"$build/vibrissa" simulate "$source/cases/flow_sensor.prm" --quiet --record "$folder/r.csv" \
  --set 'Model/Mesh resolution=1'
"$folder/example/separate_a_record" "$folder/r.csv" "$folder/separated.csv"
head -n 1 "$folder/separated.csv" | grep -q wind_moment_N_m

(cd "$build" && cpack -B "$folder/packages" > "$folder/cpack.log" 2>&1) ||
  { cat "$folder/cpack.log"; exit 1; }
program=$(echo "$folder"/packages/vibrissa_*.deb)
dpkg-deb --field "$program" Depends | grep -q libdeal.ii
dpkg-deb --extract "$program" "$folder/root"
"$folder/root/usr/bin/vibrissa" --version
"$folder/root/usr/bin/vibrissa" modes "$folder/root/usr/share/vibrissa/cases/whisker_sensor.prm" \
  --no-convergence --json --quiet | grep -q frequency_hz
"$folder/root/usr/bin/vibrissa" trial make --cases 1 --seed 3 --quiet --out "$folder/trial" > /dev/null
test -s "$folder/trial/trial.json"
"$folder/root/usr/bin/vibrissa" trial observe --help | grep -q further
PYTHONPATH="$folder/root/usr/lib/python3/dist-packages" /usr/bin/python3 -c \
  "import vibrissa; print(vibrissa.read_record('$folder/r.csv'))"
test -s "$folder/root/usr/share/man/man1/vibrissa.1"
cmp "$source/LICENSE" "$folder/root/usr/share/doc/vibrissa/LICENSE"
dpkg-deb --extract "$folder"/packages/libvibrissa-dev_*.deb "$folder/library"
for copyright in "$folder"/{root,library}/usr/share/doc/*/copyright; do
  grep -q '^License: GPL-3+' "$copyright"
done
bash -n "$folder/root/usr/share/bash-completion/completions/vibrissa"
