# The four ways a target comes into being here. Sources are always listed by hand.

# Options that every target of ours shares. Floating point must give the same bits on every machine and at every
# optimisation level: no contraction into fused multiply-add, no fast-math, no -march=native.
add_library(ironbird_options INTERFACE)
target_compile_features(ironbird_options INTERFACE cxx_std_20)
# What the compiler warns of is our business in our targets and everybody's own in a program outside this tree.
define_property(TARGET PROPERTY IRONBIRD_OWN INITIALIZE_FROM_VARIABLE DEFAULT_IRONBIRD_OWN
                BRIEF_DOCS "A target of this tree" FULL_DOCS "A target of this tree, built with its warnings")
set(DEFAULT_IRONBIRD_OWN ON)
set(own $<TARGET_PROPERTY:IRONBIRD_OWN>)
target_compile_options(ironbird_options INTERFACE
  $<$<BOOL:${own}>:-Wall> $<$<BOOL:${own}>:-Wextra> $<$<BOOL:${own}>:-Wpedantic> $<$<BOOL:${own}>:-Wshadow>
  -ffp-contract=off
  $<$<AND:$<BOOL:${own}>,$<BOOL:${IRONBIRD_WARNINGS_AS_ERRORS}>>:-Werror>)
target_include_directories(ironbird_options INTERFACE ${PROJECT_SOURCE_DIR})
# Eigen's vectorised sums would otherwise depend on the optimisation level's choice of alignment.
target_compile_definitions(ironbird_options INTERFACE EIGEN_MAX_ALIGN_BYTES=16 EIGEN_MPL2_ONLY)

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
#   makes the program NAME_test and registers each of its cases with CTest under LABELS (default: unit). With WHOLE the
#   program is registered as one CTest case, for suites of very many small cases.
function(ironbird_test)
  if(NOT IRONBIRD_TESTS)
    return()
  endif()
  cmake_parse_arguments(arg "WHOLE" "NAME;TIMEOUT" "SOURCES;LINKS;LABELS" ${ARGN})
  if(NOT arg_LABELS)
    set(arg_LABELS unit)
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT 120)
  endif()
  set(target ${arg_NAME}_test)
  add_executable(${target} ${arg_SOURCES})
  target_link_libraries(${target} PRIVATE ironbird_options ${arg_LINKS} GTest::gmock GTest::gtest_main)
  target_compile_definitions(${target} PRIVATE IRONBIRD_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  if(arg_WHOLE)
    add_test(NAME ${target} COMMAND ${target} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
    set_tests_properties(${target} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
  else()
    gtest_discover_tests(${target} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT})
  endif()
endfunction()

# ironbird_benchmark(NAME plant SOURCES plant_benchmark.cpp LINKS ...) makes the program NAME_benchmark.
function(ironbird_benchmark)
  if(NOT IRONBIRD_BENCHMARKS)
    return()
  endif()
  cmake_parse_arguments(arg "" "NAME" "SOURCES;LINKS" ${ARGN})
  add_executable(${arg_NAME}_benchmark ${arg_SOURCES})
  target_link_libraries(${arg_NAME}_benchmark PRIVATE ironbird_options ${arg_LINKS} benchmark::benchmark_main)
endfunction()
