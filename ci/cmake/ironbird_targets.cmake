# The five ways a target comes into being here. Sources are always listed by hand.

# Options that every target of ours shares. Floating point must give the same bits on every machine and at every
# optimisation level: no contraction into fused multiply-add, no fast-math, no -march=native.
add_library(ironbird_options INTERFACE)
target_compile_features(ironbird_options INTERFACE cxx_std_20)
# What the compiler warns of is our business in our targets and everybody's own in a program outside this tree.
define_property(TARGET PROPERTY IRONBIRD_OWN INITIALIZE_FROM_VARIABLE DEFAULT_IRONBIRD_OWN
                BRIEF_DOCS "A target of this tree" FULL_DOCS "A target of this tree, built with its warnings")
set(DEFAULT_IRONBIRD_OWN ON)
set(own $<TARGET_PROPERTY:IRONBIRD_OWN>)
# GCC tidies up its memory while it compiles, a tenth of its time; not where there is a gigabyte for each of the
# compilers that run at a time, which are two more than there are cores.
cmake_host_system_information(RESULT memory QUERY TOTAL_PHYSICAL_MEMORY)
cmake_host_system_information(RESULT cores QUERY NUMBER_OF_LOGICAL_CORES)
math(EXPR memory_enough "${cores} * 1024 + 2048")
if(memory GREATER memory_enough)
  target_compile_options(ironbird_options INTERFACE
    "$<$<AND:$<CXX_COMPILER_ID:GNU>,$<BOOL:${own}>>:SHELL:--param ggc-min-expand=200 --param ggc-min-heapsize=400000>")
endif()
target_compile_options(ironbird_options INTERFACE
  $<$<BOOL:${own}>:-Wall> $<$<BOOL:${own}>:-Wextra> $<$<BOOL:${own}>:-Wpedantic> $<$<BOOL:${own}>:-Wshadow>
  -ffp-contract=off
  $<$<AND:$<BOOL:${own}>,$<BOOL:${IRONBIRD_WARNINGS_AS_ERRORS}>>:-Werror>)
target_include_directories(ironbird_options INTERFACE ${PROJECT_SOURCE_DIR})
# Eigen's vectorised sums would otherwise depend on the optimisation level's choice of alignment.
target_compile_definitions(ironbird_options INTERFACE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MPL2_ONLY)

# Sanitised programs bring their own malloc, need the sanitizers' symbols, are slow and give way to others.
set(sanitised OFF)
if(CMAKE_CXX_FLAGS_RELWITHDEBINFO MATCHES "-fsanitize=")
  set(sanitised ON)
endif()

# IRONBIRD_PRECOMPILED_HEADERS names whose foreign headers (Eigen, standard library, GoogleTest) are read once a build
# instead of once a file: `tests`, `libraries`. Where neither is named, in the `dev` preset, a file that forgot an include is found.
# Files that are compiled with other options need a VARIANT of their own.
function(ironbird_precompiled whose)
  cmake_parse_arguments(arg "" "VARIANT" "HEADERS;LINKS;OPTIONS" ${ARGN})
  if(NOT whose IN_LIST IRONBIRD_PRECOMPILED_HEADERS)
    return()
  endif()
  string(JOIN _ target ironbird_headers_of ${whose} ${arg_VARIANT})
  file(GENERATE OUTPUT ${PROJECT_BINARY_DIR}/${target}.cpp CONTENT "// Carries the precompiled headers of the ${whose}.\n")
  add_library(${target} OBJECT ${PROJECT_BINARY_DIR}/${target}.cpp)
  target_link_libraries(${target} PRIVATE ironbird_options ${arg_LINKS})
  target_compile_options(${target} PRIVATE ${arg_OPTIONS})
  target_precompile_headers(${target} PRIVATE ${arg_HEADERS})
endfunction()
function(ironbird_reuse_headers target whose)
  cmake_parse_arguments(arg "" "VARIANT" "" ${ARGN})
  if(whose IN_LIST IRONBIRD_PRECOMPILED_HEADERS)
    string(JOIN _ headers ironbird_headers_of ${whose} ${arg_VARIANT})
    target_precompile_headers(${target} REUSE_FROM ${headers})
    # GCC 12 finds fault with std::string's own operator+ (its bug 105651) and says so where it is precompiled.
    foreach(fault restrict array-bounds stringop-overflow stringop-overread)
      target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-${fault}>)
    endforeach()
  endif()
