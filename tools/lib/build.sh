# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Configure and build a CMake preset with progress.

export NINJA_STATUS='[%f/%t %o/s] '

# build_preset PRESET JOBS [-D... | TARGET]...: configures when needed and builds the targets (default: everything).
build_preset() {
  local preset=$1 jobs=$2 targets=() definitions=() argument
  shift 2
  for argument in "$@"; do
    if [[ $argument == -D* ]]; then definitions+=("$argument"); else targets+=("$argument"); fi
  done
  if [[ ! -f $root/build/$preset/build.ninja || ${#definitions[@]} -gt 0 ]]; then
    (cd "$root" && run_step "configure $preset" "A missing library: run tools/setup. Else read the message above." \
      quiet_filter cmake --preset "$preset" "${definitions[@]}") || return 1
  fi
  run_step "build $preset" "The compiler's first message is in the log; fix it and run the same command again." \
    ninja_filter ninja -C "$root/build/$preset" -j "$jobs" "${targets[@]}"
}
