# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# What `tools/demo --input PATH` accepts, turned into something the robot can replay.

python_with_numpy() {
  local candidate
  for candidate in python3 /usr/bin/python3 "$deps/peers/bin/python"; do
    "$candidate" -c 'import numpy' 2>/dev/null && echo "$candidate" && return 0
  done
  say "Unpacking .mmx scans needs python3 with numpy: apt-get install python3-numpy."
  return 1
}

# The unpacker lies beside the recording or one folder up.
find_unpacker() {
  local folder
  for folder in "$1" "$1/.." "$1/../.."; do
    [[ -f $folder/lidar_pack.py ]] && readlink -f "$folder/lidar_pack.py" && return 0
  done
  say "$1 holds packed scans (.mmx), but there is no lidar_pack.py beside them or above."
  return 1
}

count_filter() {
  local line count=0
  while IFS= read -r line; do
    [[ $line == unpacked\ * ]] || continue
    count=$((count + ${line#unpacked }))
    progress "$count" "$count_total" "$(per_second "$count") scans/s"
  done
}

unpack_scans() { # FOLDER UNPACKER PYTHON: each .mmx in FOLDER becomes a .bin beside it
  # shellcheck disable=SC2016
  printf '%s\0' "$1"/*.mmx | xargs -0 -n 4 -P "$(nproc)" \
    sh -c 'python=$1 unpacker=$2; shift 2; "$python" "$unpacker" "$@" && echo "unpacked $#"' sh "$3" "$2"
}

# prepare_input PATH OUT: prints what the robot is to replay.
prepare_input() {
  local input out=$2 scans entry
  input=$(readlink -e "$1") || { say "There is no $1."; return 2; }
  if [[ -f $input ]]; then
    [[ $input == *.mcap ]] && echo "$input" && return 0
    say "$input is no recording: expected .mcap, or a folder of scans (.mmx or .bin)."
    return 2
  fi
  scans=$input
  [[ ! -d $input/velodyne ]] || scans=$input/velodyne
  if compgen -G "$scans/*.bin" >/dev/null; then
    echo "$input"
  elif compgen -G "$scans/*.mmx" >/dev/null; then
    local python unpacker
    python=$(python_with_numpy) && unpacker=$(find_unpacker "$input") || return 1
    mkdir -p "$out/input/velodyne"
    ln -sf "$scans"/*.mmx "$out/input/velodyne/"
    for entry in "$input"/*; do # images, calibration and poses as they are
      [[ $entry == "$scans" || $entry == *.mmx ]] || ln -sfn "$entry" "$out/input/"
    done
    count_total=$(find "$scans" -maxdepth 1 -name '*.mmx' | wc -l)
    run_step "unpack $count_total scans" "Is the disk full, or a scan damaged?" \
      count_filter unpack_scans "$out/input/velodyne" "$unpacker" "$python" || return 1
    rm -f "$out"/input/velodyne/*.mmx
    echo "$out/input"
  else
    say "$input holds neither .mmx nor .bin scans (looked in it and in velodyne/)."
    return 2
  fi
}
