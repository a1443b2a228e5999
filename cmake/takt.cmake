# SPDX-License-Identifier: Apache-2.0
# The few functions that every CMakeLists.txt of takt uses.

# Options that every target of takt shares: warnings are errors, floating point is never contracted, one C++ dialect.
add_library(takt_options INTERFACE)
target_compile_features(takt_options INTERFACE cxx_std_20)
target_compile_options(takt_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wnon-virtual-dtor -Werror
                                              -ffp-contract=off -fno-tree-slp-vectorize)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  target_compile_options(takt_options INTERFACE -Wno-restrict)  # GCC bug 105651: false alarms for string concatenation
endif()
# What the optimiser believes to see differs from one release of GCC to the next, and is wrong at times: it is told,
# and stops nobody.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(takt_options INTERFACE $<$<CONFIG:Release>:-Wno-error=maybe-uninitialized -Wno-error=array-bounds -Wno-error=stringop-overflow
                                                -Wno-error=stringop-overread -Wno-error=free-nonheap-object>
                                                $<$<AND:$<CONFIG:Release>,$<VERSION_GREATER_EQUAL:${CMAKE_CXX_COMPILER_VERSION},12>>:-Wno-error=dangling-pointer -Wno-error=use-after-free>)
endif()
# The compiler collects its own garbage less often: an eighth of its time for some 200 MB more.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(takt_options INTERFACE $<BUILD_INTERFACE:$<$<CONFIG:Release>:--param=ggc-min-heapsize=300000>>)
endif()
# Of sources that are compiled together (takt_unity below) one may name a variable as another names a constant, and
# GCC takes classes of a .cpp
# file for classes of a header, whose members should not be of types without linkage.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(takt_options INTERFACE $<$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>:-Wno-shadow -Wshadow=local -Wno-subobject-linkage>)
else()
  target_compile_options(takt_options INTERFACE $<$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>:-Wno-shadow>)
