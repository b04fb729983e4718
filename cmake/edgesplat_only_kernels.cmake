# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The CUDA kernels with their tests and benchmark on a machine that has nothing but nvcc, CMake and a C++ compiler. What
# else they need lies in EDGESPLAT_CARRIED (`tools/gpu-check --pack`): googletest's sources, headers, TBB and Highway.
set(EDGESPLAT_CARRIED "" CACHE PATH "Folder that tools/gpu-check --pack made")
if(NOT EXISTS "${EDGESPLAT_CARRIED}/include/Eigen/Core" OR NOT EXISTS "${EDGESPLAT_CARRIED}/googletest/CMakeLists.txt")
  message(FATAL_ERROR "EDGESPLAT_CARRIED (${EDGESPLAT_CARRIED}) lacks headers or googletest: make it with tools/gpu-check --pack")
endif()
find_package(Threads REQUIRED)
function(edgesplat_carried target)
  add_library(${target} INTERFACE IMPORTED GLOBAL)
  target_include_directories(${target} SYSTEM INTERFACE ${EDGESPLAT_CARRIED}/include)
endfunction()
edgesplat_carried(Eigen3::Eigen)
edgesplat_carried(tl::expected)
edgesplat_carried(TBB::tbb)
edgesplat_carried(PkgConfig::HWY)
target_link_libraries(TBB::tbb INTERFACE ${EDGESPLAT_CARRIED}/lib/libtbb.so.12)
target_link_libraries(PkgConfig::HWY INTERFACE ${EDGESPLAT_CARRIED}/lib/libhwy.so.1)
set(INSTALL_GTEST OFF)
add_subdirectory(${EDGESPLAT_CARRIED}/googletest ${CMAKE_BINARY_DIR}/googletest EXCLUDE_FROM_ALL)

set(EDGESPLAT_CUDA ON)
include(edgesplat_cuda)
include(edgesplat_targets)
enable_testing()
include(GoogleTest)
foreach(folder common/base common/gaussian common/geometry common/thread common/time kernels/core kernels/splat
    kernels/train test/support test/kernels/core test/kernels/splat test/kernels/train test/bench)
  add_subdirectory(${folder})
endforeach()
