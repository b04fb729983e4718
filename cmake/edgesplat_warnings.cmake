# SPDX-FileCopyrightText: 2026 The edgesplat authors
# SPDX-License-Identifier: Apache-2.0
option(EDGESPLAT_WARNINGS_AS_ERRORS "Treat warnings as errors" ON)
function(edgesplat_set_warnings target)
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Wnon-virtual-dtor
      -Woverloaded-virtual -Wimplicit-fallthrough -Wnull-dereference>
    $<$<AND:$<COMPILE_LANGUAGE:CXX>,$<BOOL:${EDGESPLAT_WARNINGS_AS_ERRORS}>>:-Werror>)
  # g++ 12 sees null dereferences and overlapping copies (PR105329) in its own inlined library code.
  target_compile_options(${target} PRIVATE
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-null-dereference -Wno-maybe-uninitialized -Wno-restrict>)
endfunction()
