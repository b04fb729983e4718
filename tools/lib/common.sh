# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Sourced by the commands in tools/: where things are, how to speak, how to run a step. Words and progress go to stderr.
set -Eeuo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
logs=$root/build/logs
deps=$root/.deps
export CCACHE_BASEDIR=$root CCACHE_NOHASHDIR=1 LC_ALL=C

say() { printf '%s\n' "$*" >&2; }
die() {
  printf '%s\n' "$*" >&2
  exit 1
}
usage_error() {
  say "${0##*/}: $1. See ${0##*/} --help."
  exit 2
}

# One compiler takes up to 2 GB: as many jobs as cores, fewer where memory is short.
job_count() {
  local cores memory_gb
  cores=$(nproc)
  memory_gb=$(awk '/MemAvailable/ {print int($2 / 1048576)}' /proc/meminfo)
  local by_memory=$((memory_gb / 2 > 0 ? memory_gb / 2 : 1))
  echo $((cores < by_memory ? cores : by_memory))
}

# run_step NAME HINT FILTER COMMAND...: runs COMMAND, its whole output into a log, the filter draws progress from it.
# On failure: which step, the last 30 lines, what to do; returns COMMAND's status.
run_step() {
  local name=$1 hint=$2 filter=$3 status
  shift 3
  local log=$logs/${name//[^A-Za-z0-9_.]/-}.log
  mkdir -p "$logs"
  progress_begin "$name"
  set +e
  "$@" 2>&1 | tee "$log" | "$filter"
  status=${PIPESTATUS[0]}
  set -e
  if ((status == 0)); then
    progress_end "done"
    return 0
  fi
  progress_end "FAILED (exit code $status)"
  say "--- last lines of $log"
  tail -n 30 "$log" >&2
  say "---"
  say "$name failed. $hint"
  return "$status"
}

# shellcheck source=tools/lib/progress.sh
source "$root/tools/lib/progress.sh"
