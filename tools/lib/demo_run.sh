# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The programs of a demo run: started, watched and ended together. Each writes its words to OUT/logs/NAME.log.

declare -A children=() # name -> process id
failed_programs=()

start_program() { # NAME COMMAND...
  local name=$1
  shift
  mkdir -p "$out/logs"
  "$@" >"$out/logs/$name.out" 2>"$out/logs/$name.log" &
  children[$name]=$!
}

is_running() { [[ -n ${children[$1]:-} ]] && kill -0 "${children[$1]}" 2>/dev/null; }

# end_program NAME [SIGNAL]: asks it to end (with SIGNAL; then it has 60 s), waits for it, notes a failure.
end_program() {
  local name=$1 signal=${2:-} status=0
  local pid=${children[$name]:-}
  [[ -n $pid ]] || return 0
  unset "children[$name]"
  if [[ -n $signal ]]; then
    kill "-$signal" "$pid" 2>/dev/null || true
    timeout 60 tail --pid="$pid" -f /dev/null || kill -KILL "$pid" 2>/dev/null || true
  fi
  wait "$pid" || status=$?
  ((status != 0)) || return 0
  failed_programs+=("$name")
  say "$name FAILED (exit code $status). Last lines of $out/logs/$name.log:"
  tail -n 15 "$out/logs/$name.log" >&2
}

end_everything() {
  local name
  for name in "${!children[@]}"; do kill -TERM "${children[$name]}" 2>/dev/null || true; done
  for name in "${!children[@]}"; do wait "${children[$name]}" 2>/dev/null || true; done
  children=()
}

# The robot prints one JSON line a second once its sockets are open.
wait_until_ready() {
  local waited=0
  until [[ -s $out/logs/$1.out ]]; do
    is_running "$1" || return 1
    ((waited++ < 300)) || { say "$1 was not ready after 30 s"; return 1; }
    sleep 0.1
  done
}

# watch NAME TOTAL_S: a progress bar of seconds until the program ends.
watch_program() {
  local name=$1 total=$2 began=$SECONDS elapsed
  while is_running "$name"; do
    elapsed=$((SECONDS - began))
    progress $((elapsed < total ? elapsed : total)) "$total" "$(last_progress)"
    sleep 0.5
  done
}

# A few words from the robot's latest JSON line: its rate and how much it has mapped.
last_progress() {
  tail -n 1 "$out/logs/robot.out" 2>/dev/null | python3 -c '
import json, sys
try:
    line = json.loads(sys.stdin.readline())
except ValueError:
    line = {}
words = [f"{line[key]:g} {label}" for key, label in (("groups", "groups"), ("keyframes", "keyframes"),
         ("gaussians", "Gaussians")) if isinstance(line.get(key), (int, float))]
print(", ".join(words) or "s")'
}
