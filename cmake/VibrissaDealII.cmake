# deal.II with PETSc as one target. deal_ii_setup_target would set its own optimisation
# level and language standard for every user, so its parts are used separately.
find_package(deal.II 9.4 REQUIRED)
foreach(feature MPI PETSC)
  if(NOT DEAL_II_WITH_${feature})
    message(FATAL_ERROR "deal.II was built without ${feature}; install the package libdeal.ii-dev")
  endif()
endforeach()

add_library(vibrissa_dealii INTERFACE)
target_include_directories(vibrissa_dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
target_compile_definitions(vibrissa_dealii INTERFACE BOOST_NO_AUTO_PTR)
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  target_compile_definitions(vibrissa_dealii INTERFACE DEBUG)
  target_link_libraries(vibrissa_dealii INTERFACE ${DEAL_II_LIBRARIES_DEBUG})
else()
  target_link_libraries(vibrissa_dealii INTERFACE ${DEAL_II_LIBRARIES_RELEASE})
endif()
