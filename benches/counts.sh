#!/bin/sh
# Instructions a view, in millions, counted by callgrind: the same on every run, so that commits can be compared.
# `benches/counts.sh` for all rows, `benches/counts.sh 10000` for scenes of one size. Needs valgrind.
# The same table in docs/performance.md is written by `cargo run --release --example performance -- counts`.
set -eu
cd "$(dirname "$0")/.."
exec cargo run --locked --release --example performance -- count "$@"
