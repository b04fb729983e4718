# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# A CUDA compiler: that of an installed toolkit, else NVIDIA's PyPI wheels in .deps/cuda.

cuda_prefix=$deps/cuda/nvidia/cu13
cuda_wheels=(nvidia-cuda-nvcc==13.0.88 nvidia-cuda-runtime==13.0.96 nvidia-cuda-crt==13.0.88 nvidia-nvvm==13.0.88
  nvidia-cuda-cccl==13.0.85)
cuda_aarch64_wheels=(nvidia-cuda-runtime==13.0.96 nvidia-cuda-crt==13.0.88 nvidia-cuda-cccl==13.0.85)

# find_nvcc: prints the compiler's path; 1 where there is none.
find_nvcc() {
  local candidate
  for candidate in "${CUDACXX:-}" "$(command -v nvcc || true)" /usr/local/cuda/bin/nvcc "$cuda_prefix/bin/nvcc"; do
    [[ -n $candidate && -x $candidate ]] && "$candidate" --version >/dev/null 2>&1 && echo "$candidate" && return 0
  done
  return 1
}

fetch_cuda_wheels() {
  rm -rf "$deps/cuda.part"
  [[ -x $deps/pip/bin/pip ]] || python3 -m venv "$deps/pip" || return 1
  "$deps/pip/bin/pip" install --no-cache-dir --disable-pip-version-check --no-deps --target "$deps/cuda.part" "${cuda_wheels[@]}" ||
    return 1
  # CMake's compiler check looks for these two names, which the wheels lack.
  ln -sfn lib "$deps/cuda.part/nvidia/cu13/lib64"
  ln -sfn libcudart.so.13 "$deps/cuda.part/nvidia/cu13/lib/libcudart.so"
  rm -rf "$deps/cuda" && mv "$deps/cuda.part" "$deps/cuda"
}

# What the compiler needs besides to make code for Jetson: the runtime and headers for aarch64.
fetch_cuda_aarch64() {
  local part=$deps/cuda-aarch64.part target=$cuda_prefix/targets/sbsa-linux name
  rm -rf "$part"
  "$deps/pip/bin/pip" install --no-cache-dir --disable-pip-version-check --no-deps --target "$part" \
    --platform manylinux_2_17_aarch64 --platform manylinux2014_aarch64 --only-binary=:all: "${cuda_aarch64_wheels[@]}" || return 1
  # Of one file only the x86-64 wheels have a copy.
  cp -n "$cuda_prefix/include/fatbinary_section.h" "$part/nvidia/cu13/include/" || return 1
  # Once there is a folder targets/, the compiler looks there for this machine's files as well.
  mkdir -p "$cuda_prefix/targets/x86_64-linux"
  for name in include lib lib64; do ln -sfn "../../$name" "$cuda_prefix/targets/x86_64-linux/$name"; done
  rm -rf "$target" && mv "$part/nvidia/cu13" "$target" && rm -rf "$part"
}

install_cuda_aarch64() {
  [[ ! -f $cuda_prefix/targets/sbsa-linux/include/cuda_runtime.h ]] || return 0
  if [[ ! -x $cuda_prefix/bin/nvcc ]]; then
    run_step "install the CUDA compiler (104 MB)" \
      "The cross build takes it from PyPI (nvidia-cuda-nvcc and others), also where a toolkit is installed: a network is needed." \
      pip_filter fetch_cuda_wheels || return 1
  fi
  run_step "install CUDA for aarch64" "It comes from PyPI (nvidia-cuda-runtime and others): a network is needed." \
    pip_filter fetch_cuda_aarch64
}

install_cuda() {
  find_nvcc >/dev/null && return 0
  run_step "install the CUDA compiler (104 MB)" \
    "It comes from PyPI (nvidia-cuda-nvcc and others): a network is needed, or install a CUDA toolkit." \
    pip_filter fetch_cuda_wheels
}
