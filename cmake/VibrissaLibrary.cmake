get_filename_component(VIBRISSA_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

# Most of the build time is for large headers (deal.II, Eigen, GoogleMock). Therefore eight files are
# compiled together, and the headers of deal.II are precompiled once. Set -DVIBRISSA_BATCHES=OFF while you
# work on one file. With VIBRISSA_PRECOMPILE=OFF, too, the compiler finds what both options hide: a missing
# include, or a name that two files of a batch share by mistake.
set(VIBRISSA_SOLID_HEADERS <Eigen/Dense> <nlohmann/json.hpp> <deal.II/base/parameter_handler.h>
    <deal.II/fe/fe_values.h> <deal.II/grid/tria.h>)

function(vibrissa_batch target)
  if(VIBRISSA_BATCHES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# vibrissa_library(ROOM LINK ... [SOURCES ...]): the static library of one room (a folder with its
# sub-rooms), vibrissa::ROOM, from all its sources, or from those named.
function(vibrissa_library room)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  if(NOT ARG_SOURCES)
    file(GLOB_RECURSE ARG_SOURCES CONFIGURE_DEPENDS *.cc)
  endif()
  add_library(vibrissa_${room} STATIC ${ARG_SOURCES})
  add_library(vibrissa::${room} ALIAS vibrissa_${room})
  target_include_directories(vibrissa_${room} PUBLIC
    $<BUILD_INTERFACE:${VIBRISSA_ROOT}> $<INSTALL_INTERFACE:include/vibrissa>)
  target_link_libraries(vibrissa_${room} PUBLIC ${ARG_LINK})
  if(VIBRISSA_PRECOMPILE AND room STREQUAL "fem")
    target_precompile_headers(vibrissa_fem PRIVATE ${VIBRISSA_SOLID_HEADERS})
  elseif(VIBRISSA_PRECOMPILE AND room MATCHES "^(case|run_views|reproduction|suite|solid_apps)$")
    target_precompile_headers(vibrissa_${room} REUSE_FROM vibrissa_fem)
  endif()
  vibrissa_batch(vibrissa_${room})
endfunction()

# vibrissa_tests(ROOM LINK ... [SOURCES ...]): the GoogleTest program of one room, of every *_test.cc of
# the folder and SOURCES beside them. One CTest test for each test case; in rooms that load deal.II one CTest
# test for the program, because its start takes longer than most cases. Suites whose name begins with Long, and
# tests named long_, run in "./check --long" only.
function(vibrissa_tests room)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  file(GLOB_RECURSE tests CONFIGURE_DEPENDS *_test.cc)
  list(APPEND ARG_SOURCES ${tests})
  add_executable(test_${room} ${ARG_SOURCES})
  vibrissa_batch(test_${room})
  # The time of a test is spent in the rooms; of the test program itself it is spent in compiling it.
  target_compile_options(test_${room} PRIVATE $<$<CONFIG:Release>:-O1>)
  if(VIBRISSA_PRECOMPILE AND room MATCHES "^(materials|meshes|flow|fem)$")
    # GoogleMock must come first: the macro Assert of deal.II hides one of its functions.
    target_precompile_headers(test_${room} PRIVATE <gmock/gmock.h>)
  endif()
  target_link_libraries(test_${room} PRIVATE ${ARG_LINK} GTest::gmock_main)
  target_include_directories(test_${room} PRIVATE ${VIBRISSA_ROOT})
  target_compile_definitions(test_${room} PRIVATE
    VIBRISSA_SOURCE_DIR="${VIBRISSA_ROOT}"
    VIBRISSA_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(room MATCHES "^(materials|meshes|flow|fem)$")
    add_test(NAME ${room} COMMAND test_${room} --gtest_filter=-Long*)
    add_test(NAME long_${room} COMMAND test_${room} --gtest_filter=Long*)
    set_tests_properties(${room} long_${room} PROPERTIES LABELS ${room} TIMEOUT 1500)
  else()
    include(GoogleTest)
    gtest_discover_tests(test_${room} TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS ${room})
  endif()
endfunction()
