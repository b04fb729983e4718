# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Parts of tools/gpu-check: what a bare machine needs, and what is measured there. They use its build, out and rounds.
# shellcheck disable=SC2154

gsplat_wheel=gsplat==1.5.3

cat_filter() { cat; }

# require_gpu: ends the program, saying why, where there is none.
require_gpu() {
  local device
  for device in /dev/nvidia[0-9]* /dev/nvhost-gpu /dev/nvgpu; do
    [[ ! -e $device ]] || return 0
  done
  if command -v nvidia-smi >/dev/null && nvidia-smi -L 2>/dev/null | grep -q GPU; then return 0; fi
  die "gpu-check: no NVIDIA GPU here (no /dev/nvidia*, nvidia-smi lists none). --build-only builds without one."
}

copy_headers() {
  local folder=$1 header
  shift
  for header in "$@"; do
    [[ -e $header ]] || die "gpu-check: $header is missing: run tools/setup"
    cp -rL "$header" "$folder/"
  done
}

# pack_carried DIR WITH_NVCC WITH_GSPLAT
pack_carried() {
  local folder=$1 name library
  rm -rf "$folder/include" "$folder/lib" "$folder/googletest"
  mkdir -p "$folder/include" "$folder/lib"
  [[ -f /usr/src/googletest/CMakeLists.txt ]] || die "gpu-check: googletest's sources are missing: run tools/setup"
  cp -r /usr/src/googletest "$folder/googletest"
  copy_headers "$folder/include" /usr/include/eigen3/Eigen /usr/include/{tl,tbb,oneapi,hwy}
  for name in libtbb.so.12 libhwy.so.1; do
    library=$(find /usr/lib -maxdepth 2 -name "$name" | head -n 1)
    [[ -n $library ]] || die "gpu-check: $name is missing: run tools/setup"
    cp -L "$library" "$folder/lib/$name"
  done
  if (($2)); then
    install_cuda
    [[ -d $deps/cuda ]] || die "gpu-check: the compiler is an installed toolkit, not that of tools/setup --cuda: nothing to pack"
    rm -rf "$folder/cuda" && cp -r "$deps/cuda" "$folder/cuda"
  fi
  if (($3)); then
    mkdir -p "$folder/wheels"
    python3 -m pip download -q --no-deps -d "$folder/wheels" "$gsplat_wheel" || die "gpu-check: gsplat's wheel cannot be had"
  fi
}

# The kernels' accesses, races and barriers, on the GPU's half of the tests.
sanitize() {
  local tool module
  if ! command -v compute-sanitizer >/dev/null; then
    say "left out: compute-sanitizer is not installed"
    return 0
  fi
  for module in core splat train; do
    [[ -x $build/bin/test_kernels_${module}_gpu ]] || continue
    for tool in memcheck racecheck synccheck; do
      run_step "$tool $module" "The kernel and its line are in the log." quiet_filter compute-sanitizer --tool "$tool" \
        --error-exitcode 9 "$build/bin/test_kernels_${module}_gpu" '--gtest_filter=*cuda*:Cuda*' || return 1
    done
  done
}

# warp_instructions SCENE: of one frame, by ncu; nothing where it cannot count.
warp_instructions() {
  ncu --csv --metrics smsp__inst_executed.sum "$build/bin/gpu_bench" --scene "$1" --only-forward \
    --rounds 1 2>"$out/ncu.log" >"$out/ncu-$1.csv" || return 1
}

measure() {
  run_step "measure" "Read the message above." cat_filter \
    "$build/bin/gpu_bench" --rounds "$rounds" || return 1
  grep '^{' "$logs/measure.log" >"$out/bench.jsonl"
  if command -v ncu >/dev/null; then
    warp_instructions 0 || say "left out: ncu cannot count here (build/gpu/out/ncu.log)"
  else
    say "left out: ncu is not installed"
  fi
  race_gsplat || say "left out: gsplat did not run ($logs/race-gsplat.log)"
  python3 "$root/tools/lib/gpu_table.py" "$out"
}

race_gsplat() {
  local wheel
  wheel=$(ls "$carried"/wheels/gsplat-*.whl 2>/dev/null | head -n 1)
  if [[ -z $wheel ]] || ! python3 -c 'import torch' 2>/dev/null; then
    say "left out: the race with gsplat (no wheel carried, or no PyTorch)"
    return 0
  fi
  [[ -d $out/site/gsplat ]] || python3 -m pip install -q --no-index --no-deps --target "$out/site" "$carried"/wheels/*.whl || return 1
  mkdir -p "$out/scene"
  "$build/bin/gpu_bench" --scene 1 --rounds 1 --only-forward --dump "$out/scene" >"$out/scene/scene.json" || return 1
  run_step "race gsplat" "Read the message above." cat_filter env "PYTHONPATH=$out/site" \
    python3 "$root/tools/lib/gsplat_race.py" "$out/scene" "$rounds" || return 1
  grep '^{' "$logs/race-gsplat.log" >"$out/gsplat.jsonl"
}
