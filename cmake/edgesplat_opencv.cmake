# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The modules of OpenCV that are used, as edgesplat_opencv. Debian has OpenCV's own CMake package only in libopencv-dev,
# which pulls in all modules with what they need; the modules' packages do.
add_library(edgesplat_opencv INTERFACE)
find_path(EDGESPLAT_OPENCV_INCLUDE opencv2/core.hpp PATH_SUFFIXES opencv4)
foreach(module core imgproc features2d dnn)
  find_library(EDGESPLAT_OPENCV_${module} opencv_${module})
  if(NOT EDGESPLAT_OPENCV_INCLUDE OR NOT EDGESPLAT_OPENCV_${module})
    message(FATAL_ERROR "OpenCV's module ${module} not found: run tools/setup (it installs every dependency), then configure again")
  endif()
  target_link_libraries(edgesplat_opencv INTERFACE ${EDGESPLAT_OPENCV_${module}})
endforeach()
target_include_directories(edgesplat_opencv SYSTEM INTERFACE ${EDGESPLAT_OPENCV_INCLUDE})
