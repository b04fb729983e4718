# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# One progress line on a terminal; elsewhere a line at each tenth of the way. Filters read a tool's output line by line.

progress_name=""
progress_began=0
progress_tenth=-1

progress_begin() {
  progress_name=$1
  progress_began=$SECONDS
  progress_tenth=-1
  if [[ -t 2 ]]; then printf '%s ...' "$1" >&2; else printf '%s: started\n' "$1" >&2; fi
}

# progress DONE TOTAL RATE: RATE is text such as "3.2 targets/s".
progress() {
  local done=$1 total=$2 rate=$3 width=30
  ((total > 0)) || return 0
  local seconds=$((SECONDS - progress_began)) tenth=$((done * 10 / total))
  if [[ -t 2 ]]; then
    local filled=$((done * width / total)) bar
    bar=$(printf '%*s' "$filled" '')
    printf '\r\033[K%s [%s%*s] %d/%d  %s  %d s' "$progress_name" "${bar// /#}" $((width - filled)) '' \
      "$done" "$total" "$rate" "$seconds" >&2
  elif ((tenth != progress_tenth)); then
    progress_tenth=$tenth
    printf '%s: %d/%d  %s  %d s\n' "$progress_name" "$done" "$total" "$rate" "$seconds" >&2
  fi
}

progress_end() {
  local clear=''
  [[ ! -t 2 ]] || clear=$'\r\033[K'
  printf '%s%s: %s, %d s\n' "$clear" "$progress_name" "$1" $((SECONDS - progress_began)) >&2
}

# per_second COUNT: COUNT over the step's time so far, one decimal.
per_second() {
  local seconds=$((SECONDS - progress_began))
  ((seconds > 0)) || seconds=1
  printf '%d.%d' $(($1 / seconds)) $(($1 * 10 / seconds % 10))
}

quiet_filter() { cat >/dev/null; }

# NINJA_STATUS must be '[%f/%t %o/s] '.
ninja_filter() {
  local line
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\ ([0-9.?]+)/s\] ]] || continue
    progress "${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "${BASH_REMATCH[3]} targets/s"
  done
}

ctest_filter() {
  local line failed=0
  while IFS= read -r line; do
    [[ $line =~ ^\ *([0-9]+)/([0-9]+)\ +Test\ +#[0-9]+:\ ([^ ]+)\ (.*) ]] || continue
    local done=${BASH_REMATCH[1]} total=${BASH_REMATCH[2]} name=${BASH_REMATCH[3]} rest=${BASH_REMATCH[4]}
    if [[ $rest == *'***'* && $rest != *'***Skipped'* ]]; then
      failed=$((failed + 1))
      [[ ! -t 2 ]] || printf '\r\033[K' >&2
      say "  failed: $name (${rest#*\*\*\*})"
    fi
    progress "$done" "$total" "$(per_second "$done") tests/s, $failed failed"
  done
}

# apt-get with APT::Status-Fd=1: dlstatus:N:PERCENT:words while it downloads, pmstatus:package:PERCENT:words after.
apt_filter() {
  local line installed=0 kilobytes=0
  while IFS= read -r line; do
    if [[ $line =~ ^Need\ to\ get\ ([0-9,]+)(\.[0-9]+)?(/[0-9.,]+\ [kM]B)?\ ([kM])B ]]; then
      kilobytes=${BASH_REMATCH[1]//,/}
      [[ ${BASH_REMATCH[4]} == k ]] || kilobytes=$((kilobytes * 1000))
    elif [[ $line =~ ^dlstatus:[0-9]+:([0-9]+) ]]; then
      ((kilobytes > 0)) || continue # still the package lists
      progress $((BASH_REMATCH[1] / 2)) 100 "$(per_second $((kilobytes * BASH_REMATCH[1] / 100))) kB/s"
    elif [[ $line =~ ^pmstatus:[^:]+(:[a-z0-9]+)?:([0-9]+)\.[0-9]+:(.*) ]]; then
      [[ ${BASH_REMATCH[3]} != Installed* ]] || installed=$((installed + 1))
      progress $((50 + BASH_REMATCH[2] / 2)) 100 "$(per_second "$installed") packages/s"
    fi
  done
}

# pip: counts its "Downloading NAME (SIZE)" lines; the total is not known beforehand.
pip_filter() {
  local line count=0
  while IFS= read -r line; do
    [[ $line =~ ^\ *Downloading\ ([^ ]+)\ \((.*)\) ]] || continue
    count=$((count + 1))
    [[ -t 2 ]] && printf '\r\033[K%s: %d files, now %s of %s  %d s' "$progress_name" "$count" \
      "${BASH_REMATCH[2]}" "${BASH_REMATCH[1]}" $((SECONDS - progress_began)) >&2
  done
  return 0
}
