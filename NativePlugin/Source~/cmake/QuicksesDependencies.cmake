# SPDX-License-Identifier: MIT
# Finds the libraries. Installed ones come first; with QUICKSES_FETCH=ON what is missing is downloaded, pinned.
include(FetchContent)
if(POLICY CMP0169) # FetchContent_MakeAvailable can't leave out install rules before CMake 3.28
  cmake_policy(SET CMP0169 OLD)
endif()

set(_how_to_get_it "on Debian and Ubuntu bash Scripts~/setup.sh installs it; -DQUICKSES_FETCH=ON downloads it")

# quickses_fetch(<name> <repository> <tag>): the library as part of this build, its own tests and install rules off.
macro(quickses_fetch name repository tag)
  if(NOT QUICKSES_FETCH)
    message(FATAL_ERROR "${name} was not found (${_how_to_get_it}).")
  endif()
  message(STATUS "${name} is not installed: fetching ${tag}")
  FetchContent_Declare(${name} GIT_REPOSITORY ${repository} GIT_TAG ${tag} GIT_SHALLOW ON)
  FetchContent_GetProperties(${name})
  string(TOLOWER ${name} _lower)
  if(NOT ${_lower}_POPULATED)
    FetchContent_Populate(${name})
    # EXCLUDE_FROM_ALL: only what we link is built, and nothing of it is installed with us.
    set(_shared ${BUILD_SHARED_LIBS})
    set(BUILD_SHARED_LIBS OFF)
    set(CMAKE_POSITION_INDEPENDENT_CODE ON)
    add_subdirectory("${${_lower}_SOURCE_DIR}" "${${_lower}_BINARY_DIR}" EXCLUDE_FROM_ALL)
    set(BUILD_SHARED_LIBS ${_shared})
  endif()
endmacro()

