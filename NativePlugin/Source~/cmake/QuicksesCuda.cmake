# SPDX-License-Identifier: MIT
# Enables CUDA. The host compiler and the architectures have to be known before the language is enabled.

if(NOT CMAKE_CUDA_COMPILER)
  find_program(QUICKSES_NVCC nvcc
    HINTS ENV CUDA_PATH ENV CUDA_HOME ${CUDAToolkit_ROOT}
    PATHS /usr/local/cuda /opt/cuda
    PATH_SUFFIXES bin
    DOC "The CUDA compiler")
  mark_as_advanced(QUICKSES_NVCC)
  if(DEFINED ENV{CUDACXX})
    set(_nvcc "$ENV{CUDACXX}")
  elseif(QUICKSES_NVCC)
    # Where /bin is a link to /usr/bin, the toolkit would be looked for in /include.
    get_filename_component(_folder "${QUICKSES_NVCC}" DIRECTORY)
    get_filename_component(_folder "${_folder}" REALPATH)
    set(_nvcc "${_folder}/nvcc")
  else()
    message(FATAL_ERROR "QUICKSES_CUDA is ON but nvcc was not found. Install the CUDA Toolkit (11.8 or later; on Debian "
      "bash Scripts~/setup.sh --with-cuda does it), or name it with -DCMAKE_CUDA_COMPILER=/path/to/nvcc.")
  endif()
  set(CMAKE_CUDA_COMPILER "${_nvcc}" CACHE FILEPATH "The CUDA compiler")
endif()

# Each nvcc refuses compilers newer than itself: where the default GCC is, the newest older one is taken.
if(NOT CMAKE_CUDA_HOST_COMPILER AND NOT DEFINED ENV{CUDAHOSTCXX} AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  execute_process(COMMAND "${CMAKE_CUDA_COMPILER}" --version OUTPUT_VARIABLE _nvcc_text ERROR_QUIET)
  string(REGEX MATCH "release ([0-9]+\\.[0-9]+)" _release "${_nvcc_text}")
  set(_release "${CMAKE_MATCH_1}")
  set(_newest 99)
  foreach(_row IN ITEMS 13.0=15 12.8=14 12.4=13 12.0=12 11.0=11) # from this release on: GCC up to this version
    string(REPLACE "=" ";" _row "${_row}")
    list(POP_FRONT _row _since _gcc)
    if(_release AND _release VERSION_GREATER_EQUAL _since)
      set(_newest ${_gcc})
      break()
    endif()
  endforeach()
  if(CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL "${_newest}.99")
    set(_names "")
    foreach(_version RANGE ${_newest} 9 -1)
      list(APPEND _names g++-${_version})
    endforeach()
    find_program(QUICKSES_CUDA_GCC NAMES ${_names} DOC "A GCC that this nvcc accepts")
    mark_as_advanced(QUICKSES_CUDA_GCC)
    if(NOT QUICKSES_CUDA_GCC)
      message(FATAL_ERROR "CUDA ${_release} needs GCC ${_newest} or earlier as its host compiler: install "
        "g++-${_newest}, or name a compiler with -DCMAKE_CUDA_HOST_COMPILER=/path/to/g++.")
    endif()
    set(CMAKE_CUDA_HOST_COMPILER "${QUICKSES_CUDA_GCC}" CACHE FILEPATH "The host compiler of nvcc")
  endif()
endif()

if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
  set(CMAKE_CUDA_ARCHITECTURES "${QUICKSES_CUDA_ARCHITECTURES}")
endif()
set(CMAKE_CUDA_RUNTIME_LIBRARY Static)
enable_language(CUDA)

if(CMAKE_CUDA_COMPILER_VERSION VERSION_LESS 11.8)
  message(FATAL_ERROR "CUDA ${CMAKE_CUDA_COMPILER_VERSION} is too old: 11.8 or later is needed.")
endif()
find_package(CUDAToolkit REQUIRED)
message(STATUS "CUDA ${CMAKE_CUDA_COMPILER_VERSION}, host compiler ${CMAKE_CUDA_HOST_COMPILER}, "
  "architectures ${CMAKE_CUDA_ARCHITECTURES}")
