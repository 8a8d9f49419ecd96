# SPDX-License-Identifier: MIT
# Installs the build to an empty prefix and checks that its headers are the only ones there.
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND "${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${PREFIX}" RESULT_VARIABLE _result OUTPUT_QUIET)
if(NOT _result EQUAL 0)
  message(FATAL_ERROR "cmake --install failed")
endif()
file(GLOB_RECURSE _headers RELATIVE "${PREFIX}" "${PREFIX}/*.h" "${PREFIX}/*.hpp" "${PREFIX}/*.cuh")
list(SORT _headers)
if(NOT _headers STREQUAL "include/quickses/quickses.h;include/quickses/quickses_gpu.h")
  message(FATAL_ERROR "Installed headers: ${_headers}; include/quickses/quickses.h and quickses_gpu.h alone were expected")
endif()
# The installed program has to find the installed library.
execute_process(COMMAND "${PREFIX}/bin/quickses" --version RESULT_VARIABLE _result OUTPUT_VARIABLE _text ERROR_VARIABLE _text)
if(NOT _result EQUAL 0)
  message(FATAL_ERROR "The installed program does not run: ${_text}")
endif()