endfunction()
set(headers <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <array> <cmath> <cstdint> <filesystem> <fstream> <functional>
            <limits> <map> <memory> <numbers> <optional> <span> <sstream> <stdexcept> <string> <string_view> <utility>
            <variant> <vector>)
# No fuzz target finds its way through the wings, into which no bytes from outside come, nor through the tests' own code. Told of each
# comparison that the sanitizers make, the filters would run at less than half their speed.
set(untold -fno-sanitize=fuzzer-no-link)
ironbird_precompiled(libraries HEADERS ${headers} LINKS Eigen3::Eigen)
if(sanitised)
  ironbird_precompiled(libraries VARIANT of_the_wings HEADERS ${headers} LINKS Eigen3::Eigen OPTIONS ${untold})
endif()
function(ironbird_room_in_wings result)
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE room)
  string(REGEX MATCH "^(autopilot|simulator)(/|$)" wing "${room}")
  set(${result} ${wing} PARENT_SCOPE)
endfunction()
# The tests' own code, which runs once, is optimised less than what it tests. Sanitised, the tests of bridge and scenarios are
# not optimised at all. Those of the wings are: the linker keeps one copy of an inline function, a test's, and the library then
# runs Eigen's at the test's level.
set(test_variants optimised)
set(optimised_options $<$<CONFIG:Release>:-O1>)
if(sanitised)
  list(APPEND test_variants unoptimised)
  set(optimised_options ${untold})
  set(unoptimised_options -O0 ${untold})
endif()
if(IRONBIRD_TESTS)
  foreach(variant IN LISTS test_variants)
    ironbird_precompiled(tests VARIANT ${variant} HEADERS ${headers} <gmock/gmock.h> <gtest/gtest.h>
                         LINKS Eigen3::Eigen GTest::gmock OPTIONS ${${variant}_options})
  endforeach()
endif()

# IRONBIRD_UNITY_FILES sources of a library or a test are compiled as one, because most of a compiler's time goes into the
# headers and templates that they share. A name in an anonymous namespace is therefore unique within its target. Sources
# with options or definitions of their own are compiled alone.
function(ironbird_unite target)
  cmake_parse_arguments(arg "" "TIMES" "" ${ARGN})
  if(NOT arg_TIMES)
    set(arg_TIMES 1)
  endif()
  if(IRONBIRD_UNITY_FILES GREATER 1)
    math(EXPR files "${arg_TIMES} * ${IRONBIRD_UNITY_FILES}")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${files})
    # GCC takes a source that is included for a header, in which a class may not have a member of an unnamed namespace's.
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# ironbird_library(NAME simulator_mujoco SOURCES a.cpp ... LINKS simulator mujoco::mujoco)
#   makes the static library ironbird_NAME and its alias ironbird::NAME.
function(ironbird_library)
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINKS" ${ARGN})
  set(target ironbird_${arg_NAME})
  add_library(${target} STATIC ${arg_SOURCES})
  add_library(ironbird::${arg_NAME} ALIAS ${target})
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME ${arg_NAME})
  set_property(GLOBAL APPEND PROPERTY IRONBIRD_LIBRARIES ${target})
  target_link_libraries(${target} PUBLIC ironbird_options ${arg_LINKS})
  ironbird_room_in_wings(in_wings)
  if(sanitised AND in_wings)
    target_compile_options(${target} PRIVATE ${untold})
    ironbird_reuse_headers(${target} libraries VARIANT of_the_wings)
  else()
    ironbird_reuse_headers(${target} libraries)
  endif()
  ironbird_unite(${target})
endfunction()

# Writes the package files by which a program outside this tree finds the libraries in the build folder:
# find_package(ironbird PATHS .../build/release). Called once, last.
function(ironbird_export)
  get_property(libraries GLOBAL PROPERTY IRONBIRD_LIBRARIES)
  set_target_properties(ironbird_options PROPERTIES EXPORT_NAME options)
  export(TARGETS ironbird_options ${libraries} NAMESPACE ironbird:: FILE ${PROJECT_BINARY_DIR}/ironbird-targets.cmake)
  configure_file(${PROJECT_SOURCE_DIR}/ci/cmake/ironbird-config.cmake.in ${PROJECT_BINARY_DIR}/ironbird-config.cmake @ONLY)
endfunction()

