# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
# The verbs of every CMakeLists.txt of the project. NAME is the folder with underscores: common/base -> common_base.

# edgesplat_library(NAME common_base SOURCES a.cpp PUBLIC dep PRIVATE dep); without SOURCES: header-only.
function(edgesplat_library)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target edgesplat_${ARG_NAME})
  if(ARG_SOURCES)
    add_library(${target} STATIC ${ARG_SOURCES})
    target_include_directories(${target} PUBLIC ${CMAKE_SOURCE_DIR})
    target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
    edgesplat_set_warnings(${target})
  else()
    add_library(${target} INTERFACE)
    target_include_directories(${target} INTERFACE ${CMAKE_SOURCE_DIR})
    target_link_libraries(${target} INTERFACE ${ARG_PUBLIC})
  endif()
endfunction()

# edgesplat_executable(NAME edgesplat-robot SOURCES main.cpp PRIVATE dep)
function(edgesplat_executable)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;PRIVATE" ${ARGN})
  add_executable(${ARG_NAME} ${ARG_SOURCES})
  target_include_directories(${ARG_NAME} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${ARG_NAME} PRIVATE ${ARG_PRIVATE})
  edgesplat_set_warnings(${ARG_NAME})
endfunction()

# edgesplat_test(NAME common_base SOURCES a_test.cpp LINK edgesplat_common_base [LABELS unit] [TIMEOUT s] [SERIAL]):
# one binary test_<NAME>; every TEST in it is a ctest of its own, named <NAME>/<suite>.<test>.
function(edgesplat_test)
  cmake_parse_arguments(ARG "SERIAL" "NAME;TIMEOUT" "SOURCES;LINK;LABELS" ${ARGN})
  set(target test_${ARG_NAME})
  add_executable(${target} ${ARG_SOURCES})
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${ARG_LINK} GTest::gmock GTest::gtest GTest::gtest_main)
  # Absolute places a test may need; a test skips visibly where the shared data is absent.
  target_compile_definitions(${target} PRIVATE EDGESPLAT_SOURCE_DIR="${CMAKE_SOURCE_DIR}"
    EDGESPLAT_BINARY_DIR="${CMAKE_BINARY_DIR}")
  edgesplat_set_warnings(${target})
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  if(EDGESPLAT_SANITIZE)
    math(EXPR ARG_TIMEOUT "5 * ${ARG_TIMEOUT}")  # so much slower, at worst
  endif()
  # SERIAL: beside nothing else, for what is about seconds on the wall.
  gtest_discover_tests(${target} TEST_PREFIX ${ARG_NAME}/ DISCOVERY_MODE PRE_TEST
    PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT} RUN_SERIAL ${ARG_SERIAL})
endfunction()

# edgesplat_fuzzer(NAME livox_protocol SOURCES livox_protocol_fuzz.cpp LINK ...): libFuzzer target fuzz_<NAME>;
# its seed corpus is test/fuzz/corpus/<NAME>/. Only with EDGESPLAT_BUILD_FUZZERS (clang).
function(edgesplat_fuzzer)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;LINK" ${ARGN})
  if(NOT EDGESPLAT_BUILD_FUZZERS)
    return()
  endif()
  set(target fuzz_${ARG_NAME})
  add_executable(${target} ${ARG_SOURCES})
  target_include_directories(${target} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(${target} PRIVATE ${ARG_LINK})
  target_compile_options(${target} PRIVATE -fsanitize=fuzzer)
  target_link_options(${target} PRIVATE -fsanitize=fuzzer)
endfunction()

# edgesplat_bench(NAME splat SOURCES splat_bench.cpp LINK ...): Google Benchmark binary bench_<NAME>.
function(edgesplat_bench)
  cmake_parse_arguments(ARG "" "NAME" "SOURCES;LINK" ${ARGN})
  if(NOT EDGESPLAT_BUILD_BENCHMARKS)
    return()
  endif()
  add_executable(bench_${ARG_NAME} ${ARG_SOURCES})
  target_include_directories(bench_${ARG_NAME} PRIVATE ${CMAKE_SOURCE_DIR})
  target_link_libraries(bench_${ARG_NAME} PRIVATE ${ARG_LINK} benchmark::benchmark_main)
  edgesplat_set_warnings(bench_${ARG_NAME})
endfunction()
