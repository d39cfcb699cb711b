#!/bin/sh
# Instructions a view, in millions, counted by callgrind: the same on every run, so that commits can be compared.
# `benches/counts.sh` for all rows, `benches/counts.sh 10000` for scenes of one size. Needs valgrind.
set -eu
cd "$(dirname "$0")/.."
command -v valgrind >/dev/null || { echo "counts.sh: valgrind is not installed" >&2; exit 1; }
views=4
binary=$(cargo bench --locked --bench counts --no-run 2>&1 | tee /dev/stderr | sed -n 's/.*(\(.*counts-.*\))$/\1/p')
echo "| scene | polygons | bsp | boxes | factors | hemicube 512 |"
echo "| --- | ---: | ---: | ---: | ---: | ---: |"
for kind in room office city; do
    for polygons in ${*:-1000 10000 50000}; do
        row="| $kind | $polygons"
        for what in bsp boxes factors hemicube; do
            count=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='counts::counted*' \
                "$binary" "$kind" "$polygons" "$what" 2>&1 | sed -n 's/.*Collected : \([0-9]*\).*/\1/p')
            row="$row | $(awk "BEGIN { printf \"%.2f\", $count / $views / 1e6 }")"
        done
        echo "$row |"
    done
done
