# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# Cross build for Jetson AGX Orin. EDGESPLAT_SYSROOT: a folder with the target's arm64 libraries and headers.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_C_COMPILER aarch64-linux-gnu-gcc)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
if(NOT EDGESPLAT_SYSROOT)
  set(EDGESPLAT_SYSROOT $ENV{EDGESPLAT_SYSROOT})
endif()
if(NOT EDGESPLAT_SYSROOT)
  message(FATAL_ERROR "Set EDGESPLAT_SYSROOT to a folder with the Jetson's arm64 libraries and headers")
endif()
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES EDGESPLAT_SYSROOT)
set(CMAKE_SYSROOT ${EDGESPLAT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH ${EDGESPLAT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
# Never -static-libstdc++: Debian's needs glibc 2.36, JetPack 6 has 2.35.
