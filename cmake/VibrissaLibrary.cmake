get_filename_component(VIBRISSA_ROOT "${CMAKE_CURRENT_LIST_DIR}/.." ABSOLUTE)

# Rooms whose files read more than they compile: deal.II's headers are compiled once for them, and eight
# files at a time, which spares a whole build most of its work. Who works on one file sets
# -DVIBRISSA_BATCHES=OFF. Both OFF find what both hide: an include that is missing, a name that two files
# of a batch share by mistake. The tests are batched everywhere: eight share GoogleMock and Eigen.
set(VIBRISSA_BATCHED_ROOMS "^(materials|meshes|flow|fem|report|apps)$")
set(VIBRISSA_SOLID_HEADERS <Eigen/Dense> <nlohmann/json.hpp> <deal.II/base/parameter_handler.h>
    <deal.II/fe/fe_values.h> <deal.II/grid/tria.h>)

function(vibrissa_batch target)
  if(VIBRISSA_BATCHES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()

# vibrissa_library(ROOM SOURCES ... LINK ...): the static library of one room (folder), vibrissa::ROOM.
function(vibrissa_library room)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_library(vibrissa_${room} STATIC ${ARG_SOURCES})
  add_library(vibrissa::${room} ALIAS vibrissa_${room})
  target_include_directories(vibrissa_${room} PUBLIC
    $<BUILD_INTERFACE:${VIBRISSA_ROOT}> $<INSTALL_INTERFACE:include/vibrissa>)
  target_link_libraries(vibrissa_${room} PUBLIC ${ARG_LINK})
  if(VIBRISSA_PRECOMPILE AND room STREQUAL "fem")
    target_precompile_headers(vibrissa_fem PRIVATE ${VIBRISSA_SOLID_HEADERS})
  elseif(VIBRISSA_PRECOMPILE AND room STREQUAL "apps")
    target_precompile_headers(vibrissa_apps REUSE_FROM vibrissa_fem)
  endif()
  if(room MATCHES "${VIBRISSA_BATCHED_ROOMS}")
    vibrissa_batch(vibrissa_${room})
  endif()
endfunction()

# vibrissa_tests(ROOM SOURCES ... LINK ...): the GoogleTest program of one room. One CTest test a case; in
# rooms that load deal.II one CTest test for the program, whose start takes longer than most cases.
function(vibrissa_tests room)
  cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
  add_executable(test_${room} ${ARG_SOURCES})
  vibrissa_batch(test_${room})
  if(VIBRISSA_PRECOMPILE AND room MATCHES "^(materials|meshes|flow|fem)$")
    # First, too: deal.II's macro Assert hides a function of GoogleMock.
    target_precompile_headers(test_${room} PRIVATE <gmock/gmock.h>)
  endif()
  target_link_libraries(test_${room} PRIVATE ${ARG_LINK} GTest::gmock_main)
  target_include_directories(test_${room} PRIVATE ${VIBRISSA_ROOT})
  target_compile_definitions(test_${room} PRIVATE
    VIBRISSA_SOURCE_DIR="${VIBRISSA_ROOT}"
    VIBRISSA_BINARY_DIR="${PROJECT_BINARY_DIR}")
  if(room MATCHES "^(materials|meshes|flow|fem)$")
    add_test(NAME ${room} COMMAND test_${room})
    set_tests_properties(${room} PROPERTIES LABELS ${room} TIMEOUT 1500)
  else()
    include(GoogleTest)
    gtest_discover_tests(test_${room} TEST_PREFIX "${room}." DISCOVERY_TIMEOUT 60
                         PROPERTIES LABELS ${room})
  endif()
endfunction()