# ---- header-only libraries, for systems whose own packages don't have them
# quickses_find_headers(<name> <header> <target>): the target, if the header is found anywhere the compiler may look.
macro(quickses_find_headers name header target)
  if(NOT TARGET ${target} AND NOT CMAKE_DISABLE_FIND_PACKAGE_${name})
    find_path(QUICKSES_${name}_INCLUDE_DIR ${header} DOC "Folder that holds ${header}")
    mark_as_advanced(QUICKSES_${name}_INCLUDE_DIR)
    if(QUICKSES_${name}_INCLUDE_DIR)
      add_library(${target} INTERFACE IMPORTED)
      set_target_properties(${target} PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${QUICKSES_${name}_INCLUDE_DIR}")
    endif()
  endif()
endmacro()

# When cross-compiling, those of the machine that builds: links to them alone, since the other headers beside them
# belong to another system.
set(QUICKSES_HEADERS_FROM "" CACHE PATH "Folder whose header-only libraries serve a cross-compilation, such as /usr/include")
mark_as_advanced(QUICKSES_HEADERS_FROM)
if(QUICKSES_HEADERS_FROM)
  file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/headers/include")
  foreach(_name IN ITEMS CLI cub gemmi glm nlohmann stb tao thrust)
    if(EXISTS "${QUICKSES_HEADERS_FROM}/${_name}")
      file(CREATE_LINK "${QUICKSES_HEADERS_FROM}/${_name}" "${PROJECT_BINARY_DIR}/headers/include/${_name}" SYMBOLIC)
    endif()
  endforeach()
  list(APPEND CMAKE_FIND_ROOT_PATH "${PROJECT_BINARY_DIR}/headers")
endif()

if(MINGW)
  set(CMAKE_FIND_LIBRARY_SUFFIXES .a .dll.a) # static ones first: a plug-in is one file
endif()

set(THREADS_PREFER_PTHREAD_FLAG ON)
find_package(Threads REQUIRED)

# ---- GLM: types of storage and interfaces
find_package(glm CONFIG QUIET)
quickses_find_headers(glm glm/glm.hpp glm::glm)
if(NOT TARGET glm::glm)
  quickses_fetch(glm https://github.com/g-truc/glm.git 1.0.1)
endif()

# ---- Thrust: the parallel verbs. The CUDA Toolkit's own copy when there is one, for the CPU's files as well: two
# versions in one binary would break the one-definition rule. (Debian's toolkit has none of its own but depends on
# libthrust-dev, so there both are /usr/include. CUDA 13 keeps it in include/cccl.)
if(QUICKSES_CUDA)
  find_path(QUICKSES_THRUST_INCLUDE_DIR thrust/version.h
    HINTS "${QUICKSES_CUDA_HEADERS}" PATH_SUFFIXES cccl NO_DEFAULT_PATH
    DOC "Folder that holds thrust/version.h")
endif()
find_path(QUICKSES_THRUST_INCLUDE_DIR thrust/version.h DOC "Folder that holds thrust/version.h")
mark_as_advanced(QUICKSES_THRUST_INCLUDE_DIR)
if(NOT QUICKSES_THRUST_INCLUDE_DIR)
  message(FATAL_ERROR "Thrust was not found: install libthrust-dev (Debian, Ubuntu) or the CUDA Toolkit, or set "
    "QUICKSES_THRUST_INCLUDE_DIR to the folder that holds thrust/version.h.")
endif()
file(STRINGS "${QUICKSES_THRUST_INCLUDE_DIR}/thrust/version.h" _thrust_line REGEX "define THRUST_VERSION +[0-9]+")
string(REGEX REPLACE ".*THRUST_VERSION +([0-9]+).*" "\\1" QUICKSES_THRUST_VERSION "${_thrust_line}")
if(QUICKSES_THRUST_VERSION LESS 101500)
  message(FATAL_ERROR "Thrust ${QUICKSES_THRUST_VERSION} in ${QUICKSES_THRUST_INCLUDE_DIR} is too old: 101500 (1.15) or later.")
endif()
message(STATUS "Thrust ${QUICKSES_THRUST_VERSION} in ${QUICKSES_THRUST_INCLUDE_DIR}")

# ---- zlib: gzipped files. Where it can be had, the static library goes into ours, so that a plug-in needs no other file.
find_package(ZLIB REQUIRED)
set(QUICKSES_LIBRARY_ZLIB ZLIB::ZLIB)
if(CMAKE_SYSTEM_NAME STREQUAL "Linux" AND BUILD_SHARED_LIBS AND NOT QUICKSES_SANITIZE)
  find_library(QUICKSES_STATIC_ZLIB NAMES libz.a DOC "zlib as a static library")
  mark_as_advanced(QUICKSES_STATIC_ZLIB)
  if(QUICKSES_STATIC_ZLIB)
    # Not every libz.a can become a part of a shared library (Debian's can, as long as its symbols stay inside).
    include(CheckCXXSourceCompiles)
    set(CMAKE_REQUIRED_FLAGS -fPIC)
    set(CMAKE_REQUIRED_INCLUDES ${ZLIB_INCLUDE_DIRS})
    set(CMAKE_REQUIRED_LIBRARIES "${QUICKSES_STATIC_ZLIB}")
    set(CMAKE_REQUIRED_LINK_OPTIONS -shared -Wl,--no-undefined
      "-Wl,--version-script=${CMAKE_CURRENT_LIST_DIR}/quickses.map")
    check_cxx_source_compiles("#include <zlib.h>
extern \"C\" int qses_probe(z_stream *s) { return inflateInit2(s, 31) + inflate(s, 0) + inflateReset(s) + inflateEnd(s); }
int main() { return 0; }" QUICKSES_STATIC_ZLIB_WORKS)
    unset(CMAKE_REQUIRED_FLAGS)
    unset(CMAKE_REQUIRED_INCLUDES)
    unset(CMAKE_REQUIRED_LIBRARIES)
    unset(CMAKE_REQUIRED_LINK_OPTIONS)
    if(QUICKSES_STATIC_ZLIB_WORKS)
      set(QUICKSES_LIBRARY_ZLIB "${QUICKSES_STATIC_ZLIB}")
    endif()
  endif()
endif()
message(STATUS "zlib of the library: ${QUICKSES_LIBRARY_ZLIB}")

# ---- gemmi: structures. It was headers only up to 0.5; later versions come with a library.
# quickses_gemmi is what its headers need, QUICKSES_GEMMI_LIBRARIES what is linked.
find_package(gemmi CONFIG QUIET)
if(NOT TARGET gemmi::gemmi_cpp)
  if(NOT CMAKE_DISABLE_FIND_PACKAGE_gemmi)
    find_path(QUICKSES_GEMMI_INCLUDE_DIR gemmi/version.hpp DOC "Folder that holds gemmi/version.hpp")
    find_library(QUICKSES_GEMMI_LIBRARY gemmi_cpp DOC "gemmi's library, from version 0.6 on")
  endif()
  mark_as_advanced(QUICKSES_GEMMI_INCLUDE_DIR QUICKSES_GEMMI_LIBRARY)
  if(NOT QUICKSES_GEMMI_INCLUDE_DIR)
    quickses_fetch(gemmi https://github.com/project-gemmi/gemmi.git v0.6.5)
  endif()
endif()
add_library(quickses_gemmi INTERFACE)
set(QUICKSES_GEMMI_LIBRARIES "")
if(TARGET gemmi::gemmi_cpp)
  target_link_libraries(quickses_gemmi INTERFACE gemmi::gemmi_cpp)
  set(QUICKSES_GEMMI_LIBRARIES gemmi::gemmi_cpp)
elseif(TARGET gemmi_cpp)
  target_link_libraries(quickses_gemmi INTERFACE gemmi_cpp)
  set(QUICKSES_GEMMI_LIBRARIES "$<BUILD_INTERFACE:gemmi_cpp>")
else()
  target_include_directories(quickses_gemmi SYSTEM INTERFACE "${QUICKSES_GEMMI_INCLUDE_DIR}")
  if(QUICKSES_GEMMI_LIBRARY)
    set(QUICKSES_GEMMI_LIBRARIES "${QUICKSES_GEMMI_LIBRARY}")
  endif()
endif()

if(QUICKSES_BUILD_CLI OR QUICKSES_BUILD_TESTS)
  # ---- the program's options and reports
  find_package(CLI11 CONFIG QUIET)
  quickses_find_headers(CLI11 CLI/CLI.hpp CLI11::CLI11)
  if(NOT TARGET CLI11::CLI11)
    quickses_fetch(CLI11 https://github.com/CLIUtils/CLI11.git v2.4.2)
  endif()
  find_package(nlohmann_json CONFIG QUIET)
  quickses_find_headers(nlohmann_json nlohmann/json.hpp nlohmann_json::nlohmann_json)
  if(NOT TARGET nlohmann_json::nlohmann_json)
    quickses_fetch(nlohmann_json https://github.com/nlohmann/json.git v3.11.3)
  endif()
endif()

if(QUICKSES_BUILD_CLI OR QUICKSES_BUILD_TESTS)
  # ---- stb_image_write: the program's pictures. It has no releases, so a commit is pinned.
  add_library(quickses_stb INTERFACE)
  quickses_find_headers(stb stb/stb_image_write.h quickses_stb_headers)
  if(NOT TARGET quickses_stb_headers)
    if(NOT QUICKSES_FETCH)
      message(FATAL_ERROR "stb was not found (${_how_to_get_it}).")
    endif()
    FetchContent_Declare(stb GIT_REPOSITORY https://github.com/nothings/stb.git
      GIT_TAG 5736b15f7ea0ffb08dd38af21067c314d6a3aae9)
    FetchContent_GetProperties(stb)
    if(NOT stb_POPULATED)
      FetchContent_Populate(stb)
    endif()
    configure_file("${stb_SOURCE_DIR}/stb_image_write.h" "${PROJECT_BINARY_DIR}/stb/stb/stb_image_write.h" COPYONLY)
    target_include_directories(quickses_stb SYSTEM INTERFACE "${PROJECT_BINARY_DIR}/stb")
  else()
    target_link_libraries(quickses_stb INTERFACE quickses_stb_headers)
  endif()

  # ---- three.js: the program's pages. It is text, so a cross-compilation takes that of the machine that builds.
  find_file(QUICKSES_THREE_JS three.min.js PATHS /usr/share/javascript/three /usr/share/nodejs/three/build
    NO_CMAKE_FIND_ROOT_PATH DOC "three.js of a release up to r124, for pages (-o x.html)")
  find_file(QUICKSES_THREE_CONTROLS_JS TrackballControls.js PATHS /usr/share/javascript/three/examples/js/controls
    /usr/share/nodejs/three/examples/js/controls NO_CMAKE_FIND_ROOT_PATH DOC "Its TrackballControls")
  mark_as_advanced(QUICKSES_THREE_JS QUICKSES_THREE_CONTROLS_JS)
  if(QUICKSES_THREE_JS AND QUICKSES_THREE_CONTROLS_JS)
    message(STATUS "three.js for pages: ${QUICKSES_THREE_JS}")
  else()
    message(STATUS "three.js was not found (libjs-three): the program will make no pages (-o x.html)")
  endif()
endif()

# ---- MPI: frames of a trajectory shared among processes
if(QUICKSES_MPI)
  find_package(MPI REQUIRED COMPONENTS CXX)
endif()

if(QUICKSES_BUILD_TESTS)
  find_package(GTest CONFIG QUIET)
  set(QUICKSES_GOOGLETEST_SOURCE "" CACHE PATH "GoogleTest's sources, to be built with the tests")
  mark_as_advanced(QUICKSES_GOOGLETEST_SOURCE)
  if(NOT TARGET GTest::gtest_main AND QUICKSES_GOOGLETEST_SOURCE)
    set(_shared ${BUILD_SHARED_LIBS})
    set(BUILD_SHARED_LIBS OFF)
    set(BUILD_GMOCK OFF)
    add_subdirectory("${QUICKSES_GOOGLETEST_SOURCE}" googletest EXCLUDE_FROM_ALL)
    set(BUILD_SHARED_LIBS ${_shared})
    if(NOT TARGET GTest::gtest_main)
      add_library(GTest::gtest ALIAS gtest)
      add_library(GTest::gtest_main ALIAS gtest_main)
    endif()
  endif()
  if(NOT TARGET GTest::gtest_main)
    quickses_fetch(googletest https://github.com/google/googletest.git v1.14.0)
  endif()
endif()

# ---- Python: where the first one, Conda's perhaps, lacks PyYAML and the system's has it, as setup.sh sees to, that one
if(QUICKSES_PLUGIN OR QUICKSES_BUILD_TESTS)
  set(_python python3)
  foreach(_candidate IN ITEMS python3 /usr/bin/python3)
    execute_process(COMMAND "${_candidate}" -c "import yaml" RESULT_VARIABLE _status OUTPUT_QUIET ERROR_QUIET)
    if(_status EQUAL 0)
      set(_python "${_candidate}")
      break()
    endif()
  endforeach()
  find_program(QUICKSES_PYTHON "${_python}" DOC "Packs the package; runs the tests of the program and of the package's files")
  mark_as_advanced(QUICKSES_PYTHON)
endif()
