#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# tools/gpu-check builds everything that it runs on a GPU, from nothing but what it packs.   usage: gpu_check_test.sh ROOT
set -u
root=$1
source "$root/tools/lib/common.sh"
source "$root/tools/lib/cuda.sh"
if ! find_nvcc >/dev/null; then
  echo "SKIPPED: no CUDA compiler (tools/setup --cuda installs one)"
  exit 77
fi
"$root/tools/gpu-check" --build-only || exit 1
failures=0
for program in gpu_bench test_kernels_{core,splat,train}_on_cpu test_kernels_{splat,train}_gpu; do
  [[ -x $root/build/gpu/bin/$program ]] || { failures=$((failures + 1)); echo "not built: $program"; }
done
# Without a GPU the benchmark says so; with one it may measure.
if "$root/build/gpu/bin/gpu_bench" --scene 5 --rounds 1 >/dev/null 2>"$root/build/gpu/said"; then
  echo "there is a GPU"
elif ! grep -q "^gpu_bench: " "$root/build/gpu/said"; then
  failures=$((failures + 1))
  echo "gpu_bench does not say why it cannot run:"
  cat "$root/build/gpu/said"
fi
exit $((failures > 0))
