# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
set(EDGESPLAT_SANITIZE "" CACHE STRING "Comma-separated -fsanitize= list, e.g. address,undefined or thread")
if(EDGESPLAT_SANITIZE)
  add_compile_options(-fsanitize=${EDGESPLAT_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all -g1)
  add_link_options(-fsanitize=${EDGESPLAT_SANITIZE})
endif()
if(EDGESPLAT_BUILD_FUZZERS)
  # Coverage of everything a fuzzer calls; without it libFuzzer sees only the target's own few lines.
  add_compile_options(-fsanitize=fuzzer-no-link)
  add_link_options(-fsanitize=fuzzer-no-link)
endif()
