# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# AUTO turns CUDA on when a compiler is found; OFF never looks; ON fails without one.
set(EDGESPLAT_CUDA "OFF" CACHE STRING "CUDA backend: AUTO, ON or OFF")
set(EDGESPLAT_WITH_CUDA OFF)
if(NOT EDGESPLAT_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES "87-real;89-real;90")  # Orin, Ada servers, Hopper
    endif()
    enable_language(CUDA)
    set(CMAKE_CUDA_STANDARD 20)
    set(EDGESPLAT_WITH_CUDA ON)
  elseif(EDGESPLAT_CUDA STREQUAL "ON")
    message(FATAL_ERROR "No CUDA compiler: install a toolkit or run tools/setup --cuda, then configure again")
  endif()
endif()
