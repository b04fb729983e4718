# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Cross build for Jetson AGX Orin from Debian 12. EDGESPLAT_SYSROOT (variable or environment): a folder with the target's
# arm64 libraries and headers; default: what tools/sysroot makes.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
if(NOT EDGESPLAT_SYSROOT)
  set(EDGESPLAT_SYSROOT $ENV{EDGESPLAT_SYSROOT})
endif()
if(NOT EDGESPLAT_SYSROOT)
  get_filename_component(EDGESPLAT_SYSROOT ${CMAKE_CURRENT_LIST_DIR}/../../.deps/sysroot-aarch64 ABSOLUTE)
endif()
if(NOT EXISTS ${EDGESPLAT_SYSROOT}/usr/lib/aarch64-linux-gnu)
  message(FATAL_ERROR "No arm64 libraries in ${EDGESPLAT_SYSROOT}: run tools/setup --jetson, or set EDGESPLAT_SYSROOT to a folder "
    "that has them, then configure again")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDGESPLAT_SYSROOT)
set(CMAKE_SYSROOT ${EDGESPLAT_SYSROOT})
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_FIND_ROOT_PATH ${EDGESPLAT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${EDGESPLAT_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR} ${EDGESPLAT_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${EDGESPLAT_SYSROOT}/usr/share/pkgconfig)
# Programs made on the way, and tests, run under emulation.
find_program(EDGESPLAT_QEMU_AARCH64 NAMES qemu-aarch64-static qemu-aarch64)
if(EDGESPLAT_QEMU_AARCH64)
  set(CMAKE_CROSSCOMPILING_EMULATOR ${EDGESPLAT_QEMU_AARCH64};-L;${EDGESPLAT_SYSROOT})
endif()
# The programs lie in /opt/edgesplat/bin, what they need and a device lacks in /opt/edgesplat/lib (tools/jetson). RPATH and not
# RUNPATH: only the first is also where the libraries that come along look for each other.
set(CMAKE_BUILD_RPATH "\$ORIGIN/../lib")
set(CMAKE_EXE_LINKER_FLAGS_INIT -Wl,--disable-new-dtags)
# The CUDA compiler for Orin, where tools/setup --jetson --cuda left it.
get_filename_component(EDGESPLAT_CUDA_ROOT ${CMAKE_CURRENT_LIST_DIR}/../../.deps/cuda/nvidia/cu13 ABSOLUTE)
if(EXISTS ${EDGESPLAT_CUDA_ROOT}/targets/sbsa-linux/include/cuda_runtime.h)
  set(CMAKE_CUDA_COMPILER ${EDGESPLAT_CUDA_ROOT}/bin/nvcc)
  set(CMAKE_CUDA_HOST_COMPILER aarch64-linux-gnu-g++)
  set(CMAKE_CUDA_ARCHITECTURES 87-real)
  set(CMAKE_CUDA_FLAGS_INIT "--target-directory sbsa-linux")
endif()
# Never -static-libstdc++: Debian's needs glibc 2.36, JetPack 6 has 2.35.
