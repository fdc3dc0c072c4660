# PENUMBRA_SANITIZE: sanitizers of clang, joined by commas; the presets sanitize and thread set it.
# Address builds also record which branches run, so that the fuzzers share their libraries.
set(PENUMBRA_SANITIZE "" CACHE STRING "Sanitizers to build with, joined by commas")
if(PENUMBRA_SANITIZE STREQUAL "")
  return()
endif()
if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  message(FATAL_ERROR "PENUMBRA_SANITIZE needs clang: use the presets sanitize and thread")
endif()

set(sanitizers ${PENUMBRA_SANITIZE})
if(sanitizers MATCHES "address")
  string(APPEND sanitizers ",fuzzer-no-link")
endif()
# A report ends the program: nothing found goes unseen.
add_compile_options(-O1 -gline-tables-only -fno-omit-frame-pointer -fsanitize=${sanitizers}
                    -fno-sanitize-recover=all)
add_link_options(-fsanitize=${sanitizers})
