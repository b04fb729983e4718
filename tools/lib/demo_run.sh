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
    timeout 60 tail --pid="$pid" -s 0.1 -f /dev/null || kill -KILL "$pid" 2>/dev/null || true
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

# wait_until_bound NAME UDP_PORT: until the program listens there.
wait_until_bound() {
  local name=$1 waited=0 port
  port=$(printf ':%04X ' "$2")
  until grep -q "$port" /proc/net/udp; do
    is_running "$name" || return 1
    ((waited++ < 300)) || { say "$name was not ready after 30 s"; return 1; }
    sleep 0.1
  done
}

# watch_program NAME TOTAL_S: a progress bar of the robot's recorded seconds until the program NAME ends.
watch_program() {
  local name=$1 total=$2 line recorded=0 words=""
  while is_running "$name"; do
    line=$(tail -n 1 "$out/logs/robot.out" 2>/dev/null || true)
    [[ ! $line =~ \"recorded_s\":\ ([0-9]+) ]] || recorded=${BASH_REMATCH[1]}
    [[ ! $line =~ \"poses\":\ ([0-9]+) ]] || words="s, ${BASH_REMATCH[1]} poses, $(per_second "${BASH_REMATCH[1]}") poses/s"
    progress $((recorded < total ? recorded : total)) "$total" "$words"
    sleep 0.5
  done
}

# What `edgesplat simulate --progress` says: "simulated 3.2 of 20.0 s in 4 s".
simulate_filter() {
  local line
  while IFS= read -r line; do
    [[ $line =~ ^simulated\ ([0-9]+)\.[0-9]+\ of\ ([0-9]+)\.[0-9]+\ s ]] || continue
    progress "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "$(per_second "${BASH_REMATCH[1]}") simulated s/s"
  done
}
