# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# AUTO turns CUDA on when a compiler is found; OFF never looks; ON fails without one.
set(EDGESPLAT_CUDA "OFF" CACHE STRING "CUDA backend: AUTO, ON or OFF")
set(EDGESPLAT_WITH_CUDA OFF)
# A compiler that is lying about makes code for this machine, not for the target: the toolchain file names the right one.
if(CMAKE_CROSSCOMPILING AND NOT CMAKE_CUDA_COMPILER)
  if(EDGESPLAT_CUDA STREQUAL "ON")
    message(FATAL_ERROR "No CUDA compiler for the target: run tools/setup --jetson --cuda, then configure again")
  endif()
  message(STATUS "No CUDA compiler for the target (tools/setup --jetson --cuda gets it): CPU backend only")
elseif(NOT EDGESPLAT_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  # What tools/setup --cuda leaves, where no toolkit is installed.
  find_program(EDGESPLAT_NVCC nvcc HINTS ENV CUDACXX PATHS /usr/local/cuda/bin
    ${CMAKE_SOURCE_DIR}/.deps/cuda/nvidia/cu13/bin)
  if(EDGESPLAT_NVCC AND NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
    set(CMAKE_CUDA_COMPILER ${EDGESPLAT_NVCC})
  endif()
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES "87-real;89-real;90")  # Orin, Ada servers, Hopper
    endif()
    enable_language(CUDA)
    if(CMAKE_SYSROOT)  # the host compiler knows the C library's headers; named again they come before those of C++
      list(APPEND CMAKE_CUDA_IMPLICIT_INCLUDE_DIRECTORIES ${CMAKE_SYSROOT}/usr/include)
    endif()
    set(CMAKE_CUDA_STANDARD 20)
    set(CMAKE_CUDA_EXTENSIONS OFF)
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)  # CMake 3.25 does not know that nvcc 12 and later take C++20
      set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION -std=c++20)
      set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION -std=c++20)
    endif()
    # Device code uses no Eigen: without its host-device marks nvcc has nothing to warn of.
    add_compile_options("$<$<COMPILE_LANGUAGE:CUDA>:-DEIGEN_NO_CUDA;-Werror=all-warnings>")
    if(CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
      # nvcc does not know g++'s NEON intrinsics. Alignments have to be those of the C++ sources all the same.
      add_compile_options("$<$<COMPILE_LANGUAGE:CUDA>:-DEIGEN_DONT_VECTORIZE;-DEIGEN_MAX_ALIGN_BYTES=16;-DEIGEN_MAX_STATIC_ALIGN_BYTES=16>")
    endif()
    set(EDGESPLAT_WITH_CUDA ON)
  elseif(EDGESPLAT_CUDA STREQUAL "ON")
    message(FATAL_ERROR "No CUDA compiler: install a toolkit or run tools/setup --cuda, then configure again")
  endif()
endif()
