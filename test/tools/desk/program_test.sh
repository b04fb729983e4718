#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The program edgesplat from outside: exit codes, --help of every verb, JSON on stdout and nothing else.
# usage: program_test.sh EDGESPLAT
set -u
edgesplat=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

expect() { # expect STATUS ARGUMENTS...
  local wanted=$1 status=0
  shift
  "$edgesplat" "$@" >"$work/stdout" 2>"$work/stderr" || status=$?
  ((status == wanted)) && return 0
  failures=$((failures + 1))
  echo "edgesplat $*: exit code $status, wanted $wanted"
  cat "$work/stderr"
}
expect_one_json_line() {
  python3 -c 'import json, sys; lines = sys.stdin.read().splitlines(); assert len(lines) == 1, lines; json.loads(lines[0])' \
    <"$work/stdout" && return 0
  failures=$((failures + 1))
  echo "stdout is not one line of JSON: $1"
}

expect 0 --help
mapfile -t verbs < <(sed -n '/^Subcommands:/,/^$/s/^  \([a-z]\+\) .*/\1/p' "$work/stdout")
((${#verbs[@]} >= 3)) || { failures=$((failures + 1)); echo "--help lists too few verbs: ${verbs[*]}"; }
for verb in "${verbs[@]}"; do
  expect 0 "$verb" --help
  expect 2 "$verb" --no-such-option
done
expect 0 --version
expect 2
expect 2 no_such_verb

for i in 0 1 2 3 4 5; do echo "$i.0 $i 0 0 0 0 0 1"; done >"$work/a.tum"
expect 0 evaluate --estimate "$work/a.tum" --reference "$work/a.tum" --json
expect_one_json_line evaluate
expect 0 inspect "$work/a.tum" --json
expect_one_json_line inspect
mkdir "$work/run"
expect 0 report --run "$work/run" --json
expect_one_json_line report
expect 0 evaluate --estimate "$work/a.tum" --reference "$work/a.tum"
[[ ! -s $work/stdout ]] || { failures=$((failures + 1)); echo "evaluate without --json writes to stdout"; }
expect 1 evaluate --estimate "$work/none.tum" --reference "$work/a.tum"
expect 1 report --run "$work/none"
expect 2 inspect "$work/a.tum" --extract rig.toml
expect 1 recover "$work/none.mcap"
expect 1 recover "$work/a.tum"
expect 2 score
expect 1 score --run "$work/none"
expect 1 score --run "$work/run"
for words in "--input" "hold pictures out of mapping"; do
  grep -q -e "$words" "$work/stderr" || { failures=$((failures + 1)); echo "score does not say '$words'"; }
done
expect 1 score --run "$work/run" --input "$work/a.tum"

printf 'ply\nformat ascii 1.0\nelement vertex 1\n' >"$work/a.ply"
for column in x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3; do
  echo "property float $column" >>"$work/a.ply"
done
printf 'end_header\n0 0 2 1 1 1 3 -3 -3 -3 1 0 0 0\n' >>"$work/a.ply"
expect 0 convert "$work/a.ply" "$work/a.spz" --json
expect_one_json_line convert
expect 0 inspect "$work/a.spz" --json
expect 2 convert "$work/a.ply" "$work/a.obj"
expect 1 convert "$work/none.ply" "$work/b.spz"
echo '{"cameras": [{"width": 32, "height": 24, "fx": 20, "fy": 20, "cx": 16, "cy": 12,
  "map_from_camera": [[1,0,0,0],[0,1,0,0],[0,0,1,0]]}]}' >"$work/cameras.json"
expect 0 render --map "$work/a.spz" --cameras "$work/cameras.json" --out "$work/drawn" --json
expect_one_json_line render
[[ -s $work/drawn/view.png ]] || { failures=$((failures + 1)); echo "render wrote no view.png"; }
expect 1 render --map "$work/a.spz" --cameras "$work/a.tum" --out "$work/drawn"
expect 1 train --scene "$work/none" --iterations 1 --out "$work/m.ply"
expect 2 train --scene "$work" --out "$work/m.ply"

echo "$failures failures"
exit $((failures > 0))