# ironbird_test(NAME estimator SOURCES ekf_test.cpp ... LINKS ironbird::autopilot [LABELS slow] [WHOLE])
#   makes the program NAME_test and registers each of its cases with CTest under LABELS. With WHOLE the program is
#   registered as one CTest case, for cases that share what they flew. RUNNER is a command that runs the program, as one
#   case: ci/with_vcan. Unit tests, those without LABELS, are registered whole, too, because starting a program costs more
#   than most of their cases, a long one in PARTS that run at the same time; their cases have the label `case`, for
#   ctest -R. With IRONBIRD_WHOLE_TESTS no program is registered by its cases.
function(ironbird_test)
  if(NOT IRONBIRD_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "WHOLE" "NAME;TIMEOUT;PARTS" "SOURCES;LINKS;LABELS;RUNNER" ${ARGN})
  if(NOT arg_LABELS)
    set(arg_LABELS unit)
  endif()
  if(IRONBIRD_UNIT_TESTS_ONLY AND NOT unit IN_LIST arg_LABELS)
    return()
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  set(discovery 60)
  if(sanitised)
    math(EXPR arg_TIMEOUT "5 * ${arg_TIMEOUT}")
    math(EXPR discovery "5 * ${discovery}")
  endif()
  set(target ${arg_NAME}_test)
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ironbird_options ${arg_LINKS} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${target} PRIVATE IRONBIRD_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  ironbird_room_in_wings(in_wings)
  set(variant optimised)
  if(sanitised AND NOT in_wings)
    set(variant unoptimised)
  endif()
  target_compile_options(${target} PRIVATE ${${variant}_options})
  ironbird_reuse_headers(${target} tests VARIANT ${variant})
  ironbird_unite(${target} TIMES 2)  # they share GoogleTest's templates, too
  if(arg_WHOLE OR arg_RUNNER)
    add_test(NAME ${target} COMMAND ${arg_RUNNER} $<TARGET_FILE:${target}> WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${target} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
    return()
  endif()
  set(label_of_cases "${arg_LABELS}")
  if(IRONBIRD_WHOLE_TESTS OR unit IN_LIST arg_LABELS)
    ironbird_test_in_parts(${target} "${arg_LABELS}" ${arg_TIMEOUT} "${arg_PARTS}")
    set(label_of_cases case)
  endif()
  if(NOT IRONBIRD_WHOLE_TESTS)
    gtest_discover_tests(${target} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} DISCOVERY_TIMEOUT ${discovery}
                         PROPERTIES LABELS "${label_of_cases}" TIMEOUT ${arg_TIMEOUT})
  endif()
endfunction()

# The parts of one program, GoogleTest's shards; those of long programs begin first.
function(ironbird_test_in_parts target labels timeout parts)
  if(NOT parts)
    add_test(NAME ${target} COMMAND ${target} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${target} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout})
    return()
  endif()
  foreach(part RANGE 1 ${parts})
    math(EXPR index "${part} - 1")
    add_test(NAME ${target}.${part} COMMAND ${target} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${target}.${part} PROPERTIES LABELS "${labels}" TIMEOUT ${timeout} COST ${parts}
                         ENVIRONMENT "GTEST_TOTAL_SHARDS=${parts};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()

# ironbird_benchmark(NAME plant SOURCES plant_benchmark.cpp LINKS ...) makes the program NAME_benchmark.
function(ironbird_benchmark)
  if(NOT IRONBIRD_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINKS" ${ARGN})
  add_executable(${arg_NAME}_benchmark ${arg_SOURCES})
  target_link_libraries(${arg_NAME}_benchmark PRIVATE ironbird_options ${arg_LINKS} benchmark::benchmark_main)
  ironbird_reuse_headers(${arg_NAME}_benchmark libraries)
endfunction()

# ironbird_fuzz(NAME stream_decoder SOURCES fuzz/stream_decoder_fuzz.cpp LINKS ironbird::rosflight) makes the program
# build/sanitised/targets/NAME, which defines ironbird::fuzzing::check. Its corpus is fuzz/corpus/NAME beside it.
function(ironbird_fuzz)
  if(NOT IRONBIRD_FUZZERS)
    return()
  endif()
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINKS" ${ARGN})
  set(target ${arg_NAME}_fuzz)
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ironbird_options ironbird_fuzzing ${arg_LINKS})
  target_link_options(${target} PRIVATE -fsanitize=fuzzer)
  ironbird_reuse_headers(${target} libraries)
  target_compile_definitions(${target} PRIVATE IRONBIRD_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${arg_NAME} RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/targets)
  add_dependencies(ironbird_fuzzers ${target})
endfunction()
