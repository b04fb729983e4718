# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
option(EDGESPLAT_BUILD_TESTS "Build the test suite" ON)
option(EDGESPLAT_BUILD_FUZZERS "Build the libFuzzer targets (needs clang)" OFF)
option(EDGESPLAT_ONLY_KERNELS "Build kernels/ and their GPU tests alone, against the folder EDGESPLAT_CARRIED" OFF)
option(EDGESPLAT_BUILD_BENCHMARKS "Build the Google Benchmark targets" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/bin)
if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif()
# The same sums on every machine: no fused multiply-add behind our back, never -ffast-math, and Eigen's plain loops, as
# its vectors for ARM fuse where those for x86 do not. A recording then gives the same trajectory to the last bit on a
# Jetson and on a desk (tools_jetson/same_trajectory); tracking takes 2 % longer. Loops worth it are written with Highway.
# Symbols stay hidden, so that a library which brings its own vectorised Eigen functions does not meet ours.
add_compile_options($<$<COMPILE_LANGUAGE:C,CXX>:-ffp-contract=off>)
add_compile_definitions($<$<COMPILE_LANGUAGE:CXX,CUDA>:EIGEN_DONT_VECTORIZE>)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)

find_program(EDGESPLAT_CCACHE ccache)
if(EDGESPLAT_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${EDGESPLAT_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${EDGESPLAT_CCACHE})
endif()