endif()
if(TAKT_SANITIZE)
  target_compile_options(takt_options INTERFACE -fsanitize=${TAKT_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer)
  target_link_options(takt_options INTERFACE -fsanitize=${TAKT_SANITIZE})
endif()
if(TAKT_FUZZ)
  target_compile_options(takt_options INTERFACE -fsanitize=fuzzer-no-link)
  target_link_options(takt_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# Where installed headers are (cmake/install.cmake).
set(TAKT_INCLUDE_FOLDER include/takt)

# Compiles the sources of the target several at a time: most of what they take is the headers.
function(takt_unity target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 24)
endfunction()

# Headers that nearly every source includes are compiled once for those that are compiled alike: CAREFULLY, QUICKLY,
# or with GoogleTest TESTS. The other compilers
# check that each source includes what it needs.
set(takt_standard_headers <algorithm> <array> <cstdint> <functional> <map> <memory> <optional> <span> <string>
  <variant> <vector>)
function(takt_precompiled target kind)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    return()
  endif()
  set(headers takt_headers_${kind})
  if(NOT TARGET ${headers})
    set(source ${PROJECT_BINARY_DIR}/generated/${headers}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "" @ONLY)
    add_library(${headers} OBJECT ${source})
    target_link_libraries(${headers} PRIVATE takt_options)
    target_precompile_headers(${headers} PRIVATE ${takt_standard_headers})
    if(kind STREQUAL TESTS)
      target_link_libraries(${headers} PRIVATE GTest::gtest)
      target_precompile_headers(${headers} PRIVATE <gtest/gtest.h>)
    endif()
    if(NOT kind STREQUAL CAREFULLY)
      target_compile_options(${headers} PRIVATE $<$<CONFIG:Release>:-Og>)
    endif()
  endif()
  target_precompile_headers(${target} REUSE_FROM ${headers})
endfunction()

# takt_feature(NAME FOUND): something optional that `takt --version` tells of; NAME is what people call it, FOUND
# whether this build has it.
function(takt_feature name)
  set(has without)
  if(${ARGN})
    set(has with)
  endif()
  set_property(GLOBAL APPEND PROPERTY TAKT_FEATURES "${has} ${name}")
endfunction()

# takt_library(NAME [SINGLY] SOURCES a.cpp ... QUICKLY b.cpp ... LINKS other ...): one layer of the house; it links
# only what the layer may use.
# QUICKLY are sources whose speed nobody notices (descriptions, commands, reports): they are compiled with -Og, in two
# thirds of the time that -O1 takes. Several sources are compiled at a
# time (TAKT_UNITY), since most of what they take is the headers; SINGLY not, where what the optimiser sees at a time
# decides about the speed. Headers are included from the repository's root ("sim/time.hpp") or from their
# wing ("handshake/participant.hpp").
set(takt_include_folders ${takt_wings})
list(TRANSFORM takt_include_folders PREPEND "${PROJECT_SOURCE_DIR}/src/")
list(PREPEND takt_include_folders "${PROJECT_SOURCE_DIR}")
set(takt_test_folders ${takt_wings})
list(TRANSFORM takt_test_folders PREPEND "${PROJECT_SOURCE_DIR}/tests/")
list(PREPEND takt_test_folders "${PROJECT_SOURCE_DIR}/tests")
function(takt_library name)
  cmake_parse_arguments(ARG "SINGLY" "" "SOURCES;QUICKLY;LINKS;PRIVATE_LINKS" ${ARGN})
  set(folders "${takt_include_folders}")
  if(NOT ARG_SOURCES AND NOT ARG_QUICKLY)
    add_library(${name} INTERFACE)
    set(reach INTERFACE)
  else()
    set(reach PUBLIC)
    set(quick)
    if(ARG_QUICKLY)
      add_library(${name}_quickly OBJECT ${ARG_QUICKLY})
      target_link_libraries(${name}_quickly PRIVATE takt_options ${ARG_LINKS} ${ARG_PRIVATE_LINKS})
      target_include_directories(${name}_quickly PRIVATE "${folders}")
      target_compile_options(${name}_quickly PRIVATE $<$<CONFIG:Release>:-Og>)
      takt_precompiled(${name}_quickly QUICKLY)
      if(TAKT_UNITY AND NOT ARG_SINGLY)
        takt_unity(${name}_quickly)
      endif()
      set(quick $<TARGET_OBJECTS:${name}_quickly>)
    endif()
    add_library(${name} STATIC ${ARG_SOURCES} ${quick})
    target_link_libraries(${name} PRIVATE takt_options ${ARG_PRIVATE_LINKS})
    if(ARG_SOURCES)
      takt_precompiled(${name} CAREFULLY)
    endif()
    if(TAKT_UNITY AND NOT ARG_SINGLY)
      takt_unity(${name})
    endif()
  endif()
  target_link_libraries(${name} ${reach} ${ARG_LINKS})
  target_include_directories(${name} ${reach} "$<BUILD_INTERFACE:${folders}>" $<INSTALL_INTERFACE:${TAKT_INCLUDE_FOLDER}>)
  target_compile_features(${name} ${reach} cxx_std_20)
endfunction()

# takt_test(NAME SOURCES a_test.cpp ... LINKS takt_sim ...): one GoogleTest binary, run by ctest as one test. Its
# sources are compiled together too (TAKT_UNITY).
function(takt_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINKS;DEFINES" ${ARGN})
  if(NOT TAKT_TESTS)
    return()
  endif()
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE takt_options ${ARG_LINKS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE TAKT_SOURCE_DIR="${PROJECT_SOURCE_DIR}" ${ARG_DEFINES})
  target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-Og>)
  takt_precompiled(${name} TESTS)
  if(TAKT_UNITY)
    takt_unity(${name})
  endif()
  add_test(NAME ${name} COMMAND ${name})
  if(rapidcheck IN_LIST ARG_LINKS)
    # The same cases in every run. How many is what RC_PARAMS says before (tools/test, docs/testing.md).
    set_tests_properties(${name} PROPERTIES ENVIRONMENT_MODIFICATION "RC_PARAMS=string_append: seed=2026")
  endif()
endfunction()

# takt_test_support(NAME): the test includes from tests/support.
function(takt_test_support name)
  if(TAKT_TESTS)
    target_include_directories(${name} PRIVATE ${takt_test_folders})
  endif()
endfunction()

# takt_tier(TIER TEST...): these tests belong to the tier "full" or "night" of tools/test. A test without a tier is in
# all of them.
function(takt_tier tier)
  if(NOT tier MATCHES "^(full|night)$")
    message(FATAL_ERROR "takt_tier: expected full or night, found ${tier}")
  endif()
  set_property(TEST ${ARGN} APPEND PROPERTY LABELS ${tier})
endfunction()

# takt_mutants(NAME TABLE SAMPLE OPTION...): the mutants of a table are killed by the tests that it names; SAMPLE of
# them, at night all.
# They are compiled and linked by the commands of this build.
function(takt_mutants name table sample)
  if(NOT TAKT_TESTS OR TAKT_SANITIZE OR NOT CMAKE_BUILD_TYPE STREQUAL "Release" OR NOT CMAKE_GENERATOR STREQUAL "Ninja")
    return()
  endif()
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  add_test(NAME ${name} COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tests/mutation/mutants.py --build
    ${PROJECT_BINARY_DIR} --ninja ${CMAKE_MAKE_PROGRAM}
                                --table ${CMAKE_CURRENT_SOURCE_DIR}/${table} --sample ${sample} ${ARGN})
  set_tests_properties(${name} PROPERTIES TIMEOUT 3600)
  takt_tier(full ${name})
endfunction()
