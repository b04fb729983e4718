#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The commands of tools/ parse, explain themselves, refuse nonsense with exit code 2, and the demo starts, joins and
# ends its programs (stand-ins here) as it should.   usage: commands_test.sh ROOT
set -u
root=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0

expect() { # expect WHAT WANTED_STATUS COMMAND...
  local what=$1 wanted=$2 status=0
  shift 2
  "$@" >"$work/stdout" 2>"$work/stderr" || status=$?
  ((status == wanted)) && return 0
  failures=$((failures + 1))
  echo "$what: exit code $status, wanted $wanted"
  tail -n 20 "$work/stderr"
}
expect_text() { # expect_text WHAT FILE PATTERN
  grep -q -- "$3" "$2" && return 0
  failures=$((failures + 1))
  echo "$1: no '$3' in $2:"
  tail -n 20 "$2"
}

for script in "$root"/tools/{setup,test,demo,bench,gpu-check,edgesplat,jetson,sysroot} "$root"/tools/lib/*.sh "$root"/.ci/run; do
  expect "syntax of $script" 0 bash -n "$script"
done
for command in setup test demo bench gpu-check jetson sysroot; do
  expect "$command --help" 0 "$root/tools/$command" --help
  expect_text "$command --help" "$work/stdout" "usage: tools/$command"
  expect "$command with an unknown option" 2 "$root/tools/$command" --no-such-option
done
expect "demo with a bad length" 2 "$root/tools/demo" --seconds soon
expect "demo live from a recording" 2 "$root/tools/demo" --live --input a.mcap
expect "demo with a bad offload setting" 2 "$root/tools/demo" --offload perhaps
expect "demo with a bad link" 2 "$root/tools/demo" --link narrow
expect "gpu-check with a bad number" 2 "$root/tools/gpu-check" --rounds none
if ! compgen -G "/dev/nvidia[0-9]*" >/dev/null && ! command -v nvidia-smi >/dev/null && [[ ! -e /dev/nvhost-gpu && ! -e /dev/nvgpu ]]; then
  expect "gpu-check without a GPU" 1 "$root/tools/gpu-check"
  expect_text "gpu-check without a GPU" "$work/stderr" "no NVIDIA GPU here"
fi
if [[ -d /usr/src/googletest ]]; then
  expect "gpu-check --pack" 0 "$root/tools/gpu-check" --pack "$work/carried"
  for file in googletest/CMakeLists.txt include/Eigen/Core include/tl/expected.hpp include/hwy/highway.h lib/libtbb.so.12; do
    [[ -f $work/carried/$file ]] || { failures=$((failures + 1)); echo "gpu-check --pack: no $file"; }
  done
fi
expect "bench without anything to measure" 2 "$root/tools/bench"

# Stand-ins for the programs: the robot listens on its port and ends on SIGTERM, all note how they were called.
mkdir "$work/bin"
cat >"$work/bin/stand_in" <<'EOF'
#!/usr/bin/env python3
import os, signal, socket, sys, time
name, arguments = os.path.basename(sys.argv[0]), sys.argv[1:]
option = lambda key: arguments[arguments.index(key) + 1]
with open(os.environ["CALLS"], "a") as calls:
    calls.write(name + " " + " ".join(arguments) + "\n")
if name == "edgesplat":
    if arguments[0] in ("simulate", "inspect"):
        open(option("--out" if arguments[0] == "simulate" else "--to"), "w").close()
    sys.exit(0)
if os.environ.get("FAILS") == name:
    sys.exit(3)
ended = []
signal.signal(signal.SIGTERM, lambda *_: ended.append(1))
listening = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
if "--points-port" in arguments:
    listening.bind(("127.0.0.1", int(option("--points-port"))))
while not ended and "--replay" not in arguments:
    time.sleep(0.05)
EOF
chmod +x "$work/bin/stand_in"
for name in edgesplat edgesplat-robot edgesplat-server; do ln -s stand_in "$work/bin/$name"; done
export EDGESPLAT_BIN_DIR=$work/bin CALLS=$work/calls

expect "demo" 0 "$root/tools/demo" --seconds 1 --out "$work/run"
expect_text "demo" "$CALLS" "^edgesplat simulate --world corridor --seconds 1"
expect_text "demo" "$CALLS" "^edgesplat-server --interface lo"
expect_text "demo" "$CALLS" "^edgesplat-robot --live --rig"
expect_text "demo" "$CALLS" "^edgesplat-robot .*--offload always --set server.link.impair.shape_at_s="
expect_text "demo" "$CALLS" "^edgesplat stream"
expect_text "demo" "$CALLS" "^edgesplat report --run"
expect "demo whose robot fails" 1 env FAILS=edgesplat-robot "$root/tools/demo" --seconds 1 --out "$work/run"
expect_text "demo whose robot fails" "$work/stderr" "The demo failed: robot"
mkdir -p "$work/scans" && : >"$work/scans/0.bin"
expect "demo with scans" 0 "$root/tools/demo" --input "$work/scans" --out "$work/run"
expect_text "demo with scans" "$CALLS" "^edgesplat-robot --replay $work/scans"
expect "demo with a missing input" 2 "$root/tools/demo" --input "$work/nothing" --out "$work/run"
mkdir "$work/empty"
expect "demo with an empty folder" 2 "$root/tools/demo" --input "$work/empty" --out "$work/run"


# Table I: one run without the server and one with it over a wide link, then the table from what they left.
: >"$CALLS"
expect "bench --table1 without figures" 1 "$root/tools/bench" --table1 --seconds 1 --out "$work/table1"
expect_text "bench --table1" "$CALLS" "^edgesplat-robot .*--out $work/table1/robot-alone .*--offload never$"
expect_text "bench --table1" "$CALLS" "^edgesplat-robot .*--out $work/table1/with-server .*--offload always$"
for run in robot-alone with-server; do
  mkdir -p "$work/table1/$run"/{robot,server}
  echo '{"render_fps_p50": 100, "render_ms_p95": 20, "robot_peak_rss_mb": 90, "gaussians": 5000, "keyframes": 10}' \
    >"$work/table1/$run/summary.json"
  echo '{"histograms": {"local.step_ms": {"mean": 20, "count": 30}, "local.keyframe_ms": {"mean": 30, "count": 10}}}' \
    >"$work/table1/$run/robot/metrics.json"
  echo '{"histograms": {"map.step_ms": {"mean": 0, "count": 0}}}' >"$work/table1/$run/server/metrics.json"
done
expect "table1.py" 0 python3 "$root/tools/lib/table1.py" "$work/table1/robot-alone" "$work/table1/with-server"
expect_text "table1.py" "$work/stdout" "optimising on the robot, ms a keyframe  *90  *90"

echo "$failures failures"
exit $((failures > 0))
